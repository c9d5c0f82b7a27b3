"""A ring with units, too large for the bed: what is cut, where, and what stays whole."""

import pytest
import shapely
from shapely import box

from mdlcad.mechanics import load_process, process_names
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.tiles import fits, joint_of, tiles_of
from tests.export.bodies import body
from tests.parts.process import with_bed

PROCESS = load_process("pom_cut")
WIDE, HIGH, RIM = 200.0, 90.0, 8.0


def ring(width: float = WIDE, height: float = HIGH) -> Body:
    section = box(0, 0, width, height).difference(box(RIM, RIM, width - RIM, height - RIM))
    return body("frame.unit", section, kind=BodyKind.FRAME)


def unit(name: str, x: float, width: float = 40.0) -> Body:
    """A unit that hangs between the lower and the upper side of the ring."""
    return body(f"unit.{name}", box(x, RIM, x + width, HIGH - RIM), kind=BodyKind.UNIT)


def test_a_plate_that_fits_either_way_round_is_one_tile():
    for bed in ((200.0, 90.0), (90.0, 200.0)):
        tiling = tiles_of("unit", [ring()], with_bed(PROCESS, bed))
        assert [tile.name for tile in tiling.tiles] == ["unit"]
        assert tiling.tiles[0].bodies == (ring(),)


def test_a_ring_becomes_tiles_that_fit_join_and_lose_nothing_but_the_clearance():
    process, joint = with_bed(PROCESS, (120.0, 95.0)), joint_of(PROCESS)
    tiling = tiles_of("unit", [ring()], process)
    assert tiling.untiled == ()
    assert [tile.name for tile in tiling.tiles] == ["unit-1", "unit-2"]
    left, right = (shapely.union_all([item.section for item in tile.bodies]) for tile in tiling.tiles)
    assert fits(left, process.machine.bed) and fits(right, process.machine.bed)
    assert shapely.distance(left, right) == pytest.approx(joint.clearance, abs=1e-3)
    lost = ring().section.area - left.area - right.area
    assert 0.0 < lost < joint.clearance * 2 * (RIM + 6 * joint.depth)
    # the tongue cannot be drawn out of its socket: moved apart by more than the play, they meet
    assert shapely.intersects(shapely.affinity.translate(left, -3.0 * joint.clearance), right)


def test_no_seam_crosses_a_unit():
    units = [unit("a", 20), unit("b", 70), unit("c", 130)]
    tiling = tiles_of("unit", [ring(), *units], with_bed(PROCESS, (130.0, 95.0)))
    assert tiling.untiled == ()
    whole = [item for tile in tiling.tiles for item in tile.bodies if item.kind is BodyKind.UNIT]
    assert sorted(whole, key=lambda item: item.name) == units
    frames = [item.section.bounds for tile in tiling.tiles for item in tile.bodies if item.kind is BodyKind.FRAME]
    seam = min(bounds[0] for bounds in frames if bounds[0] > 0.0)
    assert 110.0 < seam < 130.0


def test_where_units_leave_no_room_the_plate_and_the_place_are_told():
    tiling = tiles_of("unit", [ring(), unit("a", 10, 180.0)], with_bed(PROCESS, (150.0, 95.0)))
    assert tiling.tiles == ()
    assert tiling.untiled[0].bodies == ("unit.a",)
    assert "mm in x, the bed 150; no straight seam" in tiling.untiled[0].reason


def test_a_carrier_longer_than_the_bed_cannot_be_cut():
    bar = body("trunk.a", box(0, 0, 4, 130), kind=BodyKind.TRUNK, plate="V")
    tiling = tiles_of("V", [bar], with_bed(PROCESS, (120.0, 95.0)))
    assert [item.bodies for item in tiling.untiled] == [("trunk.a",)]


def test_loose_pieces_go_where_there_is_room_and_else_on_a_bed_of_their_own():
    bars = [body(f"rung.{i}", box(15 + 20 * i, 20, 28 + 20 * i, 80), kind=BodyKind.RUNG) for i in range(8)]
    process = with_bed(PROCESS, (101.0, 95.0))
    tiling = tiles_of("unit", [ring(), *bars], process)
    named = [item.name for tile in tiling.tiles for item in tile.bodies if item.kind is BodyKind.RUNG]
    assert sorted(named) == sorted(item.name for item in bars)
    assert len(tiling.tiles) > 2
    for tile in tiling.tiles:
        sections = [item.section for item in tile.bodies]
        assert fits(shapely.GeometryCollection(sections), process.machine.bed)
        assert shapely.union_all(sections).area == pytest.approx(sum(item.area for item in sections))


def test_neighbouring_plates_have_their_seams_apart():
    process = with_bed(PROCESS, (150.0, 95.0))

    def seam(plate: str) -> float:
        frame = body(f"frame.{plate}", ring().section, kind=BodyKind.FRAME, plate=plate)
        bounds = [item.section.bounds for tile in tiles_of(plate, [frame], process).tiles for item in tile.bodies]
        return min(b[0] for b in bounds if b[0] > 0.0)

    assert abs(seam("unit") - seam("V")) > 50.0


def test_a_rib_is_crossed_in_the_middle_of_a_post_and_nowhere_else():
    side, rib = PROCESS.pin.side, box(98, 0, 102, HIGH)
    posts = [body(f"post.{y}", box(99, y - 1, 101, y + 1), kind=BodyKind.POST) for y in (35.0, 55.0)]
    holes = shapely.union_all([post.section for post in posts])
    ribbed = body("frame.unit", ring().section.union(rib).difference(holes), kind=BodyKind.FRAME)
    tiling = tiles_of("unit", [ribbed], with_bed(PROCESS, (205.0, 60.0)))
    assert tiling.untiled == ()
    lower, upper = (shapely.union_all([item.section for item in tile.bodies]) for tile in tiling.tiles)
    # either rib end has a notch that holds the post sideways
    for part in (lower, upper):
        for dx in (-side, side):
            pushed = shapely.affinity.translate(posts[1].section, dx / 4.0)
            assert shapely.intersects(part, pushed.buffer(-0.01))
    assert lower.bounds[3] == pytest.approx(55.0 + joint_of(PROCESS).depth, abs=1e-3)
    plain = body("frame.unit", ring().section.union(rib), kind=BodyKind.FRAME)
    # without the post the rib bars that seam, and along the rib there is no room for one
    plain = tiles_of("unit", [plain], with_bed(PROCESS, (205.0, 60.0)))
    assert len(plain.tiles) > 2
    seams = {round(x, 1) for tile in plain.tiles for item in tile.bodies for x in item.section.bounds[::2]}
    assert not any(96.0 < x < 104.0 for x in seams)


@pytest.mark.parametrize("name", process_names())
def test_the_dovetail_of_a_shipped_process_fits_its_rim(name):
    process = load_process(name)
    joint = joint_of(process)
    assert joint.head + 2.0 * joint.wall <= process.frame.width
    assert joint.neck >= 2.0 * process.machine.min_wall
