"""A start for networks too large for an exact choice of columns.

1. Masses are counted in levels by the least number of couplings from a mass with a port: a coupling then joins one
   level or two neighbouring ones.
2. Every level goes to one column, the next to the same column or a neighbour, so no coupling spans more than one. The
   path goes to and fro across a strip of columns, from one end of it to the other, and then on to the next strip.
3. Columns are annealed until hardly any hub has more on a side than it holds (``crossings``), and the last are mended
   exactly (``repair``).
4. Within its column a mass goes to the height of those it is coupled to, and into rows of the column's own parity where
   these suffice: two hubs of one row are what asks for an order of trunks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlcad.placement.chance import random_source
from mdlcad.placement.crossings import settle_columns
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.problem import Floats, Ints, Problem
from mdlcad.placement.repair import Columns, repair_all

STRIP, SQUAT = 4, 22
"""Least columns of a strip, about, and how many rows there are to each: where a narrow strip is tall, it turns often,
and there trunks are long."""
SETTLE, SETTLE_HOT, SETTLE_COLD = 500, 10.0, 0.5
"""Moves a mass of the annealing of columns, and its heats."""
CELL, CROWDED = 12, 1.15
"""Rows of a cell; how much fuller than the average cell one may be."""
REST = 4
"""About how many levels move on until two share a column: where all do, a mass has hardly any choice of columns. They
do so where the strip has room, after at least half and at most twice as many."""
_SWEEPS = 12


@dataclass(frozen=True, slots=True)
class Start:
    """(M,) a slot for every mass, and the columns and sides that it was chosen for."""

    slot: Ints
    columns: Columns


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
    columns = Columns.of(problem, column, np.zeros(len(problem.coupling), np.int32), np.zeros(masses, np.int32))
    _settle(problem, columns, cell, room, seed)
    return Start(_stand(columns.column, height, beside, lattice), columns)


def _settle(
    problem: Problem,
    columns: Columns,
    cell: Ints,
    room: Floats,
    seed: int,
) -> None:
    """Anneal columns and sides (of couplings and leaves), then mend those around hubs that hold too much, in place."""
    moves = SETTLE * len(columns.column)
    source = random_source(seed)
    chosen = (columns.column, columns.side, columns.bias)
    settle_columns(problem, columns.into, *chosen, cell, room, columns.slots, source, moves, SETTLE_HOT, SETTLE_COLD)
    repair_all(problem, columns, seed)


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
