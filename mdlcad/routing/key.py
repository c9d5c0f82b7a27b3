"""The key and the scale bar under a layout's drawing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.routing.pen import Pen, text_width
from mdlcad.routing.sheet import Lanes

_LINE, _TEXT, _SIGN = 9.0, 4.4, 11.0


@dataclass(frozen=True, slots=True)
class _Entry:
    words: str
    sign: Callable[[Pen, float, float], None]

    @property
    def width(self) -> float:
        return _SIGN + 2.0 + text_width(self.words, _TEXT) + 6.0


def write_key(pen: Pen, width: float, shrunk: float, network: Network, rules: LayoutRules) -> float:
    """The key, and the scale bar below it, downwards from the pen's origin; its height.

    Args:
        width: what there is, in units of the key. shrunk: millimetres of the device to such a unit.
    """
    y = -_LINE / 2
    for line in _lines(width, network, rules):
        x = 4.0
        for entry in line:
            entry.sign(pen, x, y)
            pen.text(x + _SIGN + 2.0, y - _TEXT / 3, entry.words, 'class="lk"')
            x += entry.width
        y -= _LINE
    _scale_bar(pen, 4.0, y, width, shrunk)
    return _LINE - y


def _scale_bar(pen: Pen, x: float, y: float, width: float, shrunk: float) -> None:
    steps = (500.0, 200.0, 100.0, 50.0, 20.0, 10.0, 5.0, 1.0)
    length = next(step for step in steps if step <= shrunk * width / 4 or step == steps[-1])
    end = x + length / shrunk
    pen.box((x, y - 0.6), (end, y + 0.6), 'class="lo"', f"{length:g} mm")
    for place in (x, end):
        pen.box((place - 0.3, y - 2.0), (place + 0.3, y + 2.0), 'class="lo"', f"{length:g} mm")
    pen.text(end + 3.0, y - _TEXT / 3, f"{length:g} mm; hover over a piece for its name", 'class="lk"')


def _lines(width: float, network: Network, rules: LayoutRules) -> list[list[_Entry]]:
    lines: list[list[_Entry]] = [[]]
    used = 4.0
    for entry in _entries(network, rules):
        if lines[-1] and used + entry.width > width:
            lines.append([])
            used = 4.0
        lines[-1].append(entry)
        used += entry.width
    return lines


def _entries(network: Network, rules: LayoutRules) -> list[_Entry]:
    lanes = Lanes(rules)
    middle = _SIGN / 2

    def bar(style: str, half: float) -> Callable[[Pen, float, float], None]:
        return lambda pen, x, y: pen.box((x, y - half), (x + _SIGN, y + half), f'class="{style}"', "key")

    def leaf(style: str, post: bool) -> Callable[[Pen, float, float], None]:
        def draw(pen: Pen, x: float, y: float) -> None:
            pen.line(lanes.zigzag(x, x + _SIGN, y), f'class="z {style}"', "key")
            if post:
                pen.disc(x + middle, y, rules.post_radius, 'class="lr"', "key")

        return draw

    def bias(pen: Pen, x: float, y: float) -> None:
        pen.line([(x, y), (x + _SIGN - 2.0, y)], f'class="d {lanes.stroke[rules.link_plates[0]]}"', "key")
        pen.disc(x + _SIGN - 2.0, y, rules.post_radius, 'class="lo"', "key")

    def port(pen: Pen, x: float, y: float) -> None:
        pen.polygon([(x + middle - 2, y - 2), (x + middle - 2, y + 2), (x + middle + 2, y)], 'class="lt"', "key")

    phases = range(network.dynamics.phases)
    first = lanes.stroke[rules.link_plates[0]]
    plates = [
        _Entry(f"rung, {plate}{note}", bar(lanes.key[plate], lanes.width / 2))
        for plate, note in zip(
            rules.link_plates, [" (lowest lane)", *[""] * (len(rules.link_plates) - 1)], strict=False
        )
    ]
    return [
        *(_Entry(f"unit, phase {phase}", bar(f"u{phase % 5}", 3.0)) for phase in phases),
        _Entry("free slot", bar("lf", 3.0)),
        _Entry("trunk, V", bar("lv", 2.0)),
        *plates,
        _Entry("coupler", leaf(first, False)),
        _Entry("rocker (inverts)", leaf(first, True)),
        _Entry("bias leaf", bias),
        _Entry("sensor points in, actuator out", port),
    ]
