"""A history as a picture: one small plot a figure, builds from left to right, gaps where a build has no figure."""

from __future__ import annotations

import io
from collections.abc import Callable

import matplotlib

matplotlib.use("Agg")
from matplotlib.figure import Figure  # (the backend must be chosen first)

from mdlcad.compare.history import History, Row
from mdlcad.errors import UsageError

FORMATS = ("png", "svg")
_INK, _LINE = "#16202c", "#0b4fa0"


def _mega(row: Row) -> float:
    return row.bytes / 1e6


# heading, series of a panel: label and value
_Series = tuple[str, Callable[[Row], float | None]]
_PANELS: tuple[tuple[str, tuple[_Series, ...]], ...] = (
    ("masses and couplings", (("masses", lambda row: row.masses), ("couplings", lambda row: row.couplings))),
    (
        "margin (least |x| read out)",
        (("network", lambda row: row.margin), ("as drawn", lambda row: row.margin_drawn)),
    ),
    ("carrier stiffness ratio, worst", (("ratio", lambda row: row.carrier_ratio),)),
    ("plates", (("plates", lambda row: row.plates),)),
    ("parts", (("parts", lambda row: row.parts),)),
    (
        "extent, mm",
        (
            ("x", lambda row: row.width_mm),
            ("y", lambda row: row.depth_mm),
            ("z", lambda row: row.height_mm),
        ),
    ),
    ("size of all files, MB", (("files", _mega),)),
    ("build time, s", (("time", lambda row: row.seconds),)),
)
# series are told apart by mark and dash as well as by colour
_STYLES = (("o", "-", _LINE), ("s", "--", "#a63c00"), ("^", ":", "#2f7d32"))


def plot(history: History, form: str) -> bytes:
    """The picture as PNG or SVG; the same bytes for the same history.

    Raises:
        UsageError: another format, or nothing to plot.
    """
    if form not in FORMATS:
        raise UsageError(f"a plot is a {' or '.join(FORMATS)} file, not {form or 'one without a suffix'}")
    if not history.rows:
        raise UsageError("there is no build to plot")
    count = len(history.rows)
    with matplotlib.rc_context({"svg.hashsalt": "mdlcad", "font.size": 8.0, "axes.edgecolor": "#8d98a5"}):
        figure = Figure(figsize=(max(9.0, min(2.0 + 0.9 * count, 30.0)), 10.5), layout="constrained")
        axes = figure.subplots(4, 2, sharex=True)
        for ax, (heading, series) in zip(axes.flat, _PANELS, strict=True):
            ax.set_title(heading, fontsize=9, color=_INK, loc="left")
            ax.grid(True, color="#e3e8ee")
            ax.set_axisbelow(True)
            for (label, value), (mark, dash, colour) in zip(series, _STYLES, strict=False):
                values = [value(row) for row in history.rows]
                heights = [float("nan") if item is None else float(item) for item in values]
                ax.plot(range(count), heights, marker=mark, linestyle=dash, color=colour, label=label, markersize=4.5)
            for index, row in enumerate(history.rows):
                if all(value(row) is None for _, value in series):
                    ax.axvspan(index - 0.4, index + 0.4, facecolor="#f0f2f5", hatch="//", edgecolor="#c3cbd4", lw=0)
            known = [item for row in history.rows for _, value in series if (item := value(row)) is not None]
            ax.set_ylim(0.0, 1.15 * max(known, default=0.0) or 1.0)
            ax.set_xlim(-0.5, count - 0.5)
            if len(series) > 1:
                ax.legend(fontsize=7, frameon=False, ncols=len(series))
        for ax in axes[-1]:
            ax.set_xticks(range(count), [row.folder for row in history.rows], rotation=40, ha="right")
        figure.suptitle(f"{count} builds; hatched: not known", fontsize=10, color=_INK)
        picture = io.BytesIO()
        figure.savefig(picture, format=form, dpi=130, metadata={"Date": None} if form == "svg" else {"Software": None})
    return picture.getvalue()
