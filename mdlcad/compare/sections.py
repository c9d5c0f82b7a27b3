"""The difference of two plates as areas, computed twice: by KLayout and, as a cross-check, by Shapely.

Both work on a grid of 0.1 um, to which each rounds the coordinates itself. KLayout also puts every crossing of two
edges on the grid, so an edge may shift by up to one grid step; the areas may therefore differ by the perimeter of
the difference times that step. More than that is a fault of one of the two, and no result.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import klayout.db as kdb
import networkx as nx
import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mdlcad.errors import UsageError

GRID_MM = 1e-4
# What rounding adds even where two outlines do not cross.
_ROUNDING_MM2 = 1e-4
# Differences that lie closer together than this are told as one place.
_TOGETHER_MM = 1.0


@dataclass(frozen=True, slots=True)
class Patch:
    """A connected place of difference: its box in mm and the area of the difference in it, mm2."""

    box: tuple[float, float, float, float]
    area: float


@dataclass(frozen=True, slots=True)
class Difference:
    """Two sections compared.

    Attributes:
        only_a, only_b: area that is in one alone, mm2, in regions wider than the tolerance.
        checked: area of the whole difference by Shapely, mm2; raw: the same by KLayout.
        patches: where, largest first.
    """

    only_a: float
    only_b: float
    raw: float
    checked: float
    patches: tuple[Patch, ...]

    @property
    def area(self) -> float:
        return self.only_a + self.only_b


def difference(name: str, a: BaseGeometry, b: BaseGeometry, tolerance_mm: float) -> Difference:
    """What is in A alone and in B alone, in regions wider than ``tolerance_mm``.

    Raises:
        UsageError: KLayout and Shapely disagree about the area.
    """
    region_a, region_b = _region(a), _region(b)
    only_a, only_b = region_a - region_b, region_b - region_a
    raw = _area(region_a ^ region_b)
    exact = shapely.symmetric_difference(shapely.set_precision(a, GRID_MM), shapely.set_precision(b, GRID_MM))
    check_agreement(name, raw, exact)
    kept = [_wider(region, tolerance_mm) for region in (only_a, only_b)]
    return Difference(_area(kept[0]), _area(kept[1]), raw, exact.area, _patches(kept[0] + kept[1]))


def check_agreement(name: str, area_mm2: float, exact: BaseGeometry) -> None:
    """Hold KLayout's area of a difference against Shapely's difference.

    Raises:
        UsageError: they are further apart than rounding explains.
    """
    allowed = _ROUNDING_MM2 + GRID_MM * exact.length
    if abs(area_mm2 - exact.area) > allowed:
        raise UsageError(
            f"{name}: KLayout finds a difference of {area_mm2:.6f} mm2 and Shapely one of {exact.area:.6f} mm2, "
            f"further apart than rounding explains ({allowed:.6f} mm2); neither can be trusted"
        )


def _region(shape: BaseGeometry) -> kdb.Region:
    region = kdb.Region()
    for part in shapely.get_parts(shape):
        if isinstance(part, Polygon) and not part.is_empty:
            polygon = kdb.Polygon(_points(part.exterior.coords), True)
            for hole in part.interiors:
                polygon.insert_hole(_points(hole.coords), True)
            region.insert(polygon)
    return region.merged()


def _points(ring: Sequence[tuple[float, ...]]) -> list[kdb.Point]:
    steps = np.rint(np.asarray(ring)[:-1, :2] / GRID_MM).astype(np.int64).tolist()
    return [kdb.Point(x, y) for x, y in steps]


def _area(region: kdb.Region) -> float:
    return float(region.area()) * GRID_MM * GRID_MM


def _wider(region: kdb.Region, tolerance_mm: float) -> kdb.Region:
    """The polygons of ``region`` that are wider than the tolerance somewhere."""
    half = round(tolerance_mm / GRID_MM / 2.0)
    return region.interacting(region.sized(-half)) if half > 0 else region


def _patches(region: kdb.Region) -> tuple[Patch, ...]:
    boxes = []
    shapes = []
    for polygon in region.each():
        hull = [(p.x * GRID_MM, p.y * GRID_MM) for p in polygon.each_point_hull()]
        box = polygon.bbox()
        boxes.append((np.array([box.left, box.bottom, box.right, box.top]) * GRID_MM, polygon.area() * GRID_MM**2))
        shapes.append(shapely.linestrings([*hull, hull[0]]))
    if not shapes:
        return ()
    together = nx.Graph()
    together.add_nodes_from(range(len(shapes)))
    one, other = shapely.STRtree(shapes).query(shapes, predicate="dwithin", distance=_TOGETHER_MM)
    together.add_edges_from(zip(one.tolist(), other.tolist(), strict=True))
    found = []
    for members in nx.connected_components(together):
        corners = np.array([boxes[i][0] for i in sorted(members)])
        low, high = corners[:, :2].min(axis=0), corners[:, 2:].max(axis=0)
        area = sum(boxes[i][1] for i in sorted(members))
        left, bottom, right, top = (round(float(v), 4) for v in (*low, *high))
        found.append(Patch((left, bottom, right, top), round(area, 6)))
    return tuple(sorted(found, key=lambda patch: (-patch.area, patch.box)))
