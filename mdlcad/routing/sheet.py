"""How a layout's drawing looks: the style sheet, and the lane of every rung plate within a row."""

from __future__ import annotations

from mdlcad.mechanics.rules import LayoutRules

PHASES = ("#d6e6f7", "#dcf0d5", "#e9dff4", "#fbe6cc", "#f5dcdc")
TRUNK = "#8d8d8d"
PLATES = ("#b3261e", "#1f63a8", "#1b7a3d", "#a86a00", "#6d2f92", "#0d6b74")
"""Colours of the rung plates, bottom to top; dark enough to be read on the units' colours."""

SHEET = (
    ".lb{fill:#faf9f6;stroke:#8a8578;stroke-width:1.2}.lf{fill:#f0eee8}"
    + "".join(f".u{index}{{fill:{colour}}}" for index, colour in enumerate(PHASES))
    + f".lv{{fill:{TRUNK};opacity:.62}}"
    + "".join(f".p{index}{{fill:{colour}}}" for index, colour in enumerate(PLATES))
    + "".join(f".s{index}{{stroke:{colour}}}" for index, colour in enumerate(PLATES))
    + ".z{fill:none;stroke-width:.55;stroke-linejoin:round}.d{fill:none;stroke-width:1;stroke-dasharray:1.2 .7}"
    ".lo{fill:#16181c}.lr{fill:#fff;stroke:#16181c;stroke-width:.7}.lt{fill:#16181c}"
    ".lh{font-weight:600;fill:#16181c}.lk{font-size:4.4px;fill:#16181c}"
    ".ln{font-size:3px;text-anchor:middle;fill:#16181c;paint-order:stroke;stroke:#fff;stroke-width:.7}"
    ".lp{font-size:2.8px;fill:#5b6470}"
    "rect:hover,polyline:hover,circle:hover{filter:brightness(.8)}"
)


class Lanes:
    """Where in a row the rungs of a plate are drawn.

    Attributes:
        offset: of the lane's middle from the row's, mm, by plate; width: of a lane.
        key, stroke: the plate's class as a filled piece and as a line.
    """

    def __init__(self, rules: LayoutRules) -> None:
        count = len(rules.link_plates)
        pitch = max(rules.hub_height, rules.bar_width) / count
        self.width = 0.86 * pitch
        self.offset = {plate: (index - (count - 1) / 2) * pitch for index, plate in enumerate(rules.link_plates)}
        self.key = {plate: f"p{index % len(PLATES)}" for index, plate in enumerate(rules.link_plates)}
        self.stroke = {plate: f"s{index % len(PLATES)}" for index, plate in enumerate(rules.link_plates)}

    def zigzag(self, low: float, high: float, y: float) -> list[tuple[float, float]]:
        """A flexure in its lane, as a zigzag."""
        count = max(4, 2 * round((high - low) / 3))
        rise = (0.0, self.width / 2, 0.0, -self.width / 2)
        return [(low + (high - low) * k / count, y + rise[k % 4]) for k in range(count + 1)]
