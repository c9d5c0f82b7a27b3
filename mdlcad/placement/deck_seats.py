"""Place one deck of two: the slots of some of its masses come from the other deck, the rest is annealed around them."""

from __future__ import annotations

import random
from collections.abc import Container, Mapping

import numpy as np

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.anneal import anneal
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.placer import COLD, HOT, PlaceResult, placement_of
from mdlcad.placement.problem import Ints, build
from mdlcad.placement.state import COLUMN, start

Slot = tuple[int, int]
"""(column, row)."""


def place_deck(
    network: Network,
    lattice: Lattice,
    rules: LayoutRules,
    columns: Mapping[str, int],
    held: Container[str],
    wanted: Mapping[str, Slot],
    price: float,
    seed: int,
    moves_per_mass: int,
) -> PlaceResult | None:
    """Anneal a deck; None if a wanted slot is not one of the lattice's. Same arguments, same result.

    Args:
        columns: where to start, by mass. held: masses that pay ``price`` to leave their column.
        wanted: slots that masses shall have, or pay ``price`` for another.
    """
    index = {slot: number for number, slot in enumerate(lattice.slots)}
    if any(slot not in index for slot in wanted.values()):
        return None
    home = np.full(len(network.masses), -1, np.int32)
    for row, mass in enumerate(network.masses):
        if mass.name in wanted:
            home[row] = index[wanted[mass.name]]
    seats = _seats(network, lattice, columns, home, seed)
    if seats is None:
        return None
    problem = build(network, lattice, rules)
    state, source = start(problem, seats, seed)
    for row, mass in enumerate(network.masses):
        if home[row] < 0 and mass.name in held:
            home[row] = COLUMN - columns[mass.name]
    state.home[: len(home), 0] = home
    state.price[:] = price, 0.0
    cost = anneal(problem, state, source, moves_per_mass * len(network.masses), HOT, COLD, False)
    return PlaceResult(placement_of(network, lattice, state.mass[:, 0], seed), float(cost))


def _seats(network: Network, lattice: Lattice, columns: Mapping[str, int], home: Ints, seed: int) -> Ints | None:
    """(M,) a slot for every mass: its home, else any free one of its column; None if the column has none left."""
    taken = set(home.tolist())
    free: dict[int, list[int]] = {}
    slots = [slot for slot in range(len(lattice.slots)) if slot not in taken]
    random.Random(seed).shuffle(slots)
    for slot in slots:
        free.setdefault(lattice.slots[slot][0], []).append(slot)
    seats = home.copy()
    for row, mass in enumerate(network.masses):
        if seats[row] < 0:
            room = free.get(columns[mass.name], [])
            if not room:
                return None
            seats[row] = room.pop()
    return seats
