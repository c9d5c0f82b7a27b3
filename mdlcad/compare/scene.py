"""What the page of a comparison draws: the bodies of both builds by plate, and the areas that only one of them has."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mdlcad.compare.sections import GRID_MM
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.parts.body import Body
from mdlcad.parts.plates import STOCK
from mdlcad.placement.placement import Placement
from mdlcad.routing.layout import Layout

_COLOURS = {"unit": "#8fb3ee", "rung": "#b8a58c", "trunk": "#8c7b66", "tab": "#e0b21b", "outline": "#eef1f5"}


@dataclass(frozen=True, slots=True)
class Shape:
    """One thing to draw: ``path`` is an index into the scene's paths."""

    name: str
    colour: str
    path: int


@dataclass(frozen=True, slots=True)
class PlateScene:
    """One plate, or one group of stock: what A has, what B has, and the paths of what only A and only B cover."""

    name: str
    a: tuple[Shape, ...]
    b: tuple[Shape, ...]
    only_a: int | None
    only_b: int | None


@dataclass(frozen=True, slots=True)
class Scene:
    """Plates bottom first; ``paths`` are SVG path data in mm, y up; ``box`` is x low, y low, x high, y high."""

    plates: tuple[PlateScene, ...]
    paths: tuple[str, ...]
    box: tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Drawn:
    """One thing of a build, before it has a path."""

    name: str
    plate: str
    z: float
    colour: str
    section: Polygon


def drawn_bodies(bodies: Sequence[Body]) -> list[Drawn]:
    """Bodies as assembled."""
    return [
        Drawn(
            body.name,
            body.kind.value + "s" if body.kind in STOCK else body.plate,
            body.z,
            body.colour,
            body.assembled if body.assembled is not None else body.section,
        )
        for body in bodies
    ]


def drawn_layout(placement: Placement, layout: Layout | None, rules: LayoutRules) -> list[Drawn]:
    """Footprints of units and centre lines of carriers, for a build that has no bodies yet."""
    found = [Drawn("outline", "slots", 0.0, _COLOURS["outline"], Polygon(placement.boundary))]
    half = rules.row_pitch / 2.0
    for unit in placement.masses:
        box = shapely.box(unit.x - rules.unit_left, unit.y - half, unit.x + rules.unit_right, unit.y + half)
        found.append(Drawn(f"unit.{unit.mass}", "slots", 0.0, _COLOURS["unit"], box))
    if layout is None:
        return found
    bar = rules.bar_width / 2.0
    for trunk in layout.trunks:
        box = shapely.box(trunk.x - bar, trunk.y_low - bar, trunk.x + bar, trunk.y_high + bar)
        found.append(Drawn(trunk.name, "V", 1.0, _COLOURS["trunk"], box))
    for rung in layout.rungs:
        box = shapely.box(rung.left.x, rung.y - bar, rung.right.x, rung.y + bar)
        found.append(Drawn(rung.name, rung.plate, 2.0, _COLOURS["rung"], box))
    for tab in layout.tabs:
        way = shapely.linestrings(tab.path).buffer(bar, cap_style="flat", join_style="mitre")
        found.append(Drawn(f"tab.{tab.bit}", tab.plate, 2.0, _COLOURS["tab"], way))
    return found


def make_scene(a: Sequence[Drawn], b: Sequence[Drawn]) -> Scene:
    """Both builds, plate by plate; equal outlines are kept once."""
    paths: dict[str, int] = {}

    def index(shape: BaseGeometry) -> int:
        return paths.setdefault(_path(shape), len(paths))

    order: dict[str, float] = {}
    for item in (*a, *b):
        order[item.plate] = min(order.get(item.plate, item.z), item.z)
    both = bool(a) and bool(b)  # a build without a layout does not differ in all of it; it is not compared
    plates = []
    for plate in sorted(order, key=lambda name: (order[name], name)):
        on_a, on_b = ([item for item in items if item.plate == plate] for items in (a, b))
        area_a, area_b = _cover(on_a), _cover(on_b)
        gone = shapely.difference(area_a, area_b, grid_size=GRID_MM)
        new = shapely.difference(area_b, area_a, grid_size=GRID_MM)
        plates.append(
            PlateScene(
                plate,
                tuple(Shape(item.name, item.colour, index(item.section)) for item in on_a),
                tuple(Shape(item.name, item.colour, index(item.section)) for item in on_b),
                index(gone) if both and not gone.is_empty else None,
                index(new) if both and not new.is_empty else None,
            )
        )
    bounds = [item.section.bounds for item in (*a, *b)]
    low_x, low_y = min(box[0] for box in bounds), min(box[1] for box in bounds)
    high_x, high_y = max(box[2] for box in bounds), max(box[3] for box in bounds)
    return Scene(tuple(plates), tuple(paths), (low_x, low_y, high_x, high_y))


def _cover(items: Iterable[Drawn]) -> BaseGeometry:
    return shapely.union_all([item.section for item in items], grid_size=GRID_MM)


def _path(shape: BaseGeometry) -> str:
    """SVG path data with relative steps in mm to three digits: half as long as with absolute ones."""
    parts = []
    for polygon in shapely.get_parts(shape):
        if isinstance(polygon, Polygon):
            for ring in (polygon.exterior, *polygon.interiors):
                points = [(round(x * 1000), round(y * 1000)) for x, y, *_ in ring.coords[:-1]]
                parts.append(f"M{_mm(points[0][0])} {_mm(points[0][1])}l")
                steps = pairwise(points)
                parts.append(" ".join(f"{_mm(x1 - x0)} {_mm(y1 - y0)}" for (x0, y0), (x1, y1) in steps) + "z")
    return "".join(parts)


def _mm(micrometres: int) -> str:
    text = f"{micrometres / 1000:.3f}".rstrip("0").rstrip(".")
    return "0" if text in ("", "-0") else text
