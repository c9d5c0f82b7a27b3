"""Where guides of clock plates stand: in every kind of outline, clear of slots, between rim and plate."""

import pytest
import shapely
from shapely import Polygon

from mdlcad.mechanics.guides import guide_leaf
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.clock import handle_place
from mdlcad.parts.frame import interior
from mdlcad.parts.guides import Turned, clock_guides
from mdlcad.parts.shapes import box
from mdlcad.parts.stack import FRAME_REF, Stack, clock_ref, make_stack
from tests.parts.device import Device, small_device


@pytest.fixture(scope="module")
def device() -> Device:
    return small_device()


@pytest.fixture(scope="module")
def stack(device: Device) -> Stack:
    return make_stack(device.process, device.sizing, 3)


def on(bodies: tuple[Body, ...], plate: str, kind: BodyKind) -> list[Body]:
    return [body for body in bodies if body.plate == plate and body.kind is kind]


def test_every_clock_plate_hangs_on_two_leaves_and_is_one_piece_with_its_rim(device: Device) -> None:
    bodies = device.bodies()
    for phase, plate in enumerate(("clock-0", "clock-1", "clock-2")):
        guides = on(bodies, plate, BodyKind.GUIDE)
        (sheet,), (rim,) = on(bodies, plate, BodyKind.CLOCK), on(bodies, plate, BodyKind.SPACER)
        assert [guide.moves_with for guide in guides] == [(FRAME_REF, clock_ref(phase))] * 2
        leaf = guide_leaf(device.process, device.process.plate(plate), device.sizing.rules.clock_throw, 0.5)
        for guide in guides:
            low, bottom, high, top = guide.section.bounds
            root = leaf.wall + 2.0 * leaf.fillet
            assert (high - low, top - bottom) == pytest.approx((root, leaf.length), abs=1e-3)
            assert guide.section.area > leaf.wall * leaf.length
            for end in (sheet, rim):
                shared = shapely.intersection(guide.section, end.section)
                assert shared.length == pytest.approx(root, abs=1e-3) and shared.area < 1e-6
        whole = shapely.union_all([body.section for body in (sheet, rim, *guides)], grid_size=1e-4)
        assert isinstance(whole, Polygon)


OUTLINES = {
    "square": box(0.0, 0.0, 200.0, 200.0),
    "hexagon on a corner": Polygon([(100, 0), (187, 50), (187, 150), (100, 200), (13, 150), (13, 50)]),
    "triangle": Polygon([(0, 0), (240, 0), (120, 220)]),
    "triangle on its tip": Polygon([(120, 0), (240, 220), (0, 220)]),
    "house": Polygon([(0, 0), (180, 0), (180, 120), (90, 220), (0, 120)]),
}


@pytest.mark.parametrize("outline", OUTLINES)
def test_guides_fit_every_outline(stack: Stack, outline: str) -> None:
    boundary, rules = OUTLINES[outline], stack.sizing.rules
    inside, sheet = interior(stack, boundary), interior(stack, boundary, rules.gap + rules.clock_throw)
    handle = handle_place(stack, boundary)
    tongue = box(handle.x_start, handle.y - 4.0, handle.x_end, handle.y + 4.0)
    slots = [box(x, y, x + 5.0, y + 4.0) for x in range(20, 220, 40) for y in range(20, 200, 13)]
    away = [slot for slot in slots if sheet.contains(slot)]
    guides = clock_guides(stack, "clock-0", inside, sheet, [*away, tongue], Turned(1500.0, handle.y, (20.0, 180.0)))
    assert guides is not None
    rim = boundary.difference(inside)
    plate = sheet.difference(shapely.union_all([*away, *(place.pocket for place in guides.places)]))
    assert isinstance(plate, Polygon)
    for body in guides.bodies(stack, "clock-0", clock_ref(0)):
        assert shapely.intersection(body.section, rim).area < 1e-3
        # it is rooted over its whole wall, and ends on the plate over its whole wall
        assert body.section.buffer(1e-3).intersection(rim).length > 2.0 * guides.leaf.wall
        assert shapely.intersection(body.section.buffer(1e-3), plate).area > 1e-3 * guides.leaf.wall
        assert body.envelope is not None
        moving = shapely.difference(body.envelope, body.section.buffer(rules.clock_throw + 1e-3))
        assert moving.area < 1e-2
        assert all(shapely.distance(body.envelope, slot) > rules.gap for slot in away)
    left, right = guides.places
    assert right.x - left.x > 50.0


def test_what_turns_a_plate_more_takes_a_thicker_leaf(stack: Stack) -> None:
    boundary, rules = OUTLINES["square"], stack.sizing.rules
    inside, sheet = interior(stack, boundary), interior(stack, boundary, rules.gap + rules.clock_throw)
    walls = []
    for moment in (100.0, 6000.0, 20000.0):
        guides = clock_guides(stack, "clock-0", inside, sheet, [], Turned(moment, 100.0, (20.0, 180.0)))
        assert guides is not None
        walls.append(guides.leaf.wall)
    assert walls == sorted(walls) and walls[0] == stack.process.machine.min_wall < walls[1]


def test_without_room_there_are_none(stack: Stack) -> None:
    boundary, rules = box(0.0, 0.0, 60.0, 40.0), stack.sizing.rules
    inside, sheet = interior(stack, boundary), interior(stack, boundary, rules.gap + rules.clock_throw)
    assert clock_guides(stack, "clock-0", inside, sheet, [], Turned(100.0, 20.0, (10.0, 30.0))) is None
