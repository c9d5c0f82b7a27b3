"""The buckling-beam unit: shuttle, beams, end block, series spring and clock block, all of one sheet.

As four bodies, for they move differently: the shuttle; the beams on the frame's side with the anchor that joins them to
the rib; the beams on the clock's side with their end block; and the drive (series spring and clock block).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from shapely import Polygon

from mdlcad.mechanics.sizing import UnitSize
from mdlcad.parts import palette
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.shapes import box, cut, join, only, square, strip
from mdlcad.parts.stack import FRAME_REF, Hub, Stack, clock_ref
from mdlcad.routing.layout import Side


def unit_bodies(stack: Stack, hub: Hub, unit: UnitSize, pinned: Sequence[Side]) -> list[Body]:
    """Bodies of one unit. ``pinned``: the sides of the hub that carry a pin."""
    rules, template = stack.sizing.rules, stack.process.unit
    colour = palette.unit(unit.phase)
    high = stack.sizing.law.shuttle_height / 2.0
    holes = [square(hub_pin_x(stack, hub, side), hub.y, rules.pin) for side in pinned]
    shuttle = box(hub.x - rules.hub_half, hub.y - high, hub.x + rules.hub_half, hub.y + high)
    left, right = hub.x - rules.hub_half, hub.x + rules.hub_half
    heights = beam_heights(stack)
    anchor = box(left - template.span - stack.process.pin.wall, hub.y - high, left - template.span, hub.y + high)
    fixed = [strip([(left - template.span, hub.y + y), (left, hub.y + y)], template.beam_wall) for y in heights]
    end = right + template.span
    block = box(end, hub.y - high, end + template.block_width, hub.y + high)
    driven = [strip([(right, hub.y + y), (end, hub.y + y)], template.beam_wall) for y in heights]
    sway, swing = (0.0, rules.throw), (rules.clock_throw, rules.throw)
    name, plate, clock = f"unit.{unit.mass}", stack.unit_plate, clock_ref(unit.phase)
    kind = BodyKind.UNIT
    return [
        stack.sheet(name, kind, plate, only(cut(shuttle, holes)), sway, (hub.ref,), colour),
        stack.sheet(f"{name}.fixed", kind, plate, join([anchor, *fixed]), sway, (hub.ref, FRAME_REF), colour),
        stack.sheet(f"{name}.driven", kind, plate, join([block, *driven]), swing, (hub.ref, clock), colour),
        stack.sheet(
            f"{name}.drive",
            kind,
            plate,
            _drive(stack, hub, 0.0),
            (rules.clock_throw, 0.0),
            (clock,),
            colour,
            _drive(stack, hub, unit.preload),
        ),
    ]


def beam_heights(stack: Stack) -> list[float]:
    """Heights of the beams of one side, from the shuttle's centre."""
    template = stack.process.unit
    if template.beams == 1:
        return [0.0]
    return [template.pair_spacing * (i / (template.beams - 1) - 0.5) for i in range(template.beams)]


def hub_pin_x(stack: Stack, hub: Hub, side: Side) -> float:
    """Where the hub pin of a side stands."""
    offset = stack.sizing.rules.hub_pin_offset
    return hub.x - offset if side is Side.LEFT else hub.x + offset


def clock_pin_x(stack: Stack, hub: Hub, preload: float) -> float:
    """Where the clock pin of a unit stands with the clock in its middle; ``preload`` 0 for the hole as cut."""
    rules, template, pin = stack.sizing.rules, stack.process.unit, stack.process.pin
    end = hub.x + rules.hub_half + template.span + stack.sizing.series.reach
    return end - pin.wall - pin.side / 2.0 - preload


def _drive(stack: Stack, hub: Hub, preload: float) -> Polygon:
    """Series spring and clock block, the clock block pushed by ``preload`` towards the shuttle."""
    rules, template, series, pin = stack.sizing.rules, stack.process.unit, stack.sizing.series, stack.process.pin
    face = hub.x + rules.hub_half + template.span + template.block_width
    near = [face + series.clear_block + series.wall / 2.0 + i * series.pitch for i in range(series.leaves)]
    far = [near[-1] + series.wall + series.clear + i * series.pitch for i in range(series.leaves)]
    half, root = series.wall / 2.0, series.arm / 2.0
    centre = clock_pin_x(stack, hub, preload)
    clock_half = pin.side / 2.0 + pin.wall
    parts = [
        box(face, hub.y - root, near[-1] + half, hub.y + root),
        box(far[0] - half - preload, hub.y - root, centre, hub.y + root),
        box(centre - clock_half, hub.y - clock_half, centre + clock_half, hub.y + clock_half),
    ]
    for side in (1.0, -1.0):
        low, high = hub.y + side * (root + series.length), hub.y + side * series.height
        parts.append(
            box(near[0] - half - preload / 2, min(low, high), far[-1] + half - preload / 2, max(low, high))
        )
        for places, start, end in ((near, 0.0, -preload / 2), (far, -preload, -preload / 2)):
            for x in places:
                parts.append(strip(_guided(x + start, x + end, hub.y + side * root, low), series.wall))
    return only(cut(join(parts), [square(centre, hub.y, rules.pin)]))


def _guided(x_start: float, x_end: float, y_start: float, y_end: float) -> list[tuple[float, float]]:
    """Centre line of a leaf whose ends do not turn: x follows 3 s^2 - 2 s^3."""
    if x_start == x_end:
        return [(x_start, y_start), (x_end, y_end)]
    at = np.linspace(0.0, 1.0, 9)
    shape = 3.0 * at**2 - 2.0 * at**3
    xs, ys = x_start + (x_end - x_start) * shape, y_start + (y_end - y_start) * at
    return [(float(x), float(y)) for x, y in zip(xs, ys, strict=True)]
