"""Simulated annealing of slots, channel sides and bias sides: a compiled kernel with exact incremental costs."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from mdlcad.compiled import inlined, kernel, part
from mdlcad.placement.chance import draw
from mdlcad.placement.costs import BIAS_SIDE, PUT, SLOT, TAKEN, VIA_A, WIRE, hard_cost, passes, row_cost, span, tally
from mdlcad.placement.problem import Floats, Ints, Problem
from mdlcad.placement.state import COLUMN, DEEP, State
from mdlcad.placement.tracks import track_cost

HOME_SIDE = 2
"""Column of State.home: the channel side that a coupling should keep."""
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
    return int(draw(random) * len(p.slot))


@part
def _troubled(p: Problem, s: State, tracks: Floats, only: int, found: Ints, seen: Ints) -> int:
    """List the masses that broken rules are about: their trunks share a band with one, or they meet a row with one.

    Of channel ``only``, or of all channels and tabs if that is -1.
    """
    n = 0
    seen[:] = 0
    bands = len(tracks) // s.row.shape[0]
    for band in range(len(tracks)):
        if tracks[band] > 1e-6 and (only < 0 or band // bands == only):
            for i in range(s.trunk_count[band]):
                n = _note(s.trunks[band, i] // 2, found, seen, n)
    for channel in range(s.row.shape[0]):
        if only >= 0 and channel != only:
            continue
        for row in range(s.row.shape[1]):
            t = s.row[channel, row]
            if row_cost(t, p.is_open[channel, row], int(p.sizes[2])) < 1e-6:
                continue
            for side in range(2):
                for i in range(t[VIA_A + side]):
                    n = _note(s.items[channel, row, side, i] // 4, found, seen, n)
                column = channel - 1 + side
                if 0 <= column < p.slot_at.shape[0] and p.slot_at[column, row] >= 0:
                    n = _note(s.mass_at[p.slot_at[column, row]], found, seen, n)
    for tab in range(len(p.tab) if only < 0 else 0):
        way = p.way[tab, p.slot[s.mass[p.tab[tab, 3], SLOT], 0]]
        for column in range(way[1], way[2] + 1 if way[0] >= 0 else way[1]):
            for row in range(p.tab[tab, 0], p.tab[tab, 1] + 1):
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
    return known


@kernel
def channel_costs(p: Problem, s: State) -> Floats:
    """What the broken rules of every channel cost: of its trunks and its rows."""
    nets = np.arange(max(len(s.mass), 4 * DEEP)).astype(np.int32)
    known = _counted(p, s, nets)
    costs = np.zeros(s.row.shape[0])
    for channel in range(len(costs)):
        bands = len(known) // len(costs)
        costs[channel] = np.sum(known[channel * bands : (channel + 1) * bands])
        for row in range(s.row.shape[1]):
            costs[channel] += row_cost(s.row[channel, row], p.is_open[channel, row], int(p.sizes[2]))
    return costs


@kernel
def anneal(
    p: Problem,
    s: State,
    random: npt.NDArray[np.uint64],
    moves: int,
    hot: float,
    cold: float,
    fixed: bool,
    focus: float = 0.0,
    only: int = -1,
) -> float:
    """Anneal in place; ``fixed`` keeps the slots and changes sides only. Returns the cost of broken rules that is left.

    A share ``focus`` of the moves is on masses that broken rules are about; of channel ``only``, if that is not -1, and
    then it ends when that channel has none.

    Ends as soon as no rule is broken, but not in the hot first half, so that wires shrink too.

    A slot move is first judged by its reach alone and only then in full (delayed acceptance), which keeps the
    stationary distribution and spares the tallies most of the hopeless moves.
    """
    masses, couplings = len(s.mass), len(p.coupling)
    nets = np.arange(max(masses, 4 * DEEP)).astype(np.int32)
    known = _counted(p, s, nets)
    new = known.copy()
    everyone = np.arange(masses).astype(np.int32)
    found, seen, troubled = everyone.copy(), np.zeros(masses, np.int32), 0
    for move in range(moves):
        if focus > 0 and move % REFRESH == 0:
            troubled = _troubled(p, s, known, only, found, seen)
            if only >= 0 and troubled == 0:
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
                for channel in range(len(known)):
                    if s.dirty[channel]:
                        least -= known[channel]
                # tracks cost nothing at best: most moves are thrown out before the packing
                chance = draw(random) if least > 0 else 2.0
                taken = least <= 0 or chance < math.exp(-least / heat)
                if taken:
                    for channel in range(len(known)):
                        if s.dirty[channel]:
                            new[channel] = track_cost(p, s, channel)
                            change += new[channel] - known[channel]
                    if change > 0 and chance > 1:
                        chance = draw(random)
                    taken = change <= 0 or chance < math.exp(-change / heat)
            for channel in range(len(known)):
                if s.dirty[channel] and (attempt == 1 or taken):
                    s.dirty[channel] = 0
                    if taken:
                        known[channel] = new[channel]
            if taken:
                break
    return hard_cost(p, s, known, everyone)
