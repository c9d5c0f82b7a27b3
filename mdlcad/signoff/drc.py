"""Design rules on the finished bodies: what two bodies may do to each other while both move, and where they may be.

The check knows nothing of channels, tracks or slots: it takes the bodies as drawn, sweeps each over its own motion and
measures. A finding names the rule, the place, the value and the limit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely import Polygon
from shapely.affinity import translate
from shapely.geometry.base import BaseGeometry

from mdlcad.parts.body import Body, BodyKind

# Overlaps and shortfalls below this are rounding of the drawing grid (1e-4 mm).
TOLERANCE_MM = 5e-4
RULES = (
    "overlap",
    "swept_clearance",
    "containment",
    "min_wall",
    "min_gap",
    "bed",
    "seam",
    "trapped",
    "unrealised_coupling",
)


@dataclass(frozen=True, slots=True)
class Finding:
    """A broken rule: where (mm), by whom, the value and its limit (mm, mm2 or as the rule says)."""

    rule: str
    bodies: tuple[str, ...]
    x: float
    y: float
    value: float
    limit: float
    message: str


def swept(body: Body) -> Polygon:
    """The region that the body's section covers over its motion: its Minkowski sum with the motion's rectangle."""
    section = body.assembled if body.assembled is not None else body.section
    shape: BaseGeometry = section
    for dx, dy in ((body.throw[0], 0.0), (0.0, body.throw[1])):
        if dx or dy:
            shape = _dragged(shape, dx, dy)
    return shape


def _dragged(shape: BaseGeometry, dx: float, dy: float) -> BaseGeometry:
    """Union of ``shape`` moved by every fraction between -(dx, dy) and +(dx, dy)."""
    pieces = [translate(shape, -dx, -dy), translate(shape, dx, dy)]
    for ring in _rings(shape):
        start, end = ring[:-1], ring[1:]
        move = np.array([dx, dy])
        corners = np.stack([start - move, end - move, end + move, start + move, start - move], axis=1)
        edges = shapely.polygons(corners)
        pieces.extend(edges[shapely.area(edges) > 0])
    return shapely.union_all([shapely.make_valid(piece) for piece in pieces])


def _rings(shape: BaseGeometry) -> list[np.ndarray]:
    found = []
    for polygon in getattr(shape, "geoms", [shape]):
        found.append(np.asarray(polygon.exterior.coords)[:, :2])
        found.extend(np.asarray(hole.coords)[:, :2] for hole in polygon.interiors)
    return found


def check_motion(bodies: Sequence[Body], gap_mm: float) -> list[Finding]:
    """Rules ``overlap`` (as assembled) and ``swept_clearance`` (both bodies over their whole motion)."""
    still = [body.assembled if body.assembled is not None else body.section for body in bodies]
    regions = [body.envelope if body.envelope is not None else swept(body) for body in bodies]
    tree = shapely.STRtree(regions)
    left, right = tree.query(regions, predicate="dwithin", distance=gap_mm)
    findings = []
    for a, b in sorted(zip(left.tolist(), right.tolist(), strict=True)):
        if a >= b or not _same_level(bodies[a], bodies[b]):
            continue
        names = (bodies[a].name, bodies[b].name)
        common = shapely.intersection(still[a], still[b])
        if common.area > TOLERANCE_MM:
            place = common.representative_point()
            findings.append(
                Finding(
                    "overlap",
                    names,
                    place.x,
                    place.y,
                    common.area,
                    0.0,
                    f"they share {common.area:.3f} mm2 as assembled",
                )
            )
            continue
        if _move_together(bodies[a], bodies[b]):
            continue
        distance = float(shapely.distance(regions[a], regions[b]))
        if distance < gap_mm - TOLERANCE_MM:
            place = shapely.shortest_line(regions[a], regions[b]).centroid
            findings.append(
                Finding(
                    "swept_clearance",
                    names,
                    place.x,
                    place.y,
                    distance,
                    gap_mm,
                    f"{distance:.3f} mm apart at the worst of their motions, {gap_mm:.3f} mm needed",
                )
            )
    return findings


def _same_level(a: Body, b: Body) -> bool:
    return min(a.z + a.thickness, b.z + b.thickness) - max(a.z, b.z) > 1e-6


def _move_together(a: Body, b: Body) -> bool:
    """Whether the two are joined through a rigid body of reference, so that their motions are not independent.

    Two flexures are independent although both may be anchored in the frame: they are checked, unless they hang on the
    same shuttle.
    """
    common = set(a.moves_with) & set(b.moves_with)
    if len(a.moves_with) > 1 and len(b.moves_with) > 1:
        return any(reference.startswith("mass:") for reference in common)
    return bool(common)


def check_containment(bodies: Sequence[Body], boundary: Polygon) -> list[Finding]:
    """Rule ``containment``: nothing but tabs reaches outside the boundary, at any point of its motion."""
    outside = boundary.buffer(TOLERANCE_MM)
    findings = []
    for body in bodies:
        if body.kind is BodyKind.TAB:
            continue
        region = body.envelope if body.envelope is not None else swept(body)
        beyond = shapely.difference(region, outside)
        if beyond.area > TOLERANCE_MM:
            place = beyond.representative_point()
            findings.append(
                Finding(
                    "containment",
                    (body.name,),
                    place.x,
                    place.y,
                    beyond.area,
                    0.0,
                    f"{beyond.area:.3f} mm2 of it reach outside the boundary",
                )
            )
    return findings


def check_cut(plate: str, bodies: Sequence[Body], min_wall_mm: float, min_gap_mm: float) -> list[Finding]:
    """Rules ``min_wall`` and ``min_gap`` on one plate as cut, by opening and closing its section."""
    section = shapely.union_all([body.section for body in bodies], grid_size=1e-4)
    wall, gap = min_wall_mm - 4 * TOLERANCE_MM, min_gap_mm - 4 * TOLERANCE_MM
    opened = section.buffer(-wall / 2, join_style="mitre").buffer(wall / 2 + TOLERANCE_MM, join_style="mitre")
    closed = section.buffer(gap / 2, join_style="mitre").buffer(-gap / 2 - TOLERANCE_MM, join_style="mitre")
    findings = []
    for rule, rest, limit in (
        ("min_wall", shapely.difference(section, opened), min_wall_mm),
        ("min_gap", shapely.difference(closed, section), min_gap_mm),
    ):
        for piece in getattr(rest, "geoms", [rest]):
            # corners leave crumbs of the size of the tolerance; a wall or gap too thin leaves a strip
            if piece.area > limit * limit / 4:
                place = piece.representative_point()
                nearest = min(bodies, key=lambda body: body.section.distance(place))
                findings.append(
                    Finding(
                        rule,
                        (nearest.name, plate),
                        place.x,
                        place.y,
                        2 * shapely.maximum_inscribed_circle(piece).length if piece.area else 0.0,
                        limit,
                        f"thinner than {limit:.3f} mm on plate {plate}",
                    )
                )
    return findings
