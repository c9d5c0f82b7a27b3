"""Gather every channel's pieces from a placement and the chosen sides."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mdlcad.mechanics.decks import Deck, deck_of_plate
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.grid import RESOLUTION, TabTerminal, free_intervals, holding, way
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.placement import PlacedMass, Placement
from mdlcad.placement.placer import Sides
from mdlcad.routing.pieces import Channel, Edge, Item, Role, TrunkPiece, units
from mdlcad.routing.tab_items import guest, passed_rows, passing_plates, straight_tab, tab_item


@dataclass(frozen=True, slots=True)
class _Connection:
    """One end that a net must reach in a channel: a coupling's target or a tab."""

    coupling: str | None
    target: PlacedMass | None
    tab: TabTerminal | None


def channels(
    network: Network, placement: Placement, lattice: Lattice, sides: Sides, rules: LayoutRules, turn: int
) -> tuple[Channel, ...]:
    """The pieces of every channel, left to right; ``turn`` varies the plates of tabs that pass hub columns."""
    placed = {item.mass: item for item in placement.masses}
    result = tuple(Channel(index) for index in range(len(placement.column_x) + 1))
    wanted: dict[tuple[str, int], list[_Connection]] = {}
    for coupling in network.couplings:
        if coupling.name in sides.couplings:
            key = (coupling.source, sides.couplings[coupling.name])
            wanted.setdefault(key, []).append(_Connection(coupling.name, placed[coupling.target], None))
    plates = passing_plates(lattice, placed, rules, turn)
    for tab in lattice.tabs:
        start = placed[tab.mass].column
        found = way(tab, start)
        if found is None:
            result[tab.channel].trouble.append(
                f"port {tab.bit}: a wall stands between its mass {tab.mass} and its place"
            )
            continue
        for blocker in placement.masses:
            if found.first <= blocker.column <= found.last and blocker.row in passed_rows(tab):
                result[found.channel].trouble.append(f"port {tab.bit}: unit {blocker.mass} is in the way of its tab")
        wanted.setdefault((tab.mass, found.channel - start), []).append(_Connection(None, None, tab))
        for index in range(found.first, found.last + 1):
            # the tab comes over hub column ``index``, into the channel on the far side
            other = index + 1 if found.channel <= found.first else index
            result[other].items.append(guest(tab, lattice.column_x[index], plates[tab.bit], rules))
    for mass in network.masses:
        for side in (0, 1):
            ends = wanted.get((mass.name, side), [])
            if ends:
                source = placed[mass.name]
                _net(result[source.column + side], source, side, ends, lattice, rules, plates)
        if mass.name in sides.biases:
            _bias(result[placed[mass.name].column + sides.biases[mass.name]], placed[mass.name], sides, lattice, rules)
    return result


def _bias(channel: Channel, hub: PlacedMass, sides: Sides, lattice: Lattice, rules: LayoutRules) -> None:
    side = sides.biases[hub.mass]
    reach, half = rules.biases[hub.mass], rules.hub_height / 2
    sign = 1 if side == 1 else -1
    post = hub.x + sign * reach
    ends = sorted((hub.x, hub.x + sign * rules.bias_ends.get(hub.mass, reach + rules.post_radius)))
    strip = free_intervals(lattice.inner, hub.y - half - rules.throw, hub.y + half + rules.throw)
    span = holding(strip, hub.x)
    if span is None or ends[0] < span[0] - 1e-6 or ends[1] > span[1] + 1e-6:
        channel.trouble.append(f"bias leaf of {hub.mass} does not fit inside the rim")
    channel.items.append(
        Item(
            Role.BIAS,
            hub.mass,
            hub.mass,
            ((hub.mass, side),),
            hub.y - half,
            hub.y + half,
            Edge(math.floor(ends[0] / RESOLUTION + 1e-6)),
            Edge(units(ends[1])),
            post=round(post / RESOLUTION),
        )
    )


def _net(
    channel: Channel,
    source: PlacedMass,
    side: int,
    ends: list[_Connection],
    lattice: Lattice,
    rules: LayoutRules,
    plates: dict[str, int],
) -> None:
    only = ends[0]
    if len(ends) == 1:
        if only.target is not None and only.target.row == source.row and only.target.column != source.column:
            return _straight(channel, source, side, only.coupling or "", only.target, lattice, rules)
        if only.tab is not None and only.tab.row == source.row:
            return straight_tab(channel, source, side, only.tab, plates, rules)
    heights = [source.y, *(end.target.y if end.target else end.tab.y if end.tab else 0.0 for end in ends)]
    domain = _domain(channel.index, source, side, ends, min(heights), max(heights), lattice, rules)
    if not domain:
        channel.trouble.append(f"net {source.mass}: no track reaches all its ends")
    trunk = len(channel.trunks)
    channel.trunks.append(TrunkPiece(source.mass, domain, min(heights), max(heights)))
    channel.items.append(_hung(Role.SOURCE, source, source.mass, source, side, trunk, None, rules))
    for end in ends:
        if end.target is not None and end.coupling is not None:
            hub_side = 1 if end.target.column < channel.index else 0
            post = None
            if end.coupling in rules.post_offset:
                sign = 1 if hub_side == 1 else -1
                post = round((end.target.x + sign * rules.post_offset[end.coupling]) / RESOLUTION)
            item = _hung(Role.COUPLER, source, end.coupling, end.target, hub_side, trunk, post, rules)
            channel.items.append(item)
        elif end.tab is not None:
            channel.items.append(tab_item(source, end.tab, trunk, plates, rules))
    return None


def _hung(
    role: Role,
    source: PlacedMass,
    ref: str,
    hub: PlacedMass,
    side: int,
    trunk: int,
    post: int | None,
    rules: LayoutRules,
) -> Item:
    """An item between a hub and a trunk; ``side`` is the hub's side (1: the trunk is at higher x)."""
    half = rules.hub_height / 2
    at, bar = round(hub.x / RESOLUTION), units(rules.bar_width / 2)
    left, right = (Edge(at), Edge(bar, trunk)) if side == 1 else (Edge(-bar, trunk), Edge(at))
    return Item(
        role,
        source.mass,
        ref,
        ((hub.mass, side),),
        hub.y - half,
        hub.y + half,
        left,
        right,
        trunk=trunk,
        post=post,
        floor=_floor(source, rules),
    )


def _floor(source: PlacedMass, rules: LayoutRules) -> int | None:
    """``Item.floor`` of what belongs to the net of ``source``."""
    bare = isinstance(source.deck, Deck) and source.deck is not deck_of_plate(rules.link_plates[0])
    return 0 if bare else None


def _straight(
    channel: Channel,
    source: PlacedMass,
    side: int,
    coupling: str,
    target: PlacedMass,
    lattice: Lattice,
    rules: LayoutRules,
) -> None:
    half = rules.hub_height / 2
    strip = free_intervals(lattice.inner, source.y - half - rules.throw, source.y + half + rules.throw)
    if holding(strip, source.x) != holding(strip, target.x):
        channel.trouble.append(f"coupling {coupling}: a wall stands between its masses")
    post = None
    if coupling in rules.post_offset:
        sign = -1 if side == 1 else 1
        post = round((target.x + sign * rules.post_offset[coupling]) / RESOLUTION)
    low, high = sorted((source.x, target.x))
    channel.items.append(
        Item(
            Role.STRAIGHT,
            source.mass,
            coupling,
            ((source.mass, side), (target.mass, 1 - side)),
            source.y - half,
            source.y + half,
            Edge(round(low / RESOLUTION)),
            Edge(round(high / RESOLUTION)),
            post=post,
            floor=_floor(source, rules),
        )
    )


def _domain(
    index: int,
    source: PlacedMass,
    side: int,
    ends: list[_Connection],
    y_low: float,
    y_high: float,
    lattice: Lattice,
    rules: LayoutRules,
) -> tuple[tuple[int, int], ...]:
    """Where the net's trunk may stand in channel ``index``: inside the walls, off the hubs, far enough for couplers."""
    bar = rules.bar_width / 2
    keep = rules.hub_pin_offset + rules.pin / 2 + rules.gap + bar
    low, high = lattice.inner.bounds[0], lattice.inner.bounds[2]
    if index > 0:
        low = max(low, lattice.column_x[index - 1] + keep)
    if index < len(lattice.column_x):
        high = min(high, lattice.column_x[index] - keep)
    off_hub = rules.hub_half + bar
    limits = [(source, side, off_hub)]
    for end in ends:
        if end.target is not None and end.coupling is not None:
            hub_side = 1 if end.target.column < index else 0
            limits.append((end.target, hub_side, max(off_hub, rules.couplers[end.coupling] + bar)))
    strips = [free_intervals(lattice.inner, y_low - bar - rules.throw, y_high + bar + rules.throw)]
    for hub, hub_side, reach in limits:
        if hub_side == 1:
            low = max(low, hub.x + reach)
        else:
            high = min(high, hub.x - reach)
        half = rules.hub_height / 2 + rules.throw
        span = holding(free_intervals(lattice.inner, hub.y - half, hub.y + half), hub.x)
        strips.append((span,) if span else ())
    pieces = [(low, high)]
    for strip in strips:
        pieces = [
            (max(a, c + bar), min(b, d - bar))
            for a, b in pieces
            for c, d in strip
            if min(b, d - bar) >= max(a, c + bar)
        ]
    counts = [(units(a), math.floor(b / RESOLUTION + 1e-6)) for a, b in pieces]
    return tuple((a, b) for a, b in counts if a <= b)
