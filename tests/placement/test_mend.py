"""Mending in several spots at once."""

import threading

import numpy as np
import pytest

from mdlcad.placement import mend as mending
from mdlcad.placement.anneal import anneal, trouble
from mdlcad.placement.costs import SLOT
from mdlcad.placement.large import careful
from mdlcad.placement.lattice import Lattice, lattices, place_ports
from mdlcad.placement.levels import Start, start_by_levels
from mdlcad.placement.mend import APART, mend
from mdlcad.placement.problem import Problem, build
from mdlcad.placement.state import State
from tests.placement.networks import MAZE_PORTS, SQUARE, maze, pom_rules
from tests.placement.tiles import tiled

LARGE = tiled(maze(), 12, 0.1, 1, 1)
SCALE = 28.0


@pytest.fixture(scope="module")
def lattice() -> Lattice:
    ports = place_ports(LARGE, MAZE_PORTS, SCALE)
    return max(lattices(SQUARE, ports, pom_rules(LARGE), SCALE, len(LARGE.masses)), key=lambda it: len(it.column_x))


@pytest.fixture(scope="module")
def problem(lattice: Lattice) -> Problem:
    return build(LARGE, lattice, pom_rules(LARGE))


@pytest.fixture(scope="module")
def begun(problem: Problem, lattice: Lattice) -> Start:
    return start_by_levels(problem, lattice, 1)


def fresh(problem: Problem, begun: Start) -> tuple[State, np.ndarray, float]:
    state, source = careful(problem, begun.slot, begun.columns.side, begun.columns.bias, 1)
    return state, source, anneal(problem, state, source, 0, 1.0, 1.0, False)


def test_the_same_for_any_number_of_threads(problem: Problem, begun: Start, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mending, "EACH", 0)
    results = []
    for workers in (1, 2):
        state, source, cost = fresh(problem, begun)
        left = mend(problem, state, source, cost, False, together=2, workers=workers)
        assert left < cost
        # counted afresh: changes of both spots add up to what they cost together
        assert left == pytest.approx(anneal(problem, state, source, 0, 1.0, 1.0, False), abs=1e-6)
        assert np.array_equal(state.mass_at[state.mass[:, SLOT]], np.arange(len(state.mass)))
        assert np.count_nonzero(state.mass_at >= 0) == len(state.mass)
        results.append((left, state.mass.tobytes(), state.side.tobytes()))
    assert results[0] == results[1]


def test_spots_annealed_at_once_lie_apart(problem: Problem, begun: Start) -> None:
    state, *_ = fresh(problem, begun)
    spots = trouble(problem, state)
    assert np.ptp(spots[:, 0]) >= APART, "this network is to have trouble on both sides"
    for first in range(len(spots)):
        taken = mending._apart(spots, first, 2)
        assert taken[0] == first
        assert len(taken) < 2 or abs(spots[taken[0], 0] - spots[taken[1], 0]) >= APART
    near = spots[np.abs(spots[:, 0] - spots[0, 0]) < APART]
    assert mending._apart(near, 0, 2) == [0]


def test_what_touches_one_channel_is_not_put_together(
    problem: Problem, begun: Start, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mending, "APART", 0)
    monkeypatch.setattr(mending, "IDLE", 10)
    monkeypatch.setattr(mending, "EACH", 0)
    state, source, cost = fresh(problem, begun)
    left = mend(problem, state, source, cost, False, together=3, workers=1)
    assert left == pytest.approx(anneal(problem, state, source, 0, 1.0, 1.0, False), abs=1e-6)
    assert np.array_equal(state.mass_at[state.mass[:, SLOT]], np.arange(len(state.mass)))


def test_given_up_it_changes_nothing(problem: Problem, begun: Start) -> None:
    state, source, cost = fresh(problem, begun)
    before = state.mass.copy()
    given_up = threading.Event()
    given_up.set()
    assert mend(problem, state, source, cost, False, given_up) == cost
    assert np.array_equal(state.mass, before)


def test_a_mass_in_the_way_of_a_tab_is_a_spot_to_mend(problem: Problem, begun: Start) -> None:
    state, source, _ = fresh(problem, begun)
    mend(problem, state, source, anneal(problem, state, source, 0, 1.0, 1.0, False), False)
    before = {tuple(spot) for spot in trouble(problem, state).tolist()}
    tab, column, row = next(
        (tab, int(way[1]), row)
        for tab, mass in enumerate(problem.tab[:, 3])
        for way in (problem.way[tab, problem.slot[state.mass[mass, SLOT], 0]],)
        if way[0] >= 0 and way[1] <= way[2]
        for row in range(problem.tab[tab, 0], problem.tab[tab, 1] + 1)
        if problem.slot_at[way[1], row] >= 0
    )
    slot = problem.slot_at[column, row]
    assert state.mass_at[slot] < 0, "the way is free so far"
    other = int(np.flatnonzero(problem.slot[state.mass[:, SLOT], 0] == column)[0])
    state.mass_at[state.mass[other, SLOT]] = -1
    state.mass[other, SLOT], state.mass_at[slot] = slot, other
    assert (column, row, row) in {tuple(spot) for spot in trouble(problem, state).tolist()} - before, tab
    cost = anneal(problem, state, source, 0, 1.0, 1.0, False)
    mend(problem, state, source, cost, False)
    assert state.mass_at[slot] < 0, "it has made way"
