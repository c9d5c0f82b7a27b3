"""What all pictures share: colours, and how a figure becomes bytes that depend on nothing but the drawing."""

from __future__ import annotations

import io

import matplotlib
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

INK = "#22252b"
FAINT = "#c9ccd3"
PAPER = "#f4f4f1"
ZERO = "#3b6ea8"
ONE = "#d9822b"
NEGATIVE = "#c8202f"
LATCH = "#7a2fb5"
POSITIVE = "#8d939e"
GOOD = "#2e8b57"

# one colour a clock wave, distinct from each other in grey as well
PHASES = ("#e6b84c", "#5aa6a6", "#5b4a8a", "#a3c75e", "#b25d8f", "#4f7f3f")

_DPI = 120


def new_figure(width: float, height: float, dpi: int = _DPI) -> Figure:
    """An empty figure of ``width`` x ``height`` inches."""
    figure = Figure(figsize=(width, height), dpi=dpi, facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def png(figure: Figure) -> bytes:
    """The figure as PNG, cropped to what is drawn; the file names no software and no date."""
    stream = io.BytesIO()
    figure.savefig(stream, format="png", bbox_inches="tight", pad_inches=0.12, metadata={"Software": None})
    return stream.getvalue()


def svg(figure: Figure) -> bytes:
    """The figure as SVG, cropped likewise; text stays text."""
    stream = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": "mdlcad", "svg.fonttype": "none"}):
        nothing = {"Date": None, "Creator": None, "Format": None, "Type": None}
        figure.savefig(stream, format="svg", bbox_inches="tight", pad_inches=0.12, metadata=nothing)
    return stream.getvalue()


def bare(axes: Axes) -> None:
    """Neither ticks nor frame."""
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_visible(False)
