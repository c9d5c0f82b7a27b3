"""A start for networks too large for an exact choice of columns.

1. Masses are counted in levels by the least number of couplings from a mass with a port: a coupling then joins one
   level or two neighbouring ones.
2. Every level goes to one column, the next to the same column or a neighbour, so no coupling spans more than one
   (``path``).
3. Columns are annealed until hardly any hub has more on a side than it holds (``crossings``), and the last are mended
   exactly (``repair``).
4. Within its column a mass goes to the height of those it is coupled to and of its tabs, and into rows of the column's
   own parity where these suffice: two hubs of one row are what asks for an order of trunks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlcad.placement.chance import random_source
from mdlcad.placement.crossings import settle_columns
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.path import path_of
from mdlcad.placement.problem import Floats, Ints, Problem
from mdlcad.placement.repair import Columns, repair_all

SETTLE, SETTLE_HOT, SETTLE_COLD = 500, 10.0, 0.5
"""Moves a mass of the annealing of columns, and its heats."""
SETTLED, SETTLED_MASSES = 3, 6000
"""Times that columns are annealed from the start if hubs cannot be mended, and about how many masses all may have."""
CELL, CROWDED = 12, 1.15
"""Rows of a cell; how much fuller than the average cell one may be."""
SWEEPS, SPACING = 12, 2.0
"""Times that heights are counted anew; slots from one mass of a column to the next, where there is room."""


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
    places = path_of([len(level) for level in levels], _cuts(problem, levels), len(lattice.column_x))
    bands = 1 + places[-1].band
    column, order = np.zeros(masses, np.int32), np.zeros(masses)
    for level, place in zip(levels, places, strict=True):
        column[level], order[level] = place.column, (place.band + 0.5) / bands * len(lattice.row_y)
    column = _fitted(column, lattice)
    height = _heights(_stand(problem, column, order, beside, lattice), lattice)
    cell = (height // CELL).astype(np.int32)
    room = np.zeros((len(lattice.column_x), int(np.max(cell)) + 1))
    for at, row in lattice.slots:
        room[at, min(row // CELL, room.shape[1] - 1)] += CROWDED * masses / len(lattice.slots)
    columns = _settled(problem, column, cell, room, seed)
    return Start(_stand(problem, columns.column, height, beside, lattice), columns)


def _settled(problem: Problem, column: Ints, cell: Ints, room: Floats, seed: int) -> Columns:
    """Anneal columns and sides (of couplings and leaves), then mend those around hubs that hold too much.

    Where some cannot be mended, all is tried again; the first try that leaves the fewest is taken.
    """
    masses = len(column)
    source = random_source(seed)
    tries: list[tuple[int, Columns]] = []
    for _ in range(max(1, min(SETTLED, SETTLED_MASSES // masses))):
        columns = Columns.of(
            problem, column.copy(), np.zeros(len(problem.coupling), np.int32), np.zeros(masses, np.int32)
        )
        chosen = (columns.column, columns.side, columns.bias)
        moves = SETTLE * masses
        settle_columns(
            problem, columns.into, *chosen, cell, room, columns.slots, source, moves, SETTLE_HOT, SETTLE_COLD
        )
        repair_all(problem, columns, seed)
        tries.append((len(columns.wrong(problem, np.arange(masses, dtype=np.int32))), columns))
        if tries[-1][0] == 0:
            break
    return min(tries, key=lambda found: found[0])[1]


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


def _cuts(problem: Problem, levels: list[list[int]]) -> list[int]:
    """How many nets lead from a level before the i-th to it or one after it, or back, for every i."""
    level_of = {mass: rank for rank, level in enumerate(levels) for mass in level}
    cuts = [0] * len(levels)
    for mass in range(len(problem.mass) - 1):
        met = [
            level_of[int(problem.coupling[j, 1])]
            for j in problem.outs[problem.mass[mass, 0] : problem.mass[mass + 1, 0]]
        ]
        for rank in range(min([level_of[mass], *met]), max([level_of[mass], *met])):
            cuts[rank + 1] += 1
    return cuts


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


def _stand(problem: Problem, column: Ints, order: Floats, beside: list[list[int]], lattice: Lattice) -> Ints:
    """A slot for every mass: each column first in ``order``, then by the mean height of neighbours and tabs."""
    slots: list[list[int]] = [[] for _ in lattice.column_x]
    for index, (at, _) in sorted(enumerate(lattice.slots), key=lambda item: item[1]):
        slots[at].append(index)
    members: list[list[int]] = [[] for _ in lattice.column_x]
    for mass, at in enumerate(column.tolist()):
        members[at].append(mass)
    for at, free in enumerate(slots):
        own = [slot for slot in free if lattice.slots[slot][1] % 2 == at % 2]
        slots[at] = own if len(own) >= len(members[at]) else free
    tabs: list[list[float]] = [[] for _ in beside]
    for low, high, _, mass in problem.tab.tolist():
        tabs[mass].append((low + high) / 2)
    height, slot = order.astype(float), np.zeros(len(column), np.int32)
    for sweep in range(SWEEPS):
        for at in range(len(members)) if sweep % 2 == 0 else reversed(range(len(members))):
            wish = {
                mass: float(np.mean([*height[beside[mass]], *tabs[mass]]))
                if sweep and (beside[mass] or tabs[mass])
                else float(height[mass])
                for mass in members[at]
            }
            members[at].sort(key=lambda mass: (wish[mass], mass))
            if not members[at]:
                continue
            rows = [float(lattice.slots[index][1]) for index in slots[at]]
            wanted = np.interp([wish[mass] for mass in members[at]], rows, np.arange(len(rows)))
            for mass, index in zip(members[at], spread(wanted, len(rows)), strict=True):
                slot[mass] = slots[at][index]
                height[mass] = rows[index]
    return slot


def spread(wanted: Floats, count: int) -> list[int]:
    """Places among ``count`` for ascending ``wanted`` ones, ``SPACING`` apart if there is room, least squares away.

    Pool adjacent violators: what would stand too near moves together, to the mean of what it wants.
    """
    steps = np.arange(len(wanted)) * min(SPACING, count / max(1, len(wanted)))
    blocks: list[tuple[float, int]] = []
    for place in (wanted - steps).tolist():
        mean, size = place, 1
        while blocks and blocks[-1][0] >= mean:
            before, others = blocks.pop()
            mean, size = (mean * size + before * others) / (size + others), size + others
        blocks.append((mean, size))
    first = np.repeat([mean for mean, _ in blocks], [size for _, size in blocks])
    places = np.floor(np.clip(first, 0.0, max(0.0, count - 1 - steps[-1])) + steps + 1e-9)
    return [int(place) for place in places]
