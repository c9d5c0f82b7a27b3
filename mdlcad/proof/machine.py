"""The reference as a graph: states that can be reached and where every input leads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mdlcad.proof.behaviour import Behaviour, Bits

Ints = NDArray[np.int64]

# Machines with at most this many state and input bits together are explored and checked in full.
EXHAUSTIVE_BITS = 12

_MAX_STATES = 4096
_MAX_VECTORS = 256

# Beyond that, up to so many vectors are tried while the table of all moves stays below _MAX_MOVES: a state that only a
# few vectors lead to is not found otherwise.
_MANY_VECTORS_BITS = 12
_MAX_MOVES = 1 << 22
_BATCH = 1 << 16

_UNKNOWN = -1


@dataclass(frozen=True, slots=True, eq=False)
class Graph:
    """States and moves.

    Attributes:
        states: uint8[n, S]; state 0 is power-up.
        vectors: uint8[k, I], the input vectors that were tried.
        following: int[n, k], the next state, or -1 if it is not among ``states``.
        first: int[n, 2], the (state, vector) by which each state was first reached; -1 for state 0.
        complete: all input vectors were tried and all reachable states are here.
        closed: all states that these vectors lead to are here.
    """

    states: Bits
    vectors: Bits
    following: Ints
    first: Ints
    complete: bool
    closed: bool = True


def all_vectors(bits: int) -> Bits:
    """uint8[2^bits, bits], every vector, the first bit changing fastest."""
    return ((np.arange(1 << bits)[:, None] >> np.arange(bits)) & 1).astype(np.uint8)


def some_vectors(bits: int, count: int, seed: int) -> Bits:
    """uint8[about count, bits]: zeros, ones, one-hots, one-colds, and random ones."""
    rng = np.random.default_rng([seed, bits])
    eye = np.eye(bits, dtype=np.uint8)
    corners = [np.zeros((1, bits), np.uint8), np.ones((1, bits), np.uint8), eye, 1 - eye]
    random = rng.integers(0, 2, (count, bits), dtype=np.uint8)
    return np.unique(np.concatenate([*corners, random]), axis=0)


def explore(behaviour: Behaviour, seed: int) -> Graph:
    """Breadth-first search from power-up, a level at a time, for a machine with at least one state bit.

    All input vectors are tried if there are few enough, else a seeded sample; the search stops at 4,096 states. With
    at most EXHAUSTIVE_BITS bits of state and inputs the graph is always complete. Between these, many vectors are
    tried from fewer states, and few from many, and the graph is the one that found more states.
    """
    inputs, bits = len(behaviour.inputs), len(behaviour.states)
    if inputs + bits <= EXHAUSTIVE_BITS or 1 << inputs <= _MAX_VECTORS:
        return _explore(behaviour, all_vectors(inputs), _MAX_STATES, True)
    every = inputs <= _MANY_VECTORS_BITS
    many = all_vectors(inputs) if every else some_vectors(inputs, 1 << _MANY_VECTORS_BITS, seed)
    wide = _explore(behaviour, many, min(_MAX_STATES, _MAX_MOVES // len(many)), every)
    if wide.closed:
        return wide
    deep = _explore(behaviour, some_vectors(inputs, _MAX_VECTORS, seed), _MAX_STATES, False)
    return deep if len(deep.states) > len(wide.states) else wide


def _explore(behaviour: Behaviour, vectors: Bits, most_states: int, every: bool) -> Graph:
    """Breadth-first search by ``vectors``, which are ``every`` vector there is or some, to ``most_states`` states."""
    k = len(vectors)

    initial = np.asarray(behaviour.initial, dtype=np.uint8)
    states = [initial]
    place = {initial.tobytes(): 0}
    first = [(_UNKNOWN, _UNKNOWN)]
    rows: list[Ints] = []
    closed = True
    while len(rows) < len(states):
        here = len(rows)
        level = np.array(states[here : here + max(1, _BATCH // k)])
        after, _ = behaviour.step(np.repeat(level, k, axis=0), np.tile(vectors, (len(level), 1)))
        unique, index, inverse = np.unique(
            np.ascontiguousarray(after, dtype=np.uint8), axis=0, return_index=True, return_inverse=True
        )
        number = np.full(len(unique), _UNKNOWN, dtype=np.int64)
        for u in np.argsort(index):  # in order of discovery, whatever the values
            key = unique[u].tobytes()
            if key not in place:
                if len(states) == most_states:
                    closed = False
                    continue
                place[key] = len(states)
                states.append(unique[u])
                first.append((here + int(index[u]) // k, int(index[u]) % k))
            number[u] = place[key]
        rows.extend(number[inverse.ravel()].reshape(len(level), k))
    return Graph(np.array(states), vectors, np.array(rows), np.array(first, dtype=np.int64), every and closed, closed)


def single_state_graph(vectors: Bits, complete: bool) -> Graph:
    """The graph of a device without state: one state, every vector leads back to it."""
    following = np.zeros((1, len(vectors)), dtype=np.int64)
    return Graph(np.zeros((1, 0), np.uint8), vectors, following, np.array([(_UNKNOWN, _UNKNOWN)]), complete)


def history_graph(vectors: Bits) -> Graph:
    """The graph of a device without state whose "state" is the vector it saw before (state 0: power-up).

    Covering it shows every vector after every other vector.
    """
    k = len(vectors)
    following = np.tile(np.arange(1, k + 1), (k + 1, 1))
    first = np.array([(_UNKNOWN, _UNKNOWN)] + [(0, v) for v in range(k)], dtype=np.int64)
    return Graph(np.zeros((k + 1, 0), np.uint8), vectors, following, first, True)
