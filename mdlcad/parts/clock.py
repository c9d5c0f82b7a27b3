"""Clock plates, one a phase: sheets that move in x on their guides, and the pins that push the units' clock blocks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import shapely
from shapely import Polygon
from shapely.affinity import translate

from mdlcad.errors import UsageError
from mdlcad.mechanics.decks import Deck, plate_in
from mdlcad.mechanics.drive import DriveLoads, Seat, drive_loads
from mdlcad.mechanics.process import Process
from mdlcad.mechanics.sizes import UnitSize
from mdlcad.mechanics.sizing import Sizing
from mdlcad.network.model import Network
from mdlcad.parts import palette
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.frame import interior
from mdlcad.parts.guides import Turned, clock_guides
from mdlcad.parts.shapes import GRID, box, cut, join, only, pieces, square, without_thin
from mdlcad.parts.stack import Hub, Stack, clock_ref, make_stack
from mdlcad.parts.unit import clock_pin_x
from mdlcad.placement.placement import Placement


@dataclass(frozen=True, slots=True)
class Handle:
    """The tongue by which a clock plate is driven: its middle in y, and its end in x outside the boundary."""

    y: float
    x_start: float
    x_end: float


def handle_place(stack: Stack, boundary: Polygon) -> Handle:
    """Where the handles leave the device: to the right, at the middle of the widest run of the right-hand edge."""
    rules = stack.sizing.rules
    x_high = boundary.bounds[2]
    strip = box(x_high - 2.0 * rules.frame_width, boundary.bounds[1], x_high, boundary.bounds[3])
    at_edge = max(pieces(strip.intersection(boundary)), key=lambda piece: piece.area)
    y = round((at_edge.bounds[1] + at_edge.bounds[3]) / 2.0, 4)
    return Handle(y, x_high - 3.0 * rules.frame_width, x_high + 2.0 * rules.frame_width)


def clock_seats(
    network: Network, placement: Placement, sizing: Sizing, process: Process, boundary: Polygon
) -> tuple[Seat, ...]:
    """Where every unit meets its clock plate.

    The handles of both decks stand at one height.
    """
    stack = make_stack(process, sizing, network.dynamics.phases)
    handle = handle_place(stack, boundary).y
    phases = {mass.name: mass.phase for mass in network.masses}
    return tuple(
        Seat(
            place.mass,
            plate_in(Deck.UPPER if place.deck is Deck.UPPER else Deck.LOWER, stack.clock_plates[phases[place.mass]]),
            round(place.y - handle, 4),
        )
        for place in placement.masses
    )


def device_loads(
    network: Network, placement: Placement, sizing: Sizing, process: Process, sensor_force: float, seed: int
) -> DriveLoads:
    """What drives a device that is placed; see ``drive_loads``.

    Args:
        process: with the plates of both decks, if the device has two.
    """
    seats = clock_seats(network, placement, sizing, process, Polygon(placement.boundary))
    return drive_loads(network, sizing, process, sensor_force, seed, seats)


def handle_notch(stack: Stack, handle: Handle) -> Polygon:
    """What to cut from the rim of a clock plate's level."""
    half = stack.sizing.rules.frame_width / 2.0 + stack.sizing.rules.gap
    return box(handle.x_start, handle.y - half, handle.x_end, handle.y + half)


def clock_pin(stack: Stack, hub: Hub, unit: UnitSize) -> Body:
    """The pin from a unit's clock plate up to its clock block, in its place when the clock is in its middle."""
    rules = stack.sizing.rules
    return stack.upright(
        f"pin.clock.{unit.mass}",
        BodyKind.PIN,
        stack.clock_plates[unit.phase],
        stack.unit_plate,
        square(clock_pin_x(stack, hub, unit.preload), hub.y, rules.pin),
        (rules.clock_throw, 0.0),
        clock_ref(unit.phase),
        palette.clock(unit.phase),
    )


def clock_plates(
    stack: Stack,
    boundary: Polygon,
    handle: Handle,
    pins: Sequence[Body],
    posts: Sequence[Body],
    turning: Mapping[str, float],
) -> list[Body]:
    """The clock plates with their guides and handles: holes for their own pins, slots for other plates' and for posts.

    Args:
        pins: all clock pins; posts: all posts that pass clock plates.
        turning: by plate, the moment (N mm) about its handle that its guides are to bear; 0 if not there.

    Raises:
        UsageError: the inside of the boundary falls apart, so that a plate would be in pieces.
    """
    rules = stack.sizing.rules
    inside = interior(stack, boundary, rules.gap)
    inner = inside.intersection(translate(inside, -rules.clock_throw)).intersection(
        translate(inside, rules.clock_throw)
    )
    roomy = interior(stack, boundary)
    half = rules.frame_width / 2.0
    hole = square(handle.x_end - half, handle.y, rules.pin)
    tongue = box(handle.x_start, handle.y - half, handle.x_end, handle.y + half)
    bodies: list[Body] = []
    for phase, plate in enumerate(stack.clock_plates):
        level = stack.bottom(plate)
        own, away, rows = clock_ref(phase), [hole], []
        for body in (*pins, *posts):
            if not body.z <= level < body.z + body.thickness:
                continue
            x, y = body.section.centroid.x, body.section.centroid.y
            if body.moves_with == (own,):
                away.append(square(x, y, rules.pin))
                rows.append(y)
                continue
            reach = rules.pin / 2.0 + rules.gap
            run = reach + rules.clock_throw + body.throw[0]
            away.append(box(x - run, y - reach, x + run, y + reach))
        turned = Turned(turning.get(plate, 0.0), handle.y, tuple(rows))
        guides = clock_guides(stack, plate, roomy, inner, [*away, tongue], turned)
        if guides is not None:
            away += [place.pocket for place in guides.places]
            bodies += guides.bodies(stack, plate, own)
        try:
            whole = only(without_thin(cut(join([inner, tongue]), away), stack.process.pin.wall))
            # along a slanted edge rounding leaves slivers between the two
            outside = without_thin(shapely.difference(whole, inner, grid_size=GRID), stack.process.pin.wall)
            section, held = only(whole.intersection(inner)), only(outside)
        except ValueError as error:
            raise UsageError(f"the boundary is so narrow that the clock plate {plate} falls apart: {error}") from error
        bodies.append(
            stack.sheet(plate, BodyKind.CLOCK, plate, section, (rules.clock_throw, 0.0), (own,), palette.clock(phase))
        )
        # a tab: it reaches outside the boundary
        name = f"handle.{plate}"
        bodies.append(
            stack.sheet(name, BodyKind.TAB, plate, held, (rules.clock_throw, 0.0), (own,), palette.clock(phase))
        )
    return bodies
