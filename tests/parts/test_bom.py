from dataclasses import replace

import pytest
import trimesh
from shapely import Point, box

from mdlcad.export.mesh import stl_plate
from mdlcad.mechanics import load_process
from mdlcad.parts import Body, BodyKind
from mdlcad.parts.bom import Profile, bill_of_materials
from mdlcad.parts.plates import plates_of
from tests.parts.device import small_device


def body(name, kind, plate, section, thickness=2.0, z=0.0):
    return Body(name, kind, plate, z, thickness, section, (0.0, 0.0), ("frame",), "#000000")


def test_a_bill_by_hand():
    process = load_process("pom_cut")
    bodies = [
        body("base", BodyKind.BASE, "base", box(0, 0, 100, 50), 5.0),
        body("a", BodyKind.UNIT, "unit", box(0, 0, 10, 10), z=10.0),
        body("b", BodyKind.UNIT, "unit", box(20, 0, 30, 10), z=10.0),
        # touches b: one piece when cut, a line of its own in the list of parts
        body("c", BodyKind.FRAME, "unit", box(30, 0, 40, 10), z=10.0),
        body("shim", BodyKind.SPACER, "shims", box(0, 0, 100, 50), 0.3),
        body("pin 1", BodyKind.PIN, "pins", box(1, 1, 3, 3), 8.9),
        body("pin 2", BodyKind.PIN, "pins", box(5, 1, 7, 3), 8.9),
        body("post", BodyKind.POST, "pins", Point(50, 25).buffer(1.5), 10.0),
    ]
    bom = bill_of_materials(bodies, process)
    base, shims, unit = bom.sheets
    assert (base.material, base.size_mm, base.pieces) == ("aluminium", (100.0, 50.0), 1)
    assert base.mass_g == pytest.approx(100 * 50 * 5 * 2.70e-3)
    assert (shims.material, shims.mass_g, shims.thickness_mm) == (None, None, 0.3)
    assert (unit.pieces, unit.size_mm) == (2, (40.0, 10.0))
    assert [(line.kind, line.plate, line.count) for line in bom.parts] == [
        (BodyKind.BASE, "base", 1),
        (BodyKind.SPACER, "shims", 1),
        (BodyKind.FRAME, "unit", 1),
        (BodyKind.UNIT, "unit", 2),
    ]
    pins, post = bom.stock
    assert (pins.profile, pins.size_mm, pins.length_mm, pins.count) == (Profile.SQUARE, 2.0, 8.9, 2)
    assert (post.profile, post.size_mm, post.material) == (Profile.ROUND, 3.0, "steel")
    assert pins.mass_g == pytest.approx(2 * 4 * 8.9 * 7.85e-3, abs=1e-3)
    known = [base.mass_g, unit.mass_g, pins.mass_g, post.mass_g]
    assert bom.mass_g == pytest.approx(sum(known), abs=1e-3)


def test_sheets_weigh_what_their_meshes_hold(tmp_path):
    device = small_device()
    bodies = device.bodies()
    bom = {line.plate: line for line in bill_of_materials(bodies, device.process).sheets}
    for plate, members in plates_of(bodies).items():
        if plate == "shims":
            continue
        (tmp_path / "plate.stl").write_bytes(stl_plate(plate, members))
        volume = trimesh.load(tmp_path / "plate.stl").volume
        density = device.process.material(device.process.plate(plate)).density
        assert bom[plate].mass_g == pytest.approx(volume * density * 1e-3, rel=1e-4), plate


def test_every_body_is_counted_once_and_a_thicker_one_apart():
    device = small_device()
    bodies = list(device.bodies())
    bom = bill_of_materials(bodies, device.process)
    assert sum(line.count for line in (*bom.parts, *bom.stock)) == len(bodies)
    first = next(index for index, item in enumerate(bodies) if item.kind is BodyKind.UNIT)
    bodies[first] = replace(bodies[first], thickness=bodies[first].thickness + 1.0)
    units = [line for line in bill_of_materials(bodies, device.process).parts if line.kind is BodyKind.UNIT]
    assert sorted(line.count for line in units) == [1, 5]
