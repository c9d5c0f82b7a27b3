"""The picture of a characterisation: window, spread, fan-out, and what the numbers were chosen among."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec

from mdlcad.characterise.measure import BORNE
from mdlcad.characterise.result import CharacterisationResult
from mdlcad.scenario.figures.page import FAINT, GOOD, INK, NEGATIVE, ZERO, new_figure, png

_MAP = LinearSegmentedColormap.from_list("wrong to right", [NEGATIVE, "#f3e6c8", GOOD])


def window_picture(name: str, result: CharacterisationResult) -> bytes:
    """PNG of all measurements that there are of the cell library ``name``."""
    figure = new_figure(13.5, 9.5 if result.loads else 9.0)
    title = f"cell library {name}: own clock period T = {result.period:g}, damping b = {result.damping:g}"
    figure.suptitle(title, fontsize=12, color=INK, y=0.94)
    grid = figure.add_gridspec(2, 2, hspace=0.34, wspace=0.26)
    _draw_map(figure.add_subplot(grid[0, 0]), result)
    _draw_spread(figure.add_subplot(grid[0, 1]), result)
    _draw_choices(figure, grid[1, 0], result)
    if result.loads:
        _draw_loads(figure, grid[1, 1], result)
    return png(figure)


def _draw_map(axes: Axes, result: CharacterisationResult) -> None:
    sweep, total = result.sweep, len(result.cells)
    right = np.zeros((len(sweep.dampings), len(sweep.periods)))
    for point in result.points:
        row, column = sweep.dampings.index(point.damping), sweep.periods.index(point.period)
        right[row, column] = total - len(point.wrong)
    _heat(axes, right / total, [[f"{int(n)}" for n in line] for line in right])
    _ticks(axes, sweep.periods, sweep.dampings)
    axes.set_xlabel("clock period T (model time)")
    axes.set_ylabel("damping b (model units)")
    axes.set_title(f"cells and circuits that are right, of {total}", fontsize=10, color=INK)
    if result.period in sweep.periods and result.damping in sweep.dampings:
        place = (sweep.periods.index(result.period) - 0.5, sweep.dampings.index(result.damping) - 0.5)
        from matplotlib.patches import Rectangle

        axes.add_patch(Rectangle(place, 1, 1, fill=False, edgecolor=INK, linewidth=2.2))


def _draw_spread(axes: Axes, result: CharacterisationResult) -> None:
    for number, cell in enumerate(result.cells):
        counts = [count for count in result.spreads if count.cell == cell]
        share = [100 * count.right / count.samples for count in counts]
        whole = number == len(result.cells) - 1
        axes.plot(
            [100 * count.spread for count in counts],
            share,
            marker="o",
            markersize=3.5,
            linewidth=2.4 if whole else 1.0,
            color=INK if whole else _colour(number, len(result.cells)),
            label=cell,
        )
    axes.axhline(100 * BORNE, color=NEGATIVE, linewidth=0.8, linestyle="--")
    axes.axvline(100 * result.found.spread, color=GOOD, linewidth=1.2)
    axes.set_ylim(-3, 104)
    axes.set_xlim(left=0)
    axes.set_xlabel("spread: standard deviation of spring strength, %")
    axes.set_ylabel("devices right, %")
    samples = result.sweep.samples
    axes.set_title(f"{samples} devices of each; borne up to {100 * result.found.spread:g} %", fontsize=10, color=INK)
    axes.legend(fontsize=6.5, ncol=2, loc="lower left", framealpha=0.9)
    axes.grid(color=FAINT, linewidth=0.6)


def _colour(number: int, total: int) -> tuple[float, float, float]:
    import matplotlib

    red, green, blue, _ = matplotlib.colormaps["turbo"](0.08 + 0.84 * number / max(1, total - 1))
    return red, green, blue


def _draw_choices(figure: Figure, place: SubplotSpec, result: CharacterisationResult) -> None:
    choices = result.found.choice
    # as wide as the numbers of candidates
    widths = [len(choice.candidates) + 1 for choice in choices] or [1]
    grid = place.subgridspec(1, len(widths), wspace=0.12, width_ratios=widths)
    for number, (choice, standing) in enumerate(zip(choices, result.standing, strict=True)):
        axes = figure.add_subplot(grid[0, number])
        share = [100 * right / choice.devices for right in choice.right]
        colours = [GOOD if value == standing else ZERO for value in choice.candidates]
        axes.bar(range(len(share)), share, color=colours, width=0.7)
        words = [value if isinstance(value, str) else f"{value:g}" for value in choice.candidates]
        axes.set_xticks(range(len(share)), words, fontsize=6.5)
        axes.set_xlabel(choice.key, fontsize=8.5)
        axes.set_ylim(0, 100)
        if number:
            axes.set_yticklabels([])
        else:
            axes.set_ylabel("devices right at four corners, %")
            spread = 100 * result.sweep.choice_spread
            axes.set_title(
                f"candidates at {spread:g} % spread (green: the library's)", fontsize=10, color=INK, loc="left"
            )
        axes.grid(axis="y", color=FAINT, linewidth=0.6)
        axes.set_axisbelow(True)


def _draw_loads(figure: Figure, place: SubplotSpec, result: CharacterisationResult) -> None:
    cells = list(dict.fromkeys(count.cell for count in result.loads))
    grid = place.subgridspec(1, len(cells), wspace=0.12)
    sweep = result.sweep
    for number, cell in enumerate(cells):
        axes = figure.add_subplot(grid[0, number])
        right = np.zeros((len(sweep.echoes), len(sweep.loads)))
        for count in result.loads:
            if count.cell == cell:
                right[sweep.echoes.index(count.echo), sweep.loads.index(count.load)] = count.right
        _heat(axes, right / sweep.load_samples, [[f"{int(n)}" for n in line] for line in right])
        _ticks(axes, sweep.loads, sweep.echoes)
        axes.set_xlabel("fan-out (sum of weights)")
        axes.set_title(f"{cell}", fontsize=9, color=INK)
        if number:
            axes.set_yticklabels([])
        else:
            axes.set_ylabel(
                f"echo; devices right of {sweep.load_samples} at {100 * sweep.load_spread:g} % spread", fontsize=9
            )


def _heat(axes: Axes, part: np.ndarray, words: list[list[str]]) -> None:
    axes.imshow(part, origin="lower", aspect="auto", cmap=_MAP, vmin=0, vmax=1)
    for row, line in enumerate(words):
        for column, word in enumerate(line):
            axes.text(column, row, word, ha="center", va="center", fontsize=8.5, color=INK)


def _ticks(axes: Axes, columns: tuple[float, ...], rows: tuple[float, ...]) -> None:
    axes.set_xticks(range(len(columns)), [f"{value:g}" for value in columns])
    axes.set_yticks(range(len(rows)), [f"{value:g}" for value in rows])
