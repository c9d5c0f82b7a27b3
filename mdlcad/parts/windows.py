"""Windows in the cover, through which the shuttles that hold the starting state are pushed by hand.

A unit with a starting displacement and no tab is reached at the head of one of its hub pins. A window is as wide as the
pin with the gap on either side, and as long as its stroke. There is one only where nothing lies over the pin and the
cover keeps its walls; units without one are set before the cover goes on.
"""

from __future__ import annotations

from collections.abc import Sequence

import shapely
from shapely import Polygon

from mdlcad.network.model import Network
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.shapes import box, disc
from mdlcad.parts.stack import Stack


def held_at_start(network: Network) -> dict[str, float]:
    """Displacement at power-up, in the network's unit, by mass; those at 0 left out."""
    return {mass.name: mass.initial for mass in network.masses if mass.initial != 0.0}


def with_tab(network: Network) -> dict[str, str]:
    """Port bit by mass, of masses that have a tab."""
    return {port.mass: port.bit for port in (*network.sensors, *network.actuators)}


def windows(
    stack: Stack,
    network: Network,
    boundary: Polygon,
    pins: Sequence[Body],
    bodies: Sequence[Body],
    slots: Sequence[Polygon] = (),
) -> list[Polygon]:
    """The windows of all units that need one and can have one.

    Args:
        pins: hub pins. bodies: carriers, flexures, posts and screws, whatever may be over a pin or through the cover.
        slots: of pins that go through the cover; whose pin does needs no window.
    """
    rules, wall = stack.sizing.rules, stack.process.pin.wall
    wanted, tabs = held_at_start(network), with_tab(network)
    cover = stack.bottom(stack.cover_plate)
    through = [disc(*_centre(b), _radius(b) + wall) for b in bodies if b.z + b.thickness > cover]
    edge = boundary.exterior.buffer(rules.frame_width)
    found: dict[str, Polygon] = {}
    for pin in pins:
        mass = pin.moves_with[0].partition(":")[2]
        if mass not in wanted or mass in tabs or mass in found:
            continue
        x, y = _centre(pin)
        if any(shapely.contains(slot, pin.section) for slot in slots):
            continue
        half, high = rules.pin / 2.0 + rules.gap, rules.pin / 2.0 + rules.throw + rules.gap
        window = box(x - half, y - high, x + half, y + high)
        # what lies over the pin may come nearer by its own throw
        over = [
            body.section
            for body in bodies
            if body.z >= pin.z + pin.thickness - 1e-6 and body.kind not in (BodyKind.POST, BodyKind.SCREW)
        ]
        reach = box(x - half, y - high - rules.throw, x + half, y + high + rules.throw)
        taken = [*slots, *found.values()]
        near = [*through, *(other.buffer(wall, join_style="mitre") for other in taken), edge]
        if not any(shapely.intersects(reach, shape) for shape in over) and not any(
            shapely.intersects(window, shape) for shape in near
        ):
            found[mass] = window
    return list(found.values())


def crossing_slot(stack: Stack, pin: Body) -> Polygon | None:
    """What a hub pin that goes on into the other deck sweeps in both covers, with the gap; None if it does not."""
    low, high = sorted((stack.bottom(stack.cover_plate), stack.top(stack.cover_plate)))
    if not (pin.z < low and high < pin.z + pin.thickness):
        return None
    x, y = _centre(pin)
    rules = stack.sizing.rules
    half, along = rules.pin / 2.0 + rules.gap, rules.pin / 2.0 + rules.throw + rules.gap
    return box(x - half, y - along, x + half, y + along)


def _centre(body: Body) -> tuple[float, float]:
    centre = body.section.centroid
    return round(centre.x, 4), round(centre.y, 4)


def _radius(body: Body) -> float:
    x0, y0, x1, y1 = body.section.bounds
    return float(max(x1 - x0, y1 - y0)) / 2.0
