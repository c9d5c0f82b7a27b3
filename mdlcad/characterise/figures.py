"""Pictures of yields."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.ticker import MaxNLocator

from mdlcad.scenario.figures.page import FAINT, INK, NEGATIVE, ZERO, new_figure, png

_MOST_BARS = 12


def yield_picture(
    design: str, points: Sequence[tuple[float, float, float, float]], weak: Sequence[tuple[str, int]], samples: int
) -> bytes:
    """PNG: the yield (share, low, high) at every spread, and beside it the cells that failed first.

    Args:
        points: (spread, share, low, high), by spread.
        weak: (cell, count), most frequent first; the first few are drawn.
    """
    shown = weak[:_MOST_BARS]
    figure = new_figure(10.5 if shown else 5.5, 4.2)
    grid = figure.add_gridspec(1, 2 if shown else 1, wspace=0.12)
    axes = figure.add_subplot(grid[0, 0])
    spread = [100.0 * point[0] for point in points]
    share = [100.0 * point[1] for point in points]
    below = [100.0 * (point[1] - point[2]) for point in points]
    above = [100.0 * (point[3] - point[1]) for point in points]
    axes.errorbar(spread, share, yerr=[below, above], color=ZERO, marker="o", capsize=4, linewidth=1.5)
    axes.set_ylim(-2, 104)
    axes.set_xlim(0, 1.15 * max(spread))
    axes.set_xlabel("spread: standard deviation of spring strength, % ")
    axes.set_ylabel("devices with every decision right, %")
    axes.set_title(f"{design}: yield of {samples} devices, 95 % interval (Wilson)", fontsize=10, color=INK)
    axes.grid(color=FAINT, linewidth=0.6)
    if shown:
        bars = figure.add_subplot(grid[0, 1])
        bars.barh(range(len(shown)), [count for _, count in shown], color=NEGATIVE, height=0.62)
        bars.invert_yaxis()
        bars.set_yticks(range(len(shown)), [name for name, _ in shown], fontsize=8)
        bars.yaxis.tick_right()
        bars.set_xlabel("failed devices in which it was the first")
        more = f" (of {len(weak)}, the first {len(shown)})" if len(weak) > len(shown) else ""
        bars.set_title(f"cells that fail first{more}", fontsize=10, color=INK)
        bars.xaxis.set_major_locator(MaxNLocator(integer=True))
        bars.grid(axis="x", color=FAINT, linewidth=0.6)
        bars.set_axisbelow(True)
    return png(figure)
