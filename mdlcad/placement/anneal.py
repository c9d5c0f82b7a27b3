"""Simulated annealing of slots, channel sides and bias sides: a compiled kernel with exact incremental costs."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from mdlcad.compiled import inlined, kernel, part
from mdlcad.placement.chance import draw
from mdlcad.placement.costs import BIAS_SIDE, PUT, SLOT, TAKEN, WIRE, hard_cost, passes, row_cost, span, tally
from mdlcad.placement.problem import Floats, Ints, Problem
from mdlcad.placement.state import COLUMN, State
from mdlcad.placement.tracks import track_cost

HOME_SIDE = 2
"""Column of State.home: the channel side that a coupling should keep."""
NEAR = (2, 24)
"""How many columns and rows away from its own slot a mass is tried, where packing is careful."""
EVERYWHERE = np.array([-1, 0, 0], np.int32)
BESIDE = 4
"""Rows above and below a trunk without a track, or a row, whose trunks may be to blame."""
ASIDE = 12
"""Rows above and below a spot to which its trouble may be pushed aside, as into the channels beside its own."""
REFRESH = 500
"""Moves after which the masses that broken rules are about are listed anew."""


@part
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


@inlined
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


@inlined
def _turned(s: State, side: int, home: int) -> float:
    """What it costs to change over from ``side``, when it should be at ``home`` (-1: anywhere)."""
    if home < 0:
        return 0.0
    return float(s.price[1]) if side == home else -float(s.price[1])


@part
def _swap(s: State, a: int, slot: int) -> None:
    old = s.mass[a, SLOT]
    b = s.mass_at[slot]
    s.mass[a, SLOT] = slot
    s.mass_at[slot] = a
    s.mass_at[old] = b
    if b >= 0:
        s.mass[b, SLOT] = old


@part
def _propose(p: Problem, s: State, mass: int, random: npt.NDArray[np.uint64]) -> int:
    """A slot: mostly one near a mass that ``mass`` is coupled to, else any."""
    outs = p.mass[mass + 1, 0] - p.mass[mass, 0]
    ins = p.mass[mass + 1, 1] - p.mass[mass, 1]
    if outs + ins > 0 and draw(random) < 0.7:
        pick = int(draw(random) * (outs + ins))
        if pick < outs:
            friend = p.coupling[p.outs[p.mass[mass, 0] + pick], 1]
        else:
            friend = p.ins[p.mass[mass, 1] + pick - outs]
        at = s.mass[friend, SLOT]
        column = p.slot[at, 0] + int(draw(random) * 3) - 1
        row = p.slot[at, 1] + int(draw(random) * 7) - 3
        if 0 <= column < p.slot_at.shape[0] and 0 <= row < p.slot_at.shape[1] and p.slot_at[column, row] >= 0:
            return int(p.slot_at[column, row])
    if s.careful[0]:
        # far from where it is, a mass of a large network has no business
        at = s.mass[mass, SLOT]
        column = p.slot[at, 0] + int(draw(random) * (2 * NEAR[0] + 1)) - NEAR[0]
        row = p.slot[at, 1] + int(draw(random) * (2 * NEAR[1] + 1)) - NEAR[1]
        inside = 0 <= column < p.slot_at.shape[0] and 0 <= row < p.slot_at.shape[1] and p.slot_at[column, row] >= 0
        return int(p.slot_at[column, row] if inside else at)
    return int(draw(random) * len(p.slot))


@part
def _beside(s: State, band: int, low: int, high: int, found: Ints, seen: Ints, n: int) -> int:
    """List the masses whose trunks in a band meet rows low..high."""
    for i in range(s.trunk_count[band]):
        net = s.trunks[band, i]
        if s.rows[net, 0] <= high and low <= s.rows[net, 1]:
            n = _note(net // 2, found, seen, n)
    return n


@part
def _troubled(p: Problem, s: State, tracks: Floats, spot: Ints, found: Ints, seen: Ints) -> int:
    """List the masses that broken rules are about: their trunks stand beside one without
    a track, or they meet a row with one.

    Around rows spot[1]..spot[2] of channel spot[0], or everywhere if that is -1.
    """
    n, only, bands = 0, spot[0], len(tracks) // s.row.shape[0]
    first, last = (spot[1] - ASIDE, spot[2] + ASIDE) if only >= 0 else (0, s.row.shape[1] - 1)
    seen[:] = 0
    for band in range(len(tracks)):
        if tracks[band] <= 1e-6 or (only >= 0 and abs(band // bands - only) > 1):
            continue
        track_cost(p, s, band)  # to know which of its trunks are late
        for i in range(s.trunk_count[band]):
            net = s.trunks[band, i]
            if s.late[i] and s.rows[net, 0] <= last and first <= s.rows[net, 1]:
                n = _beside(s, band, s.rows[net, 0] - BESIDE, s.rows[net, 1] + BESIDE, found, seen, n)
    for channel in range(s.row.shape[0]):
        if only >= 0 and abs(channel - only) > 1:
            continue
        for row in range(max(0, first), min(s.row.shape[1], last + 1)):
            t = s.row[channel, row]
            if row_cost(t, p.is_open[channel, row], int(p.sizes[2])) < 1e-6:
                continue
            size = -(-s.row.shape[1] // bands)
            n = _beside(s, channel * bands + row // size, row - BESIDE, row + BESIDE, found, seen, n)
            for side in range(2):
                column = channel - 1 + side
                if 0 <= column < p.slot_at.shape[0] and p.slot_at[column, row] >= 0:
                    n = _note(s.mass_at[p.slot_at[column, row]], found, seen, n)
    for tab in range(len(p.tab)):
        way = p.way[tab, p.slot[s.mass[p.tab[tab, 3], SLOT], 0]]
        for column in range(way[1], way[2] + 1 if way[0] >= 0 else way[1]):
            if only >= 0 and abs(column - only) > 1:
                continue
            for row in range(max(first, p.tab[tab, 0]), min(last, p.tab[tab, 1]) + 1):
                slot = p.slot_at[column, row]
                if slot >= 0 and s.mass_at[slot] >= 0:
                    n = _note(s.mass_at[slot], found, seen, _note(p.tab[tab, 3], found, seen, n))
    return n


@inlined
def _note(mass: int, found: Ints, seen: Ints, n: int) -> int:
    if mass < 0 or seen[mass]:
        return n
    seen[mass], found[n] = 1, mass
    return n + 1


@part
def _counted(p: Problem, s: State, nets: Ints) -> Floats:
    """Tally everything afresh; what the trunks of every band cost."""
    s.row[:], s.trunk_count[:] = 0, 0
    for mass in range(len(s.mass)):
        nets[0] = mass
        tally(p, s, nets, PUT[0], mass, TAKEN[0], PUT[0])
    known = np.zeros(len(s.trunk_count))
    for band in range(len(known)):
        s.dirty[band] = 0
        known[band] = track_cost(p, s, band)
    s.marked[0], s.marked[1] = len(known), 0
    return known


@kernel
def trouble(p: Problem, s: State) -> Ints:
    """(N, 3) channel, first and last row of all that breaks rules, by channel: trunks without a track, rows, and masses
    in the way of tabs, the last of each, by the channel left of them."""
    nets = np.arange(len(s.mass)).astype(np.int32)
    known = _counted(p, s, nets)
    channels, rows = s.row.shape[0], s.row.shape[1]
    spots, n = np.zeros((np.sum(s.trunk_count) + channels * rows + len(p.tab), 3), np.int32), 0
    blocked = np.full((len(p.tab), 2), -1, np.int32)
    for tab in range(len(p.tab)):
        way = p.way[tab, p.slot[s.mass[p.tab[tab, 3], SLOT], 0]]
        for column in range(way[1], way[2] + 1 if way[0] >= 0 else way[1]):
            for row in range(p.tab[tab, 0], p.tab[tab, 1] + 1):
                if p.slot_at[column, row] >= 0 and s.mass_at[p.slot_at[column, row]] >= 0:
                    blocked[tab, 0], blocked[tab, 1] = column, row
    for channel in range(channels):
        bands = len(known) // channels
        for band in range(channel * bands, (channel + 1) * bands):
            if known[band] > 1e-6:
                track_cost(p, s, band)
                for i in range(s.trunk_count[band]):
                    if s.late[i]:
                        net = s.trunks[band, i]
                        spots[n, 0], spots[n, 1], spots[n, 2] = channel, s.rows[net, 0], s.rows[net, 1]
                        n += 1
        for row in range(rows):
            if row_cost(s.row[channel, row], p.is_open[channel, row], int(p.sizes[2])) > 1e-6:
                spots[n, 0], spots[n, 1], spots[n, 2] = channel, row, row
                n += 1
        for tab in range(len(p.tab)):
            if blocked[tab, 0] == channel:
                spots[n, 0], spots[n, 1], spots[n, 2] = channel, blocked[tab, 1], blocked[tab, 1]
                n += 1
    return spots[:n]


@kernel
def anneal_at(
    p: Problem,
    s: State,
    random: npt.NDArray[np.uint64],
    moves: int,
    hot: float,
    cold: float,
    fixed: bool,
    focus: float,
    spot: Ints,
) -> float:
    """Anneal in place; ``fixed`` keeps the slots and changes sides only. Returns the cost of broken rules that is left.

    A share ``focus`` of the moves is on masses that broken rules are about; of rows spot[1]..spot[2] of channel
    spot[0] alone, if that is not -1, and then it ends when nothing there breaks one.

    Ends as soon as no rule is broken, but not in the hot first half, so that wires shrink too.

    A slot move is first judged by its reach alone and only then in full (delayed acceptance), which keeps the
    stationary distribution and spares the tallies most of the hopeless moves.
    """
    masses, couplings = len(s.mass), len(p.coupling)
    nets = np.arange(masses).astype(np.int32)
    known = _counted(p, s, nets)
    new = known.copy()
    everyone = np.arange(masses).astype(np.int32)
    found, seen, troubled = everyone.copy(), np.zeros(masses, np.int32), 0
    for move in range(moves):
        if focus > 0 and move % REFRESH == 0:
            troubled = _troubled(p, s, known, spot, found, seen)
            if spot[0] >= 0 and troubled == 0:
                break
        if move % 1000 == 0 and 2 * move > moves and hard_cost(p, s, known, everyone) < 1e-6:
            break
        heat = hot * (cold / hot) ** (move / moves)
        kind = 2
        if fixed or draw(random) < 0.15:
            kind = 0 if couplings > 0 and draw(random) < 0.5 else 1
        mass, other, n, coupling, slot, reach = int(draw(random) * masses), -1, 0, 0, 0, 0.0
        focused = troubled > 0 and draw(random) < focus
        if focused:
            mass = found[int(draw(random) * troubled)]
        old = s.mass[mass, SLOT]
        change = 0.0
        if kind == 0:
            coupling = int(draw(random) * couplings)
            if focused:
                coupling = p.mass[mass, 0] + int(draw(random) * (p.mass[mass + 1, 0] - p.mass[mass, 0]))
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
            reach = -span(p, s, nets, n) - passes(p, s, WIRE) - _away(p, s, mass, other)
            _swap(s, mass, slot)
            reach += span(p, s, nets, n) + passes(p, s, WIRE) + _away(p, s, mass, other)
            _swap(s, mass, old)
            if reach > 0 and draw(random) >= math.exp(-reach / heat):
                continue
        for attempt in range(2):
            change += tally(p, s, nets, n, mass, other, TAKEN[0])
            if kind == 0:
                s.side[coupling] = 1 - s.side[coupling]
            elif kind == 1:
                s.mass[mass, BIAS_SIDE] = 1 - s.mass[mass, BIAS_SIDE]
            else:
                _swap(s, mass, slot if attempt == 0 else old)
            change += tally(p, s, nets, n, mass, other, PUT[0])
            if attempt == 0:
                least = change
                for channel in range(s.marked[0], s.marked[1]):
                    if s.dirty[channel]:
                        least -= known[channel]
                # tracks cost nothing at best: most moves are thrown out before the packing
                chance = draw(random) if least > 0 else 2.0
                taken = least <= 0 or chance < math.exp(-least / heat)
                if taken:
                    for channel in range(s.marked[0], s.marked[1]):
                        if s.dirty[channel]:
                            new[channel] = track_cost(p, s, channel)
                            change += new[channel] - known[channel]
                    if change > 0 and chance > 1:
                        chance = draw(random)
                    taken = change <= 0 or chance < math.exp(-change / heat)
            for channel in range(s.marked[0], s.marked[1]):
                if s.dirty[channel] and (attempt == 1 or taken):
                    s.dirty[channel] = 0
                    if taken:
                        known[channel] = new[channel]
            if taken:
                break
        s.marked[0], s.marked[1] = len(known), 0
    return hard_cost(p, s, known, everyone)


def anneal(
    problem: Problem,
    state: State,
    random: npt.NDArray[np.uint64],
    moves: int,
    hot: float,
    cold: float,
    fixed: bool,
    focus: float = 0.0,
    spot: Ints = EVERYWHERE,
) -> float:
    """``anneal_at`` everywhere, but for what ``focus`` and ``spot`` say."""
    return float(anneal_at(problem, state, random, moves, hot, cold, fixed, focus, spot))
