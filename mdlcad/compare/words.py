"""A comparison in words for a terminal: short, the largest first, one symbol a sort of change."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from enum import IntEnum

from mdlcad.compare.change import Change, Comparison, Level, LevelState, Side, Sort, Verdict

SYMBOLS = {
    Sort.ADDED: "+",
    Sort.REMOVED: "-",
    Sort.CHANGED: "~",
    Sort.MOVED: ">",
    Sort.RENAMED: "=",
    Sort.REROUTED: "%",
}
_INDENT = " " * 12


class Verbosity(IntEnum):
    """How much to say: the verdict; the largest changes; many with their fields; all."""

    VERDICT = 0
    SHORT = 1
    LONG = 2
    ALL = 3


_MOST = {Verbosity.SHORT: 6, Verbosity.LONG: 40}


def told(comparison: Comparison, verbosity: Verbosity = Verbosity.SHORT) -> Iterator[str]:
    """The lines to print; troubles are not among them, but for their number."""
    if verbosity > Verbosity.VERDICT:
        yield f"A {_side(comparison.a)}"
        yield f"B {_side(comparison.b)}"
        for level in comparison.levels:
            yield from _level(level, verbosity)
    yield verdict_words(comparison)


def verdict_words(comparison: Comparison) -> str:
    """One line: the verdict, and at which levels."""
    different = [level.name for level in comparison.levels if level.state is LevelState.DIFFERENT]
    apart = [level.name for level in comparison.levels if level.state is LevelState.NOT_COMPARED]
    words = f"the same within {comparison.tolerance_um:g} um"
    if different:
        words = f"different in {', '.join(different)}"
    if comparison.verdict is Verdict.TROUBLE:
        words = f"trouble with {len(comparison.troubles)} file{'s'[: len(comparison.troubles) > 1]}; " + words
    return words + (f"; not compared: {', '.join(apart)}" if apart else "")


def counted(level: Level) -> str:
    """ "2 removed, 1 moved"."""
    if level.state is LevelState.SAME:
        return "same"
    counts = Counter(change.sort for change in level.changes)
    words = ", ".join(f"{counts[sort]} {sort}" for sort in Sort if counts[sort])
    if level.state is LevelState.NOT_COMPARED:
        return f"not compared: {level.reason}"
    return words


def _side(side: Side) -> str:
    asked = f"{side.design}, {side.cells}, {side.process}, seed {side.seed}, version {side.version or 'unknown'}"
    return f"{side.folder} ({asked})" + (f"; edited since: {_few(side.edited)}" if side.edited else "")


def _few(names: tuple[str, ...], most: int = 4) -> str:
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")


def _level(level: Level, verbosity: Verbosity) -> Iterator[str]:
    yield f"{level.name:<11} {counted(level)}"
    most = _MOST.get(verbosity, len(level.changes))
    for change in level.changes[:most]:
        yield f"{_INDENT}{line(change)}"
        if verbosity > Verbosity.SHORT and len(change.fields) > 1:
            for item in change.fields:
                yield f"{_INDENT}    {item.name}: {item.before} -> {item.after}"
    if len(level.changes) > most:
        yield f"{_INDENT}... and {len(level.changes) - most} more (-v, -vv)"
    notes = level.notes if verbosity > Verbosity.SHORT else level.notes[:3]
    for note in notes:
        yield f"{_INDENT}({note})"
    if len(level.notes) > len(notes):
        yield f"{_INDENT}(... and {len(level.notes) - len(notes)} more remarks)"


def line(change: Change) -> str:
    """ "> unit heading[0]: by 0.050 mm (+0.050, +0.000), in its slot"."""
    return f"{SYMBOLS[change.sort]} {change.what} {change.name}".rstrip() + (
        f": {change.words}" if change.words else ""
    )
