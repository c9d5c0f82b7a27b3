"""Route a placed network as an earlier layout was routed, where that is still possible.

What a channel held before has a track and a plate to keep. If all of it can be kept, it is, and only what is new is
sought a way for; else as much as pays: a piece that keeps its way is worth ``KEPT`` of length.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ortools.sat.python import cp_model

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.grid import RESOLUTION
from mdlcad.placement.keep import Kept, keep_sides
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.placement import Placement
from mdlcad.placement.placer import Sides
from mdlcad.routing.channel import (
    BEST_LIMIT,
    FIRST_LIMIT,
    ChannelModel,
    ChannelRoute,
    in_mm,
    read_route,
)
from mdlcad.routing.layout import EndKind, Layout
from mdlcad.routing.pieces import Channel, Item, Role, units
from mdlcad.routing.tab_items import passing_plates
from mdlcad.solver import solver_with

KEPT = units(20.0)
"""Counts of rung length that a track or a plate may cost to stay as it was."""
_SOLVED = (cp_model.OPTIMAL, cp_model.FEASIBLE)


@dataclass(frozen=True, slots=True)
class Keeper:
    """Chooses sides and solves channels like ``layout``.

    Attributes:
        layout: the earlier layout, under the network's names.
        kept: the sides to keep.
    """

    layout: Layout
    kept: Kept

    def sides(self, network: Network, placement: Placement, lattice: Lattice, rules: LayoutRules, seed: int) -> Sides:
        """Which channel serves every coupling and bias leaf."""
        return keep_sides(network, placement, lattice, rules, self.kept, seed)

    def turns(self, placement: Placement, lattice: Lattice, rules: LayoutRules, tries: int) -> tuple[int, ...]:
        """In which order to try the plates of tabs that pass hub columns: first as they were."""
        placed = {item.mass: item for item in placement.masses}
        plates = {tab.bit: tab.plate for tab in self.layout.tabs}

        def changed(turn: int) -> tuple[int, int]:
            found = passing_plates(lattice, placed, rules, turn)
            return sum(rules.link_plates[k] != plates.get(bit) for bit, k in found.items()), turn

        return tuple(sorted(range(tries), key=changed))

    def solve(self, channel: Channel, rules: LayoutRules, seed: int) -> ChannelRoute | None:
        """Tracks and plates for ``channel``, or None if there are none (or none was found in the limit)."""
        if channel.trouble:
            return None
        if not channel.items:
            return ChannelRoute((), ())
        wish = _Wish(channel, self.layout, rules)
        return _as_before(channel, rules, seed, wish) or _mostly(channel, rules, seed, wish)


class _Wish:
    """The track (counts) of every trunk and the plate of every item as they were; None for what is new."""

    def __init__(self, channel: Channel, layout: Layout, rules: LayoutRules) -> None:
        trunks = {trunk.name: trunk for trunk in layout.trunks}
        index = {plate: k for k, plate in enumerate(rules.link_plates)}
        leaves = {leaf.coupling: leaf.plate for leaf in layout.couplers}
        biases = {leaf.mass: leaf.plate for leaf in layout.biases}
        tabs = {tab.bit: tab.plate for tab in layout.tabs}
        sources = {
            via.ref: rung.plate
            for rung in layout.rungs
            for hub, via in ((rung.left, rung.right), (rung.right, rung.left))
            if hub.kind is EndKind.HUB and via.kind is EndKind.VIA
        }
        names = {}
        for item in channel.items:
            if item.role is Role.SOURCE and item.trunk is not None:
                names[item.trunk] = f"{item.net}.{'right' if item.hubs[0][1] == 1 else 'left'}"

        def plate_of(item: Item) -> int | None:
            if item.role is Role.SOURCE:
                plate = sources.get(names.get(item.trunk if item.trunk is not None else -1, ""))
            elif item.role is Role.BIAS:
                plate = biases.get(item.net)
            elif item.role in (Role.COUPLER, Role.STRAIGHT):
                plate = leaves.get(item.ref)
            else:
                plate = tabs.get(item.ref)
            found = index.get(plate or "")
            beyond = item.ceiling is not None and found is not None and found > item.ceiling
            return None if beyond or item.plate is not None else found

        self.plates = [plate_of(item) for item in channel.items]
        self.free = any(
            plate is None and item.plate is None for plate, item in zip(self.plates, channel.items, strict=True)
        )
        self.tracks: list[int | None] = []
        for number, piece in enumerate(channel.trunks):
            old = trunks.get(names.get(number, ""))
            x = None if old is None else round(old.x / RESOLUTION)
            within = x is not None and any(low <= x <= high for low, high in piece.domain)
            self.tracks.append(x if within else None)

    def whole(self) -> bool:
        """Whether there is nothing new."""
        return None not in self.tracks and not self.free


def _as_before(channel: Channel, rules: LayoutRules, seed: int, wish: _Wish) -> ChannelRoute | None:
    """All that was there stays, and what is new finds its way; None if that cannot be."""
    model = ChannelModel(channel, rules)
    for variable, track in zip(model.x, wish.tracks, strict=True):
        if track is not None:
            model.model.add(variable == track)
    for row, plate in zip(model.plate, wish.plates, strict=True):
        if plate is not None:
            model.model.add(row[plate] == 1)
    return _shortest(model, seed, model.length()) if not wish.whole() else _any(model, seed)


def _mostly(channel: Channel, rules: LayoutRules, seed: int, wish: _Wish) -> ChannelRoute | None:
    """As much as pays stays as it was."""
    model = ChannelModel(channel, rules)
    kept: list[Any] = []
    for variable, track in zip(model.x, wish.tracks, strict=True):
        if track is not None:
            same = model.model.new_bool_var("")
            model.model.add(variable == track).only_enforce_if(same)
            model.model.add_hint(variable, track)
            kept.append(same)
    for row, plate in zip(model.plate, wish.plates, strict=True):
        if plate is not None:
            for k, literal in enumerate(row):
                model.model.add_hint(literal, k == plate)
            kept.append(row[plate])
    return _shortest(model, seed, model.length() - KEPT * sum(kept))


def _any(model: ChannelModel, seed: int) -> ChannelRoute | None:
    solver = solver_with(seed, FIRST_LIMIT)
    return in_mm(read_route(model, solver)) if solver.solve(model.model) in _SOLVED else None


def _shortest(model: ChannelModel, seed: int, cost: Any) -> ChannelRoute | None:
    """The cheapest routing that the limits allow, from the first one that is legal."""
    solver = solver_with(seed, FIRST_LIMIT)
    if solver.solve(model.model) not in _SOLVED:
        return None
    best = read_route(model, solver)
    model.model.clear_hints()
    for variable, value in zip(model.x, best[0], strict=True):
        model.model.add_hint(variable, value)
    for row, plate in zip(model.plate, best[1], strict=True):
        for k, literal in enumerate(row):
            model.model.add_hint(literal, k == plate)
    model.model.minimize(cost)
    solver = solver_with(seed, BEST_LIMIT)
    if solver.solve(model.model) in _SOLVED:
        best = read_route(model, solver)
    return in_mm(best)
