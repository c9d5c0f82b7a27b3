"""Dimensions of couplers, rockers and bias leaves read off their outlines as cut, and the frames that those make.

As in ``measure``, nothing of what a part was sized to be is used.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from shapely import Polygon

from mdlcad.errors import SignoffError
from mdlcad.mechanics.fillet import Root, Seat
from mdlcad.mechanics.flexure import RIGID, Chain, Sheet, mirrored
from mdlcad.mechanics.frame import Beam, Frame
from mdlcad.signoff.corners import fillet_at, root_at, seen_eye_root
from mdlcad.signoff.measure import Span, middle_of, spans_at_x, spans_at_y, widened, width_of


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
        return [
            span for span in spans if low + 1e-3 < middle_of(span) < high - 1e-3 and width_of(span) < high - low - 1e-3
        ]

    upper = [s for s in inside(spans_at_y(section, y + _LEVEL * height)) if low < s[0] and s[1] < high]
    lower = [s for s in inside(spans_at_y(section, y - _LEVEL * height)) if low < s[0] and s[1] < high]
    legs: list[Span] = []
    for span in sorted(upper + lower, key=lambda s: out * middle_of(s)):
        if not legs or abs(middle_of(span) - middle_of(legs[-1])) > 0.1:
            legs.append(span)
    stub = spans_at_x(section, face + out * 0.5 * abs(middle_of(legs[0]) - face))
    level = min(stub, key=lambda s: abs(middle_of(s) - y))
    nodes, walls = [(0.0, middle_of(level) - y)], [width_of(level)]
    for index, leg in enumerate(legs):
        x = out * (middle_of(leg) - face)
        nodes.append((x, nodes[-1][1]))
        walls.append(width_of(leg))
        after = middle_of(legs[index + 1]) if index + 1 < len(legs) else end
        bridges = spans_at_x(section, middle_of((middle_of(leg), after)))
        bridge = max(bridges, key=lambda s: abs(middle_of(s) - y - nodes[-1][1]) if len(bridges) > 1 else 0.0)
        nodes.append((x, middle_of(bridge) - y))
        walls.append(width_of(bridge))
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
