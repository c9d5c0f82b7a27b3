"""Bodies read back from a written STEP file: the geometry as another program would see it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from shapely import Polygon

from mdlcad.errors import UsageError
from mdlcad.parts.shapes import ARC_STEP

_SAME_MM = 1e-6


@dataclass(frozen=True, slots=True)
class ReadBody:
    """A prism found in a file: its name there, its section in the x-y plane, its extent in z and volume, in mm."""

    name: str
    section: Polygon
    z: float
    thickness: float
    volume: float


def read_step(path: Path) -> tuple[ReadBody, ...]:
    """All solids of the STEP assembly at ``path``, with the section taken from each solid's lowest face.

    Raises:
        UsageError: the file cannot be read, or holds a solid that is not one prism along z.
    """
    import cadquery as cq  # the CAD kernel takes seconds to load, and LVS without files does not need it

    try:
        assembly = cq.Assembly.importStep(str(path))
    except (ValueError, RuntimeError, OSError) as problem:
        raise UsageError(f"{path.name}: not a readable STEP assembly: {problem}") from problem
    found: list[ReadBody] = []
    for shape, name, location, _colour in assembly:
        placed = shape.moved(location)
        found.extend(_read_solid(path, name.rpartition("/")[2], solid) for solid in placed.Solids())
    if not found:
        raise UsageError(f"{path.name}: holds no solid")
    return tuple(found)


def _read_solid(path: Path, name: str, solid: Any) -> ReadBody:
    box = solid.BoundingBox()
    bottoms = [
        face
        for face in solid.Faces()
        if _is_level(face) and face.normalAt().z < -0.999 and abs(face.Center().z - box.zmin) < 1e-6
    ]
    if len(bottoms) != 1:
        raise UsageError(f"{path.name}: {name} has {len(bottoms)} bottom faces, a plate's body has one")
    bottom = bottoms[0]
    section = Polygon(_corners(bottom.outerWire()), [_corners(wire) for wire in bottom.innerWires()])
    return ReadBody(name, section, box.zmin, box.zmax - box.zmin, solid.Volume())


def _is_level(face: Any) -> bool:
    """Whether a face lies in a plane across z; most of a prism's are walls, and are to be told quickly."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.GeomAbs import GeomAbs_SurfaceType

    surface = BRepAdaptor_Surface(face.wrapped, False)
    is_plane = surface.GetType() == GeomAbs_SurfaceType.GeomAbs_Plane
    return bool(is_plane and abs(surface.Plane().Axis().Direction().Z()) > 0.999)


def _corners(wire: Any) -> list[tuple[float, float]]:
    """Corners of a closed wire of straight edges and arcs in the order of the walk, arcs with chords as they are drawn.

    Edges may be stored against the walk: each goes on from where the one before it ended.
    """
    paths = [_path(edge) for edge in wire]
    first, after = paths[0], paths[1]
    if min(_far(first[-1], after[0]), _far(first[-1], after[-1])) > _SAME_MM:
        first.reverse()
    corners: list[tuple[float, float]] = []
    end = first[0]
    for path in paths:
        if _far(path[0], end) > _SAME_MM:
            path.reverse()
        corners += path[:-1]
        end = path[-1]
    return corners


def _path(edge: Any) -> list[tuple[float, float]]:
    """An edge as points: its two ends, or an arc's in steps of what a drawn outline turns by."""
    steps = 1 if edge.geomType() == "LINE" else max(1, round(edge.Length() / edge.radius() / ARC_STEP))
    points = [edge.positionAt(step / steps) for step in range(steps + 1)]
    return [(point.x, point.y) for point in points]


def _far(a: tuple[float, float], b: tuple[float, float]) -> float:
    return max(abs(a[0] - b[0]), abs(a[1] - b[1]))
