"""The placement problem as arrays for the annealing kernel: masses, couplings, slots, channels, tabs."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.grid import RESOLUTION, TabTerminal, free_intervals, holding, way
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.linkable import unrealisable

Ints = npt.NDArray[np.int32]
Floats = npt.NDArray[np.float64]

BETWEEN = 2
"""A tab whose bend lies in its net's own channel, between what hangs on the left and on the right."""


class Problem(NamedTuple):
    """Few wide tables (the kernel's compile time grows with their number).

    Attributes:
        coupling: (J, 4) source mass, target mass, whether it has a post, how many columns apart they may be.
        mass: (M + 1, 4) first entry in ``outs``, in ``ins``, in ``tab``; whether it has a bias leaf.
        outs: couplings by source. ins: driving masses by target.
        tab: (T, 4) lowest and highest row that its rung meets, row it lies in or -1, mass; ordered by mass.
        way: (T, columns, 4) from a mass in a column: channel (-1: none), first and last hub column it passes, and on
            which side of its rows it hangs (0 left, 1 right, 2 between both).
        slot: (S, 2) column, row. slot_at: (columns, rows) slot or -1.
        reach: (J,) distance of a coupling's trunk from its target hub, mm.
        hub_x: (columns,) mm.
        limits: (C, R, 4) lowest and highest x of a trunk in a row; what a tab in y leaves of the row: highest x of
            trunks that hang on the left hub, lowest of those on the right.
        is_open: (C, R) whether the channel is open from hub to hub in that row.
        sizes: distance of a source's trunk from its hub, track pitch (mm), number of rung plates, reach of bias leaves.
    """

    coupling: Ints
    mass: Ints
    outs: Ints
    ins: Ints
    tab: Ints
    way: Ints
    slot: Ints
    slot_at: Ints
    reach: Floats
    hub_x: Floats
    limits: Floats
    is_open: Ints
    sizes: Floats


def realisable(network: Network, rules: LayoutRules) -> tuple[int, ...]:
    """Indices of the couplings that some layout can hold."""
    never = unrealisable(network, rules)
    return tuple(index for index, coupling in enumerate(network.couplings) if coupling.name not in never)


def build(network: Network, lattice: Lattice, rules: LayoutRules) -> Problem:
    """The arrays for ``network`` on ``lattice``."""
    masses = {mass.name: index for index, mass in enumerate(network.masses)}
    couplings = [network.couplings[index] for index in realisable(network, rules)]
    source = np.array([masses[c.source] for c in couplings], np.int32)
    target = np.array([masses[c.target] for c in couplings], np.int32)
    posted = np.array([c.name in rules.post_offset for c in couplings], np.int32)
    apart = np.array([int(c.name not in rules.near) for c in couplings], np.int32)
    out_start, outs = _rows(source, len(masses))
    in_start, into = _rows(target, len(masses))
    tabs = sorted(lattice.tabs, key=lambda tab: masses[tab.mass])
    tab_start = np.searchsorted(np.array([masses[t.mass] for t in tabs], np.int32), np.arange(len(masses) + 1))
    biased = np.array([mass.name in rules.biases for mass in network.masses] + [False], np.int32)
    slot_at = np.full((len(lattice.column_x), len(lattice.row_y)), -1, np.int32)
    for index, (column, row) in enumerate(lattice.slots):
        slot_at[column, row] = index
    half = rules.bar_width / 2
    limits, is_open = _channels(lattice, rules)
    return Problem(
        coupling=np.stack([source, target, posted, apart], axis=1),
        mass=np.stack([out_start, in_start, tab_start.astype(np.int32), biased], axis=1),
        outs=outs,
        ins=source[into],
        tab=np.array([(*_tab(tab, lattice), masses[tab.mass]) for tab in tabs], np.int32).reshape(-1, 4),
        way=np.array([_ways(tab, len(lattice.column_x)) for tab in tabs], np.int32).reshape(
            len(tabs), len(lattice.column_x), 4
        ),
        slot=np.array(lattice.slots, np.int32),
        slot_at=slot_at,
        reach=np.array([_counted(max(rules.couplers[c.name], rules.hub_half) + half) for c in couplings]),
        hub_x=np.array(lattice.column_x),
        limits=limits,
        is_open=is_open,
        sizes=np.array(
            [
                _counted(rules.hub_half + half),
                _counted(rules.track_pitch),
                len(rules.link_plates),
                max((rules.bias_ends.get(m, r + rules.post_radius) for m, r in rules.biases.items()), default=0.0)
                - half,
            ]
        ),
    )


def _counted(length: float) -> float:
    """``length`` rounded up to what the router counts in."""
    return math.ceil(length / RESOLUTION - 1e-6) * RESOLUTION


def _rows(key: Ints, count: int) -> tuple[Ints, Ints]:
    """Compressed rows: members of each key in index order."""
    order = np.argsort(key, kind="stable").astype(np.int32)
    start = np.searchsorted(key[order], np.arange(count + 1)).astype(np.int32)
    return start, order


def _tab(tab: TabTerminal, lattice: Lattice) -> tuple[int, int, int]:
    if tab.vertical and tab.row is not None:
        return tab.row, tab.row, tab.row
    nearest = min(range(len(lattice.row_y)), key=lambda r: abs(lattice.row_y[r] - tab.y))
    rows = tab.rows or (nearest,)
    return min(rows), max(rows), -1 if tab.row is None else tab.row


def _ways(tab: TabTerminal, columns: int) -> list[tuple[int, int, int, int]]:
    ways = []
    for column in range(columns):
        found = way(tab, column)
        if found is None:
            ways.append((-1, 0, abs(column - tab.channel), 0))
        elif tab.vertical and found.channel == tab.channel:
            ways.append((found.channel, found.first, found.last, BETWEEN))
        else:
            rightwards = tab.channel > found.channel if tab.vertical else tab.outside > 0
            ways.append((found.channel, found.first, found.last, int(rightwards)))
    return ways


def _channels(lattice: Lattice, rules: LayoutRules) -> tuple[Floats, Ints]:
    """``limits`` and ``is_open`` of a Problem."""
    columns, rows = len(lattice.column_x), len(lattice.row_y)
    half = rules.bar_width / 2
    keep = rules.hub_pin_offset + rules.pin / 2 + rules.gap + half
    limits = np.zeros((columns + 1, rows, 4))
    is_open = np.zeros((columns + 1, rows), np.int32)
    for row, y in enumerate(lattice.row_y):
        spans = free_intervals(lattice.inner, y - rules.row_pitch / 2, y + rules.row_pitch / 2)
        for channel in range(columns + 1):
            left = lattice.column_x[channel - 1] if channel > 0 else None
            right = lattice.column_x[channel] if channel < columns else None
            at_left = holding(spans, left) if left is not None else None
            at_right = holding(spans, right) if right is not None else None
            low, high = at_left or at_right or (1.0, 0.0)
            is_open[channel, row] = left is None or right is None or at_left == at_right
            low, high = low + half, high - half
            if left is not None:
                low = max(low, left + keep)
            if right is not None:
                high = min(high, right - keep)
            low, high = _counted(low), -_counted(-high)
            limits[channel, row] = low, high, high, low
    pitch = _counted(rules.track_pitch)
    for tab in lattice.tabs:
        if tab.vertical:
            for row in tab.rows:
                mine = limits[tab.channel, row]
                mine[2] = min(mine[2], tab.x - pitch)
                mine[3] = max(mine[3], tab.x + pitch)
    return limits, is_open
