"""Pictures put into the page itself, so that it is one file."""

from __future__ import annotations

import base64
import io
import re
from pathlib import Path

from PIL import Image

from mdlcad.errors import UsageError

_WIDEST = 1200
_DECIMALS = re.compile(r"(\d+\.\d\d)\d+")
_SIZE = re.compile(r'(<svg\b[^>]*?) width="[^"]*" height="[^"]*"')


def photo(path: Path) -> str | None:
    """A rendered picture as a data address, at most 1,200 pixels wide; None if there is none.

    Raises:
        UsageError: the file is no picture.
    """
    if not path.is_file():
        return None
    try:
        with Image.open(path) as picture:
            small = picture.convert("RGB")
    except OSError as problem:
        raise UsageError(f"{path}: is not a picture ({problem}); build it again") from None
    if small.width > _WIDEST:
        small = small.resize((_WIDEST, round(small.height * _WIDEST / small.width)), Image.Resampling.LANCZOS)
    stream = io.BytesIO()
    small.save(stream, "JPEG", quality=88)
    return f"data:image/jpeg;base64,{base64.b64encode(stream.getvalue()).decode()}"


def drawing(path: Path, label: str) -> str | None:
    """An SVG to be written into the page, as wide as its place, coordinates to 0.01 mm; None if there is none."""
    if not path.is_file():
        return None
    text = path.read_text(encoding="utf-8")
    # an element of the page needs no namespace
    text = text.replace(' xmlns="http://www.w3.org/2000/svg"', "", 1)
    text = _SIZE.sub(r'\1 width="100%"', text, count=1)
    text = text.replace("<svg ", f'<svg aria-label="{label}" ', 1)
    return _DECIMALS.sub(r"\1", text).strip()
