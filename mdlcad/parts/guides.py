"""Guides of a clock plate: where their two leaves stand, and their bodies.

A leaf runs along y from the rim to the bottom of a pocket in the plate, both of its ends clamped. The two stand on one
side of the plate, as far apart in x as its slots and the boundary leave room: on one side only, so that they do not
pull at each other as they shorten. Where the rim slants, a foot makes the leaf's root level.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely import Geometry, LineString, Polygon

from mdlcad.mechanics.guides import GuideLeaf, GuideLoad, guide_findings, guide_leaf, guide_load, walls
from mdlcad.parts import palette
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.shapes import GRID, box, cut, filleted, join, only
from mdlcad.parts.stack import FRAME_REF, Stack

_STEP_MM = 0.5
"""Places for leaves are tried at multiples of this."""


@dataclass(frozen=True, slots=True)
class GuidePlace:
    """Where a leaf may stand.

    Attributes:
        x: of its middle; root: y of its root; way: +1 if it runs to higher y from there, else -1.
        foot: between the rim and its root, None where the rim is level.
        pocket: what the plate leaves free for it.
    """

    x: float
    root: float
    way: float
    foot: Polygon | None
    pocket: Polygon


@dataclass(frozen=True, slots=True)
class Guides:
    """The two guides of a plate."""

    leaf: GuideLeaf
    places: tuple[GuidePlace, GuidePlace]

    def bodies(self, stack: Stack, plate: str, reference: str) -> list[Body]:
        """The leaves with their feet."""
        return [self._body(stack, plate, reference, number, place) for number, place in enumerate(self.places)]

    def _body(self, stack: Stack, plate: str, reference: str, number: int, place: GuidePlace) -> Body:
        stroke, half = stack.sizing.rules.clock_throw, self.leaf.wall / 2.0
        end = place.root + place.way * self.leaf.length

        def upright(half_width: float, start: float, stop: float) -> Polygon:
            return box(place.x - half_width, min(start, stop), place.x + half_width, max(start, stop))

        feet = [] if place.foot is None else [place.foot]
        broad = half + 2.0 * self.leaf.fillet
        # what is filleted against rim and plate is the leaf's
        rim, sheet = (upright(broad, at, at + way) for at, way in ((place.root, -place.way), (end, place.way)))
        rounded = filleted(join([upright(half, place.root, end), rim, sheet]), self.leaf.fillet)
        leaf = join([only(cut(rounded, [rim, sheet])), *feet])
        return stack.sheet(
            f"guide.{plate}.{number}",
            BodyKind.GUIDE,
            plate,
            leaf,
            (stroke, 0.0),
            (FRAME_REF, reference),
            palette.GUIDE,
            envelope=join([upright(half + stroke, place.root, end), leaf]),
        )


@dataclass(frozen=True, slots=True)
class Turned:
    """What turns a plate.

    Attributes:
        moment: about its handle, N mm. handle: its y; rows: y of the clock pins of the plate's units.
    """

    moment: float
    handle: float
    rows: tuple[float, ...]

    def load(self, leaf: GuideLeaf, stroke: float, ends: Sequence[tuple[float, float]]) -> GuideLoad:
        """What two leaves bear whose middles are at ``ends`` (x, y)."""
        (left, one), (right, other) = ends
        reach = max((abs(row - self.handle) for row in self.rows), default=0.0)
        return guide_load(leaf, right - left, stroke, self.moment, (one + other) / 2.0 - self.handle, reach)


def clock_guides(
    stack: Stack, plate: str, inside: Polygon, sheet: Polygon, away: Sequence[Polygon], turned: Turned
) -> Guides | None:
    """The guides with the thinnest wall that keeps all limits, or misses the fewest; None if there is no room.

    Args:
        inside: within the rim. sheet: the plate without its handle. away: its holes, its slots and its handle.
    """
    process, stroke = stack.process, stack.sizing.rules.clock_throw
    material = process.plate(plate)
    best: tuple[int, Guides] | None = None
    for wall in walls(process):
        leaf = guide_leaf(process, material, stroke, wall)
        pairs = [_outermost(stack, leaf, way, inside, sheet, away) for way in (1.0, -1.0)]
        found = [pair for pair in pairs if pair is not None]
        if not found:
            break  # a thicker leaf is longer
        guides = Guides(leaf, max(found, key=lambda pair: round(pair[1].x - pair[0].x, 3)))
        load = turned.load(
            leaf, stroke, [(place.x, place.root + place.way * leaf.length / 2.0) for place in guides.places]
        )
        faults = len(guide_findings(plate, leaf, load, process, material))
        if best is None or faults < best[0]:
            best = faults, guides
        if not faults:
            break
    return None if best is None else best[1]


def _outermost(
    stack: Stack, leaf: GuideLeaf, way: float, inside: Polygon, sheet: Polygon, away: Sequence[Polygon]
) -> tuple[GuidePlace, GuidePlace] | None:
    """The places farthest left and right on the lower (``way`` +1) or upper side; None if there are no two."""
    wall = stack.process.pin.wall
    taken = shapely.union_all([shape.buffer(wall, join_style="mitre") for shape in away])
    for shape in (taken, sheet, inside):
        shapely.prepare(shape)
    x_low, _, x_high, _ = sheet.bounds
    xs = np.arange(np.ceil(x_low / _STEP_MM), np.floor(x_high / _STEP_MM) + 1.0) * _STEP_MM
    left = next((place for x in xs if (place := _place(stack, leaf, float(x), way, inside, sheet, taken))), None)
    right = next((place for x in xs[::-1] if (place := _place(stack, leaf, float(x), way, inside, sheet, taken))), None)
    if left is None or right is None or right.x <= left.x:
        return None
    return left, right


def _place(
    stack: Stack, leaf: GuideLeaf, x: float, way: float, inside: Polygon, sheet: Polygon, taken: Geometry
) -> GuidePlace | None:
    """The place at ``x``, or None if the rim, what is ``taken`` of the plate, or its edge is in the way."""
    rules, wall, bar = stack.sizing.rules, stack.process.pin.wall, stack.sizing.rules.bar_width
    clear, half = rules.clock_throw + rules.gap + leaf.fillet, leaf.wall / 2.0
    # a foot reaches as far as the leaf sways, so that a rim that rises beside it is clear of it
    foot_half = half + max(wall, clear)
    roots = [_rim(inside, x + share * foot_half, way) for share in (-1.0, -0.5, 0.0, 0.5, 1.0)]
    if any(root is None for root in roots):
        return None
    levels = sorted(way * root for root in roots if root is not None)
    root, slants = way * levels[-1], levels[-1] - levels[0] > GRID
    broad = foot_half if slants else half
    edge = way * levels[0]

    def upright(half_width: float, start: float, end: float) -> Polygon:
        return box(x - half_width, min(start, end), x + half_width, max(start, end))

    end = round(root + way * leaf.length, 4)
    foot = cut(upright(broad, edge - way, root), []).intersection(inside) if slants else None
    pocket = upright(broad + clear, edge - way * clear, end)
    # the plate is as wide as a bar around the pocket's end, and the leaf is clear of a rim that runs along it
    hold = upright(broad + clear + bar, (root + end) / 2.0, end + way * bar)
    free = upright(half + clear, root + way * GRID, end)
    if not sheet.contains(hold) or taken.intersects(hold) or taken.intersects(pocket) or not inside.contains(free):
        return None
    return GuidePlace(x, round(root, 4), way, only(foot) if foot is not None else None, pocket)


def _rim(inside: Polygon, x: float, way: float) -> float | None:
    """y of the rim's lower (``way`` +1) or upper inner edge at ``x``; None if there is none."""
    _, low, _, high = inside.bounds
    line = inside.intersection(LineString([(x, low - 1.0), (x, high + 1.0)]))
    if line.is_empty:
        return None
    return float(line.bounds[1] if way > 0 else line.bounds[3])
