"""Place a network like an earlier one: what is still there stays in its slot, unless that cannot be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import linear_sum_assignment

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.anneal import anneal
from mdlcad.placement.columns import choose_columns, question_of
from mdlcad.placement.costs import HARD
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.placement import Placement
from mdlcad.placement.placer import (
    MOVES_PER_MASS,
    SIDE_MOVES_PER_MASS,
    PlaceResult,
    Sides,
    placement_of,
    sides_of,
)
from mdlcad.placement.problem import Ints, Problem, build, realisable
from mdlcad.placement.state import State, start

PRICES = (1e6, 2 * HARD, HARD)
"""What moving a mass costs: none may, or only to mend two broken rules, or to mend one. (For less, masses would move
for shorter wires.)"""
SIDE_PRICE = HARD / 4
"""What it costs to serve a coupling, or to hang a bias leaf, on the other side."""
WARM, COOL = 8.0, 0.4
"""First and last temperature: warm enough to pass a broken rule on the way, and in the end too cool to leave home."""
SHORTEN = 0.8, 0.02
"""The same of a second annealing, which breaks no rule any more, but shortens carriers: the shorter, the stiffer."""
COLUMN_APART, ROW_APART, OTHER_COLUMN = 4.0, 1.0, 1000.0
"""How far a new mass counts as from its neighbours, for a column and for a row between them; and from its column."""


@dataclass(frozen=True, slots=True)
class Kept:
    """Where things were, under the names that they have now.

    Attributes:
        slots: (column, row) by mass.
        couplings: channel side (0 left, 1 right) by name, of couplings within a column.
        biases: side of the bias leaf (0 left, 1 right) by mass.
        changed: masses that are not what they were (other inputs, say): they stay only where nothing is in the way.
    """

    slots: Mapping[str, tuple[int, int]]
    couplings: Mapping[str, int]
    biases: Mapping[str, int]
    changed: frozenset[str] = frozenset()


def place_kept(
    network: Network, lattice: Lattice, rules: LayoutRules, kept: Kept, price: float, seed: int
) -> PlaceResult:
    """Place ``network`` with every kept mass in its slot, or elsewhere for ``price``. Same arguments, same result.

    At the first of ``PRICES`` only those move whose couplings do not reach from their column. Masses that have changed
    move for nothing, but return if no rule is broken by it.
    """
    problem = build(network, lattice, rules)
    home = _homes(network, lattice, rules, kept)
    at, stiff = home[: len(network.masses), 0].copy(), price == PRICES[0]
    firm = np.where(np.array([mass.name in kept.changed for mass in network.masses]), -1, at)
    whole = stiff and bool(np.all(firm >= 0))
    slot_of = at.copy() if whole else _seated(problem, at, _columns(problem, lattice, firm, stiff, seed))
    # who cannot reach its neighbours from its column has to leave it, whatever that costs
    there = problem.slot[slot_of, 0] == problem.slot[np.maximum(firm, 0), 0]
    held = home.copy()
    held[: len(at), 0] = np.where(there, firm, -1) if stiff else firm
    state, source = _held(problem, slot_of, held, price, seed)
    moves = 0 if whole else MOVES_PER_MASS * len(network.masses)  # if nobody is new there is nothing to look for
    cost = anneal(problem, state, source, moves, WARM, COOL, False)
    slots = state.mass[:, 0]
    if cost == 0 and not whole:
        shorter = _resumed(problem, state, held, price, seed)
        cost = anneal(problem, shorter[0], shorter[1], moves, SHORTEN[0], SHORTEN[1], False)
        slots = _sent_home(problem, shorter[0], home, firm) if cost == 0 else slots
    return PlaceResult(placement_of(network, lattice, slots, seed), float(cost))


def keep_sides(
    network: Network, placement: Placement, lattice: Lattice, rules: LayoutRules, kept: Kept, seed: int
) -> Sides:
    """Which channel serves every coupling and bias leaf, as before where that can be, of masses that stay in place."""
    problem = build(network, lattice, rules)
    index = {slot: i for i, slot in enumerate(lattice.slots)}
    where = {placed.mass: index[placed.column, placed.row] for placed in placement.masses}
    slot_of = np.array([where[mass.name] for mass in network.masses], np.int32)
    home = _homes(network, lattice, rules, kept)
    state, source = _held(problem, slot_of, home, 0.0, seed)
    cost = anneal(problem, state, source, 0, WARM, COOL, True)
    if cost > 0 or not _all_known(problem, state, home):
        state, source = _held(problem, slot_of, home, 0.0, seed)
        cost = anneal(problem, state, source, SIDE_MOVES_PER_MASS * len(network.masses), WARM, COOL, True)
    return sides_of(network, placement, rules, state, float(cost))


def _homes(network: Network, lattice: Lattice, rules: LayoutRules, kept: Kept) -> Ints:
    """``State.home`` for ``network`` on ``lattice``."""
    index = {slot: i for i, slot in enumerate(lattice.slots)}
    couplings = realisable(network, rules)
    home = np.full((max(len(network.masses), len(couplings)), 3), -1, np.int32)
    for row, mass in enumerate(network.masses):
        if mass.name in kept.slots:
            home[row, 0] = index.get(kept.slots[mass.name], -1)
        home[row, 1] = kept.biases.get(mass.name, -1)
    for row, number in enumerate(couplings):
        home[row, 2] = kept.couplings.get(network.couplings[number].name, -1)
    return home


def _held(problem: Problem, slot_of: Ints, home: Ints, price: float, seed: int) -> tuple[State, npt.NDArray[np.uint64]]:
    """A state that starts from ``slot_of`` with all sides at home."""
    state, source = start(problem, slot_of, seed)
    state.mass[:, 1] = np.maximum(home[: len(slot_of), 1], 0)
    state.side[:] = np.maximum(home[: len(problem.coupling), 2], 0)
    state.home[:] = home
    state.price[:] = price, SIDE_PRICE
    return state, source


def _resumed(
    problem: Problem, state: State, home: Ints, price: float, seed: int
) -> tuple[State, npt.NDArray[np.uint64]]:
    """A state that starts where ``state`` ended."""
    again, source = _held(problem, state.mass[:, 0].copy(), home, price, seed)
    again.mass[:, 1], again.side[:] = state.mass[:, 1], state.side
    return again, source


def _all_known(problem: Problem, state: State, home: Ints) -> bool:
    """Whether every side that there is to choose has a home."""
    column = problem.slot[state.mass[:, 0], 0]
    within = column[problem.coupling[:, 0]] == column[problem.coupling[:, 1]]
    sides = home[: len(problem.coupling), 2]
    biases = home[: len(state.mass), 1]
    biased = problem.mass[: len(state.mass), 3] == 1
    return bool(np.all(sides[within] >= 0) and np.all(biases[biased] >= 0))


def _sent_home(problem: Problem, state: State, home: Ints, firm: Ints) -> Ints:
    """(M,) the slots of a sound placement, with every mass home again that breaks no rule there: those that have not
    changed (``firm``, the slot of each or -1) before those that have."""
    slot_of, at = state.mass[:, 0].copy(), home[: len(state.mass), 0]
    again = True
    while again:
        again = False
        away = np.flatnonzero((at >= 0) & (slot_of != at)).tolist()
        for mass in sorted(away, key=lambda mass: int(firm[mass] < 0)):
            trial = slot_of.copy()
            trial[slot_of == at[mass]] = slot_of[mass]
            trial[mass] = at[mass]
            tried, source = _held(problem, trial, home, 0.0, 0)
            tried.mass[:, 1], tried.side[:] = state.mass[:, 1], state.side
            if anneal(problem, tried, source, 0, WARM, COOL, False) == 0:
                slot_of, again = trial, True
    return slot_of


def _columns(problem: Problem, lattice: Lattice, home: Ints, held: bool, seed: int) -> Ints | None:
    """(M,) a column for every mass, its home's where that can be; None if none were found.

    Args:
        held: to look first whether all homes can be kept.
    """
    homes = [int(problem.slot[slot, 0]) if slot >= 0 else -1 for slot in home.tolist()]
    question = question_of(problem, lattice)
    found = choose_columns(question, seed, homes, True) if held else None
    found = found or choose_columns(question, seed, homes)
    return None if found is None else np.array(found, np.int32)


def _seated(problem: Problem, home: Ints, columns: Ints | None) -> Ints:
    """(M,) a slot for every mass: its home if that is in its column, or of the free ones one near its neighbours.

    The others are seated in rounds, those with a seated neighbour first, each round by the least sum of distances.

    Args:
        columns: the column for every mass, None if any will do.
    """
    slot_of = home.copy()
    if columns is not None:
        there = problem.slot[np.maximum(home, 0), 0] == columns
        slot_of[~there] = -1
    links = problem.coupling[:, :2]
    while np.any(slot_of < 0):
        lost = [int(mass) for mass in np.flatnonzero(slot_of < 0)]
        friends = {mass: [int(b if a == mass else a) for a, b in links.tolist() if mass in (a, b)] for mass in lost}
        seated = {mass: [f for f in friends[mass] if slot_of[f] >= 0] for mass in lost}
        turn = [mass for mass in lost if seated[mass]] or lost
        taken = set(slot_of.tolist())
        free = [slot for slot in range(len(problem.slot)) if slot not in taken]
        far = np.zeros((len(turn), len(free)))
        for row, mass in enumerate(turn):
            for friend in seated[mass]:
                apart = np.abs(problem.slot[free] - problem.slot[slot_of[friend]])
                far[row] += COLUMN_APART * np.maximum(0, apart[:, 0] - 1) + ROW_APART * apart[:, 1]
            if columns is not None:
                far[row] += OTHER_COLUMN * (problem.slot[free, 0] != columns[mass])
        rows, places = linear_sum_assignment(far)
        for row, place in zip(rows.tolist(), places.tolist(), strict=True):
            slot_of[turn[row]] = free[place]
    return slot_of
