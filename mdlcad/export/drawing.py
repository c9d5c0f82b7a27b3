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

from mdlcad.errors import SignoffError
from mdlcad.export.solid import plate_section
from mdlcad.parts.arcs import rings, with_arcs
from mdlcad.parts.body import Body

_MARGIN_MM = 5.0
_TEXT_MM = 1.5
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


def dxf_plate(bodies: Sequence[Body], kerf_mm: float = 0.0) -> bytes:
    """DXF (R2010, mm) of the plate's union: closed polylines with true arcs, one layer a purpose.

    OUTER and INNER are what is cut, NAMES (which is not plotted) says which body is where.

    Args:
        kerf_mm: width that the machine takes away; outlines are drawn half of it outside what is to be left. 0: as
            drawn.

    Raises:
        SignoffError: a gap or hole is narrower than the kerf.
    """
    section = plate_section(bodies)
    if kerf_mm:
        section = _widened(section, kerf_mm)
    with _fixed_dxf_stamps():
        return _dxf(section, bodies)


def _widened(section: Sequence[Polygon], kerf_mm: float) -> list[Polygon]:
    wide = [polygon.buffer(kerf_mm / 2.0, join_style="mitre", mitre_limit=10.0) for polygon in section]
    for before, after in zip(section, wide, strict=True):
        if len(before.interiors) != len(after.interiors):
            place = before.representative_point()
            raise SignoffError(
                f"a hole or gap near ({place.x:.1f}, {place.y:.1f}) is narrower than the kerf of {kerf_mm:g} mm"
            )
    return wide


@contextmanager
def _fixed_dxf_stamps() -> Iterator[None]:
    """The library stamps files with the time and random ids unless told not to."""
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before


def _dxf(section: Sequence[Polygon], bodies: Sequence[Body]) -> bytes:
    document = ezdxf.new("R2010", units=units.MM)
    for name in _DXF_CLASSES:
        document.classes.add_class(name)
    document.layers.add("OUTER", color=1)
    document.layers.add("INNER", color=5)
    document.layers.add("NAMES", color=8).dxf.plot = 0
    space = document.modelspace()
    for polygon in section:
        for ring, layer in zip(rings(polygon), ["OUTER"] + ["INNER"] * len(polygon.interiors), strict=True):
            space.add_lwpolyline(with_arcs(ring), format="xyb", close=True, dxfattribs={"layer": layer})
    for body in bodies:
        place = body.section.representative_point()
        text = space.add_text(body.name, height=_TEXT_MM, dxfattribs={"layer": "NAMES"})
        text.set_placement((place.x, place.y))
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode()
