"""The examples in the docs that say that they can be run: a comment ``<!-- run -->`` before a fenced block."""

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
_BLOCK = re.compile(r"^<!-- run(?P<long>: long)? -->\n```(?P<language>\w+)\n(?P<text>.*?)^```$", re.M | re.S)


@dataclass(frozen=True)
class Block:
    page: str
    line: int
    language: str
    text: str
    long: bool

    @property
    def name(self) -> str:
        return f"{self.page}:{self.line}"


def blocks_of(page: str, text: str) -> list[Block]:
    """The runnable blocks of a page.

    Raises:
        ValueError: a comment says run, and no block that can be run follows it.
    """
    found = [
        Block(page, text[: match.start()].count("\n") + 1, match["language"], match["text"], bool(match["long"]))
        for match in _BLOCK.finditer(text)
    ]
    if len(found) != text.count("<!-- run"):
        raise ValueError(f"{page}: {text.count('<!-- run')} blocks are marked, {len(found)} can be run")
    return found


def blocks() -> list[Block]:
    """Of README and docs."""
    return [block for page in PAGES for block in blocks_of(page.name, page.read_text(encoding="utf-8"))]
