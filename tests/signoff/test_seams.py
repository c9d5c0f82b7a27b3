"""Tiles that break their rules, and tiles that keep them."""

from dataclasses import replace

from shapely import box
from shapely.affinity import translate

from mdlcad.mechanics import load_process
from mdlcad.parts.body import BodyKind
from mdlcad.parts.tiles import Tile, Tiling, tiles_of
from mdlcad.signoff.seams import check_tiles
from tests.export.bodies import body
from tests.parts.process import with_bed

BED, WALL = (120.0, 95.0), 1.0
FRAME = body("frame.unit", box(0, 0, 200, 8), kind=BodyKind.FRAME)
UNIT = body("unit.a", box(90, 8, 130, 40), kind=BodyKind.UNIT)
BAR = body("rung.a", box(90, 50, 130, 54), kind=BodyKind.RUNG)


def cut_at(x: float, *bodies):
    """Tiles by a straight cut through whatever is there."""
    tiles = []
    for number, half in ((1, box(-1, -1, x, 100)), (2, box(x, -1, 201, 100))):
        parts = []
        for item in bodies:
            section = item.section & half
            if section.area:
                name = f"{item.name}/{number}" if section.area < item.section.area and item is FRAME else item.name
                parts.append(replace(item, name=name, section=section))
        tiles.append(Tile(f"unit-{number}", "unit", tuple(parts)))
    return Tiling(tuple(tiles), ())


def rules(findings):
    return sorted({finding.rule for finding in findings})


def test_a_seam_beside_the_unit_is_fine():
    assert check_tiles([FRAME, UNIT], cut_at(85.0, FRAME, UNIT), BED, WALL) == []


def test_a_seam_through_a_flexure_is_caught():
    found = check_tiles([FRAME, UNIT], cut_at(110.0, FRAME, UNIT), BED, WALL)
    assert rules(found) == ["seam"]
    assert any("unit.a" in item.bodies and "a seam crosses it" in item.message for item in found)


def test_a_seam_through_a_carrier_is_caught():
    found = check_tiles([FRAME, BAR], cut_at(110.0, FRAME, BAR), BED, WALL)
    assert [item.bodies for item in found] == [("rung.a",)]


def test_a_seam_in_the_root_of_a_flexure_is_caught_with_its_distance():
    found = check_tiles([FRAME, UNIT], cut_at(89.5, FRAME, UNIT), BED, WALL)
    assert rules(found) == ["seam"]
    assert abs(found[0].value - 0.5) < 1e-6 and found[0].limit == WALL


def test_a_body_that_is_in_no_tile_or_in_two_is_caught():
    whole = Tile("unit-1", "unit", (UNIT,))
    assert rules(check_tiles([UNIT], Tiling((), ()), BED, WALL)) == ["seam"]
    assert rules(check_tiles([UNIT], Tiling((whole, whole), ()), BED, WALL)) == ["seam"]


def test_a_tile_larger_than_the_bed_either_way_round():
    def one(width: float, height: float):
        item = body("base", box(0, 0, width, height), kind=BodyKind.BASE)
        return check_tiles([item], Tiling((Tile("base", "base", (item,)),), ()), (600.0, 400.0), WALL)

    assert one(300, 500) == []
    assert rules(one(450, 500)) == ["bed"]


def test_what_cannot_be_tiled_is_told_once_with_its_place():
    bar = translate(body("trunk.a", box(0, 0, 4, 130), kind=BodyKind.TRUNK).section, 7.0)
    trunk = body("trunk.a", bar, kind=BodyKind.TRUNK)
    tiling = tiles_of("V", [trunk], with_bed(load_process("pom_cut"), BED))
    found = check_tiles([trunk], tiling, BED, WALL)
    assert rules(found) == ["bed"] and len(found) == 1
    assert 7.0 <= found[0].x <= 11.0 and found[0].value == 130.0
