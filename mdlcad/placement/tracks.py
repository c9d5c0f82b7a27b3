"""Trunks packed onto tracks: how far the trunks of a channel are from standing legally side by side.

The whole of a channel is packed, or bands of its rows, so that a move costs no more in a large device than in a small
one.
"""

from __future__ import annotations

from mdlcad.compiled import inlined, part
from mdlcad.placement.costs import HARD, POST_A, VIA_A, VIA_B
from mdlcad.placement.problem import Problem
from mdlcad.placement.state import State

LONGEST = 8
"""Trunks that a limit is passed back along, where packing is careful."""


@inlined
def _ask(s: State, first: int, second: int, n: int) -> int:
    """Note that a row asks for item ``first`` left of item ``second``; the number of orders noted."""
    a, b = s.seat[first // 2], s.seat[second // 2]
    if a == b:
        return n
    s.orders[n, 0], s.orders[n, 1], s.orders[n, 2] = a, b, s.last[a]
    s.last[a] = n
    s.waits[b] += 1
    return n + 1


@part
def _orders(s: State, channel: int, low: int, high: int) -> int:
    """List which trunks must run left of which, as rows low..high - 1 of a channel ask for; how many."""
    n = 0
    for row in range(low, high):
        t, items = s.row[channel, row], s.items[channel, row]
        for i in range(t[VIA_A]):
            for j in range(t[VIA_B]):
                n = _ask(s, items[0, i], items[1, j], n)
        for side in range(2):
            if t[POST_A + side] == 0:
                continue
            # what has a post reaches furthest from its hub
            for i in range(t[VIA_A + side]):
                for j in range(t[VIA_A + side]):
                    if items[side, i] % 2 == side and items[side, j] % 2 == 1 - side:
                        n = _ask(s, items[side, i], items[side, j], n)
    return n


@inlined
def track_cost(p: Problem, s: State, band: int) -> float:
    """Penalty of a band's trunks: how far past their windows the best-first packing from the left pushes them.

    Each step takes, of the trunks that could stand furthest left now, the one with the tightest right limit (limits
    are passed back along the order that rows ask for). Zero means that legal tracks exist: the packing is one.
    """
    n = s.trunk_count[band]
    bands = len(s.trunk_count) // s.row.shape[0]
    rows = s.row.shape[1]
    size = -(-rows // bands)
    pitch = p.sizes[1]
    nets, at, due, waits = s.trunks[band], s.at, s.due, s.waits
    cost = 0.0
    for i in range(n):
        at[i], due[i] = s.window[nets[i], 0], s.window[nets[i], 1]
        waits[i], s.last[i], s.seat[nets[i]], s.late[i] = 0, -1, i, 0
        if due[i] < at[i] - 1e-6:
            s.late[i] = 1
            cost += HARD * (1 + (at[i] - due[i]) / pitch)
            due[i] = at[i]
    low = band % bands * size
    asked = _orders(s, band // bands, low, min(rows, low + size))
    careful = s.careful[0] != 0
    for _ in range(LONGEST if careful else 2):
        passed = False
        for k in range(asked):
            limit = due[s.orders[k, 1]] - pitch
            if limit < due[s.orders[k, 0]]:
                due[s.orders[k, 0]], passed = limit, True
        if not passed:
            break
    alive, left = s.alive, n
    for i in range(n):
        alive[i] = i
    while left > 0:
        first = 1e18
        for k in range(left):
            if waits[alive[k]] == 0:
                first = min(first, at[alive[k]])
        ring = first > 1e17  # nets that wait for one another
        if ring:
            if not careful:
                return cost + HARD * left
            cost += HARD
            for k in range(left):
                first = min(first, at[alive[k]])
        best, where = -1, 0
        for k in range(left):
            i = alive[k]
            if (ring or waits[i] == 0) and at[i] < first + pitch / 2 and (best < 0 or due[i] <= due[best]):
                if best >= 0 and due[i] == due[best] and (not careful or nets[i] > nets[best]):
                    continue
                best, where = i, k
        late = at[best] - s.window[nets[best], 1]
        if ring:
            s.late[best] = 1
        if late > 1e-6 and s.window[nets[best], 0] <= s.window[nets[best], 1]:
            s.late[best] = 1
            cost += HARD * (0.5 + late / pitch)
        left -= 1
        for k in range(where, left):
            alive[k] = alive[k + 1]
        lowest, highest = s.rows[nets[best], 0], s.rows[nets[best], 1]
        for k in range(left):
            i = alive[k]
            if s.rows[nets[i], 0] <= highest and lowest <= s.rows[nets[i], 1]:
                at[i] = max(at[i], at[best] + pitch)
        k = s.last[best]
        while k >= 0:
            # those that share a row overlap, so they have been moved on already
            waits[s.orders[k, 1]] -= 1
            k = s.orders[k, 2]
    return cost * s.careful[0] if careful else cost
