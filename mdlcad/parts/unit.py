"""The buckling-beam unit: shuttle, beams, end block, series spring and clock block, all of one sheet."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import shapely
from shapely import Polygon
from shapely.affinity import translate

from mdlcad.mechanics.sizes import UnitSize
from mdlcad.mechanics.unit import beam_heights
from mdlcad.parts import palette
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.shapes import box, cut, filleted, join, only, square, strip
from mdlcad.parts.stack import FRAME_REF, Hub, Stack, clock_ref
from mdlcad.routing.layout import Side


def unit_body(stack: Stack, hub: Hub, unit: UnitSize, pinned: Sequence[Side]) -> Body:
    """One unit, cut with its clock block at rest and assembled with the block pushed by the unit's preload.

    Args:
        pinned: the sides of the hub that carry a pin.
    """
    rules, template = stack.sizing.rules, stack.process.unit
    high = stack.sizing.law.shuttle_height / 2.0
    left, right = hub.x - rules.hub_half, hub.x + rules.hub_half
    end = right + template.span
    swaying = [box(left, hub.y - high, right, hub.y + high)]
    for y in beam_heights(stack.process):
        swaying.append(strip([(left - template.span, hub.y + y), (left, hub.y + y)], template.beam_wall))
        swaying.append(strip([(right, hub.y + y), (end, hub.y + y)], template.beam_wall))
    block = box(end, hub.y - high, end + template.block_width, hub.y + high)
    holes = [square(hub_pin_x(stack, hub, side), hub.y, rules.pin) for side in pinned]

    # the rib is the frame's; what is filleted against it is the unit's
    rib = box(left - template.span - 1.0, hub.y - high - 1.0, left - template.span, hub.y + high + 1.0)

    def whole(preload: float) -> Polygon:
        outline = join([*swaying, block, *drive_parts(stack, hub, preload), rib])
        rounded = filleted(outline, stack.process.machine.fillet)
        return only(cut(rounded, [rib, *holes, _hole(stack, hub, preload)]))

    driven = [block, *drive_parts(stack, hub, unit.preload)]
    envelope = join(
        [_swept(part, 0.0, rules.throw) for part in swaying]
        + [_swept(p, rules.clock_throw, 0.0) for p in driven]
        + [whole(unit.preload)]
    )
    return stack.sheet(
        f"unit.{unit.mass}",
        BodyKind.UNIT,
        stack.unit_plate,
        whole(0.0),
        (rules.clock_throw, rules.throw),
        (hub.ref, clock_ref(unit.phase), FRAME_REF),
        palette.unit(unit.phase),
        whole(unit.preload),
        envelope,
    )


def _hole(stack: Stack, hub: Hub, preload: float) -> Polygon:
    return square(clock_pin_x(stack, hub, preload), hub.y, stack.sizing.rules.pin)


def _swept(part: Polygon, x: float, y: float) -> Polygon:
    """What a part without re-entrant corners along its motion covers when it moves by up to +-x and +-y."""
    return shapely.union_all(
        [
            translate(part, -x, -y),
            translate(part, x, y),
            *(_between(edge, x, y) for edge in pairwise(part.exterior.coords)),
        ]
    )


def _between(edge: tuple[tuple[float, ...], tuple[float, ...]], x: float, y: float) -> Polygon:
    (x0, y0), (x1, y1) = edge
    return shapely.MultiPoint(
        [(x0 - x, y0 - y), (x0 + x, y0 + y), (x1 - x, y1 - y), (x1 + x, y1 + y)]
    ).convex_hull.buffer(0.0)


def hub_pin_x(stack: Stack, hub: Hub, side: Side) -> float:
    """Where the hub pin of a side stands."""
    offset = stack.sizing.rules.hub_pin_offset
    return hub.x - offset if side is Side.LEFT else hub.x + offset


def clock_pin_x(stack: Stack, hub: Hub, preload: float) -> float:
    """Where the clock pin of a unit stands with the clock in its middle; ``preload`` 0 for the hole as cut."""
    rules, template, pin = stack.sizing.rules, stack.process.unit, stack.process.pin
    end = hub.x + rules.hub_half + template.span + stack.sizing.series.reach
    return end - pin.wall - pin.side / 2.0 - preload


def drive_parts(stack: Stack, hub: Hub, preload: float) -> list[Polygon]:
    """Series spring and clock block, the clock block pushed by ``preload`` towards the shuttle (hole not cut)."""
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
        inner, outer = hub.y + side * (root + series.length), hub.y + side * series.height
        shift = preload / 2.0  # the trusses float half way
        parts.append(box(near[0] - half - shift, min(inner, outer), far[-1] + half - shift, max(inner, outer)))
        for places, push in ((near, 0.0), (far, preload)):
            parts += [strip(_guided(x - push, x - shift, hub.y + side * root, inner), series.wall) for x in places]
    return parts


def _guided(x_start: float, x_end: float, y_start: float, y_end: float) -> list[tuple[float, float]]:
    """Centre line of a leaf whose ends do not turn: x follows 3 s^2 - 2 s^3."""
    if x_start == x_end:
        return [(x_start, y_start), (x_end, y_end)]
    at = np.linspace(0.0, 1.0, 5)  # within 0.01 mm of the bent leaf, in the drawing of the assembled unit
    shape = 3.0 * at**2 - 2.0 * at**3
    into = 0.2 * (y_start - y_end) / abs(y_start - y_end)  # mm into stem and truss, so that no slit is left there
    xs, ys = x_start + (x_end - x_start) * shape, y_start + (y_end - y_start) * at
    path = [(float(x), float(y)) for x, y in zip(xs, ys, strict=True)]
    return [(x_start, y_start + into), *path, (x_end, y_end - into)]
