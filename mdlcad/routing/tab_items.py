"""Tabs as items of channels: from a trunk or straight from a hub, and as guests of channels that they only pass."""

from __future__ import annotations

import math

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.placement.grid import RESOLUTION, TabTerminal, clearance, way
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.placement import PlacedMass
from mdlcad.routing.pieces import Channel, Edge, Item, Role, units


def passed_rows(tab: TabTerminal) -> tuple[int, ...]:
    """Rows whose units would be in the way of the tab's rung."""
    return tab.rows if not tab.vertical or tab.row is None else (tab.row,)


def passing_plates(lattice: Lattice, placed: dict[str, PlacedMass], rules: LayoutRules, turn: int) -> dict[str, int]:
    """A plate for every tab that passes hub columns: no two that come near on the way share one.

    The longest go highest, so that a shorter one's pin, which starts nearer to the wall, stays under it.
    """
    spans = []
    for tab in lattice.tabs:
        found = way(tab, placed[tab.mass].column)
        if found is not None and found.first <= found.last:
            ends = sorted((placed[tab.mass].x, tab.x))
            spans.append((ends[0] - ends[1], tab.bit, tab, ends))
    spans.sort(key=lambda item: item[:2])
    count = len(rules.link_plates)
    plates: dict[str, int] = {}
    taken: list[tuple[TabTerminal, list[float], int]] = []
    for _, bit, tab, ends in spans:
        near = {
            plate
            for other, reach, plate in taken
            if abs(other.y - tab.y) < clearance(rules.bar_width, rules.bar_width, rules)
            and min(reach[1], ends[1]) > max(reach[0], ends[0]) - rules.column_pitch
        }
        choices = [(count - 1 - k + turn) % count for k in range(count)]
        plates[bit] = next((plate for plate in choices if plate not in near), choices[0])
        taken.append((tab, ends, plates[bit]))
    return plates


def _rise(tab: TabTerminal, rules: LayoutRules) -> tuple[int, int, float, float] | None:
    """The vertical part of a tab in y."""
    if not tab.vertical:
        return None
    half, bar, bend = rules.bar_width / 2, units(rules.bar_width / 2), round(tab.x / RESOLUTION)
    tip = tab.path[-1][1]
    return bend - bar, bend + bar, min(tab.y - half, tip), max(tab.y + half, tip)


def _outer(tab: TabTerminal, rules: LayoutRules) -> float:
    """The x that a tab's bar reaches at its far end: the tip, or the far edge of the bend."""
    if not tab.vertical:
        return tab.path[1][0]
    return tab.x


def guest(tab: TabTerminal, hub_x: float, plate: int, rules: LayoutRules) -> Item:
    """The part of a tab that lies in a channel which its net does not use: from a hub column on."""
    half, bar = rules.bar_width / 2, rules.bar_width / 2 if tab.vertical else 0.0
    low, high = sorted((hub_x, _outer(tab, rules)))
    return Item(
        Role.GUEST,
        tab.mass,
        tab.bit,
        (),
        tab.y - half,
        tab.y + half,
        Edge(math.floor((low - bar) / RESOLUTION + 1e-6)),
        Edge(units(high + bar)),
        plate=plate,
        rises=_rise(tab, rules),
    )


def straight_tab(
    channel: Channel, source: PlacedMass, side: int, tab: TabTerminal, plates: dict[str, int], rules: LayoutRules
) -> None:
    """A tab whose rung starts at its mass's own hub, added to ``channel``."""
    half, bar = rules.hub_height / 2, rules.bar_width / 2 if tab.vertical else 0.0
    sign = 1 if side == 1 else -1
    low, high = sorted((source.x, _outer(tab, rules) + sign * bar))
    channel.items.append(
        Item(
            Role.STRAIGHT_TAB,
            source.mass,
            tab.bit,
            ((source.mass, side),),
            source.y - half,
            source.y + half,
            Edge(math.floor(low / RESOLUTION + 1e-6)),
            Edge(units(high)),
            plate=plates.get(tab.bit),
            rises=_rise(tab, rules),
        )
    )


def tab_item(source: PlacedMass, tab: TabTerminal, trunk: int, plates: dict[str, int], rules: LayoutRules) -> Item:
    """A tab whose rung starts at trunk ``trunk`` of its net."""
    half, bar = rules.bar_width / 2, units(rules.bar_width / 2)
    bend = round(tab.x / RESOLUTION) if tab.vertical else None
    left, right = Edge(-bar, trunk), Edge(bar, trunk)
    if not tab.vertical:
        left = left if tab.outside > 0 else Edge(math.floor(tab.path[1][0] / RESOLUTION))
        right = Edge(units(tab.path[1][0])) if tab.outside > 0 else right
    return Item(
        Role.TAB,
        source.mass,
        tab.bit,
        (),
        tab.y - half,
        tab.y + half,
        left,
        right,
        trunk=trunk,
        bend=bend,
        plate=plates.get(tab.bit),
        rises=_rise(tab, rules),
    )
