"""What could not be routed, and its picture: who sits where, and what the full channel was to hold.

No tracks were found, so none are drawn: every trunk of the channel stands in a lane of its own, over the rows that it
has to span, with a tick for each item that it has to meet on a hub's side. Where the lanes are many and long over the
same rows, the channel is full.
"""

from __future__ import annotations

from dataclasses import dataclass
from html import escape

from mdlcad.errors import SignoffError
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.placement import Placement
from mdlcad.routing.pen import Pen, number, text_width
from mdlcad.routing.pieces import Channel
from mdlcad.routing.sheet import SHEET

MARGIN = 14.0
HEADING, NAME = 5.0, 3.0
PIXELS_A_MM = 4.0
_STYLE = ".jc{fill:#b3261e;opacity:.14}.jt{fill:#b3261e;opacity:.75}.jo{fill:#8d8d8d}.jn{font-size:3px;fill:#16181c}"


@dataclass(frozen=True, slots=True)
class Jam:
    """The place where routing stopped: the placement, and the channel that is too full (None: not one of them)."""

    placement: Placement
    channel: Channel | None = None


class JamError(SignoffError):
    """No layout was found that holds. The message names the channel or the net, and says what would help.

    ``judged``: a legal layout was found, but its judge objects to a carrier.
    """

    def __init__(self, message: str, jam: Jam, judged: bool = False) -> None:
        super().__init__(message)
        self.jam, self.judged = jam, judged


def draw_jam(network: Network, jam: Jam, rules: LayoutRules, message: str) -> bytes:
    """The picture as SVG, 1 mm a user unit, y up. Same input, same bytes."""
    placement = jam.placement
    xs, ys = [x for x, _ in placement.boundary], [y for _, y in placement.boundary]
    aside = MARGIN + max((text_width(port.bit, NAME) for port in placement.ports), default=0.0)
    width = max(xs) - min(xs) + 2 * aside
    lines = _wrapped(message, width - 8.0)
    left, top = min(xs) - aside, max(ys) + MARGIN + 1.5 * HEADING * len(lines)
    pen = Pen(left, top)
    for index, line in enumerate(lines):
        style = f'class="lh" font-size="{number(HEADING)}"'
        pen.text(left + 4.0, top - 1.5 * HEADING * (index + 1), line, style)
    pen.polygon(placement.boundary, 'class="lb"', "boundary")
    half = rules.row_pitch / 2 - 0.3
    masses = {mass.name: mass for mass in network.masses}
    for unit in placement.masses:
        low, high = (unit.x - rules.unit_left, unit.y - half), (unit.x + rules.unit_right, unit.y + half)
        pen.box(low, high, f'class="u{masses[unit.mass].phase % 5}"', unit.mass, 1.0)
        pen.text(unit.x, high[1] - NAME, unit.mass, 'class="ln"', rules.unit_left + rules.unit_right, NAME)
    for port in placement.ports:
        pen.disc(port.x, port.y, 1.5, 'class="lo"', port.bit)
        pen.text(port.x + 2.0, port.y, port.bit, 'class="jn"')
    if jam.channel is not None:
        _channel(pen, placement, jam.channel, rules)
    height = top - (min(ys) - MARGIN)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {number(width)} {number(height)}" '
        f'width="{number(width * PIXELS_A_MM)}" height="{number(height * PIXELS_A_MM)}" role="img" '
        f'font-family="sans-serif">\n<title>{escape(message)}</title>\n<style>{SHEET}{_STYLE}</style>\n'
        + "\n".join(pen.lines)
        + "\n</svg>\n"
    ).encode()


def _channel(pen: Pen, placement: Placement, channel: Channel, rules: LayoutRules) -> None:
    xs, ys = [x for x, _ in placement.boundary], [y for _, y in placement.boundary]
    hubs = placement.column_x
    low = hubs[channel.index - 1] + rules.hub_half if channel.index > 0 else min(xs) + rules.frame_width
    high = hubs[channel.index] - rules.hub_half if channel.index < len(hubs) else max(xs) - rules.frame_width
    pen.box((low, min(ys)), (high, max(ys)), 'class="jc"', f"channel {channel.index}")
    lane = (high - low) / (len(channel.trunks) + 1)
    bar = min(lane / 3, rules.bar_width / 2)
    middle = {index: low + lane * (index + 1) for index in range(len(channel.trunks))}
    for index, trunk in enumerate(channel.trunks):
        x, words = middle[index], f"trunk of {trunk.net}"
        pen.box((x - bar, trunk.y_low - bar), (x + bar, trunk.y_high + bar), 'class="jt"', words)
    for item in channel.items:
        y, words = (item.y_low + item.y_high) / 2, f"{item.role.value} {item.ref} of {item.net}"
        ends = [low if side == 1 else high for _, side in item.hubs]
        at = middle[item.trunk] if item.trunk is not None else (low + high) / 2
        for end in ends:
            pen.box((min(at, end), y - 0.25), (max(at, end), y + 0.25), 'class="jo"', words)


def _wrapped(words: str, width: float) -> list[str]:
    lines = [""]
    for word in words.split():
        longer = f"{lines[-1]} {word}".strip()
        if lines[-1] and text_width(longer, HEADING) > width:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines
