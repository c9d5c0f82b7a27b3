"""Drawings of the assembly guide: one plan view a step, and one of how the starting state is set. SVG, millimetres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import shapely
from shapely import Polygon

from mdlcad.parts.body import Body
from mdlcad.parts.leaf import occupied

_MARGIN_MM = 6.0
_COARSE_MM = 0.02
_GROUND = "#f3f4f6"
_BEFORE = "#9aa3af"
_ARROW = "#b3261e"


@dataclass(frozen=True, slots=True)
class Mark:
    """A number at a place, mm."""

    number: int
    x: float
    y: float


@dataclass(frozen=True, slots=True)
class Push:
    """An arrow from where a shuttle rests to where it is pushed, mm, with its number."""

    number: int
    x: float
    y: float
    away: float


def draw_step(boundary: Polygon, before: Sequence[Body], new: Sequence[Body], marks: Sequence[Mark], label: str) -> str:
    """The device from above at one step: what is new in colour, ``before`` in grey under it."""
    shapes = [occupied(body) for body in new]
    size = _text_size(boundary)
    parts = [_ring_path(boundary, _GROUND, _BEFORE)]
    parts += [_path(occupied(body), _BEFORE, body.name) for body in before]
    # what stands in a plate is drawn over it
    parts += [_path(shape, body.colour, body.name) for body, shape in zip(new, shapes, strict=True)]
    parts += [_number(mark.number, mark.x, mark.y, size) for mark in marks]
    return _svg([boundary, *shapes], parts, label)


def draw_start(boundary: Polygon, shown: Sequence[Body], pushes: Sequence[Push], label: str) -> str:
    """The device from above with an arrow on every shuttle that is pushed."""
    size = _text_size(boundary)
    parts = [_path(occupied(body), "#dfe5ec", body.name) for body in shown]
    for push in pushes:
        tip = push.y + push.away
        head, side = 0.35 * push.away, 0.35 * abs(push.away)
        points = (
            f"{push.x - side:.2f},{-(tip - head):.2f} {push.x + side:.2f},{-(tip - head):.2f} {push.x:.2f},{-tip:.2f}"
        )
        start = push.y - push.away
        parts.append(
            f'<g fill="{_ARROW}" stroke="{_ARROW}"><line x1="{push.x:.2f}" y1="{-start:.2f}" x2="{push.x:.2f}" '
            f'y2="{-(tip - head):.2f}" stroke-width="{size / 4.0:.2f}"/><polygon points="{points}"/></g>'
        )
        parts.append(_number(push.number, push.x + 1.3 * size, push.y, size))
    return _svg([boundary, *(occupied(body) for body in shown)], parts, label)


def _text_size(boundary: Polygon) -> float:
    """Height of numbers: read on a page as wide as the device is drawn, whatever its size."""
    x0, y0, x1, y1 = boundary.bounds
    return float(min(4.0, max(2.2, max(x1 - x0, y1 - y0) / 60.0)))


def _svg(shapes: Sequence[Polygon], parts: Sequence[str], label: str) -> str:
    x0, y0, x1, y1 = shapely.GeometryCollection(list(shapes)).buffer(_MARGIN_MM).bounds
    return (
        f'<svg viewBox="{x0:.2f} {-y1:.2f} {x1 - x0:.2f} {y1 - y0:.2f}" width="100%" role="img" '
        f'aria-label="{escape(label)}"><g fill-rule="evenodd" stroke="#202020" stroke-width="0.15">'
        f"{''.join(parts)}</g></svg>"
    )


def _path(shape: Polygon, colour: str, name: str) -> str:
    return f'<path fill="{colour}" d="{_outline(shape)}"><title>{escape(name)}</title></path>'


def _ring_path(shape: Polygon, fill: str, stroke: str) -> str:
    return f'<path fill="{fill}" stroke="{stroke}" d="{_outline(shape)}"/>'


def _outline(shape: Polygon) -> str:
    plain = shape.simplify(_COARSE_MM)
    return "".join(
        "M" + "L".join(f"{x:.2f} {-y:.2f}" for x, y in list(ring.coords)[:-1]) + "Z"
        for ring in (plain.exterior, *plain.interiors)
    )


def _number(number: int, x: float, y: float, size: float) -> str:
    return (
        f'<text x="{x:.2f}" y="{-y + 0.35 * size:.2f}" font-size="{size:.2f}" text-anchor="middle" font-weight="700" '
        f'fill="#111" stroke="#fff" stroke-width="{size / 5.0:.2f}" paint-order="stroke" '
        f'font-family="sans-serif">{number}</text>'
    )
