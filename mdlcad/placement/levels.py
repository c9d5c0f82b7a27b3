"""A start for networks too large for an exact choice of columns: level by level away from the ports.

Masses are counted in levels by the least number of couplings from a mass with a port. A coupling then joins one level
or two neighbouring ones, so columns that take whole levels in turn never put it more than one column too far. Within
its column a mass goes to the height of those it is coupled to.
"""

from __future__ import annotations

import numpy as np

from mdlcad.placement.lattice import Lattice
from mdlcad.placement.problem import Ints, Problem

_SWEEPS = 12


def slots_by_levels(problem: Problem, lattice: Lattice) -> Ints:
    """A slot for every mass."""
    masses = len(problem.mass) - 1
    beside = _neighbours(problem, masses)
    column = _columns(_levels(problem, beside, masses), lattice)
    return _rows(column, beside, lattice)


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


def _columns(levels: list[list[int]], lattice: Lattice) -> Ints:
    """A column for every mass: all columns alike full, whole levels where they fit."""
    rooms = np.bincount([column for column, _ in lattice.slots], minlength=len(lattice.column_x))
    order = [mass for level in levels for mass in level]
    share = len(order) / len(lattice.slots)
    column = np.zeros(len(order), np.int32)
    held = np.zeros(len(rooms), np.int64)
    at, placed, due = 0, 0, rooms[0] * share
    for level in levels:
        # a level stands in the next column (no further) if most of it would be beyond this one's share
        if at + 1 < len(rooms) and placed + len(level) / 2 > due:
            at += 1
            due += rooms[at] * share
        for mass in level:
            near = np.abs(np.arange(len(rooms)) - at) + np.where(held < rooms, 0, len(rooms))
            column[mass] = int(np.argmin(near))
            held[column[mass]] += 1
        placed += len(level)
    return column


def _rows(column: Ints, beside: list[list[int]], lattice: Lattice) -> Ints:
    """A slot for every mass: each column in the order of its masses' mean neighbours, spread over its slots."""
    slots: list[list[int]] = [[] for _ in lattice.column_x]
    for index, (at, _) in sorted(enumerate(lattice.slots), key=lambda item: item[1]):
        slots[at].append(index)
    members: list[list[int]] = [[] for _ in lattice.column_x]
    for mass, at in enumerate(column.tolist()):
        members[at].append(mass)
    height = np.zeros(len(column))
    slot = np.zeros(len(column), np.int32)
    for sweep in range(_SWEEPS):
        for at in range(len(members)) if sweep % 2 == 0 else reversed(range(len(members))):
            if sweep:
                wish = {mass: float(np.mean(height[beside[mass]])) if beside[mass] else 0.0 for mass in members[at]}
                members[at].sort(key=lambda mass: (wish[mass], mass))
            free, count = slots[at], len(members[at])
            for k, mass in enumerate(members[at]):
                slot[mass] = free[(2 * k + 1) * len(free) // (2 * count)]
                height[mass] = lattice.slots[int(slot[mass])][1]
    return slot
