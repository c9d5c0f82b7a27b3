"""The STEP assembly: one named, coloured solid a body, equal shapes shared."""

from __future__ import annotations

import copy
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import build123d as b3d
import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeVertex, BRepBuilderAPI_MakeWire
from OCP.GC import GC_MakeArcOfCircle
from OCP.gp import gp_Pnt
from shapely import Polygon

from mdlcad.errors import SignoffError
from mdlcad.export.stepfile import canonical_step
from mdlcad.parts.arcs import Vertex, middle_of_arc, rings, true_area, with_arcs
from mdlcad.parts.body import Body

# A fixed stamp: the file's bytes must depend on the device alone.
_STAMP = "2000-01-01T00:00:00"
# A solid whose volume differs from area x thickness by more than this was built wrongly (an open or twisted wire).
VOLUME_TOLERANCE = 1e-6


def step_assembly(design: str, bodies: Sequence[Body]) -> bytes:
    """The assembly of ``bodies`` as canonical STEP AP214 text, millimetres.

    Bodies are drawn as assembled, round holes, eyes and fillets with true arcs. Equal sections at different
    places share one shape.

    Raises:
        SignoffError: a solid's volume is not its section's area times its thickness, or the writer failed.
    """
    shapes: dict[tuple[Any, ...], b3d.Solid] = {}
    children = []
    for body in bodies:
        section = body.assembled if body.assembled is not None else body.section
        # from its lower left corner, so that equal sections are one shape wherever they are (and no zero is negative)
        origin = np.round(section.bounds[:2], 6)
        local = [np.round(ring - origin, 6) + 0.0 for ring in rings(section)]
        key = (round(body.thickness, 6), *(ring.tobytes() for ring in local))
        if key not in shapes:
            shapes[key] = _prism(body.name, section, local, body.thickness)
        solid = copy.copy(shapes[key])
        solid.location = b3d.Location((float(origin[0]), float(origin[1]), body.z))
        solid.label = body.name
        solid.color = b3d.Color(body.colour)
        children.append(solid)
    assembly = b3d.Compound(label=design, children=children)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "assembly.step"
        if not b3d.export_step(assembly, path, write_pcurves=False, timestamp=_STAMP):
            raise SignoffError("the STEP writer failed")
        return canonical_step(path.read_text(encoding="ascii")).encode("ascii")


def _wire(outline: Sequence[Vertex]) -> b3d.Wire:
    """A closed outline of straight edges and true arcs."""
    maker = BRepBuilderAPI_MakeWire()
    corners = [BRepBuilderAPI_MakeVertex(gp_Pnt(x, y, 0.0)).Vertex() for x, y, _ in outline]
    for index, start in enumerate(outline):
        after = (index + 1) % len(outline)
        end = outline[after]
        if start[2]:
            ends = gp_Pnt(*start[:2], 0.0), gp_Pnt(*end[:2], 0.0)
            arc = GC_MakeArcOfCircle(ends[0], gp_Pnt(*middle_of_arc(start, end), 0.0), ends[1]).Value()
            edge = BRepBuilderAPI_MakeEdge(arc, corners[index], corners[after])
        else:
            edge = BRepBuilderAPI_MakeEdge(corners[index], corners[after])
        maker.Add(edge.Edge())
    return b3d.Wire(maker.Wire())


def _prism(name: str, section: Polygon, local: list[Any], thickness_mm: float) -> b3d.Solid:
    wires = [_wire(with_arcs(ring)) for ring in local]
    solid = b3d.Solid.extrude(b3d.Face(wires[0], wires[1:]), b3d.Vector(0.0, 0.0, thickness_mm))
    expected = true_area(section) * thickness_mm
    if abs(solid.volume - expected) > VOLUME_TOLERANCE * expected:
        raise SignoffError(f"{name}: solid of {solid.volume:.6f} mm3 from a section that gives {expected:.6f} mm3")
    return solid
