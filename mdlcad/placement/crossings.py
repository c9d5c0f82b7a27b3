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
NARROW = 0.5
"""Cost of each track that a trunk has fewer than three to choose from."""
CROWD = 3.0
"""Cost of one mass more than a cell has room for."""
TURNS = 0.3
"""Share of the moves that turn a coupling or a bias leaf to the other side."""
EDGE = 1
"""Items on the outer side of an outermost hub: beside it the rim leaves room for one coupler's trunk."""
MOST_NEIGHBOURS = 64


@part
def _window(p: Problem, at_column: Ints, side: Ints, mass: int, channel: int) -> tuple[float, float]:
    """Lowest and highest x (mm) of the trunk of ``mass`` in ``channel``, as its targets there allow."""
    middle = p.limits.shape[1] // 2
    low, high = p.limits[channel, middle, 0], p.limits[channel, middle, 1]
    at = at_column[mass]
    if at < channel:
        low = max(low, p.hub_x[at] + p.sizes[0])
    else:
        high = min(high, p.hub_x[at] - p.sizes[0])
    for i in range(p.mass[mass, 0], p.mass[mass + 1, 0]):
        coupling = p.outs[i]
        there = at_column[p.coupling[coupling, 1]]
        if (side[coupling] if there == at else int(there > at)) != channel - at:
            continue
        if there < channel:
            low = max(low, p.hub_x[there] + p.reach[coupling])
        else:
            high = min(high, p.hub_x[there] - p.reach[coupling])
    return low, high


@part
def _hub(p: Problem, into: Ints, at_column: Ints, side: Ints, bias: Ints, mass: int) -> tuple[float, float]:
    """What the hub of mass ``mass`` costs where it and its neighbours stand: for broken rules, and beyond."""
    at, plates = at_column[mass], int(p.sizes[2])
    items, posts, own = np.zeros(2, np.int32), np.zeros(2, np.int32), np.zeros(2, np.int32)  # left, right
    for i in range(p.mass[mass, 1], p.mass[mass + 1, 1]):
        link = p.coupling[into[i]]
        across = at_column[link[0]] - at
        k = side[into[i]] if across == 0 else int(across > 0)
        items[k] += 1
        posts[k] += link[2]
    broken, cost = 0.0, 0.0
    for i in range(p.mass[mass, 0], p.mass[mass + 1, 0]):
        link = p.coupling[p.outs[i]]
        across = at_column[link[1]] - at
        broken += SPAN * max(0, abs(across) - link[3])
        own[side[p.outs[i]] if across == 0 else int(across > 0)] = 1
    for tab in range(p.mass[mass, 2], p.mass[mass + 1, 2]):
        way = p.way[tab, at]
        if way[0] < 0:
            broken += SPAN * way[2]
        else:
            own[0 if way[0] == at else 1] = 1
            cost += PASSED * max(0, way[2] - way[1] + 1)
    for k in range(2):
        if own[k]:
            low, high = _window(p, at_column, side, mass, at + k)
            broken += HARD * (low > high + 1e-6)
            cost += NARROW * max(0.0, 3 - (high - low) / p.sizes[1])
    items += own
    if p.mass[mass, 3]:
        items[bias[mass]] += 1
        posts[bias[mass]] += 1
    left = EDGE if at == 0 else plates
    right = EDGE if at == p.slot_at.shape[0] - 1 else plates
    over = max(0, items[0] - left) + max(0, items[1] - right) + max(0, posts[0] - 1) + max(0, posts[1] - 1)
    full = max(0, items[0] - left + 1) + max(0, items[1] - right + 1)
    return float(broken + HARD * over), float(cost + TRUNK * (np.sum(own) + full))


@part
def _posted(p: Problem, at_column: Ints, side: Ints, mass: int, channel: int, first: int, second: int) -> bool:
    """Whether ``second`` reaches a hub in the column of ``mass``, in ``channel``, by a post, and ``first`` without."""
    at = at_column[mass]
    for i in range(p.mass[second, 0], p.mass[second + 1, 0]):
        link = p.coupling[p.outs[i]]
        if not link[2] or link[1] == mass or at_column[link[1]] != at:
            continue
        if (side[p.outs[i]] + at if at_column[second] == at else max(at, at_column[second])) != channel:
            continue
        if link[1] == first:
            return True
        for j in range(p.mass[first, 0], p.mass[first + 1, 0]):
            mine = p.outs[j]
            if p.coupling[mine, 1] != link[1]:
                continue
            if (side[mine] + at if at_column[first] == at else max(at, at_column[first])) == channel:
                return True
    return False


@part
def _orders(p: Problem, into: Ints, at_column: Ints, side: Ints, mass: int) -> float:
    """What orders of trunks on the sides of a hub cost that no rows can give.

    What has a post reaches further than all others on its hub side.
    """
    at, pitch, cost = at_column[mass], p.sizes[1], 0.0
    for k in range(2):
        channel, post, n = at + k, -1, 0
        others = np.zeros(MOST_NEIGHBOURS, np.int32)
        for i in range(p.mass[mass, 1], p.mass[mass + 1, 1]):
            link = p.coupling[into[i]]
            across = at_column[link[0]] - at
            if (side[into[i]] if across == 0 else int(across > 0)) != k:
                continue
            if link[2]:
                post = link[0]
            else:
                others[n] = link[0]
                n += 1
        for i in range(p.mass[mass, 0], p.mass[mass + 1, 0]):
            across = at_column[p.coupling[p.outs[i], 1]] - at
            if (side[p.outs[i]] if across == 0 else int(across > 0)) == k:
                others[n] = mass
                n += 1
                break
        if post < 0:
            continue
        low, high = _window(p, at_column, side, post, channel)
        for i in range(n):
            a, b = _window(p, at_column, side, others[i], channel)
            room = high - a if k == 1 else b - low
            if room < pitch - 1e-6 or _posted(p, at_column, side, mass, channel, post, others[i]):
                cost += HARD
    return cost


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
        n = _note(found, n, other)
    return n


@inlined
def _note(found: Ints, n: int, other: int) -> int:
    known = n == len(found)
    for k in range(n):
        known = known or found[k] == other
    if known:
        return n
    found[n] = other
    return n + 1


@inlined
def _crowd(held: float, room: float) -> float:
    return CROWD * max(0.0, held - room) ** 2


@inlined
def _price(p: Problem, into: Ints, column: Ints, side: Ints, bias: Ints, mass: int) -> float:
    broken, cost = _hub(p, into, column, side, bias, mass)
    return float(broken + cost)


@kernel
def hub_costs(p: Problem, into: Ints, column: Ints, side: Ints, bias: Ints, hubs: Ints) -> Floats:
    """(N, 2) what rules cost that each of ``hubs`` breaks by itself, and by orders; arguments as ``settle_columns``."""
    costs = np.zeros((len(hubs), 2))
    for i in range(len(hubs)):
        mass = hubs[i]
        costs[i, 0] = _hub(p, into, column, side, bias, mass)[0]
        costs[i, 1] = _orders(p, into, column, side, mass)
    return costs


@kernel
def settle_columns(
    p: Problem,
    into: Ints,
    column: Ints,
    side: Ints,
    bias: Ints,
    cell: Ints,
    room: Floats,
    slots: Ints,
    random: npt.NDArray[np.uint64],
    moves: int,
    hot: float,
    cold: float,
) -> None:
    """Anneal ``column``, ``side`` and ``bias`` in place; orders of trunks do not count here.

    Args:
        into: couplings by target, as ``Problem.mass`` counts them. cell: by mass, the cell of rows that it stays in.
        side: by coupling, the channel (0 left, 1 right) that it takes within a column. bias: by mass, its leaf's side.
        room: (columns, cells) masses that a cell takes without crowding. slots: by column, how many it has.
    """
    found = np.zeros(MOST_NEIGHBOURS, np.int32)
    held, free = np.zeros(room.shape), slots.copy()
    for mass in range(len(column)):
        held[column[mass], cell[mass]] += 1
        free[column[mass]] -= 1
    for move in range(moves):
        heat = hot * (cold / hot) ** (move / moves)
        mass = int(draw(random) * len(column))
        old, new, turned, change, at = column[mass], column[mass], -1, 0.0, cell[mass]
        found[0], n = mass, 1
        kind = draw(random)
        if kind < TURNS / 2:
            if not p.mass[mass, 3]:
                continue
            change -= _price(p, into, column, side, bias, mass)
            bias[mass] = 1 - bias[mass]
        elif kind < TURNS:
            outs = p.mass[mass + 1, 0] - p.mass[mass, 0]
            if outs == 0:
                continue
            turned = p.outs[p.mass[mass, 0] + int(draw(random) * outs)]
            if column[p.coupling[turned, 1]] != old:
                continue
            found[1], n = p.coupling[turned, 1], 2
            for k in range(n):
                change -= _price(p, into, column, side, bias, found[k])
            side[turned] = 1 - side[turned]
        else:
            new = old + (1 if draw(random) < 0.5 else -1)
            if new < 0 or new >= len(room) or free[new] <= 0:
                continue
            n = _around(p, into, mass, found)
            change += _crowd(held[new, at] + 1, room[new, at]) - _crowd(held[new, at], room[new, at])
            change += _crowd(held[old, at] - 1, room[old, at]) - _crowd(held[old, at], room[old, at])
            for k in range(n):
                change -= _price(p, into, column, side, bias, found[k])
            column[mass] = new
        for k in range(n):
            change += _price(p, into, column, side, bias, found[k])
        if change <= 0 or draw(random) < math.exp(-change / heat):
            held[old, at] -= 1
            held[new, at] += 1
            free[old] += 1
            free[new] -= 1
        elif new != old:
            column[mass] = old
        elif turned >= 0:
            side[turned] = 1 - side[turned]
        else:
            bias[mass] = 1 - bias[mass]
