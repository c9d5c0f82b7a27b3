"""Whether two programs do the same: both run side by side from power-up, through every pair of states they can reach.

Exhaustive where the inputs are few and the pairs of states finite in reach; else by random walks, and the words say so.
A difference comes with the shortest sequence of inputs that shows it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mdlcad.errors import InputError, UsageError
from mdlcad.language import Device
from mdlcad.proof.machine import all_vectors
from mdlcad.proof.reference import Reference, build_reference

MOST_INPUT_BITS = 10
MOST_PAIRS = 1 << 14
_WALKS, _DECISIONS = 256, 200

Bits = NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class Outcome:
    """Whether a difference was found; what was found, in words."""

    differs: bool
    words: str


@dataclass(frozen=True, slots=True)
class _Seen:
    """A pair of states that was reached: from which pair (-1: power-up), by which input vector."""

    parent: int
    vector: int


def compare_behaviour(a: Device, b: Device) -> Outcome:
    """Run both programs.

    Raises:
        UsageError: the Verilog of one does not elaborate.
    """
    one, other = _reference(a, "A"), _reference(b, "B")
    if set(one.inputs) != set(other.inputs) or set(one.outputs) != set(other.outputs):
        return Outcome(True, "the text differs, and so do the ports: what they do cannot be held against each other")
    if len(one.inputs) > MOST_INPUT_BITS:
        return _walked(one, other)
    return _explored(one, other)


def _reference(device: Device, side: str) -> Reference:
    try:
        return build_reference(device)
    except InputError as problem:
        first = problem.diagnostics[0]
        raise UsageError(f"device.json of {side}: its Verilog cannot be used: {first.message}") from None


@dataclass(frozen=True, slots=True)
class _Both:
    """Both machines with their ports in the order of A's."""

    a: Reference
    b: Reference

    @property
    def inputs(self) -> tuple[str, ...]:
        return self.a.inputs

    def step(self, states_a: Bits, states_b: Bits, vectors: Bits) -> tuple[Bits, Bits, Bits, Bits]:
        order = [self.a.inputs.index(bit) for bit in self.b.inputs]
        after_a, out_a = self.a.step(states_a, vectors)
        after_b, out_b = self.b.step(states_b, np.ascontiguousarray(vectors[:, order]))
        outputs = [self.b.outputs.index(bit) for bit in self.a.outputs]
        return after_a, after_b, out_a, out_b[:, outputs]


def _explored(a: Reference, b: Reference) -> Outcome:
    both = _Both(a, b)
    vectors = all_vectors(len(a.inputs))
    k, width = len(vectors), len(a.states)
    start = np.concatenate([a.initial, b.initial]).astype(np.uint8)
    pairs, seen = [start], [_Seen(-1, -1)]
    known = {start.tobytes()}
    here = 0
    while here < len(pairs):
        pair = pairs[here]
        states_a, states_b = np.tile(pair[:width], (k, 1)), np.tile(pair[width:], (k, 1))
        after_a, after_b, out_a, out_b = both.step(states_a, states_b, vectors)
        wrong = np.flatnonzero((out_a != out_b).any(axis=1))
        if len(wrong):
            v = int(wrong[0])
            return Outcome(True, _shown(both, _path(seen, here), vectors, v, out_a[v], out_b[v]))
        for v, after in enumerate(np.concatenate([after_a, after_b], axis=1)):
            key = after.tobytes()
            if key not in known:
                known.add(key)
                pairs.append(after)
                seen.append(_Seen(here, v))
        if len(pairs) > MOST_PAIRS:
            return _walked(a, b)
        here += 1
    return Outcome(
        False,
        f"the Verilog is written differently and does the same: {len(pairs)} pairs of states with "
        f"{k} inputs each, all that can be reached",
    )


def _path(seen: list[_Seen], at: int) -> list[int]:
    path = []
    while seen[at].parent >= 0:
        path.append(seen[at].vector)
        at = seen[at].parent
    return path[::-1]


def _shown(both: _Both, path: list[int], vectors: Bits, last: int, out_a: Bits, out_b: Bits) -> str:
    steps = [_named(both.inputs, vectors[v]) for v in (*path, last)]
    differing = [(bit, x, y) for bit, x, y in zip(both.a.outputs, out_a, out_b, strict=True) if x != y]
    gives = ", ".join(f"{bit} is {x} in A and {y} in B" for bit, x, y in differing)
    told = "; then ".join(steps) if len(steps) <= 6 else f"{'; then '.join(steps[:3])}; ... ({len(steps)} decisions)"
    return f"after {len(steps)} decision{'s' if len(steps) > 1 else ''} from power-up ({told}) {gives}"


def _named(names: tuple[str, ...], bits: Bits) -> str:
    return " ".join(f"{name}={bit}" for name, bit in zip(names, bits, strict=True)) or "no inputs"


def _walked(a: Reference, b: Reference) -> Outcome:
    both = _Both(a, b)
    rng = np.random.default_rng(0)
    states_a = np.tile(a.initial.astype(np.uint8), (_WALKS, 1))
    states_b = np.tile(b.initial.astype(np.uint8), (_WALKS, 1))
    for decision in range(_DECISIONS):
        vectors = rng.integers(0, 2, (_WALKS, len(a.inputs)), dtype=np.uint8)
        states_a, states_b, out_a, out_b = both.step(states_a, states_b, vectors)
        wrong = np.flatnonzero((out_a != out_b).any(axis=1))
        if len(wrong):
            w = int(wrong[0])
            differing = [
                f"{bit} is {x} in A and {y} in B"
                for bit, x, y in zip(a.outputs, out_a[w], out_b[w], strict=True)
                if x != y
            ]
            return Outcome(True, f"after {decision + 1} decisions of a random walk {', '.join(differing)}")
    return Outcome(
        False,
        f"the Verilog is written differently; {_WALKS} random walks of {_DECISIONS} decisions show no difference "
        "(too large to try everything)",
    )
