"""One SVG of a placement and its routing, to scale: rim, units, trunks, rungs by plate, flexures, posts, tabs.

Rungs of several plates lie over each other in a row. Each plate therefore has its own lane within the row, the lowest
plate lowest, so that nothing hides anything and no plate is told by its colour alone. Hovering over a piece shows its
name and picks out its whole net. Same input, same bytes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from html import escape
from itertools import pairwise

from mdlcad.mechanics.decks import Deck, deck_of_plate
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.placement import Placement
from mdlcad.routing.decks import DeckParts, deck_parts
from mdlcad.routing.key import write_key
from mdlcad.routing.layout import EndKind, Layout, Rung, RungEnd, Side
from mdlcad.routing.pen import Pen, number, text_width
from mdlcad.routing.sheet import SHEET, Lanes

MARGIN = 14.0
PORT_TEXT, NAME_TEXT = 5.0, 3.0
ORDINARY = 300.0
"""Of a picture wider than this, mm, heading, key and port names grow along; the names of masses have only their row."""
PIXELS_A_MM = 4.0
"""Size at which a browser shows the picture; at this the smallest text is 11 pixels high."""


def draw_layout(network: Network, placement: Placement, layout: Layout, rules: LayoutRules) -> bytes:
    """The drawing, 1 mm a user unit, y up; of a device with two decks, of both side by side, the lower on the left."""
    nets = {mass.name: f"n{index}" for index, mass in enumerate(network.masses)}
    decks = deck_parts(network, placement, layout, rules)
    title = f"{network.design}: {len(network.masses)} masses, {len(network.couplings)} couplings, {_size(placement)}"
    if decks is None:
        sheets = [_sheet(network, placement, layout, rules, nets, title)]
    else:
        sheets = [
            _sheet(part.network, part.placement, part.layout, part.rules, nets, _deck_title(deck, part, placement))
            for deck, part in decks.items()
        ]
    pen, width = Pen(0.0, 0.0), 0.0
    for sheet in sheets:
        if width:
            pen.open(f'transform="translate({number(width)} 0)"')
        pen.lines += sheet.lines
        if width:
            pen.close()
        width += sheet.width
    height = max(sheet.height for sheet in sheets)
    body = "\n".join(pen.lines)
    pixels = f'width="{number(width * PIXELS_A_MM)}" height="{number(height * PIXELS_A_MM)}"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="layout" viewBox="0 0 {number(width)} {number(height)}" '
        f'{pixels} role="img" font-family="sans-serif">\n<title>{escape(title)}</title>\n'
        f"<style>{SHEET}{_net_rules(nets)}</style>\n{body}\n</svg>\n"
    ).encode()


@dataclass(frozen=True, slots=True)
class _Sheet:
    """The drawing of one deck: its elements, and its size in mm."""

    lines: tuple[str, ...]
    width: float
    height: float


def _size(placement: Placement) -> str:
    xs, ys = [x for x, _ in placement.boundary], [y for _, y in placement.boundary]
    return f"{max(xs) - min(xs):.1f} x {max(ys) - min(ys):.1f} mm"


def _deck_title(deck: Deck, part: DeckParts, placement: Placement) -> str:
    bare = sum(unit.deck is not deck for unit in part.placement.masses)
    units = len(part.placement.masses) - bare
    return f"{part.network.design}, {deck} deck: {units} units, {bare} bare hubs, {_size(placement)}"


def _sheet(
    network: Network, placement: Placement, layout: Layout, rules: LayoutRules, nets: dict[str, str], heading: str
) -> _Sheet:
    xs, ys = [x for x, _ in placement.boundary], [y for _, y in placement.boundary]
    grow = max(1.0, (max(xs) - min(xs)) / ORDINARY)
    aside = (MARGIN + max((text_width(port.bit, PORT_TEXT) for port in placement.ports), default=0.0)) * grow
    left, top = min(xs) - aside, max(ys) + (MARGIN + 12.0) * grow
    width = max(xs) - min(xs) + 2 * aside
    foot = min(ys) - (MARGIN + 4.0) * grow
    lanes = Lanes(rules)
    pen = Pen(left, top)
    pen.text(left + 4.0 * grow, top - 8.0 * grow, heading, f'class="lh" font-size="{number(6.5 * grow)}"')
    pen.polygon(placement.boundary, 'class="lb"', "boundary")
    _units(pen, network, placement, rules)
    _trunks(pen, layout, rules, nets)
    _rungs(pen, layout, rules, lanes, nets)
    _flexures(pen, network, placement, layout, rules, lanes, nets)
    _tabs(pen, layout, rules, lanes, nets)
    _hubs(pen, placement, rules, nets)
    _ports(pen, network, placement, layout, grow)
    key = Pen(0.0, 0.0)
    height = top - foot + grow * write_key(key, width / grow, grow, network, rules)
    pen.open(f'transform="translate(0 {number(top - foot)}) scale({number(grow)})"')
    pen.lines += key.lines
    pen.close()
    return _Sheet(tuple(pen.lines), width, height)


def _net_rules(nets: dict[str, str]) -> str:
    """While a piece of a net is hovered over, the pieces of all other nets fade."""
    return "".join(
        f".layout:has(.{key}:hover) .c:not(.{key}){{opacity:.12}}.layout:has(.{key}:hover) rect.{key}{{stroke:#000;"
        "stroke-width:.35}"
        for key in nets.values()
    )


def _units(pen: Pen, network: Network, placement: Placement, rules: LayoutRules) -> None:
    masses = {mass.name: mass for mass in network.masses}
    taken = {(unit.column, unit.row) for unit in placement.masses}
    half = rules.row_pitch / 2 - 0.3
    for column, row in placement.slots:
        if (column, row) not in taken:
            x, y = placement.column_x[column], placement.row_y[row]
            words = f"free slot, column {column}, row {row}"
            pen.box((x - rules.unit_left, y - half), (x + rules.unit_right, y + half), 'class="lf"', words, 1.0)
    here = deck_of_plate(rules.link_plates[0])
    for unit in placement.masses:
        mass = masses[unit.mass]
        if isinstance(unit.deck, Deck) and unit.deck is not here:
            low, high = (unit.x - rules.unit_left, unit.y - half), (unit.x + rules.unit_right, unit.y + half)
            pen.box(low, high, 'class="lf"', f"bare hub of {unit.mass}, whose unit is in the {unit.deck} deck", 1.0)
            pen.text(low[0] + 1.2, low[1] + 1.0, "bare hub", 'class="lp"')
            continue
        words = f"{unit.mass}: {mass.kind.value}, phase {mass.phase}, column {unit.column}, row {unit.row}"
        low, high = (unit.x - rules.unit_left, unit.y - half), (unit.x + rules.unit_right, unit.y + half)
        pen.box(low, high, f'class="u{mass.phase % 5}"', words, 1.0)
        pen.text(low[0] + 1.2, high[1] - 3.0, str(mass.phase), 'class="lp"')


def _trunks(pen: Pen, layout: Layout, rules: LayoutRules, nets: dict[str, str]) -> None:
    half = rules.bar_width / 2
    for trunk in layout.trunks:
        style = f'class="c lv {nets[trunk.net]}"'
        words = f"{trunk.name} of {trunk.net} on V"
        pen.box((trunk.x - half, trunk.y_low - half), (trunk.x + half, trunk.y_high + half), style, words)


def _rungs(pen: Pen, layout: Layout, rules: LayoutRules, lanes: Lanes, nets: dict[str, str]) -> None:
    for rung in layout.rungs:
        y, half = rung.y + lanes.offset[rung.plate], lanes.width / 2
        low, high = _reach(rung.left, -1, rules), _reach(rung.right, 1, rules)
        style = f'class="c {lanes.key[rung.plate]} {nets[rung.net]}"'
        pen.box((low, y - half), (high, y + half), style, _rung_words(rung))
        for end in (rung.left, rung.right):
            if end.kind is EndKind.VIA:
                pin = lanes.width / 3
                words = f"via of {rung.net}: {rung.plate} to V"
                pen.box((end.x - pin, y - pin), (end.x + pin, y + pin), 'class="lo"', words)


def _rung_words(rung: Rung) -> str:
    ends = ", ".join(f"{end.kind.value} {end.ref}" for end in (rung.left, rung.right))
    return f"{rung.name} of {rung.net} on {rung.plate}: {ends}"


def _reach(end: RungEnd, outward: int, rules: LayoutRules) -> float:
    if end.kind is EndKind.VIA:
        return end.x + outward * rules.bar_width / 2
    if end.kind is EndKind.HUB:
        return end.x - outward * rules.hub_gap / 2
    return end.x


def _flexures(
    pen: Pen,
    network: Network,
    placement: Placement,
    layout: Layout,
    rules: LayoutRules,
    lanes: Lanes,
    nets: dict[str, str],
) -> None:
    hubs = {unit.mass: unit for unit in placement.masses}
    couplings = {coupling.name: coupling for coupling in network.couplings}
    for leaf in layout.couplers:
        coupling = couplings[leaf.coupling]
        hub = hubs[coupling.target]
        edge = hub.x + (rules.hub_half if leaf.side is Side.RIGHT else -rules.hub_half)
        y = leaf.y + lanes.offset[leaf.plate]
        kind = "rocker" if coupling.strength < 0 else "coupler"
        words = f"{kind} {leaf.coupling} on {leaf.plate}, strength {coupling.strength:g}"
        low, high = sorted((edge, leaf.start_x))
        style = f'class="c z {lanes.stroke[leaf.plate]} {nets[coupling.source]}"'
        pen.line(lanes.zigzag(low, high, y), style, words)
        if leaf.post_x is not None:
            pen.disc(leaf.post_x, y, rules.post_radius, 'class="lr"', f"post of {words}")
    for bias in layout.biases:
        hub = hubs[bias.mass]
        edge = hub.x + (rules.hub_half if bias.side is Side.RIGHT else -rules.hub_half)
        y = hub.y + rules.bias_offsets.get(bias.mass, 0.0)
        words = f"bias leaf of {bias.mass} on {bias.plate}"
        start = (edge, hub.y + lanes.offset[bias.plate])
        pen.line([start, (bias.post_x, y)], f'class="d {lanes.stroke[bias.plate]}"', words)
        pen.disc(bias.post_x, y, rules.post_radius, 'class="lo"', f"post of the {words}")


def _tabs(pen: Pen, layout: Layout, rules: LayoutRules, lanes: Lanes, nets: dict[str, str]) -> None:
    for tab in layout.tabs:
        # a box a straight piece, so that a net that is picked out is outlined here as elsewhere
        half = rules.bar_width / 2
        last = len(tab.path) - 2
        for piece, ((x0, y0), (x1, y1)) in enumerate(pairwise(tab.path)):
            # pieces run on into the corners between them; the tab's own two ends are flat
            before, after = half if piece else 0.0, half if piece < last else 0.0
            if x0 == x1:
                way = math.copysign(1.0, y1 - y0)
                low, high = sorted((y0 - way * before, y1 + way * after))
                corners = (x0 - half, low), (x0 + half, high)
            else:
                way = math.copysign(1.0, x1 - x0)
                low, high = sorted((x0 - way * before, x1 + way * after))
                corners = (low, y0 - half), (high, y0 + half)
            style = f'class="c {lanes.key[tab.plate]} {nets[tab.net]}"'
            pen.box(*corners, style, f"tab of {tab.bit} on {tab.plate}, moved by {tab.net}")


def _hubs(pen: Pen, placement: Placement, rules: LayoutRules, nets: dict[str, str]) -> None:
    pin = rules.pin / 2
    for unit in placement.masses:
        for x in (unit.x - rules.hub_pin_offset, unit.x + rules.hub_pin_offset):
            style = f'class="lo {nets[unit.mass]}"'
            pen.box((x - pin, unit.y - pin), (x + pin, unit.y + pin), style, f"hub of {unit.mass}")
        room = rules.unit_left + rules.unit_right - 8.0
        pen.text(
            unit.x, unit.y + rules.row_pitch / 2 - 0.3 - NAME_TEXT, unit.mass, 'class="ln"', room, NAME_TEXT
        )  # fmt: skip


def _ports(pen: Pen, network: Network, placement: Placement, layout: Layout, grow: float) -> None:
    sensors = {port.bit for port in network.sensors}
    tips = {tab.bit: tab.path[-1] for tab in layout.tabs}
    for port in placement.ports:
        # along the tab, which leaves level or upright, whichever is nearer to the wall's normal
        x, y = port.normal
        x, y = (0.0, math.copysign(1.0, y)) if abs(y) > abs(x) else (math.copysign(1.0, x), 0.0)
        anchor = "middle" if y else "start" if x > 0 else "end"
        # in a row as far as the tabs reach, or beyond the tip of one that is longer, as in a slanted wall
        tip_x, tip_y = tips.get(port.bit, (port.x, port.y))
        beyond = (tip_x - port.x) * x + (tip_y - port.y) * y
        reach = max(13.0 * grow, beyond + 3.5 * grow) if anchor == "middle" else max(9.0 * grow, beyond + 1.5 * grow)
        sensor = port.bit in sensors
        tip, base = (2.2, 6.4) if sensor else (6.4, 2.2)
        corners = [
            (port.x + grow * (along * x + aside * y), port.y + grow * (along * y - aside * x))
            for along, aside in ((tip, 0.0), (base, 2.2), (base, -2.2))
        ]
        words = f"{'sensor' if sensor else 'actuator'} {port.bit} on {port.line}, mass {port.mass}"
        pen.polygon(corners, 'class="lt"', words)
        at = (port.x + reach * x, port.y - 1.8 * grow + reach * y)
        pen.text(*at, port.bit, f'class="lt" font-size="{number(PORT_TEXT * grow)}" text-anchor="{anchor}"')
