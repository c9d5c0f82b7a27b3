"""Fillets read off outlines: their radii, from how much of a corner is filled. Lengths in mm."""

from __future__ import annotations

import math

from shapely import LineString, Point, Polygon

from mdlcad.mechanics.fillet import Root, Seat, eye_root, flat_root
from mdlcad.parts.shapes import ARC_STEP

_LOOK = 2.0
"""How far from a corner its fillet is looked for, mm."""
_GRAIN = 2e-3
"""Nearer than this to a corner its outline is sharp, and a place is on an outline: far above the drawing grid."""
_BESIDE = 0.01
"""How far from a corner its two sides are looked for, mm."""


def is_inner(section: Polygon, corner: tuple[float, float], way: tuple[float, float]) -> bool:
    """Whether there is material on both sides of a corner whose void would open towards ``way`` (signs along x, y)."""
    x, y = corner
    step_x, step_y = way[0] * _BESIDE, way[1] * _BESIDE
    return all(section.intersects(Point(side)) for side in ((x + step_x, y - step_y), (x - step_x, y + step_y)))


def fillet_at(section: Polygon, corner: tuple[float, float], way: tuple[float, float], lean: float = 0.0) -> float:
    """Radius of the fillet in an inner corner whose void opens towards ``way`` (signs along x and y), 0 if it is sharp.

    An arc that touches both sides of a corner of angle a has its nearest point r (1 / sin(a / 2) - 1) from it.

    Args:
        lean: by how much the corner is wider than a right angle, rad, its side along y leaning away.
    """
    half = math.pi / 4.0 + lean / 2.0
    along = (way[0] * math.cos(half), way[1] * math.sin(half))
    line = LineString([corner, (corner[0] + along[0] * _LOOK, corner[1] + along[1] * _LOOK)])
    filled = section.intersection(line)
    for piece in getattr(filled, "geoms", [filled]):
        ends = sorted(math.dist(corner, point) for point in piece.coords)
        if ends and ends[0] < _GRAIN < ends[-1]:
            return ends[-1] / (1.0 / math.sin(half) - 1.0)
    return 0.0


def root_at(section: Polygon, x: float, wall: tuple[float, float], out: float, seat: Seat) -> Root:
    """The root of a wall that spans ``wall`` in y and runs from a face at ``x`` towards ``out`` (+1 or -1) along x."""
    corners = [((x, edge), (out, way)) for edge, way in zip(wall, (-1.0, 1.0), strict=True)]
    radii = [radius for radius in (fillet_at(section, *corner) for corner in corners) if radius]
    if radii:
        return flat_root(sum(radii) / len(radii), len(radii), seat=seat)
    return flat_root(0.0, sum(is_inner(section, *corner) for corner in corners), seat=seat)


def seen_eye_root(section: Polygon, front: float, middle: float, wall: float, eye: float, out: float) -> Root:
    """The root of a wall about y = ``middle`` at an eye of radius ``eye`` whose front is at x = ``front``.

    Round eyes are drawn with straight edges: the first of them leans away from the wall by half of what they turn by.
    """
    lean = ARC_STEP / 2.0
    x = front - out * wall / 2.0 * math.tan(lean)
    radii = [fillet_at(section, (x, middle + way * wall / 2.0), (out, way), lean) for way in (-1.0, 1.0)]
    return eye_root(sum(radii) / 2.0, wall, eye) if all(radii) else flat_root(0.0, 0)
