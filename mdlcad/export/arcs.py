"""True arcs from outlines: parts are drawn with straight edges alone, a circle as a regular polygon."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mdlcad.parts.shapes import ARC_STEP

# How far the turn between two chords and their lengths may be off: the drawing grid of 1e-4 mm on chords of tenths of
# a millimetre, with room.
_TURN = math.radians(0.5)
_LENGTH_MM = 1e-3
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
    goes_on = even & (np.abs(np.abs(turn) - ARC_STEP) < _TURN)  # from edge i to edge i + 1
    goes_on &= (np.sign(turn) == np.sign(np.roll(turn, 1))) | ~np.roll(goes_on, 1)
    breaks = np.flatnonzero(~goes_on)
    if not len(breaks):
        return _arc(ring, 0, count, math.copysign(ARC_STEP, float(turn[0])))
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
            vertices += _arc(ring, edge, run, math.copysign(ARC_STEP, float(turn[edge % count])))
        else:
            vertices += [(*_at(ring, edge + step), 0.0) for step in range(run)]
        edge = last + 1
    return vertices


def _arc(ring: NDArray[np.float64], first: int, edges: int, step: float) -> list[Vertex]:
    half = round(math.pi / ARC_STEP)
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
