"""Plane shapes on a grid of 0.1 um: boxes, round eyes, strips of constant width, and clean unions of them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry, LineString, MultiPolygon, Polygon

GRID = 1e-4
"""Coordinates are rounded to this, mm."""

_QUARTER = 6  # segments of a quarter circle
ARC_STEP = math.pi / 2.0 / _QUARTER
"""What a round outline turns by from one straight edge to the next, rad."""


def box(x_low: float, y_low: float, x_high: float, y_high: float) -> Polygon:
    """An axis-parallel rectangle."""
    return _snap(shapely.box(x_low, y_low, x_high, y_high))


def square(x: float, y: float, side: float) -> Polygon:
    """A square about (x, y), its sides parallel to the axes."""
    return box(x - side / 2.0, y - side / 2.0, x + side / 2.0, y + side / 2.0)


def disc(x: float, y: float, radius: float) -> Polygon:
    """A regular 24-gon inscribed in a circle."""
    return _snap(shapely.Point(x, y).buffer(radius, quad_segs=_QUARTER))


def strip(path: Sequence[tuple[float, float]], width: float) -> Polygon:
    """The strip of constant width along a centre line: flat ends, sharp corners."""
    return _snap(LineString(path).buffer(width / 2.0, cap_style="flat", join_style="mitre", mitre_limit=4.0))


def join(parts: Iterable[Geometry]) -> Polygon:
    """The union of parts that touch or overlap, as one polygon.

    Raises:
        ValueError: the parts do not hang together.
    """
    whole = shapely.union_all([_snap(part) for part in parts], grid_size=GRID)
    return only(whole)


def cut(shape: Geometry, holes: Iterable[Geometry]) -> Geometry:
    """``shape`` without ``holes``; may fall into several polygons."""
    away = list(holes)
    if not away:
        return _snap(shape)
    return shapely.difference(_snap(shape), shapely.union_all(away, grid_size=GRID), grid_size=GRID)


def without_thin(shape: Geometry, wall: float) -> Geometry:
    """``shape`` without what is thinner than ``wall``: a slot close to an edge is opened to it."""
    half = wall / 2.0 - 10.0 * GRID
    opened = shape.buffer(-half, join_style="mitre").buffer(half + GRID, join_style="mitre")
    return shapely.intersection(shape, opened, grid_size=GRID)


def slits(shape: Geometry, beside: Geometry, gap: float) -> list[Polygon]:
    """What is narrower than ``gap`` between two shapes of one rigid body: a slit that no cutter can leave open."""
    both = shapely.union_all([_snap(shape), _snap(beside)], grid_size=GRID)
    half = gap / 2.0
    closed = both.buffer(half, join_style="mitre").buffer(-half - GRID, join_style="mitre")
    found = pieces(shapely.difference(closed, both, grid_size=GRID))
    # corners leave crumbs of the rounding
    return [piece for piece in found if piece.area > gap * gap / 4.0]


_SHARPEST = math.radians(30.0)
"""Outlines of bent walls turn by less from edge to edge, corners by more."""
_LEAST_RADIUS = 0.97
"""Two fillets that share an edge a little too short for both (a bent leaf's root) may be so much less."""


def filleted(shape: Polygon, radius: float) -> Polygon:
    """``shape`` with an arc of ``radius`` in every inner corner of its outline and of its holes.

    Raises:
        ValueError: two corners are too near to each other for their fillets.
    """
    if not radius:
        return shape
    # without vertices that are next to none, such as those where a bent leaf leaves its block
    plain = shape.simplify(10.0 * GRID)
    # the material on the left of every ring: inner corners turn right
    outer, *holes = (np.asarray(ring.coords)[:-1] for ring in (plain.exterior, *plain.interiors))
    rings = [_wound(outer, 1.0), *(_wound(hole, -1.0) for hole in holes)]
    rounded, *voids = (_rounded(ring, radius) for ring in rings)
    return only(_snap(Polygon(rounded, voids)))


def _wound(ring: NDArray[np.float64], sense: float) -> NDArray[np.float64]:
    x, y = ring.T
    return ring if sense * float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) > 0.0 else ring[::-1]


def _rounded(ring: NDArray[np.float64], radius: float) -> NDArray[np.float64]:
    before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    along, edge = before / np.hypot(*before.T)[:, None], np.hypot(*after.T)
    turn = np.arctan2(before[:, 1] * after[:, 0] - before[:, 0] * after[:, 1], (before * after).sum(axis=1))
    inner = turn > _SHARPEST
    reach = np.where(inner, radius * np.tan(np.where(inner, turn, 0.0) / 2.0), 0.0)
    # of an edge, what the fillets at its two ends take, at most all of it
    share = np.minimum(1.0, edge / np.maximum(reach + np.roll(reach, -1), GRID))
    share = np.minimum(share, np.roll(share, 1))
    if np.any(share[inner] < _LEAST_RADIUS):
        x, y = ring[np.flatnonzero(inner & (share < _LEAST_RADIUS))[0]]
        raise ValueError(f"no room for a fillet of {radius:g} mm in the corner at ({x:.2f}, {y:.2f})")
    points: list[NDArray[np.float64]] = []
    for corner, way, angle, own, length in zip(ring, along, turn, radius * share, reach * share, strict=True):
        if length == 0.0:
            points.append(corner[None])
            continue
        start, right = corner - length * way, np.array([way[1], -way[0]])
        steps = max(1, round(angle / ARC_STEP))
        at = (angle * np.arange(steps + 1) / steps)[:, None]
        points.append(start + own * (np.sin(at) * way + (1.0 - np.cos(at)) * right))
    outline = np.round(np.concatenate(points) / GRID) * GRID
    # where two fillets meet, one ends where the next begins
    return np.asarray(outline[np.any(outline != np.roll(outline, 1, axis=0), axis=1)])


def closed(shape: Geometry, radius: float) -> Polygon:
    """``shape`` as a tool of ``radius`` leaves it that goes all around it: with arcs in its inner corners.

    Raises:
        ValueError: a gap of it is so narrow that no such tool gets in.
    """
    if not radius:
        return only(_snap(shape))
    whole = shape.buffer(radius, join_style="mitre", mitre_limit=10.0).buffer(-radius, quad_segs=_QUARTER)
    for piece in pieces(shapely.difference(whole, shape)):
        if piece.area > radius * radius:
            place = piece.representative_point()
            raise ValueError(f"a gap at ({place.x:.2f}, {place.y:.2f}) is too narrow for fillets of {radius:g} mm")
    return only(shapely.union_all([_snap(whole), _snap(shape)], grid_size=GRID))


def only(shape: Geometry) -> Polygon:
    """The one polygon of a shape, tidied: no needless vertices, oriented, starting at its least vertex.

    Raises:
        ValueError: it is not exactly one polygon.
    """
    found = pieces(shape)
    if len(found) != 1:
        raise ValueError(f"expected one polygon, found {len(found)}")
    return found[0]


def pieces(shape: Geometry) -> list[Polygon]:
    """All polygons of a shape with an area, tidied, in the order of their lower left corners."""
    parts = list(shape.geoms) if isinstance(shape, MultiPolygon | shapely.GeometryCollection) else [shape]
    found = [part.simplify(GRID / 10.0).normalize() for part in parts if isinstance(part, Polygon) and part.area > GRID]
    return sorted(found, key=lambda part: part.bounds)


def _snap(shape: Geometry) -> Geometry:
    return shapely.set_precision(shape, GRID)
