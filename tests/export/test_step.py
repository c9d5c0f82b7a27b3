import subprocess
import sys

import cadquery as cq
import pytest
from shapely import box

from mdlcad.errors import SignoffError
from mdlcad.export.step import step_assembly
from mdlcad.export.stepfile import canonical_step
from mdlcad.parts.arcs import true_area
from mdlcad.parts.shapes import cut, disc, filleted, join
from mdlcad.signoff.files import check_bodies
from mdlcad.signoff.readback import read_step
from tests.export.bodies import body, few_bodies


def test_a_second_reader_finds_names_colours_and_volumes(tmp_path):
    path = tmp_path / "device.step"
    path.write_bytes(step_assembly("device", few_bodies()))
    found = {}
    for shape, name, _, colour in cq.Assembly.importStep(str(path)):
        found[name.removeprefix("device/")] = (shape.Volume(), colour.toTuple()[:3])
    assert sorted(found) == sorted(item.name for item in few_bodies())
    for item in few_bodies():
        volume, colour = found[item.name]
        assert volume == pytest.approx(true_area(item.section) * item.thickness, rel=1e-9)
        wanted = [int(item.colour[start : start + 2], 16) / 255 for start in (1, 3, 5)]
        # cadquery gives linear light or sRGB by version; order and zeros are the same in both
        assert [value > 0.3 for value in colour] == [value > 0.3 for value in wanted]


def test_fillets_and_eyes_are_round_faces(tmp_path):
    beam = filleted(join([box(0, 0, 2, 6), box(2, 2, 8, 2.5), box(8, 2, 10, 6)]), 0.2)
    eye = cut(disc(20.0, 5.0, 2.6), [disc(20.0, 5.0, 1.6)])
    path = tmp_path / "device.step"
    path.write_bytes(step_assembly("device", [body("beam", beam), body("eye", eye)]))
    radii = {
        name.removeprefix("device/"): sorted(
            round(face._geomAdaptor().Cylinder().Radius(), 3) for face in shape.Faces() if face.geomType() == "CYLINDER"
        )
        for shape, name, _, _ in cq.Assembly.importStep(str(path))
    }
    assert radii == {"beam": [0.2] * 3, "eye": [1.6, 1.6, 2.6, 2.6]}


def test_bodies_read_back_are_the_bodies_written(tmp_path):
    path = tmp_path / "device.step"
    path.write_bytes(step_assembly("device", few_bodies()))
    assert check_bodies(few_bodies(), read_step(path)) == []
    round_ = [body("eye", cut(disc(20.0, 5.0, 2.6), [disc(20.0, 5.0, 1.6)]))]
    path.write_bytes(step_assembly("device", round_))
    (read,) = read_step(path)
    assert check_bodies(round_, [read]) == []
    assert len(read.section.exterior.coords) == len(round_[0].section.exterior.coords)


@pytest.mark.parametrize(
    ("name", "other", "words"),
    [
        ("missing", lambda bodies: bodies[1:], "in the STEP file but not"),
        ("renamed", lambda bodies: [body("unit.z", bodies[0].section), *bodies[1:]], "holds it 0 times"),
        ("moved", lambda bodies: [body("unit.a[0]", box(0, 0, 10, 6), z=1.0), *bodies[1:]], "another height"),
        ("filled", lambda bodies: [body("unit.a[0]", box(0, 0, 10, 6)), *bodies[1:]], "mm3"),
        (
            "hole moved",
            lambda bodies: [body("unit.a[0]", box(0, 0, 10, 6).difference(box(3, 2, 5, 4))), *bodies[1:]],
            "outline",
        ),
    ],
)
def test_a_file_of_other_bodies_is_told_apart(tmp_path, name, other, words):
    path = tmp_path / "device.step"
    path.write_bytes(step_assembly("device", few_bodies()))
    problems = check_bodies(other(few_bodies()), read_step(path))
    assert any(words in problem for problem in problems), problems


def test_the_same_bytes_in_a_fresh_process_with_other_hashes():
    program = (
        "import sys, hashlib; from tests.export.bodies import few_bodies; from mdlcad.export.step import step_assembly;"
        "print(hashlib.sha256(step_assembly('device', few_bodies())).hexdigest())"
    )
    seen = {
        subprocess.run(
            [sys.executable, "-c", program], env={"PYTHONHASHSEED": seed}, capture_output=True, text=True, check=True
        ).stdout
        for seed in ("1", "2", "3")
    }
    assert len(seen) == 1


def test_the_same_bytes_whatever_was_written_before():
    first = step_assembly("device", few_bodies())
    step_assembly("other", few_bodies()[:2])
    assert step_assembly("device", few_bodies()) == first


def test_canonical_step_forgets_numbering_and_the_order_of_styles():
    head = "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n"
    tail = "ENDSEC;\nEND-ISO-10303-21;\n"
    style = "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION"
    one = f"#1=A('n #9');\n#2=B(#1,1.);\n#3=B(#1,2.);\n#4={style}('',(#2,#3),#1);\n"
    two = f"#7={style}('',\n (#5,#6),#9);\n#9=A('n #9');\n#6=B(#9,1.);\n#5=B(#9,2.);\n"
    assert canonical_step(head + one + tail) == canonical_step(head + two + tail)
    other = one.replace("'n #9'", "'n #8'")
    assert canonical_step(head + one + tail) != canonical_step(head + other + tail)


def test_text_that_is_no_step_file_is_refused():
    with pytest.raises(SignoffError):
        canonical_step("nothing")
