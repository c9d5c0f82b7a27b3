"""Flat drawings of a plate: SVG to look at, DXF to cut."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from xml.sax.saxutils import escape

import ezdxf
import numpy as np
from ezdxf import units
from shapely import Polygon

from mdlcad.export.solid import plate_section, rings
from mdlcad.parts.body import Body

_MARGIN_MM = 5.0
# Registered in this order; left alone, the library registers them in the order of a set.
_DXF_CLASSES = (
    "ACDBDICTIONARYWDFLT",
    "ACDBPLACEHOLDER",
    "DICTIONARYVAR",
    "LAYOUT",
    "MATERIAL",
    "MLEADERSTYLE",
    "SCALE",
    "TABLESTYLE",
    "VISUALSTYLE",
)


def svg_plate(plate: str, bodies: Sequence[Body]) -> bytes:
    """SVG of one plate as cut, 1 unit = 1 mm, every body filled in its colour and named on hover."""
    bounds = np.array([body.section.bounds for body in bodies])
    low, high = bounds[:, :2].min(axis=0) - _MARGIN_MM, bounds[:, 2:].max(axis=0) + _MARGIN_MM
    width, height = high - low
    # y points up in the device and down in SVG
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.3f}mm" height="{height:.3f}mm" '
        f'viewBox="{low[0]:.3f} {-high[1]:.3f} {width:.3f} {height:.3f}">',
        f"<title>plate {escape(plate)}</title>",
        '<g fill-rule="evenodd" stroke="#202020" stroke-width="0.08">',
    ]
    for body in bodies:
        path = _path(body.section)
        parts.append(f'<path fill="{body.colour}" d="{path}"><title>{escape(body.name)}</title></path>')
    parts.append("</g></svg>\n")
    return "\n".join(parts).encode()


def _path(section: Polygon) -> str:
    return "".join("M" + "L".join(f"{x:.4f} {-y:.4f}" for x, y in ring) + "Z" for ring in rings(section))


def dxf_plate(bodies: Sequence[Body]) -> bytes:
    """DXF (R2010, mm) of the plate's union as cut: closed polylines, outer cuts and inner cuts on their own layers.

    Kerf is not applied.
    """
    with _fixed_dxf_stamps():
        return _dxf(bodies)


@contextmanager
def _fixed_dxf_stamps() -> Iterator[None]:
    """The library stamps files with the time and random ids unless told not to."""
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before


def _dxf(bodies: Sequence[Body]) -> bytes:
    document = ezdxf.new("R2010", units=units.MM)
    for name in _DXF_CLASSES:
        document.classes.add_class(name)
    document.layers.add("OUTER", color=1)
    document.layers.add("INNER", color=5)
    space = document.modelspace()
    for polygon in plate_section(bodies):
        outline, *holes = rings(polygon)
        space.add_lwpolyline(outline, close=True, dxfattribs={"layer": "OUTER"})
        for hole in holes:
            space.add_lwpolyline(hole, close=True, dxfattribs={"layer": "INNER"})
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode()
