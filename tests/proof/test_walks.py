"""Walks of the planner: legal, complete, balanced, and the same every time."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mdlcad.proof.itinerary import make_itinerary
from mdlcad.proof.machine import Graph, all_vectors, explore, history_graph, some_vectors
from mdlcad.proof.walks import plan
from tests.proof.devices import Machine


def made_of(table: np.ndarray, bits: int, inputs: int) -> Machine:
    """The machine whose next state number is table[state number, input number]; its output is the state."""

    def rule(states: np.ndarray, vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        s = states @ (1 << np.arange(bits))
        v = vectors @ (1 << np.arange(inputs)).astype(np.int64)
        after = (table[s, v][:, None] >> np.arange(bits)) & 1
        return after, states

    names = [tuple(f"{name}[{i}]" for i in range(size)) for name, size in (("I", inputs), ("O", bits), ("S", bits))]
    return Machine(names[0], names[1], names[2], np.zeros(bits, np.uint8), rule)


def taken(graph: Graph, walks: list[list[int]]) -> set[tuple[int, int]]:
    """All moves of the walks, each from power-up."""
    moves = set()
    for walk in walks:
        state = 0
        for step, vector in enumerate(walk):
            assert state >= 0 or step == len(walk)
            moves.add((state, vector))
            state = int(graph.following[state, vector])
    return moves


@settings(max_examples=30, deadline=None)
@given(st.integers(1, 5), st.integers(0, 3), st.integers(1, 9), st.integers(0, 1000))
def test_every_reachable_transition_is_walked(bits: int, inputs: int, lanes: int, seed: int) -> None:
    table = np.random.default_rng(seed).integers(0, 2**bits, (2**bits, 2**inputs))
    machine = made_of(table, bits, inputs)
    graph = explore(machine, seed)
    reachable, todo = {0}, [0]
    while todo:
        for after in table[todo.pop()]:
            if int(after) not in reachable:
                reachable.add(int(after))
                todo.append(int(after))
    assert graph.complete
    assert {int(s @ (1 << np.arange(bits))) for s in graph.states} == reachable
    walks = plan(graph, np.ones(graph.following.shape, dtype=bool), lanes, seed)
    assert len(taken(graph, walks)) == len(reachable) * 2**inputs
    assert walks == plan(graph, np.ones(graph.following.shape, dtype=bool), lanes, seed)

    plans = make_itinerary(machine, 100, seed)
    assert plans.exhaustive
    assert plans.total == len(reachable) * 2**inputs
    assert plans.total + plans.unreachable == 2 ** (bits + inputs)
    pairs = np.concatenate([plans.states[:-1], plans.inputs], axis=2).reshape(-1, bits + inputs)
    assert len(np.unique(pairs, axis=0)) == plans.total


def test_lanes_share_the_work() -> None:
    table = np.tile(np.arange(64), (64, 1))  # every state reaches every other in one move
    graph = explore(made_of(table, 6, 6), 0)
    walks = plan(graph, np.ones(graph.following.shape, dtype=bool), 32, 0)
    lengths = [len(walk) for walk in walks]
    assert len(lengths) == 32
    assert max(lengths) <= 1.1 * 64 * 64 / 32


def test_states_of_no_return_get_further_lanes() -> None:
    """Four ways down from power-up, none back: one lane cannot see them all."""
    table = np.array([[0, 1, 2, 3]] + [[i] * 4 for i in (1, 2, 3)])
    graph = explore(made_of(table, 2, 2), 0)
    walks = plan(graph, np.ones((4, 4), dtype=bool), 1, 0)
    assert len(walks) >= 3
    assert len(taken(graph, walks)) == 16


def test_what_cannot_be_reached_is_refused() -> None:
    graph = Graph(np.zeros((2, 1), np.uint8), all_vectors(0), np.array([[0], [1]]), np.full((2, 2), -1), True)
    with pytest.raises(ValueError, match="cannot be reached"):
        plan(graph, np.ones((2, 1), dtype=bool), 4, 0)


def test_history_covers_every_vector_after_every_other() -> None:
    graph = history_graph(all_vectors(3))
    walks = plan(graph, graph.following >= 0, 4, 0)
    after = {(a, b) for walk in walks for a, b in pairwise(walk)}
    assert after == {(a, b) for a in range(8) for b in range(8)}


def test_too_large_a_machine_is_explored_as_far_as_it_goes() -> None:
    """A 16-bit counter that counts while its first input is 1, with 9 inputs: cut at 4,096 states."""

    def rule(states: np.ndarray, inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        value = states @ (1 << np.arange(16)) + inputs[:, 0]
        return (value[:, None] >> np.arange(16)) & 1, states

    names = tuple(f"S[{i}]" for i in range(16))
    machine = Machine(tuple(f"I[{i}]" for i in range(9)), names, names, np.zeros(16, np.uint8), rule)
    graph = explore(machine, 0)
    assert not graph.complete
    assert len(graph.states) == 4096
    assert (graph.following == -1).any()


def wide(bits: int, inputs: int) -> Machine:
    """A register that takes its first inputs: every state can be reached, and there are too many transitions."""

    def rule(states: np.ndarray, vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return vectors[:, :bits].copy(), states

    names = [tuple(f"{name}[{i}]" for i in range(size)) for name, size in (("I", inputs), ("O", bits), ("S", bits))]
    return Machine(names[0], names[1], names[2], np.zeros(bits, np.uint8), rule)


@pytest.mark.parametrize(("bits", "inputs"), [(3, 13), (8, 9), (0, 16)])
def test_beyond_twelve_bits_twenty_thousand_transitions_and_every_state(bits: int, inputs: int) -> None:
    plans = make_itinerary(wide(bits, inputs), 20_000, 0)
    assert not plans.exhaustive
    assert plans.total == 2 ** (bits + inputs)
    pairs = np.concatenate([plans.states[:-1], plans.inputs], axis=2).reshape(-1, bits + inputs)
    assert len(np.unique(pairs, axis=0)) >= 20_000
    met = {state.tobytes() for state in plans.states.reshape(pairs.shape[0] + len(plans.inputs[0]), bits)}
    assert len(met) == plans.reachable_states == 2**bits


def test_twelve_bits_are_checked_in_full() -> None:
    plans = make_itinerary(wide(3, 9), 20_000, 0)
    assert plans.exhaustive and plans.total == 4096


def test_samples_hold_the_corners() -> None:
    vectors = {tuple(int(bit) for bit in row) for row in some_vectors(20, 100, 0)}
    assert {(0,) * 20, (1,) * 20, (1,) + (0,) * 19, (0,) + (1,) * 19} <= vectors
    assert 100 <= len(vectors) <= 142
