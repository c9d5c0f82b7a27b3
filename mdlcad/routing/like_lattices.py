"""Lattices to lay out a device on like an earlier one: the earlier lattice, or one that holds it with room to spare."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.grid import RESOLUTION, inside
from mdlcad.placement.lattice import Lattice, lattices, make_lattice, outline_at, place_ports
from mdlcad.placement.placement import Placement
from mdlcad.placement.ports import PortPlace
from mdlcad.routing.driver import STEP, Size
from mdlcad.routing.layout import Layout

MOST_LARGER = 6
"""Steps in size, of ``STEP`` each, above the earlier one."""
SHIFT = 2
"""How many columns or rows the old lattice is shifted at most to fit onto a new one."""

Slots = dict[str, tuple[int, int]]


@dataclass(frozen=True, slots=True)
class Site:
    """A lattice and what an earlier build has on it.

    Attributes:
        slots: where its masses have their places here; those without one are left out.
        layout: its routing, moved along; without trunks where columns stand at other distances.
    """

    lattice: Lattice
    slots: Slots
    layout: Layout


def sites(
    network: Network,
    boundary: tuple[tuple[int, int], ...],
    ports: tuple[PortPlace, ...],
    rules: LayoutRules,
    earlier: Placement,
    layout: Layout,
    size: Size,
) -> Iterator[Site]:
    """Lattices to try, the smallest first.

    At the earlier scale it is the earlier lattice. At every other scale it is first the earlier lattice with what rows
    and columns there is room for around it, which lets routes stay too; then the one of that scale that is most like
    it, whose channels may be wider (two of them, if today's units are too large for the earlier lattice).

    Args:
        earlier, layout: what is to be alike, under the network's names.
    """
    most = size.most(boundary) + 1e-9
    scale = earlier.mm_per_grid
    old = {unit.mass: (unit.column, unit.row) for unit in earlier.masses}
    need = len(network.masses)
    for step in range(MOST_LARGER + 1) if size.pitch is None else range(1):
        tried = size.pitch or math.floor(scale * STEP**step * 1e4 + 1e-6) / 1e4
        if tried > most:
            return
        grown = [
            site
            for site in _grown(network, boundary, ports, rules, earlier, layout, tried)
            if len(site.lattice.slots) >= need
        ]
        yield from grown
        if grown and tried == scale:
            continue
        choices = lattices(boundary, place_ports(network, ports, tried), rules, tried, need)
        found = [_shifted(lattice, old, earlier, layout) for lattice in choices]
        found.sort(key=lambda site: _unlike(site, earlier))
        yield from found[: 1 if grown else 2]


def _unlike(site: Site, earlier: Placement) -> tuple[int, int, int]:
    """How a lattice ranks: by the slots that it lacks, then by its columns and rows."""
    columns, rows = len(site.lattice.column_x), len(site.lattice.row_y)
    return -len(site.slots), abs(columns - len(earlier.column_x)), abs(rows - len(earlier.row_y))


def _grown(
    network: Network,
    boundary: tuple[tuple[int, int], ...],
    ports: tuple[PortPlace, ...],
    rules: LayoutRules,
    earlier: Placement,
    layout: Layout,
    scale: float,
) -> Iterator[Site]:
    """The columns and rows of the earlier build in the boundary at ``scale``, with as many more of the same pitch as
    there is room for: in the middle of it, at its lower and at its upper edge. None if they stand too close for today's
    units.

    From the middle the least of the ports leave their rows; at an edge the outermost row there stays the outermost,
    from which the tabs of that wall leave, and all the room is in one place.
    """
    if any(b - a < rules.column_pitch - 1e-6 for a, b in pairwise(earlier.column_x)):
        return
    if any(b - a < rules.row_pitch - 1e-6 for a, b in pairwise(earlier.row_y)):
        return
    outline = outline_at(boundary, scale)
    inner = inside(outline, rules)
    if inner.is_empty:
        return
    x_low, y_low, x_high, y_high = inner.bounds
    more = (scale - earlier.mm_per_grid) / 2
    dx = round(more * (min(x for x, _ in boundary) + max(x for x, _ in boundary)) / RESOLUTION) * RESOLUTION
    half = rules.row_pitch / 2
    left, column_x = _extended(
        earlier.column_x, rules.column_pitch, dx, x_low + rules.unit_left, x_high - rules.unit_right
    )
    middle = more * (min(y for _, y in boundary) + max(y for _, y in boundary))
    edges = (y_low + half - earlier.row_y[0], y_high - half - earlier.row_y[-1])
    done: set[tuple[int, int]] = set()
    for dy in (middle, *edges) if scale > earlier.mm_per_grid else (middle,):
        below, row_y = _extended(earlier.row_y, rules.row_pitch, dy, y_low + half, y_high - half)
        if (below, len(row_y)) in done:
            continue
        done.add((below, len(row_y)))
        lattice = make_lattice(outline, scale, inner, column_x, row_y, place_ports(network, ports, scale), rules)
        there = set(lattice.slots)
        slots = {unit.mass: (unit.column + left, unit.row + below) for unit in earlier.masses}
        moved = replace(layout, trunks=tuple(replace(trunk, x=trunk.x + dx) for trunk in layout.trunks))
        yield Site(lattice, {mass: slot for mass, slot in slots.items() if slot in there}, moved)


def _extended(
    at: tuple[float, ...], pitch: float, shift: float, low: float, high: float
) -> tuple[int, tuple[float, ...]]:
    """Places ``at`` shifted, with as many before and behind them, ``pitch`` apart, as there is room for in low..high
    (mm); and how many there are before."""
    first, last = at[0] + shift, at[-1] + shift
    before = max(0, int((first - low) / pitch + 1e-6))
    behind = max(0, int((high - last) / pitch + 1e-6))
    places = [first - k * pitch for k in range(before, 0, -1)]
    places += [x + shift for x in at]
    places += [last + k * pitch for k in range(1, behind + 1)]
    return before, tuple(round(place, 6) for place in places)


def _shifted(lattice: Lattice, old: Slots, earlier: Placement, layout: Layout) -> Site:
    """The old slots on another lattice, shifted by whole columns and rows so that most of them are slots there."""
    there = set(lattice.slots)
    best: tuple[tuple[float, ...], Slots] | None = None
    for dc in range(-SHIFT, SHIFT + 1):
        for dr in range(-SHIFT, SHIFT + 1):
            slots = {mass: (c + dc, r + dr) for mass, (c, r) in old.items() if (c + dc, r + dr) in there}
            far = sum(
                abs(lattice.column_x[c] / lattice.mm_per_grid - earlier.column_x[c - dc] / earlier.mm_per_grid)
                + abs(lattice.row_y[r] / lattice.mm_per_grid - earlier.row_y[r - dr] / earlier.mm_per_grid)
                for c, r in slots.values()
            )
            rank = (-len(slots), far, dc, dr)
            if best is None or rank < best[0]:
                best = rank, slots
    assert best is not None
    return Site(lattice, best[1], replace(layout, trunks=()))
