"""Bill of materials: what a device is made of, the sheets it is cut from and the stock cut to length.

Areas are those of the outlines as cut, masses are area x thickness x the process's density. A shim has no material in
the process, so its mass is not known and says so (None), and the total leaves it out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import shapely
from shapely import Polygon

from mdlcad.mechanics.process import Process
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.plates import STOCK, plates_of

# g/cm3 x mm3
_GRAMS = 1e-3
# of the drawing grid: outlines nearer than this to a square are one
_SQUARE_MM2 = 1e-3


class Profile(StrEnum):
    """Section of a piece of stock."""

    SQUARE = "square"
    ROUND = "round"


@dataclass(frozen=True, slots=True)
class PartLine:
    """Bodies of one kind on one plate, taken together.

    Attributes:
        material: None if the process names none.
        thickness_mm: of the sheet; area_mm2, mass_g: of all of them together.
    """

    kind: BodyKind
    plate: str
    material: str | None
    thickness_mm: float
    count: int
    area_mm2: float
    mass_g: float | None


@dataclass(frozen=True, slots=True)
class SheetLine:
    """One plate: the piece of sheet to buy and what is cut from it.

    Attributes:
        size_mm: width and height of the rectangle that holds all of its pieces in their places.
        pieces: pieces that fall out of it; bodies drawn apart but touching are one piece.
    """

    plate: str
    material: str | None
    thickness_mm: float
    size_mm: tuple[float, float]
    pieces: int
    area_mm2: float
    mass_g: float | None


@dataclass(frozen=True, slots=True)
class StockLine:
    """Pins, posts or screws of one profile and length; ``size_mm`` is the side of a square, the diameter of a rod."""

    kind: BodyKind
    profile: Profile
    size_mm: float
    length_mm: float
    material: str
    count: int
    mass_g: float


@dataclass(frozen=True, slots=True)
class Bom:
    """The bill of materials; parts and sheets bottom plate first, stock by size.

    Attributes:
        mass_g: of all that has a material.
    """

    parts: tuple[PartLine, ...]
    sheets: tuple[SheetLine, ...]
    stock: tuple[StockLine, ...]
    mass_g: float


def bill_of_materials(bodies: Sequence[Body], process: Process) -> Bom:
    """The bill of materials of a device's bodies."""
    plates = plates_of(bodies)
    parts: list[PartLine] = []
    sheets: list[SheetLine] = []
    for plate, members in plates.items():
        material = _material(process, plate)
        kinds = sorted({body.kind for body in members}, key=list(BodyKind).index)
        for kind in kinds:
            parts += _part_lines(plate, material, [body for body in members if body.kind is kind], process)
        sheets += [_sheet(plate, material, group, process) for group in _by_thickness(members)]
    stock = _stock([body for body in bodies if body.kind in STOCK], process)
    weighed = [line.mass_g for line in sheets if line.mass_g is not None] + [line.mass_g for line in stock]
    return Bom(tuple(parts), tuple(sheets), tuple(stock), round(sum(weighed), 3))


def _material(process: Process, plate: str) -> str | None:
    return {item.name: item.material for item in process.stack.plates}.get(plate)


def _grams(process: Process, material: str | None, volume_mm3: float) -> float | None:
    return None if material is None else round(process.materials[material].density * volume_mm3 * _GRAMS, 3)


def _by_thickness(bodies: Sequence[Body]) -> list[list[Body]]:
    groups: dict[float, list[Body]] = {}
    for body in bodies:
        groups.setdefault(round(body.thickness, 4), []).append(body)
    return [groups[thickness] for thickness in sorted(groups)]


def _part_lines(plate: str, material: str | None, bodies: Sequence[Body], process: Process) -> list[PartLine]:
    lines = []
    for group in _by_thickness(bodies):
        thickness, area = round(group[0].thickness, 4), sum(body.section.area for body in group)
        mass = _grams(process, material, area * thickness)
        lines.append(PartLine(group[0].kind, plate, material, thickness, len(group), round(area, 2), mass))
    return lines


def _sheet(plate: str, material: str | None, bodies: Sequence[Body], process: Process) -> SheetLine:
    layers: dict[float, list[Polygon]] = {}
    for body in bodies:
        layers.setdefault(round(body.z, 4), []).append(body.section)
    # shims of many heights lie over each other in the device: each height is its own cut
    cuts = [shapely.union_all(sections, grid_size=1e-4) for sections in layers.values()]
    pieces = sum(len(getattr(cut, "geoms", [cut])) for cut in cuts)
    x0, y0, x1, y1 = shapely.union_all(cuts).bounds
    thickness, area = round(bodies[0].thickness, 4), sum(cut.area for cut in cuts)
    return SheetLine(
        plate=plate,
        material=material,
        thickness_mm=thickness,
        size_mm=(round(x1 - x0, 2), round(y1 - y0, 2)),
        pieces=pieces,
        area_mm2=round(area, 2),
        mass_g=_grams(process, material, area * thickness),
    )


def _stock(bodies: Sequence[Body], process: Process) -> list[StockLine]:
    material = process.stack.pin_material
    density = process.materials[material].density
    groups: dict[tuple[int, str, float, float], list[Body]] = {}
    for body in bodies:
        profile, size = _profile(body.section)
        key = (list(BodyKind).index(body.kind), profile.value, size, round(body.thickness, 3))
        groups.setdefault(key, []).append(body)
    return [
        StockLine(
            kind=group[0].kind,
            profile=Profile(profile),
            size_mm=size,
            length_mm=length,
            material=material,
            count=len(group),
            mass_g=round(sum(body.section.area * body.thickness for body in group) * density * _GRAMS, 3),
        )
        for (_, profile, size, length), group in sorted(groups.items())
    ]


def _profile(section: Polygon) -> tuple[Profile, float]:
    x0, y0, x1, y1 = section.bounds
    square = abs((x1 - x0) * (y1 - y0) - section.area) < _SQUARE_MM2
    return (Profile.SQUARE if square else Profile.ROUND), round(x1 - x0, 2)
