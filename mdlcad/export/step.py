"""The STEP assembly: one named, coloured solid a body, equal shapes shared."""

from __future__ import annotations

import copy
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import build123d as b3d
import numpy as np
from shapely import Polygon

from mdlcad.errors import SignoffError
from mdlcad.export.solid import rings
from mdlcad.export.stepfile import canonical_step
from mdlcad.parts.body import Body

# A fixed stamp: the file's bytes must depend on the device alone.
_STAMP = "2000-01-01T00:00:00"
# A solid whose volume differs from area x thickness by more than this was built wrongly (an open or twisted wire).
VOLUME_TOLERANCE = 1e-6


def step_assembly(design: str, bodies: Sequence[Body]) -> bytes:
    """The assembly of ``bodies`` as canonical STEP AP214 text, millimetres.

    Bodies are drawn as assembled. Equal sections at different places share one shape.

    Raises:
        SignoffError: a solid's volume is not its section's area times its thickness, or the writer failed.
    """
    shapes: dict[tuple[Any, ...], b3d.Solid] = {}
    children = []
    for body in bodies:
        section = body.assembled if body.assembled is not None else body.section
        origin = np.floor(np.asarray(section.bounds[:2]))
        local = [np.round(ring - origin, 6) for ring in rings(section)]
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


def _prism(name: str, section: Polygon, local: list[Any], thickness_mm: float) -> b3d.Solid:
    wires = [b3d.Wire.make_polygon([(x, y, 0.0) for x, y in ring], close=True) for ring in local]
    solid = b3d.Solid.extrude(b3d.Face(wires[0], wires[1:]), b3d.Vector(0.0, 0.0, thickness_mm))
    expected = section.area * thickness_mm
    if abs(solid.volume - expected) > VOLUME_TOLERANCE * expected:
        raise SignoffError(f"{name}: solid of {solid.volume:.6f} mm3 from a section that gives {expected:.6f} mm3")
    return solid
