"""Place and route like an earlier build: on its lattice if that still fits, or on one a little larger."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise, product

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.anneal import HARD
from mdlcad.placement.grid import inside
from mdlcad.placement.keep import PRICES, place_kept
from mdlcad.placement.lattice import Lattice, lattices, make_lattice, outline_at, place_ports
from mdlcad.placement.placement import Placement
from mdlcad.placement.ports import PortPlace
from mdlcad.routing.driver import SMALLEST, STEP, Size
from mdlcad.routing.earlier import Earlier, kept_of, under_new_names
from mdlcad.routing.jam import JamError
from mdlcad.routing.judge import Judge, no_objection
from mdlcad.routing.keep import Keeper
from mdlcad.routing.layout import Layout
from mdlcad.routing.router import route

MOST_MOVED = 0.1
"""Share of the kept masses that may move before a larger lattice is looked at."""
MOST_LARGER = 6
"""Steps in size, of ``STEP`` each, above the earlier one."""
SAME_TRIES = 3
"""Seeds to try at each price on the earlier lattice."""
SHIFT = 2
"""How many columns or rows the old lattice is shifted at most to fit onto a new one."""

Slots = dict[str, tuple[int, int]]


@dataclass(frozen=True, slots=True)
class _Site:
    """A lattice, and the slots on it that the kept masses have their places in; ``same`` if it is the earlier one."""

    lattice: Lattice
    slots: Slots
    same: bool


def place_and_route_like(
    network: Network,
    boundary: tuple[tuple[int, int], ...],
    ports: tuple[PortPlace, ...],
    rules: LayoutRules,
    seed: int,
    earlier: Earlier,
    progress: Callable[[str], None] | None = None,
    judge: Judge = no_objection,
    size: Size = SMALLEST,
) -> tuple[Placement, Layout] | None:
    """Place and route with as much as possible where ``earlier`` had it; None if nothing like it can be routed.

    The first way that moves at most ``MOST_MOVED`` of the kept masses is taken; if there is none, the one that moves
    the fewest. Same arguments, same result.

    Args:
        boundary: vertices on the grid, clockwise. ports: places in grid units.
        earlier: under its own names. progress, judge, size: as for ``place_and_route``.
    """
    tell = progress or (lambda line: None)
    before = under_new_names(earlier, network)
    now = {mass.name for mass in network.masses}
    old = {unit.mass: (unit.column, unit.row) for unit in before.placement.masses if unit.mass in now}
    best: tuple[int, Placement, Layout] | None = None
    for site in _sites(network, boundary, ports, rules, before, old, size):
        kept = kept_of(before, network, site.slots)
        layout = before.layout if site.same else replace(before.layout, trunks=())
        tried: list[Placement] = []
        for price, offset in product(PRICES, range(SAME_TRIES if site.same else 1)):
            result = place_kept(network, site.lattice, rules, kept, price, seed + offset)
            moved = len(old) - len(site.slots) + _count_moved(site.slots, result.placement)
            conflicts = round(result.cost / HARD)
            words = f"{moved} of {len(old)} kept masses moved, about {conflicts} conflicts left"
            tell(f"{site.lattice.mm_per_grid:.3f} mm per grid unit: {words}")
            if result.cost > 0 or result.placement in tried or (best is not None and moved >= best[0]):
                continue
            tried.append(result.placement)
            try:
                routed = route(network, result.placement, rules, seed, judge, Keeper(layout, kept))
            except JamError:
                continue
            best = moved, result.placement, routed
            if moved <= MOST_MOVED * len(old):
                return best[1:]
    return None if best is None else best[1:]


def _count_moved(slots: Slots, placement: Placement) -> int:
    """How many masses are not in the ``slots`` that they should be in."""
    now = {unit.mass: (unit.column, unit.row) for unit in placement.masses}
    return sum(now.get(mass, slot) != slot for mass, slot in slots.items())


def _sites(
    network: Network,
    boundary: tuple[tuple[int, int], ...],
    ports: tuple[PortPlace, ...],
    rules: LayoutRules,
    before: Earlier,
    old: Slots,
    size: Size,
) -> Iterator[_Site]:
    """Lattices to try: the earlier one, then others of its scale and of larger ones, the most alike first."""
    most = size.most(boundary) + 1e-9
    scale = before.placement.mm_per_grid
    need = len(network.masses)
    if (size.pitch is None and scale <= most) or size.pitch == scale:
        lattice = _earlier_lattice(network, boundary, ports, rules, before.placement)
        if lattice is not None and len(lattice.slots) >= need:
            yield _Site(lattice, old, True)
    steps = range(MOST_LARGER + 1) if size.pitch is None else range(1)
    for step in steps:
        tried = size.pitch or math.floor(scale * STEP**step * 1e4 + 1e-6) / 1e4
        if tried > most:
            return
        choices = lattices(boundary, place_ports(network, ports, tried), rules, tried, need)
        sites = [_shifted(lattice, old, before.placement) for lattice in choices]
        ranks = sorted(
            (-len(site.slots), abs(len(site.lattice.row_y) - len(before.placement.row_y)), index)
            for index, site in enumerate(sites)
        )
        for _, _, index in ranks[:1]:
            yield sites[index]


def _earlier_lattice(
    network: Network,
    boundary: tuple[tuple[int, int], ...],
    ports: tuple[PortPlace, ...],
    rules: LayoutRules,
    placement: Placement,
) -> Lattice | None:
    """The columns and rows of the earlier build in the boundary of today; None if they stand too close now."""
    column_x, row_y, scale = placement.column_x, placement.row_y, placement.mm_per_grid
    if any(b - a < rules.column_pitch - 1e-6 for a, b in pairwise(column_x)):
        return None
    if any(b - a < rules.row_pitch - 1e-6 for a, b in pairwise(row_y)):
        return None
    outline = outline_at(boundary, scale)
    inner = inside(outline, rules)
    if inner.is_empty:
        return None
    return make_lattice(outline, scale, inner, column_x, row_y, place_ports(network, ports, scale), rules)


def _shifted(lattice: Lattice, old: Slots, placement: Placement) -> _Site:
    """The old slots on another lattice, shifted by whole columns and rows so that most of them are slots there."""
    there = set(lattice.slots)
    best: tuple[tuple[float, ...], Slots] | None = None
    for dc in range(-SHIFT, SHIFT + 1):
        for dr in range(-SHIFT, SHIFT + 1):
            slots = {mass: (c + dc, r + dr) for mass, (c, r) in old.items() if (c + dc, r + dr) in there}
            far = sum(
                abs(lattice.column_x[c] / lattice.mm_per_grid - placement.column_x[c - dc] / placement.mm_per_grid)
                + abs(lattice.row_y[r] / lattice.mm_per_grid - placement.row_y[r - dr] / placement.mm_per_grid)
                for c, r in slots.values()
            )
            rank = (-len(slots), far, dc, dr)
            if best is None or rank < best[0]:
                best = rank, slots
    assert best is not None
    return _Site(lattice, best[1], False)
