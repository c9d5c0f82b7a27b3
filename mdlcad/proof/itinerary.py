"""What a proof does with a device: the inputs of every lane, and what the reference makes of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mdlcad.proof.behaviour import Behaviour, Bits
from mdlcad.proof.machine import (
    EXHAUSTIVE_BITS,
    Graph,
    all_vectors,
    explore,
    history_graph,
    single_state_graph,
    some_vectors,
)
from mdlcad.proof.walks import plan

_LANES = 32

# Lanes are filled up with random inputs to this length, so that nothing is shown for the first decisions only.
_LEAST_DECISIONS = 24


@dataclass(frozen=True, slots=True, eq=False)
class Itinerary:
    """D decisions of L lanes, and how they were chosen.

    Attributes:
        inputs: uint8[D, L, I].
        states: uint8[D + 1, L, S], the reference before each decision and after the last.
        outputs: uint8[D, L, O], the reference at the end of each decision: new state, inputs still held.
        total, unreachable, exhaustive, reachable_states: as in ``Proof``.
        method: in words.
    """

    inputs: Bits
    states: Bits
    outputs: Bits
    total: int
    unreachable: int
    exhaustive: bool
    reachable_states: int
    method: str


# Random inputs repeat transitions: a sampled proof goes on until enough distinct ones were met, but not for ever.
_MOST_TIMES = 4


def make_itinerary(
    reference: Behaviour, decisions: int, seed: int, *, exhaustive: bool = True, lanes: int = _LANES
) -> Itinerary:
    """Choose transitions and walks: all transitions if they are known and few enough, else ``decisions`` of them.

    Of these, all are distinct as far as there are so many and four times as many decisions meet them.
    ``exhaustive`` = False: ``decisions`` decisions in any case. More than ``lanes`` lanes are used where some states
    cannot be reached from others.
    """
    asked_for_all = exhaustive
    graph, wanted, exhaustive, method = _goals(reference, decisions, seed, exhaustive)
    walks = plan(graph, wanted, lanes, seed)
    length = max(_LEAST_DECISIONS, max(map(len, walks)), 0 if exhaustive else -(-decisions // len(walks)))
    bits = len(reference.states) + len(reference.inputs)
    known = len(graph.states) if reference.states else 1
    total = known << len(reference.inputs) if graph.complete else 1 << bits

    inputs, states, outputs = _follow(reference, graph, walks, length, seed)
    longest = _MOST_TIMES * length
    while asked_for_all and not exhaustive and length < longest and _distinct(states, inputs) < min(decisions, total):
        length = min(longest, length + -(-length // 4))
        inputs, states, outputs = _follow(reference, graph, walks, length, seed)
    return Itinerary(inputs, states, outputs, total, (1 << bits) - total, exhaustive, known, method)


def _follow(
    reference: Behaviour, graph: Graph, walks: list[list[int]], length: int, seed: int
) -> tuple[Bits, Bits, Bits]:
    """Inputs, states and outputs of ``length`` decisions: the walks, then random inputs."""
    # Random inputs after the planned ones, vectors that the graph knows and others alike.
    inputs = np.random.default_rng([seed, 2]).integers(0, 2, (length, len(walks), len(reference.inputs)), np.uint8)
    for lane, walk in enumerate(walks):
        inputs[: len(walk), lane] = graph.vectors[walk]

    states = np.empty((length + 1, len(walks), len(reference.states)), np.uint8)
    outputs = np.empty((length, len(walks), len(reference.outputs)), np.uint8)
    states[0] = reference.initial
    for d in range(length):
        states[d + 1], outputs[d] = reference.step(states[d], inputs[d])
    return inputs, states, outputs


def _distinct(states: Bits, inputs: Bits) -> int:
    """Transitions met, each counted once."""
    pairs = np.packbits(np.concatenate([states[:-1], inputs], axis=2), axis=2)
    return len(np.unique(pairs.reshape(-1, pairs.shape[2]), axis=0))


def _goals(
    reference: Behaviour, decisions: int, seed: int, exhaustive: bool
) -> tuple[Graph, NDArray[np.bool_], bool, str]:
    """The graph to walk, bool[n, k] the moves to make, whether those are all there are, and words about it."""
    inputs = len(reference.inputs)
    if not reference.states:
        if 2 * inputs <= EXHAUSTIVE_BITS:
            graph = history_graph(all_vectors(inputs))
            method = "every input vector after every other"
        elif inputs <= EXHAUSTIVE_BITS:
            graph = single_state_graph(all_vectors(inputs), True)
            method = "every input vector, in random order"
        else:
            graph = single_state_graph(some_vectors(inputs, decisions, seed), False)
            method = "random input vectors"
        return graph, graph.following >= 0, graph.complete, method

    graph = explore(reference, seed)
    most = max(decisions, 1 << EXHAUSTIVE_BITS) if exhaustive else decisions
    if graph.complete and graph.following.size <= most:
        return graph, np.ones(graph.following.shape, dtype=bool), True, "every input vector in every reachable state"
    wanted = np.zeros(graph.following.shape, dtype=bool)
    reached = graph.first[1:]
    wanted[reached[:, 0], reached[:, 1]] = True  # every state that was found is visited
    sample = np.random.default_rng([seed, 3]).permutation(wanted.size)[: max(0, decisions - len(reached))]
    wanted.ravel()[sample] = True
    return graph, wanted, False, "every state found, and random transitions from them"
