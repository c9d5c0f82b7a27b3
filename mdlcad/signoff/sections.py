"""Outlines of bodies as cut, read back from the drawings of plates (plates/PLATE.svg)."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

from shapely import Polygon

from mdlcad.errors import UsageError
from mdlcad.mechanics.process import PlateRole, Process

_SVG = "{http://www.w3.org/2000/svg}"


def read_cut(folder: Path, process: Process) -> dict[str, Polygon]:
    """The outlines as cut of all bodies on the rung plates of a build.

    Raises:
        UsageError: a drawing is missing or is none.
    """
    found: dict[str, Polygon] = {}
    for plate in process.plates(PlateRole.RUNG):
        path = folder / "plates" / f"{plate.name}.svg"
        if path.is_file():  # a rung plate that a device does not need is not drawn
            found |= read_sections(path)
    return found


def read_sections(path: Path) -> dict[str, Polygon]:
    """The outline of every body named in the drawing at ``path``, in mm in its place in the device.

    Raises:
        UsageError: it is not such a drawing.
    """
    try:
        root = ElementTree.parse(path).getroot()
        found = {}
        for element in root.iter(f"{_SVG}path"):
            title = element.find(f"{_SVG}title")
            if title is None or not title.text:
                continue
            rings = [_ring(ring) for ring in element.attrib["d"].split("Z") if ring]
            found[title.text] = Polygon(rings[0], rings[1:])
    except (OSError, ElementTree.ParseError, KeyError, ValueError, IndexError) as error:
        raise UsageError(f"{path.name}: not the drawing of a plate: {error}") from error
    return found


def _ring(text: str) -> list[tuple[float, float]]:
    corners = []
    for corner in text.removeprefix("M").split("L"):
        x, y = corner.split()
        corners.append((float(x), -float(y)))
    return corners
