"""Dimensions of flexures read off their outlines, by lines laid across them: where walls are, and how thick.

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
from mdlcad.mechanics.flexure import RIGID, Chain, Sheet
from mdlcad.mechanics.frame import Frame
from mdlcad.mechanics.series import SpringPlan

Span = tuple[float, float]

_TOUCH = 0.05
"""How far from an edge a line is laid that is to run just inside it, mm."""


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


def _middle(span: Span) -> float:
    return (span[0] + span[1]) / 2.0


def _width(span: Span) -> float:
    return span[1] - span[0]


@dataclass(frozen=True, slots=True)
class BeamSeen:
    """One beam of a unit: its height from the row's centre, wall and span."""

    y: float
    wall: float
    span: float


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
    inner = min(span[0] for span in left_walls if _middle(span) > y)
    # just under the upper beam: above pin holes and stems, below the trusses
    crossed = spans_at_y(section, inner - _TOUCH)
    shuttle, block = crossed[0], crossed[1]
    right_walls = [span for span in spans_at_x(section, shuttle[1] + 1.0) if _width(span) < high_y - y]
    left = tuple(BeamSeen(_middle(s) - y, _width(s), shuttle[0] - low_x) for s in left_walls)
    right = tuple(BeamSeen(_middle(s) - y, _width(s), block[0] - shuttle[1]) for s in right_walls)
    truss = spans_at_x(section, _middle((crossed[2][1], crossed[3][0])))
    # leaves are what runs on to the trusses; the clock block, if it is as high as this, does not
    reaches = [s for s in crossed[2:] if spans_at_x(section, _middle(s))[-1][1] > high_y - _TOUCH]
    bank = len(reaches) // 2
    stem = next(s for s in spans_at_x(section, _middle((block[1], crossed[2][0]))) if s[0] < y < s[1])
    thick = _width(truss[-1])
    root, face = _width(stem) / 2.0, high_y - thick - y
    leaves = [_leaf(section, y, root, face, _middle(s)) for s in reaches]
    near, far = leaves[:bank], leaves[bank:]
    shift_near = sum(leaf.root - leaf.head for leaf in near) / bank
    shift_far = sum(leaf.head - leaf.root for leaf in far) / bank
    preload = shift_near + shift_far
    centre = _middle(block)
    plan = SpringPlan(
        near=tuple((leaf.root - centre, leaf.above, leaf.below) for leaf in near),
        far=tuple((leaf.root + preload - centre, leaf.above, leaf.below) for leaf in far),
        stem=_width(stem),
        truss=thick,
        height=high_y - y,
    )
    return UnitSeen(_middle(shuttle), y, _width(shuttle) / 2.0, left, right, plan, preload)


@dataclass(frozen=True, slots=True)
class _Leaf:
    """A pair of leaves of a series spring, above and below: x at the stem and at the trusses, and both walls."""

    root: float
    head: float
    above: float
    below: float


def _leaf(section: Polygon, y: float, root: float, face: float, near_x: float) -> _Leaf:
    """Follow a leaf from stem to truss. Its first and last quarters are straight: extrapolate its ends from them."""
    length = face - root
    at = np.array([0.06, 0.12, 0.19, 0.31, 0.5, 0.69, 0.81, 0.88, 0.94])
    walls, ends = [], []
    for side in (1.0, -1.0):
        x, seen = near_x, []
        for share in at[::-1] if side > 0 else at:
            spans = spans_at_y(section, y + side * (root + share * length))
            seen.append(min(spans, key=lambda span: abs(_middle(span) - x)))
            x = _middle(seen[-1])
        if side > 0:
            seen.reverse()
        middles = [_middle(span) for span in seen]
        steps = np.diff(at) * length
        leans = np.hypot(np.diff(middles), steps) / steps
        # a strip is as much wider along x as it leans; between two lines the mean of both
        widths = [(_width(a) + _width(b)) / 2.0 / lean for a, b, lean in zip(seen, seen[1:], leans, strict=False)]
        walls.append(min(widths))
        slope = (middles[1] - middles[0]) / (at[1] - at[0])
        fall = (middles[-1] - middles[-2]) / (at[-1] - at[-2])
        ends.append((middles[0] - slope * at[0], middles[-1] + fall * (1.0 - at[-1])))
    (r0, h0), (r1, h1) = ends
    return _Leaf(float(r0 + r1) / 2.0, float(h0 + h1) / 2.0, float(walls[0]), float(walls[1]))


@dataclass(frozen=True, slots=True)
class MeanderSeen:
    """One meander as cut, from a hub's block outwards.

    Attributes:
        nodes: corners of its centre line, from (0, 0) at the face of the block, x outwards.
        walls: thickness of every piece between two corners.
        face: x of the block's face in the device; row: y of its row; out: +1 if it runs towards higher x, else -1.
    """

    nodes: tuple[tuple[float, float], ...]
    walls: tuple[float, ...]
    face: float
    row: float
    out: float

    @property
    def length(self) -> float:
        """From the block to its end, mm."""
        return self.nodes[-1][0]


@dataclass(frozen=True, slots=True)
class LeafSeen:
    """A coupler, rocker (two meanders, the second seen from the far end) or bias leaf as cut.

    Attributes:
        post: distance of the post from the block's face along x; None for a coupler.
        slot: how far the eye can slide on the post, mm.
    """

    halves: tuple[MeanderSeen, ...]
    post: float | None
    slot: float = 0.0


def measure_leaf(name: str, section: Polygon, hub_x: float, post_x: float | None) -> LeafSeen:
    """Measure a flexure as cut, whose block sits on the hub at ``hub_x``; ``post_x`` is its post's place, if any.

    Raises:
        SignoffError: it does not look like one.
    """
    try:
        return _flexure(section, hub_x, post_x)
    except (IndexError, ValueError, StopIteration) as error:
        raise SignoffError(f"{name}: its outline is not that of a flexure") from error


_LEVEL = 0.2
"""Where lines across a flexure's legs are laid, as a share of its block's height: beyond its pin and the
bridges in its middle, below the bridges of the lowest legs (``mechanics.leaves.stiffened``)."""


def _flexure(section: Polygon, hub_x: float, post_x: float | None) -> LeafSeen:
    low_x, low_y, high_x, high_y = section.bounds
    y, height = (low_y + high_y) / 2.0, high_y - low_y
    out = 1.0 if abs(high_x - hub_x) > abs(low_x - hub_x) else -1.0
    far = high_x if out > 0 else low_x
    block = spans_at_y(section, y + _LEVEL * height)
    face = block[0][1] if out > 0 else block[-1][0]
    if post_x is None:
        return LeafSeen((_meander(section, face, far, y, height, out),), None)
    reach = abs(post_x - face)
    ring = spans_at_x(section, post_x)
    radius = (ring[-1][1] - ring[0][0]) / 2.0
    first = _meander(section, face, post_x - out * radius, y, height, out)
    # of a bias leaf nothing but its eye is beyond the post
    if abs(far - post_x) < 0.5 * abs(post_x - face):
        hole = max((Polygon(ring) for ring in section.interiors), key=lambda ring: abs(ring.centroid.x - hub_x))
        left, bottom, right, top = hole.bounds
        return LeafSeen((first,), reach, max(0.0, (right - left) - (top - bottom)))
    second = _meander(section, far, post_x + out * radius, y, height, -out)
    return LeafSeen((first, second), reach)


def _meander(section: Polygon, face: float, end: float, y: float, height: float, out: float) -> MeanderSeen:
    """Legs, bridges and the two stubs between the block's face and ``end``."""
    low, high = sorted((face, end))

    def inside(spans: list[Span]) -> list[Span]:
        return [span for span in spans if low + 1e-3 < _middle(span) < high - 1e-3 and _width(span) < high - low - 1e-3]

    upper = [s for s in inside(spans_at_y(section, y + _LEVEL * height)) if low < s[0] and s[1] < high]
    lower = [s for s in inside(spans_at_y(section, y - _LEVEL * height)) if low < s[0] and s[1] < high]
    legs: list[Span] = []
    for span in sorted(upper + lower, key=lambda s: out * _middle(s)):
        if not legs or abs(_middle(span) - _middle(legs[-1])) > 0.1:
            legs.append(span)
    stub = spans_at_x(section, face + out * 0.5 * abs(_middle(legs[0]) - face))
    level = min(stub, key=lambda s: abs(_middle(s) - y))
    nodes, walls = [(0.0, _middle(level) - y)], [_width(level)]
    for index, leg in enumerate(legs):
        x = out * (_middle(leg) - face)
        nodes.append((x, nodes[-1][1]))
        walls.append(_width(leg))
        after = _middle(legs[index + 1]) if index + 1 < len(legs) else end
        bridges = spans_at_x(section, _middle((_middle(leg), after)))
        bridge = max(bridges, key=lambda s: abs(_middle(s) - y - nodes[-1][1]) if len(bridges) > 1 else 0.0)
        nodes.append((x, _middle(bridge) - y))
        walls.append(_width(bridge))
    nodes.append((out * (end - face), nodes[-1][1]))
    return MeanderSeen(tuple(nodes), tuple(walls), face, y, out)


def thickened(seen: LeafSeen, extra: float) -> LeafSeen:
    """The same with every wall thicker by ``extra`` mm."""
    halves = tuple(replace(half, walls=tuple(wall + extra for wall in half.walls)) for half in seen.halves)
    return replace(seen, halves=halves)


def chain_of_leaf(leaf: LeafSeen, sheet: Sheet) -> Chain:
    """The measured flexure as a frame, its left end at the block of the hub that it sits on."""
    half = leaf.halves[0]
    nodes, walls = list(half.nodes), list(half.walls)
    beams = [sheet.beam(i, i + 1, wall) for i, wall in enumerate(walls)]
    wall = max(walls)
    if leaf.post is None:
        return Chain(Frame(nodes, beams), len(beams), 0, len(nodes) - 1, None, wall)
    eye = len(nodes)
    nodes.append((leaf.post, 0.0))
    rigid = [sheet.beam(eye - 1, eye, wall, RIGID)]
    if len(leaf.halves) == 1:
        return Chain(Frame(nodes, beams + rigid), len(beams), 0, eye, eye, wall)
    other = leaf.halves[1]
    span = math.fabs(other.face - half.face)
    first = len(nodes)
    nodes += [(span - x, y) for x, y in reversed(other.nodes)]
    beams += [sheet.beam(first + i, first + i + 1, w) for i, w in enumerate(reversed(other.walls))]
    rigid.append(sheet.beam(eye, first, wall, RIGID))
    return Chain(Frame(nodes, beams + rigid), len(beams), 0, len(nodes) - 1, eye, wall)
