"""A start for networks too large for an exact choice of columns.

1. Masses are counted in levels by the least number of couplings from a mass with a port: a coupling then joins one
   level or two neighbouring ones.
2. Every level goes to one column, the next to the same column or a neighbour, so no coupling spans more than one. The
   path goes to and fro across a strip of columns, from one end of it to the other, and then on to the next strip.
3. Columns are annealed until no hub has more on a side than it holds (``crossings``).
4. Within its column a mass goes to the height of those it is coupled to, and into rows of the column's own parity where
   these suffice: two hubs of one row are what asks for an order of trunks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlcad.placement.chance import random_source
from mdlcad.placement.costs import HARD
from mdlcad.placement.crossings import settle_columns
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.problem import Floats, Ints, Problem

STRIP, SQUAT = 4, 22
"""Least columns of a strip, about, and how many rows there are to each: where a narrow strip is tall, it turns often,
and there trunks are long."""
SETTLE, SETTLE_HOT, SETTLE_COLD = 1000, 10.0, 0.5
"""Moves a mass of the annealing of columns, and its heats."""
CELL, CROWDED = 12, 1.15
"""Rows of a cell; how much fuller than the average cell one may be."""
MEND_ROUNDS, MEND_EACH, MEND, MEND_HOT, MEND_REACH = 30, 5, 300, (6.0, 10.0), (2, 3, 4, 5, 6)
"""Times that masses around a hub that holds too much are annealed again, and how many more for each such hub; moves a
mass; first heats; how many couplings away they may be, one time after the other."""
TOGETHER = 5
"""The first so many times, all such hubs at once."""
REST = 4
"""About how many levels move on until two share a column: where all do, a mass has hardly any choice of columns. They
do so where the strip has room, after at least half and at most twice as many."""
_SWEEPS = 12


@dataclass(frozen=True, slots=True)
class Start:
    """A slot for every mass, the channel side of every coupling, the side of every bias leaf."""

    slot: Ints
    side: Ints
    bias: Ints


def start_by_levels(problem: Problem, lattice: Lattice, seed: int) -> Start:
    """Slots and sides that break few rules or none, but for tracks."""
    masses = len(problem.mass) - 1
    beside = _neighbours(problem, masses)
    levels = _levels(problem, beside, masses)
    path = _path([len(level) for level in levels], lattice)
    column, order = np.zeros(masses, np.int32), np.zeros(masses)
    for rank, (level, (at, down)) in enumerate(zip(levels, path, strict=True)):
        column[level], order[level] = at, -rank if down else rank
    column = _fitted(column, lattice)
    height = _heights(_stand(column, order, beside, lattice), lattice)
    cell = (height // CELL).astype(np.int32)
    room = np.zeros((len(lattice.column_x), int(np.max(cell)) + 1))
    for at, row in lattice.slots:
        room[at, min(row // CELL, room.shape[1] - 1)] += CROWDED * masses / len(lattice.slots)
    side, bias = np.zeros(len(problem.coupling), np.int32), np.zeros(masses, np.int32)
    _settle(problem, lattice, beside, (column, side, bias), cell, room, seed)
    return Start(_stand(column, height, beside, lattice), side, bias)


def _settle(
    problem: Problem,
    lattice: Lattice,
    beside: list[list[int]],
    chosen: tuple[Ints, Ints, Ints],
    cell: Ints,
    room: Floats,
    seed: int,
) -> None:
    """Anneal columns and sides (of couplings and leaves), then those around hubs that hold too much, in place."""
    masses = len(chosen[0])
    into = np.argsort(problem.coupling[:, 1], kind="stable").astype(np.int32)
    slots = np.bincount([at for at, _ in lattice.slots], minlength=len(lattice.column_x)).astype(np.int32)
    source, hub = random_source(seed), np.zeros(masses)

    def settle(among: Ints, exact: bool, moves: int, hot: float) -> float:
        moves *= len(among)
        return float(
            settle_columns(
                problem, into, *chosen, cell, room, slots, among, exact, hub, source, moves, hot, SETTLE_COLD
            )
        )

    all_masses = np.arange(masses, dtype=np.int32)
    settle(all_masses, False, SETTLE, SETTLE_HOT)
    cost = settle(all_masses, True, 0, SETTLE_HOT)
    wrong = np.flatnonzero(hub >= HARD).tolist()
    for turn in range(MEND_ROUNDS + MEND_EACH * len(wrong)):
        if not wrong:
            return
        near = set(wrong if turn < TOGETHER else wrong[turn % len(wrong) :][:1])
        for _ in range(MEND_REACH[turn % len(MEND_REACH)]):
            near |= {other for mass in near for other in beside[mass]}
        held: tuple[Ints | Floats, ...] = (*chosen, hub)
        before = [array.copy() for array in held]
        after = settle(np.array(sorted(near), np.int32), True, MEND, MEND_HOT[turn % len(MEND_HOT)])
        left = np.flatnonzero(hub >= HARD).tolist()
        if (len(left), after) > (len(wrong), cost):
            for array, old in zip(held, before, strict=True):
                np.copyto(array, old)
        else:
            wrong, cost = left, after


def _neighbours(problem: Problem, masses: int) -> list[list[int]]:
    beside: list[list[int]] = [[] for _ in range(masses)]
    for source, target, *_ in problem.coupling.tolist():
        beside[source].append(target)
        beside[target].append(source)
    return beside


def _levels(problem: Problem, beside: list[list[int]], masses: int) -> list[list[int]]:
    """Masses by distance from the ports; what hangs together without a port follows, from its first mass on."""
    reached = [False] * masses
    levels: list[list[int]] = []
    roots = sorted({int(tab[3]) for tab in problem.tab})
    for first in [roots, *([mass] for mass in range(masses))]:
        level = [mass for mass in first if not reached[mass]]
        while level:
            for mass in level:
                reached[mass] = True
            levels.append(level)
            ahead = sorted({other for mass in level for other in beside[mass]})
            level = [mass for mass in ahead if not reached[mass]]
    return levels


def _path(sizes: list[int], lattice: Lattice) -> list[tuple[int, bool]]:
    """By level, its column and whether its strip is filled from the top down. Outermost columns count half."""
    room = np.bincount([column for column, _ in lattice.slots], minlength=len(lattice.column_x)).astype(float)
    room[0] /= 2
    room[-1] /= 2
    share = sum(sizes) / np.sum(room)
    strips = max(1, round(len(room) / max(STRIP, len(lattice.row_y) / SQUAT)))
    ends = [round(len(room) * i / strips) for i in range(strips + 1)]
    used = np.zeros(len(room))
    path: list[tuple[int, bool]] = []
    at, strip, ahead, moved = 0, 0, 1, 0
    for rank, size in enumerate(sizes):
        low, high = ends[strip], ends[strip + 1] - 1
        if (
            rank
            and strip + 1 < strips
            and np.sum(room[low : high + 1] * share - used[low : high + 1]) <= sum(sizes[rank : rank + high - at])
        ):
            # the strip's last levels lead over to the next one
            at += 1
            strip += int(at > high)
        elif rank:
            onward = low <= at + ahead <= high
            roomy = used[at] / max(room[at], 0.5) <= np.mean(used[low : high + 1]) / np.mean(room[low : high + 1])
            due = moved >= 2 * REST or (moved >= REST / 2 and roomy) if onward else moved > 0 and roomy
            step = 0 if due else ahead if onward else -ahead
            ahead = step or ahead
            at = min(max(at + step, low), high)
            moved = moved + 1 if step else 0
        used[at] += size
        path.append((at, strip % 2 == 1))
    return path


def _fitted(column: Ints, lattice: Lattice) -> Ints:
    """``column``, with what a column has no slots for in the nearest that has."""
    free = np.bincount([at for at, _ in lattice.slots], minlength=len(lattice.column_x))
    fitted = column.copy()
    for mass, at in enumerate(column.tolist()):
        near = np.abs(np.arange(len(free)) - at) + np.where(free > 0, 0, len(free))
        fitted[mass] = int(np.argmin(near))
        free[fitted[mass]] -= 1
    return fitted


def _heights(slot: Ints, lattice: Lattice) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    return np.array([float(lattice.slots[index][1]) for index in slot.tolist()])


def _stand(
    column: Ints, order: np.ndarray[tuple[int], np.dtype[np.float64]], beside: list[list[int]], lattice: Lattice
) -> Ints:
    """A slot for every mass: each column first in ``order``, then by mean neighbours, spread over its slots."""
    slots: list[list[int]] = [[] for _ in lattice.column_x]
    for index, (at, _) in sorted(enumerate(lattice.slots), key=lambda item: item[1]):
        slots[at].append(index)
    members: list[list[int]] = [[] for _ in lattice.column_x]
    for mass, at in enumerate(column.tolist()):
        members[at].append(mass)
    for at, free in enumerate(slots):
        own = [slot for slot in free if lattice.slots[slot][1] % 2 == at % 2]
        slots[at] = own if len(own) >= len(members[at]) else free
    height, slot = order.astype(float), np.zeros(len(column), np.int32)
    for sweep in range(_SWEEPS):
        for at in range(len(members)) if sweep % 2 == 0 else reversed(range(len(members))):
            wish = {
                mass: float(np.mean(height[beside[mass]])) if sweep and beside[mass] else float(height[mass])
                for mass in members[at]
            }
            members[at].sort(key=lambda mass: (wish[mass], mass))
            free, count = slots[at], len(members[at])
            for k, mass in enumerate(members[at]):
                slot[mass] = free[(2 * k + 1) * len(free) // (2 * count)]
                height[mass] = lattice.slots[int(slot[mass])][1]
    return slot
