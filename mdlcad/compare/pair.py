"""Two builds, and what every level of their comparison needs to know."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

from mdlcad.compare.change import Change
from mdlcad.compare.folders import Build, NotComparable, read
from mdlcad.errors import UsageError
from mdlcad.parts.body import Body

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Findings:
    """What a level found: changes, remarks that are none, files that cannot be read as they should, in words, and the
    names of files that it would have read and could not compare."""

    changes: Sequence[Change]
    notes: Sequence[str] = ()
    troubles: Sequence[str] = ()
    apart: Sequence[str] = ()


@dataclass(frozen=True, slots=True)
class Pair:
    """The builds A and B.

    Attributes:
        tolerance_mm: lengths that differ by no more are the same.
        renamed: mass of A -> the mass of B that takes its place under another name.
        bodies: the bodies of A and of B, or why they cannot be had.
    """

    a: Build
    b: Build
    tolerance_mm: float
    renamed: Mapping[str, str]
    bodies: tuple[tuple[Body, ...], tuple[Body, ...]] | NotComparable | UsageError

    def both(self, name: str, kind: type[T]) -> tuple[T, T]:
        """An artefact of either build; see ``read`` for what is raised."""
        return read(self.a, name, kind), read(self.b, name, kind)

    def drawn(self) -> tuple[tuple[Body, ...], tuple[Body, ...]]:
        """The bodies of A and of B; raises why they cannot be had."""
        if isinstance(self.bodies, Exception):
            raise self.bodies
        return self.bodies

    def mass(self, name: str) -> str:
        """What B calls a mass of A."""
        return self.renamed.get(name, name)

    def coupling(self, name: str) -> str:
        """What B calls a coupling ("SOURCE->TARGET") of A."""
        source, arrow, target = name.partition("->")
        return f"{self.mass(source)}{arrow}{self.mass(target)}" if arrow else name
