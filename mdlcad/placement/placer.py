"""Place a network on a lattice: who sits in which slot."""

from __future__ import annotations

import random
from dataclasses import dataclass

import numpy as np

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.anneal import anneal
from mdlcad.placement.columns import Answers, question_of
from mdlcad.placement.large import place_large
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.mend import mend
from mdlcad.placement.placement import PlacedMass, Placement
from mdlcad.placement.problem import Ints, Problem, build, realisable
from mdlcad.placement.state import State, start

MOVES_PER_MASS = 8000
SIDE_MOVES_PER_MASS = 2000
HOT, COLD = 8.0, 0.5
LARGE = 100
"""Networks of more masses are placed by ``large``; LARGE_SIDE_MOVES a mass choose their sides."""
LARGE_SIDE_MOVES = 200


@dataclass(frozen=True, slots=True)
class Sides:
    """Side (0 left, 1 right channel of the source's column) of every realisable coupling, by name, and the side of
    every bias leaf (0 left, 1 right of its hub), by mass."""

    couplings: dict[str, int]
    biases: dict[str, int]
    cost: float


@dataclass(frozen=True, slots=True)
class PlaceResult:
    """A placement, and the cost of the rules that it is known to break (0: legal tracks exist).

    Attributes:
        sides: those that it was found with, which routing need not choose anew; None if it is to choose them.
    """

    placement: Placement
    cost: float
    sides: Sides | None = None


def place(
    network: Network,
    lattice: Lattice,
    rules: LayoutRules,
    seed: int,
    moves_per_mass: int = MOVES_PER_MASS,
    columns: Answers | None = None,
    workers: int = 1,
) -> PlaceResult:
    """Anneal ``network`` onto ``lattice``, which must have a slot for every mass. Same arguments, same result.

    Args:
        columns: those chosen so far, in a search that places many times.
        workers: starts of a large network that are tried at once; the result is the same for any number.
    """
    problem = build(network, lattice, rules)
    if len(network.masses) > LARGE:
        state, cost = place_large(problem, lattice, seed, moves_per_mass, workers)
        placement = placement_of(network, lattice, state.mass[:, 0], seed)
        return PlaceResult(placement, cost, sides_of(network, placement, rules, state, cost))
    slots = _start(problem, lattice, len(network.masses), seed, columns or Answers())
    state, source = start(problem, np.array(slots, np.int32), seed)
    cost = anneal(problem, state, source, moves_per_mass * len(network.masses), HOT, COLD, False)
    return PlaceResult(placement_of(network, lattice, state.mass[:, 0], seed), float(cost))


def placement_of(network: Network, lattice: Lattice, slot_of: Ints, seed: int) -> Placement:
    """The artefact for ``slot_of``, (M,) the slot of every mass."""
    masses = []
    for mass, slot in zip(network.masses, slot_of.tolist(), strict=True):
        column, row = lattice.slots[slot]
        masses.append(PlacedMass(mass.name, column, row, lattice.column_x[column], lattice.row_y[row]))
    return Placement(
        boundary=lattice.boundary,
        mm_per_grid=lattice.mm_per_grid,
        column_x=lattice.column_x,
        row_y=lattice.row_y,
        slots=lattice.slots,
        masses=tuple(masses),
        ports=lattice.ports,
        seed=seed,
    )


def _start(problem: Problem, lattice: Lattice, masses: int, seed: int, answers: Answers) -> list[int]:
    """A slot for every mass: any of the column chosen for it, or any at all if no columns were found."""
    slots = list(range(len(lattice.slots)))
    random.Random(seed).shuffle(slots)
    columns = answers.choose(question_of(problem, lattice), seed)
    if columns is None:
        return slots[:masses]
    free: dict[int, list[int]] = {}
    for slot in slots:
        free.setdefault(lattice.slots[slot][0], []).append(slot)
    return [free[column].pop() for column in columns]


def choose_sides(network: Network, placement: Placement, lattice: Lattice, rules: LayoutRules, seed: int) -> Sides:
    """Which channel serves every coupling and bias leaf, for masses that stay where they are."""
    problem = build(network, lattice, rules)
    index = {slot: i for i, slot in enumerate(lattice.slots)}
    where = {placed.mass: index[placed.column, placed.row] for placed in placement.masses}
    slots, masses = np.array([where[mass.name] for mass in network.masses], np.int32), len(network.masses)
    state, source = start(problem, slots, seed)
    if masses > LARGE:
        state.careful[0] = 1.0
    moves = LARGE_SIDE_MOVES if masses > LARGE else SIDE_MOVES_PER_MASS
    cost = anneal(problem, state, source, moves * masses, HOT, COLD, True)
    if masses > LARGE:
        cost = mend(problem, state, source, cost, True)
    return sides_of(network, placement, rules, state, float(cost))


def sides_of(network: Network, placement: Placement, rules: LayoutRules, state: State, cost: float) -> Sides:
    """The sides that ``state`` has settled on."""
    columns = {placed.mass: placed.column for placed in placement.masses}
    couplings = {}
    for i, j in enumerate(realisable(network, rules)):
        coupling = network.couplings[j]
        across = columns[coupling.target] - columns[coupling.source]
        couplings[coupling.name] = int(state.side[i]) if across == 0 else int(across > 0)
    biases = {mass.name: int(state.mass[i, 1]) for i, mass in enumerate(network.masses) if mass.name in rules.biases}
    return Sides(couplings, biases, cost)
