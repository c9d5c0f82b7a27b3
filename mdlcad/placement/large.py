"""Placement of networks too large to be annealed from a random start.

The start (``levels``) is nearly legal, so what follows is warm, not hot: slots, with the trunks of a channel packed in
bands of rows, half of the moves on masses that broken rules are about; and then, with whole channels packed, which is
what a channel's tracks really are, only those around one broken rule after the other, until none is.

Where there is room, units stand like the black squares of a chessboard: no row of a channel then has a hub on either
side, which is what asks most often for an order of trunks, and such orders make rings.
"""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from mdlcad.placement.anneal import HOME_SIDE, anneal
from mdlcad.placement.costs import BIAS_SIDE, SLOT
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.levels import start_by_levels
from mdlcad.placement.mend import mend
from mdlcad.placement.problem import Ints, Problem
from mdlcad.placement.repair import Columns, repair_all
from mdlcad.placement.state import COLUMN, State, start

BAND = 24
"""Most rows whose trunks are packed together at first, so that a move costs no more in a large device; what is legal in
every band need not be so in all."""
SQUARES = 0.85
"""Share of the black squares that may be taken; a network that needs more takes any slot."""
COLD = 0.2
ATTEMPTS, ATTEMPTED, FAR_SEED = 3, 6000, 1_000_003
"""Starts to try, about how many masses all of them may have, and how far their seeds are apart: not the next ones,
which the caller may try."""
BAND_MOVES, BAND_HOT, BAND_FOCUS = 800, 2.0, 0.5
"""Moves a mass, first heat, and share of the moves that are on troubled masses."""
HOLD = 1.0
"""What it costs at first to leave the columns and sides of the start, where no hub holds too much."""
LIGHT = 0.3
"""What a trunk without a track weighs at first beside a hub that holds too much: it is mended more easily."""
TOGETHER = 2
"""Spots that are mended at once where there is but one start."""
HANGS = 4
"""Times that what still hangs on hubs which hold too much is hung up anew, exactly."""


def place_large(
    problem: Problem, lattice: Lattice, seed: int, moves_per_mass: int, workers: int = 1
) -> tuple[State, float]:
    """A state with few broken rules or none, and their cost. Same arguments, same result, for any ``workers``.

    So many starts as there are ``workers`` are tried at once. The first without broken rules is taken, counted by its
    seed and not by when it is done, or the best. A network too large for more than one is mended in several spots at
    once instead.
    """
    given_up = threading.Event()
    best: tuple[State, float] | None = None
    starts = min(ATTEMPTS, -(-ATTEMPTED // len(problem.mass)))
    together = 1 if starts > 1 else TOGETHER
    with ThreadPoolExecutor(max(1, workers)) as pool:
        found = [
            pool.submit(_attempt, problem, lattice, seed + turn * FAR_SEED, moves_per_mass, given_up, together, workers)
            for turn in range(starts)
        ]
        try:
            for future in found:
                state, cost = future.result()
                if best is None or cost < best[1]:
                    best = state, cost
                if cost < 1e-6:
                    break
        finally:
            given_up.set()
            for future in found:
                future.cancel()
    assert best is not None
    return best


def _attempt(
    problem: Problem,
    lattice: Lattice,
    seed: int,
    moves_per_mass: int,
    given_up: threading.Event,
    together: int,
    workers: int,
) -> tuple[State, float]:
    masses = len(problem.mass) - 1
    squares = _squares(lattice, masses)
    part = _only(problem, squares)
    begun = start_by_levels(part, replace(lattice, slots=tuple(lattice.slots[slot] for slot in squares.tolist())), seed)
    state, source = careful(part, begun.slot, begun.columns.side, begun.columns.bias, seed, BAND)
    state.careful[0] = LIGHT
    _hold(part, state, HOLD)
    moves = 0 if given_up.is_set() else min(moves_per_mass, BAND_MOVES) * masses
    anneal(part, state, source, moves, BAND_HOT, COLD, False, BAND_FOCUS)
    state, _ = careful(part, state.mass[:, 0], state.side, state.mass[:, 1], seed)
    cost = float(anneal(part, state, source, 0, COLD, COLD, False))
    cost = mend(part, state, source, cost, False, given_up, together, workers)
    for turn in range(HANGS):
        if cost < 1e-6 or given_up.is_set() or not _hang_anew(part, state, seed + turn):
            break
        cost = float(anneal(part, state, source, 0, COLD, COLD, False))
        cost = mend(part, state, source, cost, False, given_up, together, workers)
    whole, source = careful(problem, squares[state.mass[:, 0]], state.side, state.mass[:, 1], seed)
    return whole, float(anneal(problem, whole, source, 0, COLD, COLD, False))


def careful(
    problem: Problem, slot: Ints, side: Ints, bias: Ints, seed: int, band: int | None = None
) -> tuple[State, npt.NDArray[np.uint64]]:
    """A state with those slots by mass, channel sides by coupling, leaf sides by mass, and a seeded random source."""
    state, source = start(problem, slot.copy(), seed, band)
    state.careful[0] = 1
    state.side[:], state.mass[:, 1] = side, bias
    return state, source


def _hang_anew(problem: Problem, state: State, seed: int) -> bool:
    """Mend hubs that hold too much by columns, where annealing cannot; whether any mass has moved.

    Masses go to the free slots of their new columns that are nearest to their rows.
    """
    column = problem.slot[state.mass[:, SLOT], 0].copy()
    columns = Columns.of(problem, column, state.side.copy(), state.mass[:, BIAS_SIDE].copy())
    repair_all(problem, columns, seed)
    moved = np.flatnonzero(columns.column != problem.slot[state.mass[:, SLOT], 0])
    rows = problem.slot[state.mass[moved, SLOT], 1]
    state.mass_at[state.mass[moved, SLOT]] = -1
    for mass, row in zip(moved.tolist(), rows.tolist(), strict=True):
        at = problem.slot_at[columns.column[mass]]
        free = [int(slot) for slot in at[at >= 0] if state.mass_at[slot] < 0]
        slot = min(free, key=lambda slot: (abs(int(problem.slot[slot, 1]) - row), slot))
        state.mass[mass, SLOT], state.mass_at[slot] = slot, mass
    state.side[:], state.mass[:, BIAS_SIDE] = columns.side, columns.bias
    return bool(len(moved))


def _hold(problem: Problem, state: State, price: float) -> None:
    """Let it cost ``price`` to leave the columns and sides that masses, couplings and leaves have now."""
    masses, couplings = len(state.mass), len(state.side)
    state.home[:masses, SLOT] = COLUMN - problem.slot[state.mass[:, SLOT], 0]
    state.home[:masses, BIAS_SIDE] = state.mass[:, BIAS_SIDE]
    state.home[:couplings, HOME_SIDE] = state.side
    state.price[:] = price


def _squares(lattice: Lattice, masses: int) -> Ints:
    """The slots to use: those of a chessboard's black squares, or all if these are too few."""
    black = [index for index, (column, row) in enumerate(lattice.slots) if (column + row) % 2 == 0]
    return np.array(black if masses <= SQUARES * len(black) else range(len(lattice.slots)), np.int32)


def _only(problem: Problem, slots: Ints) -> Problem:
    """The problem with no other slots than ``slots``."""
    slot_at = np.full_like(problem.slot_at, -1)
    for index, (column, row) in enumerate(problem.slot[slots].tolist()):
        slot_at[column, row] = index
    return problem._replace(slot=problem.slot[slots], slot_at=slot_at)
