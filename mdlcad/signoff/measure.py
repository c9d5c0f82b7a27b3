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
from mdlcad.mechanics.fillet import Root, Seat
from mdlcad.mechanics.flexure import RIGID, Chain, Sheet, mirrored
from mdlcad.mechanics.frame import Beam, Frame
from mdlcad.mechanics.series import SpringPlan
from mdlcad.signoff.corners import fillet_at, is_inner, root_at, seen_eye_root

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


def _middle(span: Span) -> float:
    return (span[0] + span[1]) / 2.0


def _width(span: Span) -> float:
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
    inner = min(span[0] for span in left_walls if _middle(span) > y)
    crossed = spans_at_y(section, y + _UNDER * (inner - y))
    shuttle, block = crossed[0], crossed[1]
    right_walls = [span for span in spans_at_x(section, shuttle[1] + 1.0) if _width(span) < high_y - y]

    def beam(wall: Span, start: float, end: float) -> BeamSeen:
        roots = root_at(section, start, wall, 1.0, Seat.BLOCK), root_at(section, end, wall, -1.0, Seat.BLOCK)
        return BeamSeen(_middle(wall) - y, _width(wall), end - start, roots)

    left = tuple(beam(wall, low_x, shuttle[0]) for wall in left_walls)
    right = tuple(beam(wall, shuttle[1], block[0]) for wall in right_walls)
    # leaves are what runs on to the trusses; the clock block, if it is as high as this, does not
    reaches = [s for s in crossed[2:] if spans_at_x(section, _middle(s))[-1][1] > high_y - _TOUCH]
    bank = len(reaches) // 2
    # between the banks, where neither fillets nor leaves are
    truss = spans_at_x(section, _middle((reaches[bank - 1][1], reaches[bank][0])))
    stem = next(s for s in spans_at_x(section, _middle((block[1], crossed[2][0]))) if s[0] < y < s[1])
    thick = _width(truss[-1])
    root, face = _width(stem) / 2.0, high_y - thick - y
    leaves = [_leaf(section, y, root, face, _middle(s)) for s in reaches]
    near, far = leaves[:bank], leaves[bank:]
    shift_near = sum(leaf.root - leaf.head for leaf in near) / bank
    shift_far = sum(leaf.head - leaf.root for leaf in far) / bank
    preload = shift_near + shift_far
    centre = _middle(block)
    fillet = _mean([radius for leaf in leaves for radius in leaf.fillets])
    beside = spans_at_y(section, y + root + fillet + _TOUCH)
    clock = next(span[0] for span in beside if span[0] > far[-1].root + far[-1].above)
    plan = SpringPlan(
        near=tuple((leaf.root - centre, leaf.above, leaf.below) for leaf in near),
        far=tuple((leaf.root + preload - centre, leaf.above, leaf.below) for leaf in far),
        stem=_width(stem),
        truss=thick,
        height=high_y - y,
        fillet=fillet,
        block=_width(block) / 2.0,
        clock=clock - far[-1].root,
    )
    return UnitSeen(_middle(shuttle), y, _width(shuttle) / 2.0, left, right, plan, preload)


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
        for x, rise, height, way in ((ends[-1][0], slope, root, side), (ends[-1][1], -fall, face, -side)):
            for edge in (-1.0, 1.0):
                # where a leaf leans to, its angle is narrower
                lean = -math.atan(edge * rise / length)
                corner = (float(x + edge * walls[-1] / 2.0 / math.cos(lean)), y + side * height)
                if is_inner(section, corner, (edge, way)):
                    fillets.append(fillet_at(section, corner, (edge, way), lean))
    (r0, h0), (r1, h1) = ends
    return _Leaf(float(r0 + r1) / 2.0, float(h0 + h1) / 2.0, float(walls[0]), float(walls[1]), tuple(fillets))


@dataclass(frozen=True, slots=True)
class MeanderSeen:
    """One meander as cut, from a hub's block outwards.

    Attributes:
        nodes: corners of its centre line, from (0, 0) at the face of the block, x outwards.
        walls: thickness of every piece between two corners.
        ends: its roots at the block and at the far end; bends: radius of the fillet at every corner between.
        face: x of the block's face in the device; row: y of its row; out: +1 if it runs towards higher x, else -1.
    """

    nodes: tuple[tuple[float, float], ...]
    walls: tuple[float, ...]
    ends: tuple[Root, Root]
    bends: tuple[float, ...]
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
        return LeafSeen((_meander(section, face, far, y, height, out, None),), None)
    reach = abs(post_x - face)
    ring = spans_at_x(section, post_x)
    radius = (ring[-1][1] - ring[0][0]) / 2.0
    # of a bias leaf nothing but its eye is beyond the post
    if abs(far - post_x) < 0.5 * abs(post_x - face):
        hole = max((Polygon(ring) for ring in section.interiors), key=lambda ring: abs(ring.centroid.x - hub_x))
        left, bottom, right, top = hole.bounds
        slot = max(0.0, (right - left) - (top - bottom))
        eye = Eye(far - out * (2.0 * radius + slot), radius)
        return LeafSeen((_meander(section, face, post_x - out * radius, y, height, out, eye),), reach, slot)
    near, beyond = Eye(post_x - out * radius, radius), Eye(post_x + out * radius, radius)
    first = _meander(section, face, near.front, y, height, out, near)
    return LeafSeen((first, _meander(section, far, beyond.front, y, height, -out, beyond)), reach)


@dataclass(frozen=True, slots=True)
class Eye:
    """An eye as drawn: x of the side of it that a meander comes to, and its radius."""

    front: float
    radius: float


def _meander(
    section: Polygon, face: float, end: float, y: float, height: float, out: float, eye: Eye | None
) -> MeanderSeen:
    """Legs, bridges and the two stubs between the block's face and ``end``, where there may be an eye."""
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
    bends = tuple(_bend(section, nodes, walls, i, face, y, out) for i in range(1, len(nodes) - 1))
    first, last = walls[0] / 2.0, walls[-1] / 2.0
    middle = y + nodes[0][1]
    start = root_at(section, face, (middle - first, middle + first), out, Seat.RIGID)
    middle = y + nodes[-1][1]
    if eye is None:
        far = root_at(section, end, (middle - last, middle + last), -out, Seat.RIGID)
    else:
        far = seen_eye_root(section, eye.front, middle, walls[-1], eye.radius, -out)
    return MeanderSeen(tuple(nodes), tuple(walls), (start, far), bends, face, y, out)


def _bend(
    section: Polygon,
    nodes: list[tuple[float, float]],
    walls: list[float],
    i: int,
    face: float,
    y: float,
    out: float,
) -> float:
    """Radius of the fillet on the inner side of the bend at node ``i``."""
    (x0, y0), (x1, y1), (x2, y2) = nodes[i - 1 : i + 2]
    before, after = walls[i - 1] / 2.0, walls[i] / 2.0
    # one of the two walls runs along x, the other along y
    along = x0 != x1
    way_x = math.copysign(1.0, (x0 - x1) if along else (x2 - x1))
    way_y = math.copysign(1.0, (y2 - y1) if along else (y0 - y1))
    across_x, across_y = (after, before) if along else (before, after)
    corner = (face + out * (x1 + way_x * across_x), y + y1 + way_y * across_y)
    return fillet_at(section, corner, (out * way_x, way_y))


def thickened(seen: LeafSeen, extra: float) -> LeafSeen:
    """The same with every wall thicker by ``extra`` mm, and its fillets as much sharper as goes with it."""

    def half(one: MeanderSeen) -> MeanderSeen:
        first, last = (widened(root, extra) for root in one.ends)
        bends = tuple(max(0.0, bend - extra / 2.0) for bend in one.bends)
        return replace(one, walls=tuple(wall + extra for wall in one.walls), ends=(first, last), bends=bends)

    return replace(seen, halves=tuple(half(one) for one in seen.halves))


def widened(root: Root, extra: float) -> Root:
    """A root after all outlines have moved outwards by half of ``extra`` mm: a concave arc gets the smaller for it."""
    radius = max(0.0, root.radius - extra / 2.0)
    return replace(root, radius=radius, reach=root.reach * radius / root.radius if root.radius else 0.0)


def chain_of_leaf(leaf: LeafSeen, sheet: Sheet) -> Chain:
    """The measured flexure as a frame, its left end at the block of the hub that it sits on."""
    half = leaf.halves[0]
    nodes, beams = list(half.nodes), _walls(half, sheet)
    wall = max(half.walls)
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
    last = len(nodes) - 1
    for beam in reversed(_walls(other, sheet)):
        beams.append(mirrored(beam, math.dist(other.nodes[beam.start], other.nodes[beam.end]), last))
    rigid.append(sheet.beam(eye, first, wall, RIGID))
    return Chain(Frame(nodes, beams + rigid), len(beams), 0, last, eye, wall)


def _walls(half: MeanderSeen, sheet: Sheet) -> list[Beam]:
    return sheet.walls(half.nodes, half.walls, half.ends, half.bends)
