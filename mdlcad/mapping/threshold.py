"""Threshold functions of a few inputs: which truth tables one mass can compute, and with what weights.

A mass computes sign(sum_i w_i x_i + b) of inputs x_i = -1 or +1 with integer weights. The sum is odd for every input
that can occur, so no input leaves it undecided.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import product

MOST_INPUTS = 5


@dataclass(frozen=True, slots=True)
class Threshold:
    """sign(sum weights[i] x_i + bias); weights are not zero, and negative where the input is inverted."""

    weights: tuple[int, ...]
    bias: int

    @property
    def inputs(self) -> int:
        """Sum of the absolute weights."""
        return sum(abs(w) for w in self.weights)

    @property
    def total(self) -> int:
        """Sum of the absolute weights and bias: how much force stands behind a margin of one."""
        return self.inputs + abs(self.bias)

    def negated(self) -> Threshold:
        """The function with its output inverted."""
        return Threshold(tuple(-w for w in self.weights), -self.bias)

    def gated(self) -> Threshold:
        """This function AND one more input, put in front."""
        greatest = sum(abs(w) for w in self.weights) + self.bias
        gate = max(1, greatest // 2 + 1)
        return Threshold((gate, *self.weights), self.bias - gate)


AND2 = Threshold((1, 1), -1)
COPY = Threshold((1,), 0)


@lru_cache(maxsize=8)
def threshold_functions(inputs: int, limit: int) -> tuple[tuple[int, Threshold], ...]:
    """All functions that need exactly ``inputs`` inputs and at most ``limit`` total weight, lightest first.

    Each comes with its truth table: bit m is the value where input i is bit i of m.
    """
    best: dict[int, Threshold] = {}
    spans = [w for w in range(-limit, limit + 1) if w]
    for weights in product(spans, repeat=inputs):
        used = sum(abs(w) for w in weights)
        for bias in range(used - limit, limit - used + 1):
            if (used + bias) % 2 == 0:
                continue
            candidate = Threshold(weights, bias)
            table = _table(candidate)
            if not _needs_all(table, inputs):
                continue
            if table not in best or candidate.total < best[table].total:
                best[table] = candidate
    return tuple(sorted(best.items(), key=lambda item: (item[1].total, item[0])))


@lru_cache(maxsize=65536)
def match(on: int, off: int, inputs: int, limit: int) -> Threshold | None:
    """The lightest function that is 1 on the minterms ``on`` and 0 on ``off`` (free elsewhere), or None."""
    for table, candidate in threshold_functions(inputs, limit):
        if not (on & ~table) and not (off & table):
            return candidate
    return None


def _table(function: Threshold) -> int:
    table = 0
    for minterm in range(1 << len(function.weights)):
        total = function.bias + sum(w if minterm >> i & 1 else -w for i, w in enumerate(function.weights))
        table |= (total > 0) << minterm
    return table


def _needs_all(table: int, inputs: int) -> bool:
    return all(
        any((table >> m & 1) != (table >> (m | 1 << i) & 1) for m in range(1 << inputs) if not m >> i & 1)
        for i in range(inputs)
    )
