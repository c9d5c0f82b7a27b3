"""What a written plate file draws: its outline as cut, read back from DXF, SVG, STL or STEP.

One section in mm; what is inside follows the even-odd rule where the file has only outlines.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import shapely
from shapely.errors import ShapelyError
from shapely.geometry.base import BaseGeometry

from mdlcad.errors import UsageError

# No device is this large; numbers beyond it are damage.
MOST_MM = 1e5
_FLATTEN_MM = 1e-3
_SVG_STEP = re.compile(r"([MLHVZmlhvz])([^A-Za-z]*)")
_SVG_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
KINDS = ("dxf", "svg", "stl", "step")


def read_drawing(path: Path) -> BaseGeometry:
    """The section that a plate file draws, in mm.

    Raises:
        UsageError: the file cannot be read as a drawing of a plate; the message names it.
    """
    # the readers of files load in a second or more, and most comparisons need none of them
    from ezdxf import DXFError

    reader = {".dxf": _dxf, ".svg": _svg, ".stl": _stl, ".step": _step}[path.suffix]
    try:
        section = reader(path)
        bounds = section.bounds
    except (OSError, ValueError, KeyError, IndexError, TypeError, ShapelyError, ElementTree.ParseError) as problem:
        raise UsageError(f"{path}: cannot be read as a drawing ({problem or type(problem).__name__})") from None
    except DXFError as problem:
        raise UsageError(f"{path}: cannot be read as a DXF drawing ({problem})") from None
    if section.is_empty:
        raise UsageError(f"{path}: draws nothing")
    if not np.isfinite(bounds).all() or np.abs(bounds).max() > MOST_MM:
        raise UsageError(f"{path}: draws something larger than {MOST_MM / 1000:g} m; it is damaged")
    return section


def _dxf(path: Path) -> BaseGeometry:
    import ezdxf
    import ezdxf.path

    rings = []
    for entity in ezdxf.readfile(path).modelspace():
        if entity.dxftype() in ("TEXT", "MTEXT"):
            continue  # says what something is, cuts nothing
        outline = ezdxf.path.make_path(entity)
        points = [(point.x, point.y) for point in outline.flattening(_FLATTEN_MM)]
        if len(points) > 2:
            rings.append(shapely.linestrings([*points, points[0]]))
    return _inside(rings)


def _svg(path: Path) -> BaseGeometry:
    bodies = []
    for element in ElementTree.parse(path).iter():
        if "transform" in element.attrib:
            raise ValueError("has transformed shapes, which this reader does not follow")
        if element.tag.rpartition("}")[2] == "path":
            # y points down in SVG
            rings = [shapely.linestrings([(x, -y) for x, y in ring]) for ring in _svg_rings(element.attrib["d"])]
            bodies.append(_inside(rings))
    return shapely.union_all(bodies, grid_size=1e-4)


def _svg_rings(text: str) -> Iterator[list[tuple[float, float]]]:
    if re.search(r"[^MLHVZmlhvz\d\s.,eE+-]", text):
        raise ValueError("has curves, which this reader does not follow")
    ring: list[tuple[float, float]] = []
    x = y = 0.0
    for command, argument in _SVG_STEP.findall(text):
        numbers = [float(number) for number in _SVG_NUMBER.findall(argument)]
        relative, kind = command.islower(), command.upper()
        if kind == "Z":
            if len(ring) > 2:
                yield [*ring, ring[0]]
            ring = []
        elif kind in "HV":
            for number in numbers:
                x = number + (x if relative else 0.0) if kind == "H" else x
                y = number + (y if relative else 0.0) if kind == "V" else y
                ring.append((x, y))
        else:
            for one, other in zip(numbers[::2], numbers[1::2], strict=True):
                x, y = (x + one, y + other) if relative else (one, other)
                ring.append((x, y))


def _stl(path: Path) -> BaseGeometry:
    """The cut at half height."""
    import trimesh

    mesh = trimesh.load_mesh(path, file_type="stl")
    if not len(mesh.faces) or not np.isfinite(mesh.vertices).all():
        raise ValueError("holds no mesh")
    middle = float(mesh.bounds[:, 2].mean())
    cut = trimesh.intersections.mesh_plane(mesh, (0.0, 0.0, 1.0), (0.0, 0.0, middle))
    # ends of neighbouring segments are interpolated from either side: the same but for rounding
    ends = np.round(np.asarray(cut)[:, :, :2], 6)
    kept = ends[(ends[:, 0] != ends[:, 1]).any(axis=1)]
    return _inside(list(shapely.linestrings(kept)))


def _step(path: Path) -> BaseGeometry:
    from mdlcad.signoff.readback import read_step

    return shapely.union_all([body.section for body in read_step(path)], grid_size=1e-4)


def _inside(lines: list[BaseGeometry]) -> BaseGeometry:
    """What closed lines enclose, by the even-odd rule."""
    return shapely.make_valid(shapely.build_area(shapely.geometrycollections(lines)))
