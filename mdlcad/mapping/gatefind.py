"""Which gates of given signals compute a function of which only some minterms matter, alone or with one gate more."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

from mdlcad.mapping.threshold import Threshold, match, threshold_functions

MOST_LEAVES = 4
"""Most inputs of a gate that is looked for."""


@dataclass(frozen=True, slots=True)
class Need:
    """Truth tables of where a function must be 1 and where it must be 0; elsewhere it is free."""

    on: int
    off: int


@dataclass(frozen=True, slots=True)
class Gate:
    """``function`` of ``sources``."""

    sources: tuple[str, ...]
    function: Threshold


class GateFinder:
    """Looks for gates of signals with known truth tables, small ones first.

    Attributes:
        limit: greatest sum of the weights and bias of a gate.
        effort: how many shapes of gates, of sets of signals, it may still try; without any left it finds no more.
    """

    def __init__(self, tables: Mapping[str, int], full: int, limit: int) -> None:
        self._tables, self._full, self.limit = tables, full, limit
        self.effort = 0
        self._regions: dict[tuple[str, ...], list[int]] = {}

    def gates(self, need: Need, signals: tuple[str, ...]) -> Iterator[Gate]:
        """Every set of ``signals`` of which some gate meets ``need``, with the lightest such gate."""
        for count in range(1, MOST_LEAVES + 1):
            for leaves in self._sets(signals, count, 1):
                on = off = 0
                for minterm, region in enumerate(self._split(leaves)):
                    ones, zeros = need.on & region, need.off & region
                    if ones and zeros:
                        break
                    on |= bool(ones) << minterm
                    off |= bool(zeros) << minterm
                else:
                    function = match(on, off, count, self.limit)
                    if function is not None:
                        yield Gate(leaves, function)

    def halves(self, need: Need, signals: tuple[str, ...]) -> Iterator[tuple[Gate, Need]]:
        """Every gate of ``signals`` and one input more (the last, not inverted) that meets ``need`` if that input meets
        the need that comes with it."""
        for count in range(MOST_LEAVES):
            for leaves in self._sets(signals, count, len(_shapes(count, self.limit))):
                parts = [(need.on & region, need.off & region) for region in self._split(leaves)]
                for follows, function in _shapes(count, self.limit):
                    on = off = 0
                    for output, (ones, zeros) in zip(follows, parts, strict=True):
                        if output is None:
                            on, off = on | ones, off | zeros
                        elif zeros if output else ones:
                            break
                    else:
                        if on and off:
                            yield Gate(leaves, function), Need(on, off)

    def _sets(self, signals: tuple[str, ...], count: int, cost: int) -> Iterator[tuple[str, ...]]:
        """Sets of ``count`` signals of which no two are the same, or each other's inverse."""
        for leaves in combinations(signals, count):
            if self.effort <= 0:
                return
            self.effort -= cost
            tables = [self._tables[leaf] for leaf in leaves]
            if len({min(table, table ^ self._full) for table in tables}) == count:
                yield leaves

    def _split(self, leaves: tuple[str, ...]) -> list[int]:
        """Where the leaves have each of their minterms."""
        if leaves not in self._regions:
            parts = [self._full]
            for leaf in reversed(leaves):
                table = self._tables[leaf]
                parts = [half for part in parts for half in (part & ~table, part & table)]
            self._regions[leaves] = parts
        return self._regions[leaves]


@lru_cache(maxsize=16)
def _shapes(leaves: int, limit: int) -> tuple[tuple[tuple[bool | None, ...], Threshold], ...]:
    """What gates of ``leaves`` + 1 inputs, the last not inverted, make of the leaves' minterms: 0, 1 or (None) the last
    input; each with the lightest such gate."""
    found: dict[tuple[bool | None, ...], Threshold] = {}
    for table, function in threshold_functions(leaves + 1, limit):
        if function.weights[-1] > 0:
            lows = [bool(table >> minterm & 1) for minterm in range(1 << leaves)]
            highs = [bool(table >> (minterm | 1 << leaves) & 1) for minterm in range(1 << leaves)]
            shape = tuple(low if low == high else None for low, high in zip(lows, highs, strict=True))
            found.setdefault(shape, function)
    return tuple(found.items())
