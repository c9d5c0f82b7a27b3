"""Words around a picture: a title above, what the colours mean below, and the card of what was found beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from mdlcad.view.colours import Colours, Key
from mdlcad.view.describe import Card

Font = ImageFont.FreeTypeFont | ImageFont.ImageFont

_INK = "#1c2127"
_FAINT = "#5b636e"
_MARKED = "#b30f5f"
_MOST = 0.25
"""Share of a picture's height that its title, and that its keys, may take from what is shown."""


@dataclass(frozen=True, slots=True)
class Caption:
    """Where the words of pictures of one size stand, so that they cover nothing.

    Attributes:
        size: of the whole picture, pixels.
        above: height of the band for the title; 0 if the picture is so small that the title has to lie over it.
        rows: the keys, row by row; none if the picture is too small for them.
        panel: width of the panel at the right, for a card.
    """

    size: tuple[int, int]
    above: int
    rows: tuple[tuple[Key, ...], ...]
    panel: int

    @property
    def room(self) -> tuple[int, int]:
        """What is left for the device, pixels."""
        width, height = self.size
        return width - self.panel, height - self.above - _band(len(self.rows), height)

    def around(self, image: Colours, title: str, card: Card | None = None) -> Image.Image:
        """``image`` (uint8[h, w, 3], of the size of the room) with its words."""
        width, height = self.size
        picture = Image.new("RGB", self.size, "white")
        picture.paste(Image.fromarray(np.ascontiguousarray(image)), (0, self.above))
        draw = ImageDraw.Draw(picture)
        font, letter, line, pad = _type(height)
        for number, row in enumerate(_wrapped(title, font, width - 2 * pad)):
            draw.text((pad, pad + number * line), row, fill=_INK, font=font)
        y = height - _band(len(self.rows), height) + pad / 2
        for keys in self.rows:
            x = pad
            for key in keys:
                draw.rectangle(
                    (x, y + 0.25 * letter, x + 1.5 * letter, y + 1.15 * letter), fill=key.colour, outline=_INK
                )
                draw.text((x + 2.1 * letter, y), key.words, fill=_INK, font=font)
                x += _breadth(key, font, letter)
            y += line
        if card is not None:
            _card(draw, (width - self.panel, width), card, font, line)
        return picture


def caption(size: tuple[int, int], titles: Sequence[str], keys: Sequence[Key], panel: int = 0) -> Caption:
    """The caption of pictures that have one or another of ``titles``."""
    width, height = size
    font, letter, _, pad = _type(height)
    above = _band(max(len(_wrapped(title, font, width - 2 * pad)) for title in titles), height)
    rows: list[list[Key]] = []
    left = 0.0
    for key in keys:
        breadth = _breadth(key, font, letter)
        if not rows or left < breadth:
            rows.append([])
            left = width - pad
        rows[-1].append(key)
        left -= breadth
    fits = _band(len(rows), height) <= _MOST * height
    return Caption(
        size, above if above <= _MOST * height else 0, tuple(tuple(row) for row in rows) if fits else (), panel
    )


def _type(height: int) -> tuple[Font, int, float, float]:
    """Font, its size, the height of a line and the space around, for a picture of that height."""
    letter = max(13, round(height / 62))
    return ImageFont.load_default(letter), letter, letter * 1.45, letter * 0.8


def _band(rows: int, height: int) -> int:
    """Height of a band of so many rows."""
    _, _, line, pad = _type(height)
    return round(rows * line + pad) if rows else 0


def _breadth(key: Key, font: Font, letter: int) -> float:
    """A key's colour, words, and the space to the next."""
    return font.getlength(key.words) + 4.0 * letter


def _card(draw: ImageDraw.ImageDraw, across: tuple[float, float], card: Card, font: Font, line: float) -> None:
    """The card between two places in x."""
    pad = 0.6 * line
    left, right = across[0] + pad, across[1] - pad
    wide = max((font.getlength(key) for key, _ in card.facts), default=0.0) + pad
    y = 2.5 * line
    for row in _wrapped(card.name, font, right - left):
        draw.text((left, y), row, fill=_MARKED, font=font)
        y += line
    for key, value in card.facts:
        y += 0.25 * line
        draw.text((left, y), key, fill=_FAINT, font=font)
        for row in _wrapped(value, font, right - left - wide):
            draw.text((left + wide, y), row, fill=_INK, font=font)
            y += line


def _wrapped(text: str, font: Font, width: float) -> list[str]:
    rows = [""]
    for word in text.split(" "):
        longer = f"{rows[-1]} {word}".strip()
        if rows[-1] and font.getlength(longer) > width:
            rows.append(word)
        else:
            rows[-1] = longer
    return rows
