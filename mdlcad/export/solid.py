"""Prisms from sections: triangle meshes by manifold3d, which keeps what it makes watertight."""

from __future__ import annotations

from collections.abc import Sequence

import manifold3d
import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

from mdlcad.errors import SignoffError
from mdlcad.parts.arcs import rings
from mdlcad.parts.body import Body

# Parts are drawn on a grid of a tenth of a micrometre, far below what any process resolves, so that bodies that share
# an edge join without slivers.
GRID_MM = 1e-4


def polygons(shape: BaseGeometry) -> list[Polygon]:
    """The polygons of a shapely geometry, in a fixed order (by their lower left corner, then area)."""
    if isinstance(shape, Polygon):
        parts = [shape]
    elif isinstance(shape, MultiPolygon):
        parts = list(shape.geoms)
    else:
        parts = [part for part in getattr(shape, "geoms", []) if isinstance(part, Polygon)]
    kept = [part for part in parts if not part.is_empty]
    return sorted(kept, key=lambda part: (part.bounds[0], part.bounds[1], part.area))


def plate_section(bodies: Sequence[Body]) -> list[Polygon]:
    """The union of the bodies' sections as cut: disjoint polygons with holes."""
    union = shapely.union_all([body.section for body in bodies], grid_size=GRID_MM)
    return polygons(shapely.normalize(union))


def prism(section: Sequence[Polygon], z_mm: float, thickness_mm: float) -> manifold3d.Manifold:
    """The watertight prism over ``section`` from z to z + thickness.

    Raises:
        SignoffError: the kernel could not make a closed solid of the section.
    """
    contours = [ring for polygon in section for ring in rings(polygon)]
    solid = manifold3d.Manifold.extrude(
        manifold3d.CrossSection(contours, manifold3d.FillRule.Positive), thickness_mm
    ).translate((0.0, 0.0, z_mm))
    if solid.status() != manifold3d.Error.NoError or solid.is_empty():
        raise SignoffError(f"a section of {len(section)} polygons did not make a closed solid: {solid.status()}")
    return solid


def triangles(solid: manifold3d.Manifold) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices (n, 3) in mm and triangles (m, 3) of a solid, outward normals."""
    mesh = solid.to_mesh64()
    return np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts, dtype=np.int64)
