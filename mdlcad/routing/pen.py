"""Writes SVG elements with the device's y upwards; every element has a name to hover over."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

Point = tuple[float, float]


def number(value: float) -> str:
    """A length with at most two decimals."""
    return f"{value:.2f}".rstrip("0").rstrip(".") if abs(value) >= 0.005 else "0"


class Pen:
    """Collects elements. ``left`` and ``top``: device coordinates, mm, of the picture's upper left corner."""

    def __init__(self, left: float, top: float) -> None:
        self.left, self.top = left, top
        self.lines: list[str] = []

    def at(self, x: float, y: float) -> tuple[str, str]:
        """A place of the device in the picture."""
        return number(x - self.left), number(self.top - y)

    def open(self, attributes: str) -> None:
        """Begin a group."""
        self.lines.append(f"<g {attributes}>")

    def close(self) -> None:
        """End a group."""
        self.lines.append("</g>")

    def element(self, kind: str, attributes: str, title: str) -> None:
        """Any element with its name."""
        self.lines.append(f"<{kind} {attributes}><title>{escape(title)}</title></{kind}>")

    def box(self, low: Point, high: Point, style: str, title: str, round_mm: float = 0.0) -> None:
        """A rectangle between two corners."""
        x, y = self.at(min(low[0], high[0]), max(low[1], high[1]))
        width, height = number(abs(high[0] - low[0])), number(abs(high[1] - low[1]))
        corner = f' rx="{number(round_mm)}"' if round_mm else ""
        self.element("rect", f'x="{x}" y="{y}" width="{width}" height="{height}"{corner} {style}', title)

    def line(self, points: Sequence[Point], style: str, title: str) -> None:
        """A polyline."""
        self.element("polyline", f'points="{self._points(points)}" {style}', title)

    def polygon(self, points: Sequence[Point], style: str, title: str) -> None:
        """A filled polygon."""
        self.element("polygon", f'points="{self._points(points)}" {style}', title)

    def disc(self, x: float, y: float, radius: float, style: str, title: str) -> None:
        """A circle."""
        cx, cy = self.at(x, y)
        self.element("circle", f'cx="{cx}" cy="{cy}" r="{number(radius)}" {style}', title)

    def text(self, x: float, y: float, words: str, style: str, most_mm: float | None = None, size: float = 0.0) -> None:
        """A line of text; squeezed to ``most_mm`` if at ``size`` it would be longer."""
        at_x, at_y = self.at(x, y)
        squeeze = ""
        if most_mm is not None and text_width(words, size) > most_mm:
            squeeze = f' textLength="{number(most_mm)}" lengthAdjust="spacingAndGlyphs"'
        self.lines.append(f'<text x="{at_x}" y="{at_y}"{squeeze} {style}>{escape(words)}</text>')

    def _points(self, points: Sequence[Point]) -> str:
        return " ".join(",".join(self.at(x, y)) for x, y in points)


def text_width(words: str, size: float) -> float:
    """About how wide a text of a sans-serif face is, in the unit of ``size``."""
    return 0.58 * size * len(words)
