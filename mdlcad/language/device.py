"""What a program says about the device: its outline, the ports on it, and its behaviour as Verilog."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple


@dataclass(frozen=True, slots=True, order=True)
class Where:
    """A position in the MDL file: line and column, both counted from 1, the column in characters."""

    line: int
    column: int


# for devices that are made by hand and not read from a file
NOWHERE = Where(1, 1)


@dataclass(frozen=True, slots=True)
class Line:
    """One straight side of the boundary, from ``start`` to ``end``, in grid units."""

    name: str
    start: tuple[int, int]
    end: tuple[int, int]
    where: Where = NOWHERE


@dataclass(frozen=True, slots=True)
class Place:
    """A spot on the boundary: ``position`` is the fraction (0 to 1) of ``line``, from the line's first point."""

    line: str
    position: float
    where: Where = NOWHERE


class Value(NamedTuple):
    """What people call one value of a port: ``bits`` are the digits 0 and 1, the highest bit first, without "0b"."""

    bits: str
    label: str


@dataclass(frozen=True, slots=True)
class Sensor:
    """An input of the behaviour.

    Attributes:
        places: one a bit; ``places[i]`` is where bit i stands, "NAME[i]", bit 0 being the lowest.
        values: the labels given, in the program's order. Every ``bits`` is ``len(places)`` digits, or every one is a
            single digit: then the labels name the two states of each bit on its own.
        type: the kind of sensor in the user's words, or "".
    """

    name: str
    places: tuple[Place, ...]
    values: tuple[Value, ...]
    type: str = ""
    where: Where = NOWHERE


@dataclass(frozen=True, slots=True)
class Actuator:
    """An output of the behaviour. The attributes are those of a sensor."""

    name: str
    type: str
    places: tuple[Place, ...]
    values: tuple[Value, ...]
    where: Where = NOWHERE


@dataclass(frozen=True, slots=True)
class Device:
    """A program that passed every check of the language.

    Attributes:
        name: of the mechanical module; also the stem of the files made from it.
        boundary: a closed, simple polygon, listed clockwise; each line starts where the one before it ends.
        verilog: the text of the Verilog modules, verbatim, set at the line and column that it has in ``file``, so
            that a position in one is the position in the other (columns in characters, line ends as "\\n").
        file: the name of the MDL file, without folders.
        where: of the module's name.
    """

    name: str
    boundary: tuple[Line, ...]
    sensors: tuple[Sensor, ...]
    actuators: tuple[Actuator, ...]
    verilog: str
    file: str
    where: Where = NOWHERE
