"""The placement artefact: the boundary in millimetres, the lattice, and who sits where."""

from __future__ import annotations

from dataclasses import dataclass

from msgspec import UNSET, UnsetType

from mdlcad.mechanics.decks import Deck


@dataclass(frozen=True, slots=True)
class PlacedMass:
    """A mass in its slot; (x, y) is the centre of its hub in mm.

    Attributes:
        deck: where its unit is; left out of the file of a device with one unit plate.
    """

    mass: str
    column: int
    row: int
    x: float
    y: float
    deck: Deck | UnsetType = UNSET


@dataclass(frozen=True, slots=True)
class PlacedPort:
    """A sensor or actuator bit at its true place on the boundary, in mm.

    Attributes:
        bit: "NAME[i]".
        mass: the mass that it drives or that drives it.
        line: the boundary line it stands on.
        normal: outward unit normal of that line.
    """

    bit: str
    mass: str
    line: str
    x: float
    y: float
    normal: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Placement:
    """Who sits where.

    Attributes:
        boundary: the device's outline in mm, one vertex a line, in the program's order.
        mm_per_grid: the one uniform scale from the program's grid to mm.
        column_x: hub x of every column; row_y: hub y of every row.
        slots: every usable (column, row).
        seed: the seed that found it.
    """

    boundary: tuple[tuple[float, float], ...]
    mm_per_grid: float
    column_x: tuple[float, ...]
    row_y: tuple[float, ...]
    slots: tuple[tuple[int, int], ...]
    masses: tuple[PlacedMass, ...]
    ports: tuple[PlacedPort, ...]
    seed: int
