"""True arcs from outlines: parts are drawn with straight edges alone, a circle and a fillet with even chords."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from shapely import Polygon

from mdlcad.parts.shapes import ARC_STEP

# How far the turns between chords and their lengths may differ: the drawing grid of 1e-4 mm on chords of hundredths of
# a millimetre, with room.
_TURN = math.radians(0.6)
_LENGTH_MM = 1e-3
# A fillet between sides that are not at right angles turns by nearly as much from chord to chord.
_LEAST, _MOST = 0.75 * ARC_STEP, 1.25 * ARC_STEP
# Two chords can meet at any angle by chance; three that turn alike are an arc.
_LEAST_EDGES = 3

Vertex = tuple[float, float, float]
"""x and y in mm, and the bulge of the edge that begins there: tan of a quarter of the arc's angle, 0 for a straight."""


def with_arcs(ring: NDArray[np.float64]) -> list[Vertex]:
    """The outline with its runs of equal chords as arcs through their ends, of at most half a circle each.

    An arc runs on the circle that the polygon is inscribed in, so a round hole is as wide as its design says.

    Args:
        ring: float[n, 2], mm, without the repeated last point.
    """
    count = len(ring)
    edges = np.roll(ring, -1, axis=0) - ring
    length = np.hypot(edges[:, 0], edges[:, 1])
    after = np.roll(edges, -1, axis=0)
    turn = np.arctan2(
        edges[:, 0] * after[:, 1] - edges[:, 1] * after[:, 0], edges[:, 0] * after[:, 0] + edges[:, 1] * after[:, 1]
    )
    even = np.abs(length - np.roll(length, -1)) < _LENGTH_MM
    goes_on = even & (np.abs(turn) > _LEAST) & (np.abs(turn) < _MOST)  # from edge i to edge i + 1
    goes_on &= (np.abs(turn - np.roll(turn, 1)) < _TURN) | ~np.roll(goes_on, 1)
    breaks = np.flatnonzero(~goes_on)
    if not len(breaks):
        return _arc(ring, 0, count, float(turn.mean()))
    # begin after a break, so that no run goes round the end of the list
    start = int(breaks[0]) + 1
    vertices: list[Vertex] = []
    edge = start
    while edge < start + count:
        last = edge
        while goes_on[last % count] and last + 1 < start + count:
            last += 1
        run = last - edge + 1
        if run >= _LEAST_EDGES:
            within = [float(turn[step % count]) for step in range(edge, last)]
            vertices += _arc(ring, edge, run, sum(within) / len(within))
        else:
            vertices += [(*_at(ring, edge + step), 0.0) for step in range(run)]
        edge = last + 1
    return vertices


def _arc(ring: NDArray[np.float64], first: int, edges: int, step: float) -> list[Vertex]:
    half = int(math.pi / abs(step) + 1e-3)
    vertices: list[Vertex] = []
    done = 0
    while done < edges:
        # two arcs of one length rather than a half circle and a crumb
        run = min(half, edges - done) if edges % 2 or edges <= half else edges // 2
        vertices.append((*_at(ring, first + done), math.tan(run * step / 4.0)))
        done += run
    return vertices


def _at(ring: NDArray[np.float64], index: int) -> tuple[float, float]:
    x, y = ring[index % len(ring)]
    return float(x), float(y)


def middle_of_arc(start: Vertex, end: Vertex) -> tuple[float, float]:
    """The point half way along the arc that begins at ``start``: half the chord times the bulge beside its middle."""
    (x0, y0, bulge), (x1, y1, _) = start, end
    return (x0 + x1 + bulge * (y1 - y0)) / 2.0, (y0 + y1 - bulge * (x1 - x0)) / 2.0


def arc_area(start: Vertex, end: Vertex) -> float:
    """What is between an arc and its chord, mm2: positive if it turns left."""
    bulge = start[2]
    if not bulge:
        return 0.0
    angle, chord = 4.0 * math.atan(bulge), math.dist(start[:2], end[:2])
    radius = chord / 2.0 / math.sin(angle / 2.0)
    return radius**2 / 2.0 * (angle - math.sin(angle))


def rings(polygon: Polygon) -> list[NDArray[np.float64]]:
    """Outer ring anticlockwise, then holes clockwise; each (n, 2) in mm without the repeated last point."""
    outline, *holes = (np.asarray(ring.coords)[:-1, :2] for ring in (polygon.exterior, *polygon.interiors))
    return [_turned(outline, 1.0), *(_turned(hole, -1.0) for hole in holes)]


def _turned(ring: NDArray[np.float64], sense: float) -> NDArray[np.float64]:
    x, y = ring[:, 0], ring[:, 1]
    signed_area = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    return ring if sense * signed_area > 0.0 else ring[::-1]


def true_area(section: Polygon) -> float:
    """Area, mm2, with true arcs where a section is drawn with chords of them."""
    area = 0.0
    for ring in rings(section):
        vertices = with_arcs(ring)
        for start, end in zip(vertices, vertices[1:] + vertices[:1], strict=True):
            area += (start[0] * end[1] - start[1] * end[0]) / 2.0 + arc_area(start, end)
    return area


def arc_length(section: Polygon) -> float:
    """No less than the length of all arcs of a section's outlines, mm: half a circle is pi / 2 times its chord."""
    total = 0.0
    for ring in rings(section):
        vertices = with_arcs(ring)
        total += sum(
            math.dist(start[:2], end[:2]) * (math.pi / 2.0)
            for start, end in zip(vertices, vertices[1:] + vertices[:1], strict=True)
            if start[2]
        )
    return total
