import io
import math
import subprocess
import sys
from xml.etree import ElementTree

import ezdxf
import pytest
from ezdxf.math import bulge_to_arc
from shapely import box

from mdlcad.errors import SignoffError
from mdlcad.export.drawing import dxf_plate, svg_plate
from mdlcad.export.solid import plate_section
from mdlcad.parts.shapes import cut, disc, join, strip
from tests.export.bodies import body, few_bodies


def test_svg_shows_every_body_by_name_and_colour():
    root = ElementTree.fromstring(svg_plate("unit", few_bodies()))
    space = {"s": "http://www.w3.org/2000/svg"}
    paths = root.findall(".//s:path", space)
    assert [path.find("s:title", space).text for path in paths] == [item.name for item in few_bodies()]
    assert [path.get("fill") for path in paths] == [item.colour for item in few_bodies()]
    assert root.get("width").endswith("mm")


def drawn(data: bytes) -> tuple[list, list]:
    """Cut outlines, as ezdxf reads them back, and names."""
    document = ezdxf.read(io.StringIO(data.decode()))
    assert document.units == ezdxf.units.MM
    assert not document.layers.get("NAMES").dxf.plot
    space = list(document.modelspace())
    assert {item.dxf.layer for item in space} <= {"OUTER", "INNER", "NAMES"}
    lines = [item for item in space if item.dxftype() == "LWPOLYLINE"]
    assert all(line.closed for line in lines)
    return lines, [item for item in space if item not in lines]


def area(line) -> float:
    """Of a polyline with arcs: its polygon and, for every arc, the segment beyond its chord."""
    vertices = line.get_points()
    total = 0.0
    for (x, y, *_, bulge), (x1, y1, *_) in zip(vertices, [*vertices[1:], vertices[0]], strict=True):
        total += (x * y1 - x1 * y) / 2.0
        if bulge:
            angle = 4.0 * math.atan(bulge)
            radius = math.hypot(x1 - x, y1 - y) / (2.0 * math.sin(abs(angle) / 2.0))
            total += math.copysign(radius**2 / 2.0 * (abs(angle) - math.sin(abs(angle))), angle)
    return abs(total)


def test_dxf_is_closed_polylines_in_millimetres_with_the_area_of_the_section():
    bodies = [item for item in few_bodies() if item.plate == "unit"]
    lines, names = drawn(dxf_plate(bodies))
    total = sum(area(line) * (1.0 if line.dxf.layer == "OUTER" else -1.0) for line in lines)
    assert total == pytest.approx(sum(polygon.area for polygon in plate_section(bodies)))
    assert [item.dxf.text for item in names] == [item.name for item in bodies]
    assert {item.dxf.layer for item in names} == {"NAMES"}


def test_round_holes_and_eyes_are_true_arcs_of_their_design_radius():
    eye = cut(join([disc(10.0, 5.0, 2.6), strip([(0.0, 5.0), (10.0, 5.0)], 0.8)]), [disc(10.0, 5.0, 1.6)])
    lines, _ = drawn(dxf_plate([body("eye", eye)]))
    inner = next(line for line in lines if line.dxf.layer == "INNER")
    outer = next(line for line in lines if line.dxf.layer == "OUTER")
    assert area(inner) == pytest.approx(math.pi * 1.6**2, rel=2e-4)
    assert len(inner) == 2
    arcs = [
        bulge_to_arc((x, y), (x1, y1), bulge)
        for (x, y, *_, bulge), (x1, y1, *_) in zip(
            outer.get_points(), [*outer.get_points()[1:], outer.get_points()[0]], strict=True
        )
        if bulge
    ]
    assert arcs
    for centre, _, _, radius in arcs:
        assert radius == pytest.approx(2.6, abs=2e-3)
        assert (centre.x, centre.y) == pytest.approx((10.0, 5.0), abs=2e-3)


def test_straight_outlines_stay_straight():
    lines, _ = drawn(dxf_plate(few_bodies()[:3]))
    assert all(bulge == 0.0 for line in lines for *_, bulge in line.get_points())


def test_kerf_is_applied_only_when_asked_and_evenly():
    bodies = [body("a", box(0, 0, 10, 6).difference(box(2, 2, 4, 4)))]
    plain, wide = drawn(dxf_plate(bodies))[0], drawn(dxf_plate(bodies, kerf_mm=0.2))[0]
    assert [area(line) for line in plain] == pytest.approx([60.0, 4.0])
    assert [area(line) for line in wide] == pytest.approx([10.2 * 6.2, 1.8 * 1.8])
    with pytest.raises(SignoffError, match=r"narrower than the kerf of 2\.5 mm"):
        dxf_plate(bodies, kerf_mm=2.5)


def test_the_same_dxf_in_a_fresh_process_with_other_hashes():
    program = (
        "import hashlib; from tests.export.bodies import few_bodies; from mdlcad.export.drawing import dxf_plate;"
        "print(hashlib.sha256(dxf_plate(few_bodies()[:3])).hexdigest())"
    )
    seen = {
        subprocess.run(
            [sys.executable, "-c", program], env={"PYTHONHASHSEED": seed}, capture_output=True, text=True, check=True
        ).stdout
        for seed in ("1", "2")
    }
    assert len(seen) == 1
