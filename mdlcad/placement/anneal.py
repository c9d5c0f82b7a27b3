"""Simulated annealing of slots, channel sides and bias sides: a numba kernel with exact incremental costs.

A net is added to or removed from running tallies, so a move costs only the nets and channels it touches. The tallies:
items per hub side against plates, posts per hub side, straight rungs against what must lie under them, and which nets
must run left of which. The trunks of a touched channel are then packed onto tracks (``_tracks``); a channel of many
rows is judged in bands of them, so that a move costs no more in a large device than in a small one.

All compiled code is in this one file, because numba's cache does not notice a change in another.
"""

from __future__ import annotations

import math

import numba
import numpy as np
import numpy.typing as npt

from mdlcad.placement.problem import BETWEEN, Floats, Ints, Problem
from mdlcad.placement.state import COLUMN, DEEP, State

HARD = 12.0
"""Cost of one violated hard rule; a wire of one row costs WIRE."""
SPAN = 3 * HARD
"""Cost of a column too far: it is found at the start (``columns``), and hardly ever mended once lost."""
WIRE = 0.06
ORDER = 0.03
SHARED = 4.0
REFRESH = 500
"""Moves after which the masses that broken rules are about are listed anew."""

# columns of State.row, the tallies of one (channel, row); A hangs on the left of the channel, B on the right
VIA_A, VIA_B, BIAS_A, BIAS_B, STRAIGHT, POST_A, POST_B, SPOST_A, SPOST_B = range(9)
SLOT, BIAS_SIDE = 0, 1
HOME_SIDE = 2


# The small functions take single rows, not the whole state: numba passes every array of a tuple by value.


@numba.njit(cache=True, error_model="numpy", forceinline=True)
def _row_cost(t: Ints, is_open: int, plates: int) -> float:
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


@numba.njit(cache=True, error_model="numpy", forceinline=True)
def _order_cost(t: Ints, plates: int) -> float:
    """What the orders asked for by one row cost: legal, but each takes freedom from the tracks.

    So does a bias leaf that has not a plate to itself: what shares its plate must stop short of it.
    """
    a, b = t[VIA_A], t[VIA_B]
    shared = max(0, b + t[BIAS_A] - plates) * t[BIAS_A] + max(0, a + t[BIAS_B] - plates) * t[BIAS_B]
    return float(ORDER * (a * b + t[POST_A] * (a - t[POST_A]) + t[POST_B] * (b - t[POST_B])) + SHARED * shared)


@numba.njit(cache=True, error_model="numpy")
def _piece(t: Ints, items: Ints, is_open: int, plates: int, net: int, side: int, posted: bool, sign: int) -> float:
    """Add (+1) or remove (-1) one trunk-borne item of net-channel ``net`` in a row; side 0 hangs on its left.

    What hangs on the left must run left of what hangs on the right; on one side, what has a post reaches furthest.
    """
    cost = -_row_cost(t, is_open, plates) - _order_cost(t, plates)
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
    return cost + _row_cost(t, is_open, plates) + _order_cost(t, plates)


@numba.njit(cache=True, error_model="numpy", forceinline=True)
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
        cost = -_row_cost(t, is_open, plates)
        t[STRAIGHT] += sign
        if targets == 1 and p.coupling[chosen, 2]:
            t[SPOST_A + side] += sign
        return cost + _row_cost(t, is_open, plates)
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
    for band in range(channel * bands + low // size, channel * bands + high // size + 1):
        _register(s.trunks[band], s.trunk_count, band, net, sign)
        s.dirty[band] = 1
    return cost


@numba.njit(cache=True, error_model="numpy", forceinline=True)
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


@numba.njit(cache=True, error_model="numpy", forceinline=True)
def _ask(s: State, first: int, second: int, n: int) -> int:
    """Note that a row asks for item ``first`` left of item ``second``; the number of orders noted."""
    a, b = s.seat[first // 2], s.seat[second // 2]
    if a == b:
        return n
    s.orders[n, 0], s.orders[n, 1], s.orders[n, 2] = a, b, s.last[a]
    s.last[a] = n
    s.waits[b] += 1
    return n + 1


@numba.njit(cache=True, error_model="numpy")
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


@numba.njit(cache=True, error_model="numpy", forceinline=True)
def _tracks(p: Problem, s: State, band: int) -> float:
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
        waits[i], s.last[i], s.seat[nets[i]] = 0, -1, i
        if due[i] < at[i] - 1e-6:
            cost += HARD * (1 + (at[i] - due[i]) / pitch)
            due[i] = at[i]
    low = band % bands * size
    asked = _orders(s, band // bands, low, min(rows, low + size))
    for _ in range(2):
        for k in range(asked):
            due[s.orders[k, 0]] = min(due[s.orders[k, 0]], due[s.orders[k, 1]] - pitch)
    alive, left = s.alive, n
    for i in range(n):
        alive[i] = i
    while left > 0:
        first = 1e18
        for k in range(left):
            if waits[alive[k]] == 0:
                first = min(first, at[alive[k]])
        if first > 1e17:
            # nets that wait for one another in a ring
            return cost + HARD * left
        best, where = -1, 0
        for k in range(left):
            i = alive[k]
            if waits[i] == 0 and at[i] < first + pitch / 2 and (best < 0 or due[i] < due[best]):
                best, where = i, k
        late = at[best] - s.window[nets[best], 1]
        if late > 1e-6 and s.window[nets[best], 0] <= s.window[nets[best], 1]:
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
    return cost


@numba.njit(cache=True, error_model="numpy", forceinline=True)
def _outside(p: Problem, channel: int, row: int, x: float) -> bool:
    return bool(x < p.limits[channel, row, 0] - 1e-6 or x > p.limits[channel, row, 1] + 1e-6)


@numba.njit(cache=True, error_model="numpy")
def _bias(p: Problem, s: State, mass: int, sign: int) -> float:
    slot = s.mass[mass, SLOT]
    column, row = p.slot[slot, 0], p.slot[slot, 1]
    side = s.mass[mass, BIAS_SIDE]
    channel = column + side
    t, is_open, plates = s.row[channel, row], p.is_open[channel, row], int(p.sizes[2])
    cost = -_row_cost(t, is_open, plates) - _order_cost(t, plates)
    t[BIAS_B - side] += sign
    cost += _row_cost(t, is_open, plates) + _order_cost(t, plates)
    end = p.hub_x[column] + (2 * side - 1) * p.sizes[3]
    if _outside(p, channel, row, end):
        cost += sign * HARD
    return cost


@numba.njit(cache=True, error_model="numpy")
def _tally(p: Problem, s: State, nets: Ints, n: int, a: int, b: int, sign: int) -> float:
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


@numba.njit(cache=True, error_model="numpy", forceinline=True)
def _draw(random: npt.NDArray[np.uint64]) -> float:
    """xorshift64*: uniform in [0, 1)."""
    x = random[0]
    x ^= x >> np.uint64(12)
    x ^= x << np.uint64(25)
    x ^= x >> np.uint64(27)
    random[0] = x
    return float((x * np.uint64(2685821657736338717)) >> np.uint64(11)) / 9007199254740992.0


@numba.njit(cache=True, error_model="numpy")
def _gather(p: Problem, mass: int, nets: Ints, n: int) -> int:
    """Append the nets that move with ``mass``: its own and those that drive it."""
    for i in range(p.mass[mass, 1] - 1, p.mass[mass + 1, 1]):
        net = mass if i < p.mass[mass, 1] else p.ins[i]
        known = False
        for k in range(n):
            if nets[k] == net:
                known = True
        if not known:
            nets[n] = net
            n += 1
    return n


@numba.njit(cache=True, error_model="numpy")
def _span(p: Problem, s: State, nets: Ints, n: int) -> float:
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


@numba.njit(cache=True, error_model="numpy")
def _passes(p: Problem, s: State, wire: float) -> float:
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


@numba.njit(cache=True, error_model="numpy", forceinline=True)
def _away(p: Problem, s: State, a: int, b: int) -> float:
    """What masses a and b (or -1) pay for not being in their home slots or columns."""
    away = 0
    for k in range(2):
        mass = a if k == 0 else b
        if mass < 0:
            continue
        home, slot = s.home[mass, SLOT], s.mass[mass, SLOT]
        if (home >= 0 and slot != home) or (home <= COLUMN and p.slot[slot, 0] != COLUMN - home):
            away += 1
    return float(s.price[0]) * away


@numba.njit(cache=True, error_model="numpy", forceinline=True)
def _turned(s: State, side: int, home: int) -> float:
    """What it costs to change over from ``side``, when it should be at ``home`` (-1: anywhere)."""
    if home < 0:
        return 0.0
    return float(s.price[1]) if side == home else -float(s.price[1])


@numba.njit(cache=True, error_model="numpy")
def _swap(s: State, a: int, slot: int) -> None:
    old = s.mass[a, SLOT]
    b = s.mass_at[slot]
    s.mass[a, SLOT] = slot
    s.mass_at[slot] = a
    s.mass_at[old] = b
    if b >= 0:
        s.mass[b, SLOT] = old


@numba.njit(cache=True, error_model="numpy")
def _propose(p: Problem, s: State, mass: int, random: npt.NDArray[np.uint64]) -> int:
    """A slot: mostly one near a mass that ``mass`` is coupled to, else any."""
    outs = p.mass[mass + 1, 0] - p.mass[mass, 0]
    ins = p.mass[mass + 1, 1] - p.mass[mass, 1]
    if outs + ins > 0 and _draw(random) < 0.7:
        pick = int(_draw(random) * (outs + ins))
        if pick < outs:
            friend = p.coupling[p.outs[p.mass[mass, 0] + pick], 1]
        else:
            friend = p.ins[p.mass[mass, 1] + pick - outs]
        at = s.mass[friend, SLOT]
        column = p.slot[at, 0] + int(_draw(random) * 3) - 1
        row = p.slot[at, 1] + int(_draw(random) * 7) - 3
        if 0 <= column < p.slot_at.shape[0] and 0 <= row < p.slot_at.shape[1] and p.slot_at[column, row] >= 0:
            return int(p.slot_at[column, row])
    return int(_draw(random) * len(p.slot))


@numba.njit(cache=True, error_model="numpy")
def _hard(p: Problem, s: State, tracks: Floats, all_masses: Ints) -> float:
    """The part of the cost that breaks rules, counted afresh; ``tracks`` are the channels' penalties."""
    cost = np.sum(tracks) + _span(p, s, all_masses, len(all_masses)) + _passes(p, s, 0.0)
    for channel in range(s.row.shape[0]):
        for row in range(s.row.shape[1]):
            cost += _row_cost(s.row[channel, row], p.is_open[channel, row], int(p.sizes[2]))
    for mass in range(len(s.mass)):
        if p.mass[mass, 3]:
            column, row = p.slot[s.mass[mass, SLOT], 0], p.slot[s.mass[mass, SLOT], 1]
            side = s.mass[mass, BIAS_SIDE]
            if _outside(p, column + side, row, p.hub_x[column] + (2 * side - 1) * p.sizes[3]):
                cost += HARD
    return cost


@numba.njit(cache=True, error_model="numpy")
def _troubled(p: Problem, s: State, tracks: Floats, found: Ints, seen: Ints) -> int:
    """List the masses that broken rules are about: their trunks share a band with one, or they meet a row with one."""
    n = 0
    seen[:] = 0
    for band in range(len(tracks)):
        if tracks[band] > 1e-6:
            for i in range(s.trunk_count[band]):
                n = _note(s.trunks[band, i] // 2, found, seen, n)
    for channel in range(s.row.shape[0]):
        for row in range(s.row.shape[1]):
            t = s.row[channel, row]
            if _row_cost(t, p.is_open[channel, row], int(p.sizes[2])) < 1e-6:
                continue
            for side in range(2):
                for i in range(t[VIA_A + side]):
                    n = _note(s.items[channel, row, side, i] // 4, found, seen, n)
                column = channel - 1 + side
                if 0 <= column < p.slot_at.shape[0] and p.slot_at[column, row] >= 0:
                    n = _note(s.mass_at[p.slot_at[column, row]], found, seen, n)
    return n


@numba.njit(cache=True, error_model="numpy", forceinline=True)
def _note(mass: int, found: Ints, seen: Ints, n: int) -> int:
    if mass < 0 or seen[mass]:
        return n
    seen[mass], found[n] = 1, mass
    return n + 1


@numba.njit(cache=True, error_model="numpy")
def anneal(
    p: Problem,
    s: State,
    random: npt.NDArray[np.uint64],
    moves: int,
    hot: float,
    cold: float,
    fixed: bool,
    focus: float = 0.0,
) -> float:
    """Anneal in place; ``fixed`` keeps the slots and changes sides only. Returns the cost of broken rules that is left.

    A share ``focus`` of the moves is on masses that broken rules are about.

    Ends as soon as no rule is broken, but not in the hot first half, so that wires shrink too.

    A slot move is first judged by its reach alone and only then in full (delayed acceptance), which keeps the
    stationary distribution and spares the tallies most of the hopeless moves.
    """
    masses, couplings = len(s.mass), len(p.coupling)
    nets = np.arange(max(masses, 4 * DEEP)).astype(np.int32)
    s.row[:], s.trunk_count[:] = 0, 0
    for mass in range(masses):
        nets[0] = mass
        _tally(p, s, nets, 1, mass, -1, 1)
    known = np.zeros(len(s.trunk_count))
    for channel in range(len(known)):
        s.dirty[channel] = 0
        known[channel] = _tracks(p, s, channel)
    new = known.copy()
    everyone = np.arange(masses).astype(np.int32)
    found, seen, troubled = everyone.copy(), np.zeros(masses, np.int32), 0
    for move in range(moves):
        if focus > 0 and move % REFRESH == 0:
            troubled = _troubled(p, s, known, found, seen)
        if move % 1000 == 0 and 2 * move > moves and _hard(p, s, known, everyone) < 1e-6:
            break
        heat = hot * (cold / hot) ** (move / moves)
        kind = 2
        if fixed or _draw(random) < 0.15:
            kind = 0 if couplings > 0 and _draw(random) < 0.5 else 1
        mass, other, n, coupling, slot, reach = int(_draw(random) * masses), -1, 0, 0, 0, 0.0
        focused = troubled > 0 and _draw(random) < focus
        if focused:
            mass = found[int(_draw(random) * troubled)]
        old = s.mass[mass, SLOT]
        change = 0.0
        if kind == 0:
            coupling = int(_draw(random) * couplings)
            if focused:
                coupling = p.mass[mass, 0] + int(_draw(random) * (p.mass[mass + 1, 0] - p.mass[mass, 0]))
                if coupling == p.mass[mass + 1, 0]:
                    continue
                coupling = p.outs[coupling]
            nets[0] = p.coupling[coupling, 0]
            n, mass = 1, -1
            if p.slot[s.mass[nets[0], SLOT], 0] != p.slot[s.mass[p.coupling[coupling, 1], SLOT], 0]:
                continue
            change = _turned(s, s.side[coupling], s.home[coupling, HOME_SIDE])
        elif kind == 1:
            if not p.mass[mass, 3]:
                continue
            change = _turned(s, s.mass[mass, BIAS_SIDE], s.home[mass, BIAS_SIDE])
        else:
            slot = _propose(p, s, mass, random)
            if slot == old:
                continue
            other = s.mass_at[slot]
            n = _gather(p, mass, nets, 0)
            if other >= 0:
                n = _gather(p, other, nets, n)
            reach = -_span(p, s, nets, n) - _passes(p, s, WIRE) - _away(p, s, mass, other)
            _swap(s, mass, slot)
            reach += _span(p, s, nets, n) + _passes(p, s, WIRE) + _away(p, s, mass, other)
            _swap(s, mass, old)
            if reach > 0 and _draw(random) >= math.exp(-reach / heat):
                continue
        for attempt in range(2):
            change += _tally(p, s, nets, n, mass, other, -1)
            if kind == 0:
                s.side[coupling] = 1 - s.side[coupling]
            elif kind == 1:
                s.mass[mass, BIAS_SIDE] = 1 - s.mass[mass, BIAS_SIDE]
            else:
                _swap(s, mass, slot if attempt == 0 else old)
            change += _tally(p, s, nets, n, mass, other, 1)
            if attempt == 0:
                least = change
                for channel in range(len(known)):
                    if s.dirty[channel]:
                        least -= known[channel]
                # tracks cost nothing at best: most moves are thrown out before the packing
                chance = _draw(random) if least > 0 else 2.0
                taken = least <= 0 or chance < math.exp(-least / heat)
                if taken:
                    for channel in range(len(known)):
                        if s.dirty[channel]:
                            new[channel] = _tracks(p, s, channel)
                            change += new[channel] - known[channel]
                    if change > 0 and chance > 1:
                        chance = _draw(random)
                    taken = change <= 0 or chance < math.exp(-change / heat)
            for channel in range(len(known)):
                if s.dirty[channel] and (attempt == 1 or taken):
                    s.dirty[channel] = 0
                    if taken:
                        known[channel] = new[channel]
            if taken:
                break
    return _hard(p, s, known, everyone)
