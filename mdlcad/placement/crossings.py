"""Columns of a large network by annealing: which hub side everything hangs on, before rows are known.

What hangs on which side of a hub follows from columns alone, and a hub side has room for one item a rung plate and
one post. A full annealing of slots hardly ever mends an overfull hub, because several masses would have to change
columns at once; here a move costs a microsecond, and only that is looked at.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from mdlcad.compiled import inlined, kernel, part
from mdlcad.placement.chance import draw
from mdlcad.placement.costs import HARD, SPAN
from mdlcad.placement.problem import Floats, Ints, Problem

TRUNK = 0.3
"""Cost of a rung to its own hub, which means a trunk, and of a hub side with no plate to spare."""
PASSED = 1.8
"""Cost of a hub column that a tab passes."""
EDGE = 1
"""Items on the outer side of an outermost hub: beside it the rim leaves room for one coupler's trunk."""
MOST_NEIGHBOURS = 64


@part
def _hub(p: Problem, into: Ints, column: Ints, mass: int) -> float:
    """What mass ``mass`` costs where it and its neighbours stand."""
    at, plates = column[mass], int(p.sizes[2])
    items, posts = np.zeros(3, np.int32), np.zeros(3, np.int32)  # left, either side, right
    for i in range(p.mass[mass, 1], p.mass[mass + 1, 1]):
        link = p.coupling[into[i]]
        side = 1 + min(1, max(-1, column[link[0]] - at))
        items[side] += 1
        posts[side] += link[2]
    own = np.zeros(3, np.int32)
    cost = 0.0
    for i in range(p.mass[mass, 0], p.mass[mass + 1, 0]):
        link = p.coupling[p.outs[i]]
        across = column[link[1]] - at
        cost += SPAN * max(0, abs(across) - link[3])
        own[1 + min(1, max(-1, across))] = 1
    for tab in range(p.mass[mass, 2], p.mass[mass + 1, 2]):
        way = p.way[tab, at]
        if way[0] < 0:
            cost += SPAN * way[2]
        else:
            own[0 if way[0] == at else 2] = 1
            cost += PASSED * max(0, way[2] - way[1] + 1)
    if own[0] + own[2] > 0:
        own[1] = 0
    items += own
    if p.mass[mass, 3]:
        items[1] += 1
        posts[1] += 1
    left = EDGE if at == 0 else plates
    right = EDGE if at == p.slot_at.shape[0] - 1 else plates
    over = max(0, items[0] - left) + max(0, items[2] - right)
    over = max(over, np.sum(items) - left - right)
    over += max(max(0, posts[0] - 1) + max(0, posts[2] - 1), np.sum(posts) - 2, 0)
    full = max(0, items[0] - left + 1) + max(0, items[2] - right + 1)
    return float(cost + HARD * over + TRUNK * (np.sum(own) + full))


@part
def _around(p: Problem, into: Ints, mass: int, found: Ints) -> int:
    """List ``mass`` and those it is coupled to, each once."""
    found[0], n = mass, 1
    outs = p.mass[mass + 1, 0] - p.mass[mass, 0]
    for i in range(outs + p.mass[mass + 1, 1] - p.mass[mass, 1]):
        if i < outs:
            other = p.coupling[p.outs[p.mass[mass, 0] + i], 1]
        else:
            other = p.coupling[into[p.mass[mass, 1] + i - outs], 0]
        known = False
        for k in range(n):
            known = known or found[k] == other
        if not known and n < len(found):
            found[n] = other
            n += 1
    return n


@inlined
def _crowd(held: float, room: float) -> float:
    return max(0.0, held - room) ** 2


@kernel
def settle_columns(
    p: Problem,
    into: Ints,
    column: Ints,
    cell: Ints,
    room: Floats,
    random: npt.NDArray[np.uint64],
    moves: int,
    hot: float,
    cold: float,
) -> float:
    """Anneal ``column`` in place, one column at a time; the cost that is left.

    Args:
        into: couplings by target, as ``Problem.mass`` counts them. cell: by mass, the cell of rows that it stays in.
        room: (columns, cells) masses that a cell takes without crowding.
    """
    found = np.zeros(MOST_NEIGHBOURS, np.int32)
    held = np.zeros(room.shape)
    for mass in range(len(column)):
        held[column[mass], cell[mass]] += 1
    for move in range(moves):
        heat = hot * (cold / hot) ** (move / moves)
        mass = int(draw(random) * len(column))
        old = column[mass]
        new = old + (1 if draw(random) < 0.5 else -1)
        if new < 0 or new >= len(room):
            continue
        at = cell[mass]
        n = _around(p, into, mass, found)
        change = _crowd(held[new, at] + 1, room[new, at]) - _crowd(held[new, at], room[new, at])
        change += _crowd(held[old, at] - 1, room[old, at]) - _crowd(held[old, at], room[old, at])
        for k in range(n):
            change -= _hub(p, into, column, found[k])
        column[mass] = new
        for k in range(n):
            change += _hub(p, into, column, found[k])
        if change <= 0 or draw(random) < math.exp(-change / heat):
            held[old, at] -= 1
            held[new, at] += 1
        else:
            column[mass] = old
    cost = 0.0
    for mass in range(len(column)):
        cost += _hub(p, into, column, mass)
    return cost
