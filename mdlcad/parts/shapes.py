"""Plane shapes on a grid of 0.1 um: boxes, round eyes, strips of constant width, and clean unions of them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import shapely
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
