"""Dimensions of units read off their outlines, by lines laid across them: where walls are, and how thick.

Nothing of what a part was sized to be is used: all comes from the polygon of its section, in mm. Walls as drawn run
along x or y; only the leaves of a preloaded series spring are bent, in the drawing of the assembled device.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from shapely import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from mdlcad.errors import SignoffError
from mdlcad.mechanics.fillet import Root, Seat
from mdlcad.mechanics.series import SpringPlan
from mdlcad.signoff.corners import fillet_at, is_inner, root_at

Span = tuple[float, float]

_TOUCH = 0.05
"""How far from an edge a line is laid that is to run just inside it, mm."""
_UNDER = 0.7
"""Where a line through shuttle, end block and leaves is laid, as a share of the height of the upper beam: under its
fillets, above pin holes and stems, below the trusses."""


def spans_at_y(section: Polygon, y: float) -> list[Span]:
    """What a line along x at ``y`` crosses, as (x from, x to), from left to right."""
    low, _, high, _ = section.bounds
    return _spans(section.intersection(LineString([(low - 1.0, y), (high + 1.0, y)])), 0)


def spans_at_x(section: Polygon, x: float) -> list[Span]:
    """What a line along y at ``x`` crosses, as (y from, y to), upwards."""
    _, low, _, high = section.bounds
    return _spans(section.intersection(LineString([(x, low - 1.0), (x, high + 1.0)])), 1)


def _spans(crossed: BaseGeometry, axis: int) -> list[Span]:
    found = []
    for piece in getattr(crossed, "geoms", [crossed]):
        ends = sorted(point[axis] for point in piece.coords)
        if ends and ends[-1] - ends[0] > 1e-6:
            found.append((float(ends[0]), float(ends[-1])))
    return sorted(found)


def middle_of(span: Span) -> float:
    """Half way between its ends."""
    return (span[0] + span[1]) / 2.0


def width_of(span: Span) -> float:
    """From one end to the other."""
    return span[1] - span[0]


@dataclass(frozen=True, slots=True)
class BeamSeen:
    """One beam of a unit: its height from the row's centre, wall, span, and the fillets of its two roots."""

    y: float
    wall: float
    span: float
    roots: tuple[Root, Root]


@dataclass(frozen=True, slots=True)
class UnitSeen:
    """A unit as drawn.

    Attributes:
        x, y: centre of its shuttle; left, right: its beams; half_hub: half the shuttle's width.
        plan: the series spring with its leaves unbent; preload: by how much it is pushed together.
    """

    x: float
    y: float
    half_hub: float
    left: tuple[BeamSeen, ...]
    right: tuple[BeamSeen, ...]
    plan: SpringPlan
    preload: float


def measure_unit(name: str, section: Polygon) -> UnitSeen:
    """Measure a unit in its place in the assembled device.

    Raises:
        SignoffError: it does not look like a unit.
    """
    try:
        return _unit(section)
    except (IndexError, ValueError) as error:
        raise SignoffError(f"{name}: its outline is not that of a unit") from error


def _unit(section: Polygon) -> UnitSeen:
    low_x, low_y, _, high_y = section.bounds
    y = (low_y + high_y) / 2.0
    left_walls = spans_at_x(section, low_x + 1.0)
    inner = min(span[0] for span in left_walls if middle_of(span) > y)
    crossed = spans_at_y(section, y + _UNDER * (inner - y))
    shuttle, block = crossed[0], crossed[1]
    right_walls = [span for span in spans_at_x(section, shuttle[1] + 1.0) if width_of(span) < high_y - y]

    def beam(wall: Span, start: float, end: float) -> BeamSeen:
        roots = root_at(section, start, wall, 1.0, Seat.BLOCK), root_at(section, end, wall, -1.0, Seat.BLOCK)
        return BeamSeen(middle_of(wall) - y, width_of(wall), end - start, roots)

    left = tuple(beam(wall, low_x, shuttle[0]) for wall in left_walls)
    right = tuple(beam(wall, shuttle[1], block[0]) for wall in right_walls)
    # leaves are what runs on to the trusses; the clock block, if it is as high as this, does not
    reaches = [s for s in crossed[2:] if spans_at_x(section, middle_of(s))[-1][1] > high_y - _TOUCH]
    bank = len(reaches) // 2
    # between the banks, where neither fillets nor leaves are
    truss = spans_at_x(section, middle_of((reaches[bank - 1][1], reaches[bank][0])))
    stem = next(s for s in spans_at_x(section, middle_of((block[1], crossed[2][0]))) if s[0] < y < s[1])
    thick = width_of(truss[-1])
    root, face = width_of(stem) / 2.0, high_y - thick - y
    leaves = [_leaf(section, y, root, face, middle_of(s)) for s in reaches]
    near, far = leaves[:bank], leaves[bank:]
    shift_near = sum(leaf.root - leaf.head for leaf in near) / bank
    shift_far = sum(leaf.head - leaf.root for leaf in far) / bank
    preload = shift_near + shift_far
    centre = middle_of(block)
    fillet = _mean([radius for leaf in leaves for radius in leaf.fillets])
    beside = spans_at_y(section, y + root + fillet + _TOUCH)
    clock = next(span[0] for span in beside if span[0] > far[-1].root + far[-1].above)
    plan = SpringPlan(
        near=tuple((leaf.root - centre, leaf.above, leaf.below) for leaf in near),
        far=tuple((leaf.root + preload - centre, leaf.above, leaf.below) for leaf in far),
        stem=width_of(stem),
        truss=thick,
        height=high_y - y,
        fillet=fillet,
        block=width_of(block) / 2.0,
        clock=clock - far[-1].root,
    )
    return UnitSeen(middle_of(shuttle), y, width_of(shuttle) / 2.0, left, right, plan, preload)


def _mean(values: list[float]) -> float:
    return sum(values) / len(values)


@dataclass(frozen=True, slots=True)
class _Leaf:
    """A pair of leaves of a series spring, above and below: x at the stem and at the trusses, and both walls.

    ``fillets``: radii of all its corners with stem and trusses.
    """

    root: float
    head: float
    above: float
    below: float
    fillets: tuple[float, ...]


def _leaf(section: Polygon, y: float, root: float, face: float, near_x: float) -> _Leaf:
    """Follow a leaf from stem to truss. Its first and last quarters are straight: extrapolate its ends from them."""
    length = face - root
    at = np.array([0.06, 0.12, 0.19, 0.31, 0.5, 0.69, 0.81, 0.88, 0.94])
    walls, ends, fillets = [], [], []
    for side in (1.0, -1.0):
        x, seen = near_x, []
        for share in at[::-1] if side > 0 else at:
            spans = spans_at_y(section, y + side * (root + share * length))
            seen.append(min(spans, key=lambda span: abs(middle_of(span) - x)))
            x = middle_of(seen[-1])
        if side > 0:
            seen.reverse()
        middles = [middle_of(span) for span in seen]
        steps = np.diff(at) * length
        leans = np.hypot(np.diff(middles), steps) / steps
        # a strip is as much wider along x as it leans; between two lines the mean of both
        widths = [(width_of(a) + width_of(b)) / 2.0 / lean for a, b, lean in zip(seen, seen[1:], leans, strict=False)]
        walls.append(min(widths))
        slope = (middles[1] - middles[0]) / (at[1] - at[0])
        fall = (middles[-1] - middles[-2]) / (at[-1] - at[-2])
        ends.append((middles[0] - slope * at[0], middles[-1] + fall * (1.0 - at[-1])))
        for x, rise, height, way in ((ends[-1][0], slope, root, side), (ends[-1][1], -fall, face, -side)):
            for edge in (-1.0, 1.0):
                # where a leaf leans to, its angle is narrower
                lean = -math.atan(edge * rise / length)
                corner = (float(x + edge * walls[-1] / 2.0 / math.cos(lean)), y + side * height)
                if is_inner(section, corner, (edge, way)):
                    fillets.append(fillet_at(section, corner, (edge, way), lean))
    (r0, h0), (r1, h1) = ends
    return _Leaf(float(r0 + r1) / 2.0, float(h0 + h1) / 2.0, float(walls[0]), float(walls[1]), tuple(fillets))


def widened(root: Root, extra: float) -> Root:
    """A root after all outlines have moved outwards by half of ``extra`` mm: a concave arc gets the smaller for it."""
    radius = max(0.0, root.radius - extra / 2.0)
    return replace(root, radius=radius, reach=root.reach * radius / root.radius if root.radius else 0.0)
