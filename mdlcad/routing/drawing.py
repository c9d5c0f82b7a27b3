"""One SVG of a placement and its routing: rim, units, trunks, rungs by plate, flexures, posts, tabs. Same input, same
bytes; hovering over a piece shows its name."""

from __future__ import annotations

from html import escape

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.placement import Placement
from mdlcad.routing.layout import EndKind, Layout, Rung, RungEnd, Side

PHASES = ("#cfe3f5", "#d9efd2", "#fbe3c8", "#ead9f0", "#f5d5d5")
TRUNK = "#5a5a5a"
PLATES = ("#c0392b", "#2471a3", "#1e8449", "#b9770e", "#7d3c98", "#117a8b")
"""Colours of the rung plates, bottom to top."""
POST = "#111111"
MARGIN = 16.0
LETTER = 2.4
"""Width of a letter of a port's label, about, mm."""


def draw_layout(network: Network, placement: Placement, layout: Layout, rules: LayoutRules) -> bytes:
    """The drawing, 1 mm a user unit, y up. Rungs are solid, flexures hatched in their plate's colour, bias leaves
    dotted, posts black."""
    xs, ys = [x for x, _ in placement.boundary], [y for _, y in placement.boundary]
    aside = MARGIN + LETTER * max((len(port.bit) for port in placement.ports), default=0)
    left, top = min(xs) - aside, max(ys) + MARGIN
    width, height = max(xs) - min(xs) + 2 * aside, max(ys) - min(ys) + 2 * MARGIN
    pen = _Pen(left, top, dict(zip(rules.link_plates, PLATES * 2, strict=False)))
    pen.polygon(placement.boundary, "#f6f4ef", "#8a8578", "boundary")
    _units(pen, network, placement, rules)
    half = rules.bar_width / 2
    for trunk in layout.trunks:
        pen.box(trunk.x - half, trunk.y_low - half, trunk.x + half, trunk.y_high + half, TRUNK, 0.75, trunk.name)
    for rung in layout.rungs:
        low, high = _reach(rung.left, -1, rules), _reach(rung.right, 1, rules)
        pen.box(low, rung.y - half, high, rung.y + half, pen.plates[rung.plate], 0.6, _rung_words(rung))
    hubs = {unit.mass: unit for unit in placement.masses}
    targets = {coupling.name: coupling.target for coupling in network.couplings}
    for leaf in layout.couplers:
        hub = hubs[targets[leaf.coupling]]
        edge = hub.x + (rules.hub_half if leaf.side is Side.RIGHT else -rules.hub_half)
        low, high = sorted((edge, leaf.start_x))
        pen.leaf(low, leaf.y, high, pen.plates[leaf.plate], f"coupler {leaf.coupling} on {leaf.plate}")
        if leaf.post_x is not None:
            pen.disc(leaf.post_x, leaf.y, rules.post_radius, f"post of {leaf.coupling}")
    for bias in layout.biases:
        hub = hubs[bias.mass]
        edge = hub.x + (rules.hub_half if bias.side is Side.RIGHT else -rules.hub_half)
        y = hub.y + rules.bias_offsets.get(bias.mass, 0.0)
        pen.dotted(edge, hub.y, bias.post_x, y, pen.plates[bias.plate], f"bias of {bias.mass} on {bias.plate}")
        pen.disc(bias.post_x, y, rules.post_radius, f"bias post of {bias.mass}")
    for tab in layout.tabs:
        pen.path(tab.path, rules.bar_width, pen.plates[tab.plate], f"tab {tab.bit} on {tab.plate}")
    for port in placement.ports:
        x, y = port.normal
        anchor = "middle" if abs(y) > abs(x) else "start" if x > 0 else "end"
        pen.label(port.x + 11 * x, port.y - 1.4 + 11 * y, port.bit, 4.0, anchor)
    _hubs(pen, placement, rules)
    _legend(pen, left, top, rules)
    body = "\n".join(pen.lines)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_n(width)} {_n(height)}" '
        f'width="{_n(width * 4)}" height="{_n(height * 4)}" font-family="sans-serif">\n{body}\n</svg>\n'
    ).encode()


def _units(pen: _Pen, network: Network, placement: Placement, rules: LayoutRules) -> None:
    phases = {mass.name: mass.phase for mass in network.masses}
    half = rules.row_pitch / 2 - 0.3
    for column, row in placement.slots:
        x, y = placement.column_x[column], placement.row_y[row]
        pen.box(x - rules.unit_left, y - half, x + rules.unit_right, y + half, "#e9e6de", 0.5, f"slot {column}, {row}")
    for unit in placement.masses:
        colour = PHASES[phases[unit.mass] % len(PHASES)]
        words = f"{unit.mass}, phase {phases[unit.mass]}, column {unit.column}, row {unit.row}"
        pen.box(unit.x - rules.unit_left, unit.y - half, unit.x + rules.unit_right, unit.y + half, colour, 1.0, words)


def _hubs(pen: _Pen, placement: Placement, rules: LayoutRules) -> None:
    pin = rules.pin / 2
    for unit in placement.masses:
        for x in (unit.x - rules.hub_pin_offset, unit.x + rules.hub_pin_offset):
            pen.box(x - pin, unit.y - pin, x + pin, unit.y + pin, POST, 0.9, f"hub of {unit.mass}")
        pen.label(unit.x, unit.y + rules.row_pitch / 2 - 3.0, unit.mass, 2.6)


def _legend(pen: _Pen, left: float, top: float, rules: LayoutRules) -> None:
    x, y = left + 3.0, top - 6.0
    for name, colour in (("V", TRUNK), *((plate, pen.plates[plate]) for plate in rules.link_plates)):
        pen.box(x, y - 1.5, x + 6.0, y + 1.5, colour, 0.8, name)
        pen.label(x + 10.0, y - 1.3, name, 4.0)
        x += 17.0


def _rung_words(rung: Rung) -> str:
    ends = ", ".join(f"{end.kind.value} {end.ref}" for end in (rung.left, rung.right))
    return f"{rung.name} of {rung.net} on {rung.plate}: {ends}"


def _reach(end: RungEnd, outward: int, rules: LayoutRules) -> float:
    if end.kind is EndKind.VIA:
        return end.x + outward * rules.bar_width / 2
    if end.kind is EndKind.HUB:
        return end.x - outward * rules.hub_gap / 2
    return end.x


def _n(value: float) -> str:
    return f"{value:.2f}".rstrip("0").rstrip(".") if abs(value) >= 0.005 else "0"


class _Pen:
    """Writes SVG elements; takes y up, writes y down."""

    def __init__(self, left: float, top: float, plates: dict[str, str]) -> None:
        self.left, self.top, self.plates = left, top, plates
        self.lines: list[str] = []

    def at(self, x: float, y: float) -> tuple[str, str]:
        return _n(x - self.left), _n(self.top - y)

    def add(self, kind: str, attributes: str, title: str) -> None:
        self.lines.append(f"<{kind} {attributes}><title>{escape(title)}</title></{kind}>")

    def polygon(self, points: tuple[tuple[float, float], ...], fill: str, stroke: str, title: str) -> None:
        where = " ".join(",".join(self.at(x, y)) for x, y in points)
        self.add("polygon", f'points="{where}" fill="{fill}" stroke="{stroke}" stroke-width="1"', title)

    def box(self, x0: float, y0: float, x1: float, y1: float, fill: str, opacity: float, title: str) -> None:
        x, y = self.at(min(x0, x1), max(y0, y1))
        size = f'width="{_n(abs(x1 - x0))}" height="{_n(abs(y1 - y0))}"'
        self.add("rect", f'x="{x}" y="{y}" {size} fill="{fill}" fill-opacity="{opacity:g}"', title)

    def leaf(self, x0: float, y: float, x1: float, colour: str, title: str) -> None:
        """A meander, as a zigzag."""
        count = max(4, 2 * round((x1 - x0) / 3))
        points = [(x0 + (x1 - x0) * k / count, y + (0.0, 2.0, 0.0, -2.0)[k % 4]) for k in range(count + 1)]
        self.line(points, 0.6, colour, "", title)

    def dotted(self, x0: float, y0: float, x1: float, y1: float, colour: str, title: str) -> None:
        self.line([(x0, y0), (x1, y1)], 1.0, colour, ' stroke-dasharray="1.2 0.8"', title)

    def path(self, points: tuple[tuple[float, float], ...], width: float, colour: str, title: str) -> None:
        self.line(list(points), width, colour, ' stroke-opacity="0.85"', title)

    def line(self, points: list[tuple[float, float]], width: float, colour: str, more: str, title: str) -> None:
        where = " ".join(",".join(self.at(x, y)) for x, y in points)
        attributes = f'points="{where}" fill="none" stroke="{colour}" stroke-width="{_n(width)}"{more}'
        self.add("polyline", attributes, title)

    def disc(self, x: float, y: float, radius: float, title: str) -> None:
        cx, cy = self.at(x, y)
        self.add("circle", f'cx="{cx}" cy="{cy}" r="{_n(radius)}" fill="{POST}"', title)

    def label(self, x: float, y: float, text: str, size: float, anchor: str = "middle") -> None:
        at_x, at_y = self.at(x, y)
        where = f'x="{at_x}" y="{at_y}" font-size="{_n(size)}" text-anchor="{anchor}" fill="#222"'
        self.lines.append(f"<text {where}>{escape(text)}</text>")
