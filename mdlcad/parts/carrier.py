"""Carriers: rungs, trunks and tabs, all rigid and all moving with the shuttle of the net's source."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import shapely
from shapely import Polygon

from mdlcad.parts import palette
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.leaf import hub_block
from mdlcad.parts.shapes import GRID, box, cut, join, only, pieces, slits, square, strip
from mdlcad.parts.stack import Hub, Stack, mass_ref
from mdlcad.parts.stiffness import rung_width
from mdlcad.parts.unit import hub_pin_x
from mdlcad.routing.layout import EndKind, Rung, Side, Tab, Trunk


def rung_body(stack: Stack, hubs: Mapping[str, Hub], rung: Rung) -> Body:
    """A rung with its hub block, its via pads and the holes of its pins."""
    rules = stack.sizing.rules
    half, high_half = rules.bar_width / 2.0, rung_width(rung, rules) / 2.0
    parts: list[Polygon] = []
    holes: list[Polygon] = []
    low, high = rung.left.x, rung.right.x
    for end, side in ((rung.left, Side.RIGHT), (rung.right, Side.LEFT)):
        # a rung that starts at a hub on its left sits on that hub's right side
        if end.kind is EndKind.HUB:
            hub = hubs[end.ref]
            parts.append(hub_block(stack, hub, side))
            holes.append(square(hub_pin_x(stack, hub, side), hub.y, rules.pin))
            edge = hub.x + (rules.hub_half if side is Side.RIGHT else -rules.hub_half)
        elif end.kind is EndKind.VIA:
            holes.append(square(end.x, rung.y, rules.pin))
            edge = end.x - half if side is Side.RIGHT else end.x + half
        else:
            edge = end.x
        low, high = (edge, high) if side is Side.RIGHT else (low, edge)
    parts.append(box(low, rung.y - high_half, high, rung.y + high_half))
    section = only(cut(join(parts), holes))
    name = rung.name if rung.name.startswith("rung.") else f"rung.{rung.name}"
    moves = (mass_ref(rung.net),)
    return stack.sheet(name, BodyKind.RUNG, rung.plate, section, (0.0, rules.throw), moves, palette.RUNG)


def joined_rungs(rungs: Sequence[Body]) -> list[Body]:
    """The rungs, those of one net that lie over each other on a plate (left and right of one via) made one body."""
    groups: list[list[Body]] = []
    for rung in rungs:
        own = [
            group
            for group in groups
            if group[0].plate == rung.plate
            and group[0].moves_with == rung.moves_with
            and any(other.section.intersects(rung.section) for other in group)
        ]
        merged = [rung]
        for group in own:
            merged = group + merged
            groups.remove(group)
        groups.append(merged)
    groups.sort(key=lambda group: rungs.index(group[0]))
    return [
        group[0] if len(group) == 1 else replace(group[0], section=only(join([body.section for body in group])))
        for group in groups
    ]


def trunk_body(stack: Stack, trunk: Trunk, rungs: Sequence[Rung]) -> Body:
    """A trunk with the holes of its via pins."""
    rules = stack.sizing.rules
    half = rules.bar_width / 2.0
    bar = box(trunk.x - half, trunk.y_low - half, trunk.x + half, trunk.y_high + half)
    holes = [square(trunk.x, rung.y, rules.pin) for rung in rungs if trunk.name in via_refs(rung)]
    name = trunk.name if trunk.name.startswith("trunk.") else f"trunk.{trunk.name}"
    section = only(cut(bar, holes))
    moves = (mass_ref(trunk.net),)
    return stack.sheet(name, BodyKind.TRUNK, stack.trunk_plate, section, (0.0, rules.throw), moves, palette.TRUNK)


def via_refs(rung: Rung) -> set[str]:
    """Names of the trunks that a rung is pinned to (for membership only)."""
    return {end.ref for end in (rung.left, rung.right) if end.kind is EndKind.VIA}


def tab_body(stack: Stack, tab: Tab, carriers: Sequence[Body], rungs: Sequence[Rung]) -> Body:
    """A tab, butting against the carrier bodies of its net on its plate, with holes for pins under it.

    Raises:
        ValueError: nothing is left of it, or its own carrier cuts it in two.
    """
    rules = stack.sizing.rules
    path = list(tab.path)
    (x0, y0), (x1, y1) = path[0], path[1]
    if abs(y1 - y0) > abs(x1 - x0):
        # the rung ends in the tab's centre line: fill the corner
        path[0] = (x0, y0 - (rules.bar_width / 2.0 if y1 > y0 else -rules.bar_width / 2.0))
    ref = mass_ref(tab.net)
    beside = [body.section for body in carriers if body.plate == tab.plate and body.moves_with == (ref,)]
    own = beside + [
        square(end.x, rung.y, rules.pin)
        for rung in rungs
        if rung.net == tab.net
        for end in (rung.left, rung.right)
        if end.kind is EndKind.VIA
    ]
    left = pieces(cut(strip(path, rules.bar_width), own))
    if len(left) != 1:
        raise ValueError(f"tab {tab.bit}: its carrier leaves {len(left)} pieces of it")
    section = left[0]
    if beside:
        # between a tab and the wide part of its own rung: material, since a slit that narrow cannot be cut
        narrow = slits(section, shapely.union_all(beside, grid_size=GRID), stack.process.machine.min_gap)
        section = only(join([section, *(piece.buffer(2.0 * GRID, join_style="mitre") for piece in narrow)]))
        section = only(cut(section, own))
    throw = (0.0, rules.throw)
    return stack.sheet(f"tab.{tab.bit}", BodyKind.TAB, tab.plate, section, throw, (ref,), palette.TAB)


def tab_notch(stack: Stack, tab: Tab) -> list[Polygon]:
    """What a tab sweeps, with the gap: to be cut from the rim of its plate."""
    rules = stack.sizing.rules
    half = rules.bar_width / 2.0 + rules.gap
    found = []
    for (x0, y0), (x1, y1) in zip(tab.path, tab.path[1:], strict=False):
        reach = half + rules.throw
        found.append(box(min(x0, x1) - half, min(y0, y1) - reach, max(x0, x1) + half, max(y0, y1) + reach))
    return found
