"""Screws and windows: where they are, and that they keep clear of all that moves."""

from dataclasses import replace

import pytest
import shapely

from mdlcad.mechanics.process import PlateRole
from mdlcad.parts.body import BodyKind
from mdlcad.parts.frame import frame_bodies
from mdlcad.parts.plates import plates_of
from mdlcad.parts.screws import screw_bodies
from mdlcad.parts.stack import make_stack
from mdlcad.signoff.drc import check_cut, check_motion
from tests.parts.device import small_device


@pytest.fixture(scope="module")
def device():
    made = small_device()
    masses = tuple(replace(mass, initial=1.2) for mass in made.network.masses)
    return replace(made, network=replace(made.network, masses=masses))


@pytest.fixture(scope="module")
def bodies(device):
    return device.bodies()


def test_screws_stand_in_the_rim_at_the_corners_and_no_farther_apart_than_the_pitch(device, bodies):
    screws = [body for body in bodies if body.kind is BodyKind.SCREW]
    frame, boundary = device.process.frame, device.boundary
    places = [screw.section.centroid for screw in screws]
    for x, y in list(boundary.exterior.coords)[:-1]:
        assert min(place.distance(shapely.Point(x, y)) for place in places) < frame.width
    along = sorted(boundary.exterior.project(place) for place in places)
    gaps = [b - a for a, b in zip(along, [*along[1:], along[0] + boundary.exterior.length], strict=True)]
    # a tab or handle may push a screw by half a pitch
    assert max(gaps) <= 1.5 * frame.screw_pitch
    for place in places:
        assert boundary.exterior.distance(place) >= frame.screw_hole / 2.0 + device.process.pin.wall


def test_every_sheet_that_lies_under_a_screw_has_its_clearance_hole(device, bodies):
    screws = [body for body in bodies if body.kind is BodyKind.SCREW]
    play = (device.process.frame.screw_hole - device.process.frame.screw) / 2.0
    for body in bodies:
        if body.kind is not BodyKind.SCREW:
            for screw in screws:
                assert shapely.distance(body.section, screw.section) >= 0.98 * play, (body.name, screw.name)


def test_windows_and_screws_break_no_rule(device, bodies):
    assert check_motion(bodies, device.sizing.rules.gap) == []
    machine = device.process.machine
    for plate, members in plates_of(bodies).items():
        assert check_cut(plate, members, machine.min_wall, machine.min_gap) == []


def test_a_window_is_as_long_as_the_stroke_of_its_pin(device, bodies):
    cover = next(body.section for body in bodies if body.kind is BodyKind.COVER)
    rules = device.sizing.rules
    sizes = {(round(x1 - x0, 3), round(y1 - y0, 3)) for x0, y0, x1, y1 in (ring.bounds for ring in cover.interiors)}
    wanted = (round(rules.pin + 2 * rules.gap, 3), round(rules.pin + 2 * (rules.throw + rules.gap), 3))
    assert wanted in sizes


def test_without_a_starting_state_there_are_no_windows(bodies):
    made = small_device()
    plain = next(body.section for body in made.bodies() if body.kind is BodyKind.COVER)
    open_ = next(body.section for body in bodies if body.kind is BodyKind.COVER)
    assert len(open_.interiors) > len(plain.interiors)


def test_a_piece_of_rim_between_two_near_tabs_that_no_screw_holds_is_left_out(device):
    boundary = device.boundary
    stack = make_stack(device.process, device.sizing, device.network.dynamics.phases)
    low_x, low_y, high_x, _ = boundary.bounds
    middle = low_x + 0.26 * (high_x - low_x)  # between a corner and the screw half way
    sides = [shapely.box(middle + at - 6.0, low_y - 1.0, middle + at + 6.0, low_y + 12.0) for at in (-11.0, 11.0)]
    between = shapely.Point(middle, low_y + 2.0)  # a piece 10 mm wide
    plate = device.process.plates(PlateRole.RUNG)[0].name
    screws = screw_bodies(stack, boundary, sides)
    piece = shapely.box(middle - 5.0, low_y, middle + 5.0, low_y + 12.0)
    assert not any(piece.contains(screw.section.centroid) for screw in screws)
    made = frame_bodies(stack, boundary, (), (), {plate: sides}, screws, ())
    over = [body for body in made if body.name.startswith((f"frame.{plate}", f"shim.{plate}"))]
    assert over and not any(body.section.intersects(between) for body in over)
    whole = frame_bodies(stack, boundary, (), (), {}, screws, ())
    assert any(body.section.intersects(between) for body in whole if body.name.startswith(f"frame.{plate}"))
    for body in made:
        if body.kind in (BodyKind.FRAME, BodyKind.SPACER):
            rings = shapely.Polygon(body.section.exterior)
            assert any(rings.contains(screw.section.centroid) for screw in screws), body.name
