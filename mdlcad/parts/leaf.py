"""Polygons of meander flexures, as cut and as deflected, in the device's own axes."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import shapely
from shapely import Polygon

from mdlcad.mechanics.flexure import Chain, Meander, deflect
from mdlcad.parts.body import Body
from mdlcad.parts.shapes import box, pieces, strip
from mdlcad.parts.stack import Hub, Stack
from mdlcad.routing.layout import Side

Path = list[tuple[float, float]]

_AT = np.linspace(0.0, 1.0, 5)


def hub_block(stack: Stack, hub: Hub, side: Side) -> Polygon:
    """The block of one side of a hub on a rung plate (without its pin hole)."""
    rules = stack.sizing.rules
    inner, outer = rules.hub_gap / 2.0, rules.hub_half
    half = rules.hub_height / 2.0
    if side is Side.LEFT:
        return box(hub.x - outer, hub.y - half, hub.x - inner, hub.y + half)
    return box(hub.x + inner, hub.y - half, hub.x + outer, hub.y + half)


def outward(side: Side) -> float:
    """+1 if a side looks at higher x, else -1."""
    return -1.0 if side is Side.LEFT else 1.0


def rung_end(stack: Stack, x: float, y: float, direction: float) -> Polygon:
    """The end of the rung that a flexure running along +x or -x ends at: what it is filleted against."""
    half = stack.sizing.rules.bar_width / 2.0
    low, high = sorted((x, x + direction * stack.sizing.rules.bar_width))
    return box(low, y - half, high, y + half)


def leaf_start(stack: Stack, hub: Hub, side: Side) -> float:
    """x of the outer face of a hub block, where flexures begin."""
    return hub.x + outward(side) * stack.sizing.rules.hub_half


def meander_path(meander: Meander, x: float, y: float, direction: float) -> Path:
    """Centre line as cut, from (x, y) along +x or -x."""
    return [(x + direction * u, y + v) for u, v in meander.path()]


def deflected_path(chain: Chain, left: float, right: float, x: float, y: float, direction: float) -> Path:
    """Centre line of the flexible beams with the ends of the flexure displaced in y, from (x, y) along +x or -x."""
    solution = deflect(chain, left, right)
    points: Path = []
    for beam in chain.frame.beams[: chain.flexible]:
        for u, v in chain.frame.deformed(beam, solution, _AT)[0][0 if not points else 1 :]:
            points.append((x + direction * float(u), y + float(v)))
    return points


def leaf_envelope(
    chain: Chain,
    lefts: Sequence[float],
    rights: Sequence[float],
    solid: Callable[[Path, float], Polygon],
    start: tuple[float, float],
    direction: float,
) -> Polygon:
    """All that a flexure covers while its left end takes every height of ``lefts`` and its right end of ``rights``.

    Args:
        solid: the body's polygon from a centre line and the left end's height.
    """
    x, y = start
    shapes = [solid(deflected_path(chain, left, right, x, y, direction), left) for left in lefts for right in rights]
    whole = shapely.union_all(shapes, grid_size=0.01)
    outline = max(pieces(whole), key=lambda piece: piece.area)
    return shapely.Polygon(outline.exterior).simplify(0.01)


def heights(throw: float) -> list[float]:
    """Heights from -throw to +throw, close enough to each other that thin walls leave no gaps."""
    return [float(value) for value in np.linspace(-throw, throw, 11)]


def wall_strip(path: Path, wall: float) -> Polygon:
    """The wall along a centre line."""
    return strip(path, wall)


def occupied(body: Body) -> Polygon:
    """Where a body is in the assembled device."""
    return body.section if body.assembled is None else body.assembled
