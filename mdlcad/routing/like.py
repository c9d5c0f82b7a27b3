"""Place and route like an earlier build: on its lattice if that still fits, or on one a little larger."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import product

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.costs import HARD
from mdlcad.placement.keep import PRICES, place_kept
from mdlcad.placement.placement import PlacedMass, Placement
from mdlcad.placement.ports import PortPlace
from mdlcad.routing.driver import SMALLEST, Size
from mdlcad.routing.earlier import Earlier, kept_of, under_new_names
from mdlcad.routing.jam import JamError
from mdlcad.routing.judge import Judge, no_objection
from mdlcad.routing.keep import Keeper
from mdlcad.routing.layout import Layout
from mdlcad.routing.like_lattices import Slots, sites
from mdlcad.routing.router import route

MOST_MOVED = 0.1
"""Share of the masses that did not change themselves that may move before a larger lattice is looked at."""
SEEDS = 3
"""Placements to try at each price of a move on each lattice: legal tracks do not make every one routable."""
FAR = 3 * HARD
"""A placement that is left with more than this is not worth another seed."""


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

    Masses that changed themselves (other inputs, another bias or phase) have to go where their new couplings reach, so
    it is the others that count. The first way that moves at most ``MOST_MOVED`` of them is taken; if there is none, the
    one that moves the fewest. Same arguments, same result.

    Args:
        boundary: vertices on the grid, clockwise. ports: places in grid units.
        earlier: under its own names. progress, judge, size: as for ``place_and_route``.
    """
    tell = progress or (lambda line: None)
    before = under_new_names(earlier, network)
    now = {mass.name for mass in network.masses}
    still = replace(before.placement, masses=tuple(unit for unit in before.placement.masses if unit.mass in now))
    best: tuple[int, Placement, Layout] | None = None
    for site in sites(network, boundary, ports, rules, still, before.layout, size):
        kept = kept_of(before, network, site.slots)
        firm = [unit.mass for unit in still.masses if unit.mass not in kept.changed]
        scale = f"{site.lattice.mm_per_grid:.3f} mm per grid unit"
        tried: list[tuple[PlacedMass, ...]] = []
        hopeless: set[float] = set()
        for price, offset in product(PRICES, range(SEEDS)):
            if price in hopeless:
                continue
            result = place_kept(network, site.lattice, rules, kept, price, seed + offset)
            moved = _count_moved(firm, site.slots, result.placement)
            words = f"{moved} of {len(firm)} unchanged masses moved"
            if result.cost > 0:
                tell(f"{scale}: {words}, about {math.ceil(result.cost / HARD)} conflicts left")
                hopeless |= {price} if result.cost > FAR else set()
                continue
            seats = result.placement.masses
            if seats in tried or (best is not None and moved >= best[0]):
                continue
            tried.append(seats)
            routed = _routed(network, result.placement, rules, seed + offset, judge, Keeper(site.layout, kept))
            tell(f"{scale}: {words}, {'not ' if routed is None else ''}routed")
            if routed is None:
                continue
            best = moved, result.placement, routed
            if moved <= MOST_MOVED * len(firm):
                return best[1:]
    return None if best is None else best[1:]


def _routed(
    network: Network, placement: Placement, rules: LayoutRules, seed: int, judge: Judge, keeper: Keeper
) -> Layout | None:
    """A layout with routes as they were where that can be, or with all of them free; None if there is neither."""
    for held in (keeper, None):
        try:
            return route(network, placement, rules, seed, judge, held)
        except JamError:
            continue
    return None


def _count_moved(firm: list[str], slots: Slots, placement: Placement) -> int:
    """How many of the masses ``firm`` are not in the ``slots`` that they had."""
    at = {unit.mass: (unit.column, unit.row) for unit in placement.masses}
    return sum(slots.get(mass) != at[mass] for mass in firm)
