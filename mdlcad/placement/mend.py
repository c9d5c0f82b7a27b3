"""Mending a placement spot by spot: annealing only what is around one broken rule after the other.

Spots far apart have nothing to do with each other, so two of them may be annealed at once, each on a state of its own;
what both have come to is put together. Which spots go together does not hang on how many threads there are.
"""

from __future__ import annotations

import copy
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from mdlcad.placement.anneal import anneal, trouble
from mdlcad.placement.chance import random_source
from mdlcad.placement.costs import SLOT
from mdlcad.placement.problem import Ints, Problem
from mdlcad.placement.state import State

IDLE, EACH = 40, 20
"""Rounds on the masses of one troubled spot alone without any gain, and how many more for each spot that there is."""
MOVES, HEATS, COLD = 4_000, (1.0, 2.0, 4.0), 0.2
"""Moves of a round, first heats, one after the other, and last heat."""
LONGER = 4
"""How much longer a round is on what every heat has been tried on in vain."""
APART = 12
"""Channels between two spots that are annealed at once: masses move by a column or two, their nets a column more."""


def mend(
    problem: Problem,
    state: State,
    source: npt.NDArray[np.uint64],
    cost: float,
    fixed: bool,
    given_up: threading.Event | None = None,
    together: int = 1,
    workers: int = 1,
) -> float:
    """Anneal one troubled spot after the other, keeping what is no worse; ``fixed`` keeps the slots. The cost.

    Args:
        given_up: ends it at once when set: then nobody wants the result any more.
        together: spots far apart that are annealed at once. workers: threads to do it, which change no result.
    """
    given_up = given_up or threading.Event()
    benches = [(state, source)]
    for k in range(1, together):
        benches.append((copy.deepcopy(state), random_source(int(source[0] >> np.uint64(1)) + k)))
    spots = trouble(problem, state)
    turn, at, idle = 0, 0, 0
    with ThreadPoolExecutor(max(1, min(workers, together))) as pool:
        # what no spot is to blame for is couplings that reach too far
        while cost > 1e-6 and len(spots) and idle < IDLE + EACH * len(spots) and not given_up.is_set():
            before = _Chosen.of(state)
            taken = _apart(spots, at % len(spots), together)
            heat = HEATS[turn % len(HEATS)]
            moves = MOVES if idle < len(HEATS) * len(spots) else LONGER * MOVES
            tries = [
                pool.submit(_try, problem, before, *bench, moves, heat, fixed, spots[spot])
                for bench, spot in zip(benches, taken, strict=False)
            ]
            found = [future.result() for future in tries]
            before.write(state)
            touched, old = np.zeros(len(problem.limits), bool), cost
            for change, after in found:
                channels = change.channels(problem, before)
                if after <= old and not np.any(touched & channels):
                    change.merge(state, before)
                    touched |= channels
                    cost += after - old
            turn, at, idle = turn + 1, at + 1, idle + len(taken)
            if cost < old:
                here = tuple(spots[taken[0]].tolist())
                idle = 0
                spots = trouble(problem, state)
                at = next((i for i, spot in enumerate(spots.tolist()) if tuple(spot) > here), 0)
    return cost


def _try(
    problem: Problem,
    before: _Chosen,
    state: State,
    source: npt.NDArray[np.uint64],
    moves: int,
    heat: float,
    fixed: bool,
    spot: Ints,
) -> tuple[_Chosen, float]:
    """What annealing one spot comes to, and its cost."""
    before.write(state)
    cost = anneal(problem, state, source, moves, heat, COLD, fixed, 1.0, spot)
    return _Chosen.of(state), cost


def _apart(spots: Ints, first: int, count: int) -> list[int]:
    """``first`` and up to ``count`` - 1 further spots ``APART`` channels or more from it and each other."""
    taken = [first]
    for k in range(1, count):
        begin = first + k * len(spots) // count
        for i in range(len(spots)):
            spot = (begin + i) % len(spots)
            if all(abs(int(spots[spot, 0]) - int(spots[other, 0])) >= APART for other in taken):
                taken.append(spot)
                break
    return taken


@dataclass(frozen=True, slots=True)
class _Chosen:
    """All that annealing chooses of a state: its ``mass``, ``mass_at`` and ``side``."""

    mass: Ints
    mass_at: Ints
    side: Ints

    @staticmethod
    def of(state: State) -> _Chosen:
        return _Chosen(state.mass.copy(), state.mass_at.copy(), state.side.copy())

    def write(self, state: State) -> None:
        """Make it what ``state`` has chosen."""
        state.mass[:], state.mass_at[:], state.side[:] = self.mass, self.mass_at, self.side

    def merge(self, state: State, before: _Chosen) -> None:
        """Make what has changed since ``before`` what ``state`` has chosen."""
        for array, own, old in (
            (state.mass, self.mass, before.mass),
            (state.mass_at, self.mass_at, before.mass_at),
            (state.side, self.side, before.side),
        ):
            array[own != old] = own[own != old]

    def channels(self, problem: Problem, before: _Chosen) -> npt.NDArray[np.bool_]:
        """(C,) the channels in which nets or leaves lie that have changed since ``before``."""
        moved = np.any(self.mass != before.mass, axis=1)
        nets = moved.copy()
        nets[problem.coupling[moved[problem.coupling[:, 1]], 0]] = True
        nets[problem.coupling[self.side != before.side, 0]] = True
        touched = np.zeros(len(problem.limits), bool)
        for chosen in (before, self):
            columns = problem.slot[chosen.mass[nets, SLOT], 0]
            touched[columns] = touched[columns + 1] = True
        return touched
