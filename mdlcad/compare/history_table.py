"""A history as a table for a terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from mdlcad.compare.history import History, Row

GAP = "-"


def _number(value: float | None, digits: int) -> str:
    return GAP if value is None else f"{value:.{digits}f}"


def _extent(row: Row) -> str:
    if row.width_mm is None or row.depth_mm is None or row.height_mm is None:
        return GAP
    return f"{row.width_mm:.1f} x {row.depth_mm:.1f} x {row.height_mm:.1f}"


# heading, and what stands under it
_COLUMNS: tuple[tuple[str, Callable[[Row], str]], ...] = (
    ("build", lambda row: row.folder + ("*" if row.edited else "")),
    ("version", lambda row: row.version or GAP),
    ("cells", lambda row: row.cells or GAP),
    ("process", lambda row: row.process or GAP),
    ("seed", lambda row: GAP if row.seed is None else str(row.seed)),
    ("masses", lambda row: _number(row.masses, 0)),
    ("couplings", lambda row: _number(row.couplings, 0)),
    ("margin", lambda row: _number(row.margin, 3)),
    ("drawn", lambda row: _number(row.margin_drawn, 3)),
    ("strain %", lambda row: GAP if row.strain is None else f"{100 * row.strain:.2f}"),
    ("carrier", lambda row: _number(row.carrier_ratio, 1)),
    ("findings", lambda row: _number(row.findings, 0)),
    ("plates", lambda row: _number(row.plates, 0)),
    ("parts", lambda row: _number(row.parts, 0)),
    ("extent mm", _extent),
    ("MB", lambda row: f"{row.bytes / 1e6:.1f}"),
    ("time s", lambda row: _number(row.seconds, 1)),
)
_WORDS = 4  # columns of words, set to the left; the rest are figures, set to the right


def table(history: History) -> Iterator[str]:
    """A heading and a line a build."""
    lines = [[name for name, _ in _COLUMNS], *([show(row) for _, show in _COLUMNS] for row in history.rows)]
    widths = [max(len(line[index]) for line in lines) for index in range(len(_COLUMNS))]
    for line in lines:
        cells = [
            cell.ljust(width) if index < _WORDS else cell.rjust(width)
            for index, (cell, width) in enumerate(zip(line, widths, strict=True))
        ]
        yield "  ".join(cells).rstrip()
    if any(row.edited for row in history.rows):
        yield "* has files that were edited since it was built"
