"""Records against records: which of their fields differ, and which of a list of named ones come, go or change."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from enum import Enum
from typing import Any, TypeVar

from mdlcad.compare.change import Change, FieldChange, Plain, Sort

T = TypeVar("T")
# Beyond a mm tolerance for lengths, numbers are the same when they agree to the last digits of a float.
_RELATIVE = 1e-9


def same_number(a: float, b: float, tolerance: float) -> bool:
    """Within ``tolerance``, or equal but for rounding."""
    return a == b or abs(a - b) <= max(tolerance, _RELATIVE * max(abs(a), abs(b)))


def flat(record: object, skip: frozenset[str] = frozenset()) -> dict[str, Plain]:
    """A record (dataclass, mapping, sequence or scalar) as dotted names and plain values, in the record's order."""
    return dict(_walk("", record, skip))


def _walk(name: str, value: Any, skip: frozenset[str]) -> Iterator[tuple[str, Plain]]:
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        for item in dataclasses.fields(value):
            if item.name not in skip:
                yield from _walk(_joined(name, item.name), getattr(value, item.name), skip)
    elif isinstance(value, Mapping):
        for key in sorted(value):
            yield from _walk(_joined(name, str(key)), value[key], skip)
    elif isinstance(value, list | tuple):
        for index, item in enumerate(value):
            yield from _walk(f"{name}[{index}]", item, skip)
    elif isinstance(value, Enum):
        yield name, str(value.value)
    else:
        yield name, value


def _joined(name: str, part: str) -> str:
    return f"{name}.{part}" if name else part


def field_changes(
    a: object, b: object, tolerance: float = 0.0, skip: frozenset[str] = frozenset()
) -> tuple[FieldChange, ...]:
    """The fields in which two records differ; numbers by more than ``tolerance``."""
    before, after = flat(a, skip), flat(b, skip)
    found = []
    for name in dict.fromkeys((*before, *after)):
        old, new = before.get(name), after.get(name)
        if isinstance(old, int | float) and isinstance(new, int | float) and not isinstance(old, bool):
            if same_number(float(old), float(new), tolerance):
                continue
        elif old == new:
            continue
        found.append(FieldChange(name, old, new))
    return tuple(found)


def shown(value: Plain) -> str:
    """A value for people: numbers to four digits."""
    if value is None:
        return "none"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.4g}" if math.isfinite(value) else str(value)
    text = str(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def worded(fields: Sequence[FieldChange], most: int = 3) -> str:
    """ "k0 3 -> 2.5, bias 0 -> 0.5 and 2 more"."""
    parts = [f"{item.name} {_pair(item)}".lstrip() for item in fields[:most]]
    if len(fields) > most:
        parts.append(f"and {len(fields) - most} more")
    return ", ".join(parts)


def _pair(item: FieldChange) -> str:
    before, after = shown(item.before), shown(item.after)
    if before == after:  # four digits do not tell them apart
        before, after = repr(item.before), repr(item.after)
    return f"{before} -> {after}"


def keyed_changes(
    what: str,
    a: Mapping[str, T],
    b: Mapping[str, T],
    describe: Callable[[T], str] = lambda _: "",
    tolerance: float = 0.0,
    skip: frozenset[str] = frozenset(),
) -> list[Change]:
    """Changes between two sets of records known by name."""
    found = [Change(what, name, Sort.REMOVED, describe(a[name])) for name in a if name not in b]
    found += [Change(what, name, Sort.ADDED, describe(b[name])) for name in b if name not in a]
    for name in a:
        if name in b:
            fields = field_changes(a[name], b[name], tolerance, skip)
            if fields:
                found.append(Change(what, name, Sort.CHANGED, worded(fields), fields))
    return found


# what is gone or new first: its size says little beside that
_ORDER = (Sort.REMOVED, Sort.ADDED, Sort.REROUTED, Sort.MOVED, Sort.CHANGED, Sort.RENAMED)


def largest_first(changes: Iterable[Change]) -> tuple[Change, ...]:
    """By sort, since millimetres and areas do not compare, then by size; ties by kind and name."""
    return tuple(sorted(changes, key=lambda item: (_ORDER.index(item.sort), -(item.size or 0.0), item.what, item.name)))


def counted(number: int, word: str) -> str:
    """ "1 place", "2 places"."""
    return f"{number} {word}{'' if number == 1 else 's'}"
