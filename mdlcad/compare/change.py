"""The artefact of a comparison: levels, and what changed at each, in one form for machine and person.

Lengths are in mm and areas in mm2, unless a field's name says otherwise. A is the first build, B the second; what is
"added" is in B alone, what is "removed" in A alone.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum

Plain = str | float | int | bool | None


class Verdict(StrEnum):
    """The outcome, one an exit code: 0, 1, 2."""

    SAME = "same"
    DIFFERENT = "different"
    TROUBLE = "trouble"


class LevelState(StrEnum):
    """How a level came out."""

    SAME = "same"
    DIFFERENT = "different"
    NOT_COMPARED = "not compared"


class Sort(StrEnum):
    """What happened to a thing."""

    ADDED = "added"
    REMOVED = "removed"
    CHANGED = "changed"
    MOVED = "moved"
    RENAMED = "renamed"
    REROUTED = "re-routed"


@dataclass(frozen=True, slots=True)
class FieldChange:
    """One property with its two values; nested ones have dotted names."""

    name: str
    before: Plain
    after: Plain


@dataclass(frozen=True, slots=True)
class Spot:
    """Where a change is: a box (x low, y low, x high, y high) in mm.

    Attributes:
        plate: the plate it is on; "" if it concerns all of them.
        area_mm2: of the difference inside the box, where that was measured.
        bodies: names of the changed bodies there.
    """

    plate: str
    box: tuple[float, float, float, float]
    area_mm2: float | None = None
    bodies: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Change:
    """One change.

    Attributes:
        what: the kind of thing ("mass", "coupling", "unit", "net", "plate", "body", "file", ...).
        name: its name in B, or in A if B lacks it.
        words: what happened, for people, without the name.
        size: how much, in ``unit``, where that can be said; a level lists its largest changes first.
        spots: where, largest first.
    """

    what: str
    name: str
    sort: Sort
    words: str = ""
    fields: tuple[FieldChange, ...] = ()
    size: float | None = None
    unit: str = ""
    spots: tuple[Spot, ...] = ()


@dataclass(frozen=True, slots=True)
class Level:
    """One level of a build.

    Attributes:
        notes: remarks that are no differences ("the text differs, the behaviour does not").
        reason: why it was not compared, or "".
    """

    name: str
    state: LevelState
    changes: tuple[Change, ...] = ()
    notes: tuple[str, ...] = ()
    reason: str = ""


@dataclass(frozen=True, slots=True)
class Side:
    """What a build says of itself. ``edited``: files that are not the ones its report vouches for."""

    folder: str
    design: str
    version: str
    cells: str
    process: str
    seed: int | None
    edited: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two builds compared.

    Attributes:
        tolerance_um: lengths that differ by no more count as the same.
        troubles: what stands in the way of a full comparison and is nobody's intention (a truncated file).
    """

    verdict: Verdict
    a: Side
    b: Side
    tolerance_um: float
    levels: tuple[Level, ...]
    troubles: tuple[str, ...] = field(default=())
