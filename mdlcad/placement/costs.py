"""What a placement costs: tallies of every row of every channel, kept net by net, and the rules they are held to.

A net is added to or removed from running tallies, so a move costs only the nets and channels it touches. The tallies:
items per hub side against plates, posts per hub side, straight rungs against what must lie under them, and which nets
must run left of which. Trunks are packed onto tracks elsewhere (``tracks``).
"""

from __future__ import annotations

import numpy as np

from mdlcad.compiled import inlined, part
from mdlcad.placement.problem import BETWEEN, Floats, Ints, Problem
from mdlcad.placement.state import State

HARD = 12.0
"""Cost of one violated hard rule; a wire of one row costs WIRE."""
SPAN = 3 * HARD
"""Cost of a column too far: it is found at the start (``columns``), and hardly ever mended once lost."""
WIRE = 0.06
ORDER = 0.03
SHARED = 4.0

# columns of State.row, the tallies of one (channel, row); A hangs on the left of the channel, B on the right
VIA_A, VIA_B, BIAS_A, BIAS_B, STRAIGHT, POST_A, POST_B, SPOST_A, SPOST_B = range(9)
SLOT, BIAS_SIDE = 0, 1
TAKEN, PUT = np.array([-1]), np.array([1])
"""Signs of what is taken out of the tallies and put in. From arrays, as numba compiles anew for every constant."""


# The small functions take single rows, not the whole state: numba passes every array of a tuple by value.


@inlined
def row_cost(t: Ints, is_open: int, plates: int) -> float:
    """Penalty of one row of a channel from its tallies."""
    straight = t[STRAIGHT]
    over = max(t[VIA_A] + t[BIAS_A], t[VIA_B] + t[BIAS_B]) - plates
    cost = 0
    if straight > 0:
        over = max(t[VIA_A], t[VIA_B]) + straight + max(t[BIAS_A], t[BIAS_B]) - plates
        cost += (t[POST_A] + t[POST_B] > 0) + (t[SPOST_A] + t[SPOST_B] > 1) + (is_open == 0)
    cost += max(0, over)
    cost += max(0, t[POST_A] + t[BIAS_A] + t[SPOST_A] - 1) + max(0, t[POST_B] + t[BIAS_B] + t[SPOST_B] - 1)
    return HARD * cost


@inlined
def _order_cost(t: Ints, plates: int) -> float:
    """What the orders asked for by one row cost: legal, but each takes freedom from the tracks.

    So does a bias leaf that has not a plate to itself: what shares its plate must stop short of it.
    """
    a, b = t[VIA_A], t[VIA_B]
    shared = max(0, b + t[BIAS_A] - plates) * t[BIAS_A] + max(0, a + t[BIAS_B] - plates) * t[BIAS_B]
    return float(ORDER * (a * b + t[POST_A] * (a - t[POST_A]) + t[POST_B] * (b - t[POST_B])) + SHARED * shared)


@part
def _piece(t: Ints, items: Ints, is_open: int, plates: int, net: int, side: int, posted: bool, sign: int) -> float:
    """Add (+1) or remove (-1) one trunk-borne item of net-channel ``net`` in a row; side 0 hangs on its left.

    What hangs on the left must run left of what hangs on the right; on one side, what has a post reaches furthest.
    """
    cost = -row_cost(t, is_open, plates) - _order_cost(t, plates)
    code, n = 2 * net + posted, t[VIA_A + side]
    if sign > 0:
        items[side, n] = code
    else:
        for i in range(n):
            if items[side, i] == code:
                items[side, i] = items[side, n - 1]
                break
    t[VIA_A + side] += sign
    if posted:
        t[POST_A + side] += sign
    return cost + row_cost(t, is_open, plates) + _order_cost(t, plates)


@inlined
def _half(p: Problem, s: State, mass: int, side: int, sign: int) -> float:
    """One net's pieces in the channel left (0) or right (1) of its source."""
    slot = s.mass[mass, SLOT]
    column, row = p.slot[slot, 0], p.slot[slot, 1]
    channel = column + side
    targets, tabs, chosen = 0, 0, -1
    plates = int(p.sizes[2])
    straight = False
    for i in range(p.mass[mass, 0], p.mass[mass + 1, 0]):
        coupling = p.outs[i]
        there = s.mass[p.coupling[coupling, 1], SLOT]
        across = p.slot[there, 0] - column
        if across == 2 * side - 1 or (across == 0 and s.side[coupling] == side):
            targets += 1
            chosen = coupling
            straight = across != 0 and p.slot[there, 1] == row
    for tab in range(p.mass[mass, 2], p.mass[mass + 1, 2]):
        if p.way[tab, column, 0] == channel:
            tabs += 1
            straight = p.tab[tab, 2] == row
    if targets + tabs == 0:
        return 0.0
    if targets + tabs == 1 and straight:
        t, is_open = s.row[channel, row], p.is_open[channel, row]
        cost = -row_cost(t, is_open, plates)
        t[STRAIGHT] += sign
        if targets == 1 and p.coupling[chosen, 2]:
            t[SPOST_A + side] += sign
        return cost + row_cost(t, is_open, plates)
    net = 2 * mass + side
    low, high = row, row
    x_low, x_high = -1e9, 1e9
    free = tabs > 0
    if side == 1:
        x_low = p.hub_x[column] + p.sizes[0]
        x_high = 1e9 if free else p.limits[channel, row, 2]
    else:
        x_high = p.hub_x[column] - p.sizes[0]
        x_low = -1e9 if free else p.limits[channel, row, 3]
    t, items = s.row[channel], s.items[channel]
    is_open = p.is_open[channel]
    cost = _piece(t[row], items[row], is_open[row], plates, net, 1 - side, False, sign)
    for i in range(p.mass[mass, 0], p.mass[mass + 1, 0]):
        coupling = p.outs[i]
        there = s.mass[p.coupling[coupling, 1], SLOT]
        across = p.slot[there, 0] - column
        if across == 2 * side - 1 or (across == 0 and s.side[coupling] == side):
            at = p.slot[there, 1]
            low, high = min(low, at), max(high, at)
            hub = 0 if p.slot[there, 0] == channel - 1 else 1
            if hub == 0:
                x_low = max(x_low, p.hub_x[channel - 1] + p.reach[coupling])
                x_high = x_high if free else min(x_high, p.limits[channel, at, 2])
            else:
                x_high = min(x_high, p.hub_x[channel] - p.reach[coupling])
                x_low = x_low if free else max(x_low, p.limits[channel, at, 3])
            posted = p.coupling[coupling, 2] != 0
            cost += _piece(t[at], items[at], is_open[at], plates, net, hub, posted, sign)
    for tab in range(p.mass[mass, 2], p.mass[mass + 1, 2]):
        if p.way[tab, column, 0] == channel:
            low, high = min(low, p.tab[tab, 0]), max(high, p.tab[tab, 1])
            kind = p.way[tab, column, 3]
            for at in range(p.tab[tab, 0], p.tab[tab, 1] + 1):
                for hub in range(2):
                    if kind == BETWEEN or hub == kind:
                        cost += _piece(t[at], items[at], is_open[at], plates, net, hub, False, sign)
    cost += sign * WIRE * (high - low)
    for at in range(low, high + 1):
        x_low = max(x_low, p.limits[channel, at, 0])
        x_high = min(x_high, p.limits[channel, at, 1])
    if sign > 0:
        s.window[net, 0], s.window[net, 1] = x_low, x_high
        s.rows[net, 0], s.rows[net, 1] = low, high
    bands = len(s.trunk_count) // s.row.shape[0]
    size = -(-s.row.shape[1] // bands)
    first, last = channel * bands + low // size, channel * bands + high // size
    s.marked[0], s.marked[1] = min(s.marked[0], first), max(s.marked[1], last + 1)
    for band in range(first, last + 1):
        _register(s.trunks[band], s.trunk_count, band, net, sign)
        s.dirty[band] = 1
    return cost


@inlined
def _register(trunks: Ints, count: Ints, band: int, net: int, sign: int) -> None:
    """Add (+1) or remove (-1) a trunk in the list of a band."""
    n = count[band]
    count[band] = n + sign
    if sign > 0:
        trunks[n] = net
        return
    for i in range(n):
        if trunks[i] == net:
            trunks[i] = trunks[n - 1]
            return


@inlined
def outside(p: Problem, channel: int, row: int, x: float) -> bool:
    """Whether ``x`` lies beyond the walls or hubs of a row of a channel."""
    return bool(x < p.limits[channel, row, 0] - 1e-6 or x > p.limits[channel, row, 1] + 1e-6)


@part
def _bias(p: Problem, s: State, mass: int, sign: int) -> float:
    slot = s.mass[mass, SLOT]
    column, row = p.slot[slot, 0], p.slot[slot, 1]
    side = s.mass[mass, BIAS_SIDE]
    channel = column + side
    t, is_open, plates = s.row[channel, row], p.is_open[channel, row], int(p.sizes[2])
    cost = -row_cost(t, is_open, plates) - _order_cost(t, plates)
    t[BIAS_B - side] += sign
    cost += row_cost(t, is_open, plates) + _order_cost(t, plates)
    end = p.hub_x[column] + (2 * side - 1) * p.sizes[3]
    if outside(p, channel, row, end):
        cost += sign * HARD
    return cost


@part
def tally(p: Problem, s: State, nets: Ints, n: int, a: int, b: int, sign: int) -> float:
    """Add or remove the first ``n`` of ``nets`` and the bias leaves of masses a and b (or -1)."""
    cost = 0.0
    for k in range(n):
        for side in range(2):
            cost += _half(p, s, nets[k], side, sign)
    for k in range(2):
        mass = a if k == 0 else b
        if mass >= 0 and p.mass[mass, 3]:
            cost += _bias(p, s, mass, sign)
    return cost


@part
def span(p: Problem, s: State, nets: Ints, n: int) -> float:
    """Penalty of targets and tabs that are out of reach of their sources."""
    far = 0
    for k in range(n):
        mass = nets[k]
        column = p.slot[s.mass[mass, SLOT], 0]
        for i in range(p.mass[mass, 0], p.mass[mass + 1, 0]):
            link = p.coupling[p.outs[i]]
            far += max(0, abs(p.slot[s.mass[link[1], SLOT], 0] - column) - link[3])
        for tab in range(p.mass[mass, 2], p.mass[mass + 1, 2]):
            if p.way[tab, column, 0] < 0:
                far += p.way[tab, column, 2]
    return SPAN * far


@part
def passes(p: Problem, s: State, wire: float) -> float:
    """Penalty of tabs that pass over hub columns: their length, and the masses in their way."""
    cost = 0.0
    for tab in range(len(p.tab)):
        w = p.way[tab, p.slot[s.mass[p.tab[tab, 3], SLOT], 0]]
        if w[0] < 0:
            continue
        for column in range(w[1], w[2] + 1):
            cost += 10 * wire
            for row in range(p.tab[tab, 0], p.tab[tab, 1] + 1):
                slot = p.slot_at[column, row]
                if slot >= 0 and s.mass_at[slot] >= 0:
                    cost += HARD
    return cost


@part
def hard_cost(p: Problem, s: State, tracks: Floats, all_masses: Ints) -> float:
    """The part of the cost that breaks rules, counted afresh; ``tracks`` are the channels' penalties."""
    cost = np.sum(tracks) + span(p, s, all_masses, len(all_masses)) + passes(p, s, 0.0)
    for channel in range(s.row.shape[0]):
        for row in range(s.row.shape[1]):
            cost += row_cost(s.row[channel, row], p.is_open[channel, row], int(p.sizes[2]))
    for mass in range(len(s.mass)):
        if p.mass[mass, 3]:
            column, row = p.slot[s.mass[mass, SLOT], 0], p.slot[s.mass[mass, SLOT], 1]
            side = s.mass[mass, BIAS_SIDE]
            if outside(p, column + side, row, p.hub_x[column] + (2 * side - 1) * p.sizes[3]):
                cost += HARD
    return cost
