"""Placement of networks too large to be annealed from a random start.

The start (``levels``) is nearly legal, so what follows is warm, not hot: sides alone; slots, with the trunks of a
channel packed in bands of rows; slots again with whole channels packed, which is what a channel's tracks really are,
half of the moves on masses that broken rules are about; and then only those, until no rule is broken.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from mdlcad.placement.anneal import anneal
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.levels import slots_by_levels
from mdlcad.placement.problem import Problem
from mdlcad.placement.state import State, start

BAND = 24
"""Most rows whose trunks are packed together at first, so that a move costs no more in a large device; what is legal in
every band need not be so in all."""
COLD = 0.2
SIDE_MOVES, SIDE_HOT = 100, 8.0
BAND_MOVES, BAND_HOT, BAND_FOCUS = 300, 0.7, 0.5
WHOLE_MOVES, WHOLE_HOT, WHOLE_FOCUS = 80, 0.7, 0.8
"""Moves a mass, first heat, and share of the moves that are on troubled masses."""
MEND_MOVES, MEND_HEATS = 30_000, (4.0, 2.0, 8.0) * 6
"""Moves of a round on troubled masses alone, and the first heat of every round."""


def place_large(problem: Problem, lattice: Lattice, seed: int, moves_per_mass: int) -> tuple[State, float]:
    """A state with few broken rules or none, and their cost. Same arguments, same result."""
    masses = len(problem.mass) - 1
    state, source = start(problem, slots_by_levels(problem, lattice, seed), seed, BAND)
    anneal(problem, state, source, SIDE_MOVES * masses, SIDE_HOT, COLD, True)
    moves = min(moves_per_mass, BAND_MOVES) * masses
    anneal(problem, state, source, moves, BAND_HOT, COLD, False, BAND_FOCUS)
    state = _whole(problem, state, seed)
    moves = min(moves_per_mass, WHOLE_MOVES) * masses
    cost = anneal(problem, state, source, moves, WHOLE_HOT, COLD, False, WHOLE_FOCUS)
    return state, mend(problem, state, source, cost, False)


def mend(problem: Problem, state: State, source: npt.NDArray[np.uint64], cost: float, fixed: bool) -> float:
    """Anneal masses in trouble alone, round by round, keeping what is no worse; ``fixed`` keeps the slots. The cost."""
    for heat in MEND_HEATS:
        if cost < 1e-6:
            break
        before = [array.copy() for array in (state.mass, state.mass_at, state.side)]
        after = anneal(problem, state, source, MEND_MOVES, heat, COLD, fixed, 1.0)
        if after > cost:
            for array, old in zip((state.mass, state.mass_at, state.side), before, strict=True):
                array[:] = old
        else:
            cost = after
    return float(cost)


def _whole(problem: Problem, state: State, seed: int) -> State:
    """The same places and sides, with every channel packed as a whole."""
    whole, _ = start(problem, state.mass[:, 0].copy(), seed)
    whole.mass[:], whole.side[:], whole.price[:] = state.mass, state.side, state.price
    return whole
