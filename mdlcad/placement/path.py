"""The way of a large network's levels through the columns: to and fro across all of them, band above band.

Every level has a column, the next one the same or its neighbour. The fullest columns are those whose trunks find no
tracks, so the levels that share one are chosen such that columns hold about as many masses each, and the way turns
where few nets lead from one level to the next: they all pass from one band to the other there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SHARED, LEAST, TOGETHER = 1.5, 1.2, 4
"""Levels to a column where the way goes once more to and fro, and where it ends before the last column; most that share
one. Where each has a column to itself, a mass has hardly any choice of columns."""
EARLY = 12
"""Columns before the last in which the way may turn."""
TURN, IDLE = 4.0, 0.3
"""Cost of a net at a turn, squared, and of a column left out at one, in masses that it would have held, squared."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where a level goes: a column, and a band of rows."""

    column: int
    band: int


def path_of(sizes: list[int], cuts: list[int], columns: int) -> list[Place]:
    """The places of levels of those ``sizes``, of which ``cuts`` nets lead from the one before to each.

    By dynamic programming over levels, columns and bands: least squares of what columns hold, and of nets at turns.
    """
    levels = len(sizes)
    bands = max(1, round(levels / (SHARED * columns)))
    length = max(1, min(bands * columns, round(levels / LEAST)))
    together = min(max(TOGETHER, -(-levels // length)), levels)
    total = np.concatenate([[0], np.cumsum(sizes)]).astype(float)
    share = total[-1] / length
    across = np.array([*cuts, 0], float) ** 2
    before = np.full((columns, levels + 1), np.inf)
    before[0, 0] = 0.0
    taken = np.zeros((bands, columns, levels + 1), np.int32)  # levels of the last column; negative: the first of a band
    for band in range(bands):
        cost = np.full((columns, levels + 1), np.inf)
        order = range(columns) if band % 2 == 0 else range(columns - 1, -1, -1)
        for rank, column in enumerate(order):
            wish = share / 2 if band == 0 and rank == 0 else share
            for count in range(1, together + 1):
                held = (total[count:] - total[:-count] - wish) ** 2
                for sign, from_there in ((-1, before[column]), (1, cost[order[rank - 1]] if rank else None)):
                    if from_there is None:
                        continue
                    more = from_there[:-count] + held
                    better = np.flatnonzero(more < cost[column, count:])
                    cost[column, count + better], taken[band, column, count + better] = more[better], sign * count
        before = np.full_like(cost, np.inf)
        for rank, column in enumerate(order):
            idle = columns - 1 - rank
            if idle <= EARLY:
                before[column] = cost[column] + TURN * across + 2 * IDLE * idle * share**2
    column, left, found = int(np.argmin(cost[:, -1])), levels, []
    while left:
        count = int(taken[band, column, left])
        found += [Place(column, band)] * abs(count)
        left -= abs(count)
        if count < 0:
            band -= 1
        else:
            column += 1 if band % 2 else -1
    return found[::-1]
