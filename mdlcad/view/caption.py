"""Words on a picture: a title, what the colours mean, and the card of what was found."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from mdlcad.view.colours import Colours, Key
from mdlcad.view.describe import Card

_INK = "#1c2127"
_PAPER = (255, 255, 255, 226)
_FAINT = "#5b636e"
_MARKED = "#b30f5f"
_MOST_COVERED = 0.25
"""Share of a picture that its keys may cover."""


def captioned(image: Colours, title: str, keys: Sequence[Key], card: Card | None = None, panel: int = 0) -> Image.Image:
    """``image`` (uint8[h, w, 3]) with a title at the top, ``keys`` at the lower left and ``card`` beside it.

    Of a picture so small that the keys would cover more than a quarter of it, they are left out.

    Args:
        panel: width of the panel that is put on the right for the card, pixels.
    """
    height, edge = image.shape[:2]
    picture = Image.new("RGB", (edge + panel, height), "white")
    picture.paste(Image.fromarray(np.ascontiguousarray(image)), (0, 0))
    draw = ImageDraw.Draw(picture, "RGBA")
    size = max(13, round(picture.height / 62))
    font = ImageFont.load_default(size)
    pad, line = size * 0.8, size * 1.45
    for number, row in enumerate(_wrapped(draw, title, font, picture.width - 2 * pad)):
        draw.text((pad, pad + number * line), row, fill=_INK, font=font)
    bottom = picture.height - pad
    width = max((draw.textlength(key.words, font) for key in keys), default=0.0) + 2.6 * size
    if keys and width * line * len(keys) <= _MOST_COVERED * edge * height:
        top = bottom - line * len(keys)
        draw.rectangle((pad * 0.5, top - pad * 0.5, pad * 1.5 + width, bottom + pad * 0.5), fill=_PAPER)
        for number, key in enumerate(keys):
            y = top + number * line
            draw.rectangle((pad, y + 0.25 * size, pad + 1.5 * size, y + 1.15 * size), fill=key.colour, outline=_INK)
            draw.text((pad + 2.1 * size, y), key.words, fill=_INK, font=font)
    if card is not None:
        _card(draw, (edge, picture.width), card, font, line)
    return picture


def _card(
    draw: ImageDraw.ImageDraw,
    across: tuple[float, float],
    card: Card,
    font: ImageFont.FreeTypeFont | ImageFont.ImageFont,
    line: float,
) -> None:
    """The card between two places in x."""
    pad = 0.6 * line
    left, right = across[0] + pad, across[1] - pad
    wide = max((draw.textlength(key, font) for key, _ in card.facts), default=0.0) + pad
    y = 2.5 * line
    for row in _wrapped(draw, card.name, font, right - left):
        draw.text((left, y), row, fill=_MARKED, font=font)
        y += line
    for key, value in card.facts:
        y += 0.25 * line
        draw.text((left, y), key, fill=_FAINT, font=font)
        for row in _wrapped(draw, value, font, right - left - wide):
            draw.text((left + wide, y), row, fill=_INK, font=font)
            y += line


def _wrapped(
    draw: ImageDraw.ImageDraw, text: str, font: ImageFont.FreeTypeFont | ImageFont.ImageFont, width: float
) -> list[str]:
    rows = [""]
    for word in text.split(" "):
        longer = f"{rows[-1]} {word}".strip()
        if rows[-1] and draw.textlength(longer, font) > width:
            rows.append(word)
        else:
            rows[-1] = longer
    return rows
