"""The declarations as written: every word with its place, nothing yet checked for sense."""

from __future__ import annotations

from dataclasses import dataclass

from mdlcad.language.device import Where


@dataclass(frozen=True, slots=True)
class Word:
    """A name, number or text of the program (a text without its quotes)."""

    text: str
    where: Where


@dataclass(frozen=True, slots=True)
class WrittenLine:
    """``line NAME {(x, y), (x, y)}``; the points are where their brackets open."""

    name: Word
    start: tuple[Word, Word]
    end: tuple[Word, Word]
    start_where: Where
    end_where: Where


@dataclass(frozen=True, slots=True)
class WrittenBoundary:
    """``boundary {...}``."""

    where: Where
    lines: tuple[WrittenLine, ...]


@dataclass(frozen=True, slots=True)
class WrittenPlace:
    """``(line, position)``."""

    where: Where
    line: Word
    position: Word


@dataclass(frozen=True, slots=True)
class WrittenValue:
    """``"0b..": "LABEL"``."""

    key: Word
    label: Word


@dataclass(frozen=True, slots=True)
class WrittenPort:
    """A sensor or an actuator. A field that is given twice stands here twice, each with the place of its word."""

    kind: str
    name: Word
    types: tuple[tuple[Where, Word], ...]
    locations: tuple[tuple[Where, tuple[WrittenPlace, ...]], ...]
    values: tuple[tuple[Where, tuple[WrittenValue, ...]], ...]


@dataclass(frozen=True, slots=True)
class Program:
    """All declarations of a file, in its order.

    Attributes:
        broken: a declaration could not be read, so that nothing can be said to be missing.
    """

    names: tuple[Word, ...]
    boundaries: tuple[WrittenBoundary, ...]
    ports: tuple[WrittenPort, ...]
    broken: bool
