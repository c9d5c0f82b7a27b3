"""The map and the way that the device took on it."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.patches import Rectangle

from mdlcad.scenario.figures.page import FAINT, GOOD, INK, ONE, bare, new_figure, png
from mdlcad.scenario.world import Cell, Maze

# the way is drawn beside the middle of a corridor, so that there and back again are two lines
_ASIDE = 0.16
_EVERY = 5
_WALL = "#565b66"

_TIME = LinearSegmentedColormap.from_list("time", ["#3b6ea8", "#7a5ba8", "#d9822b"])


def draw_map(axes: Axes, maze: Maze) -> None:
    """Walls, start and exit; cell (row, column) is the unit square around x = column, y = row, y downwards."""
    rows, columns = len(maze.rows), len(maze.rows[0])
    for row, text in enumerate(maze.rows):
        for column, mark in enumerate(text):
            if mark == "#":
                axes.fill(*_square((row, column), 0.5), color=_WALL, lw=0)
    # beyond the map all is wall
    edge = Rectangle((-0.5, -0.5), columns, rows, fc="none", ec=_WALL, lw=2.5)
    axes.add_patch(edge)
    start = next((row, text.index("S")) for row, text in enumerate(maze.rows) if "S" in text)
    for cell, colour, word in ((start, FAINT, "start"), (maze.exit, GOOD, "exit")):
        axes.fill(*_square(cell, 0.5), color=colour, alpha=0.35, lw=0)
        axes.text(
            cell[1],
            cell[0] + (0.38 if word == "start" else -0.38),
            word,
            ha="center",
            va="center",
            fontsize=7.5,
            color=INK,
        )
    axes.set_xlim(-0.6, columns - 0.4)
    axes.set_ylim(rows - 0.4, -0.6)
    axes.set_aspect("equal")
    bare(axes)


def trajectory(worlds: tuple[Maze, ...], title: str) -> bytes:
    """PNG of the whole way through ``worlds``, numbered by decisions."""
    maze = worlds[0]
    rows, columns = len(maze.rows), len(maze.rows[0])
    figure = new_figure(0.62 * columns + 0.4, 0.62 * rows + 0.9)
    axes = figure.add_axes((0.02, 0.02, 0.96, 0.9))
    draw_map(axes, maze)
    cells = np.array([world.cell for world in worlds], dtype=float)
    points, times = _path(cells)
    lines = LineCollection(
        list(np.stack([points[:-1], points[1:]], axis=1)), cmap=_TIME, array=times[:-1], lw=2.2, capstyle="round"
    )
    axes.add_collection(lines)
    moves = np.diff(cells, axis=0)
    for d, (cell, move) in enumerate(zip(cells, moves, strict=False)):
        if not move.any():
            continue
        x, y = cell[1] + 0.5 * move[1], cell[0] + 0.5 * move[0]
        aside = _left_of(move)
        x, y = x + aside[0], y + aside[1]
        colour = _TIME(d / max(1, len(moves) - 1))
        head = (x + 0.09 * move[1], y + 0.09 * move[0])
        axes.annotate(
            "", head, (x, y), arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 0, "mutation_scale": 13}
        )
        if d % _EVERY == 0:
            spot = (x + 1.1 * aside[0], y + 1.1 * aside[1])
            axes.text(*spot, str(d), fontsize=7.5, ha="center", va="center", color=INK)
    axes.plot(points[-1, 0], points[-1, 1], "o", ms=8, color=GOOD if worlds[-1].cell == maze.exit else ONE, zorder=5)
    axes.set_title(title, fontsize=10.5, color=INK)
    return png(figure)


def _path(cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corner points float[p, 2] as (x, y) of the way beside the middle, and the decision of each."""
    points, times = [cells[0, ::-1]], [0.0]
    for d, move in enumerate(np.diff(cells, axis=0)):
        if not move.any():
            continue
        aside = _left_of(move)
        # from edge to edge of the middle square, so that a turn is a short slant within a cell
        begin, end = cells[d, ::-1] + 0.2 * move[::-1], cells[d + 1, ::-1] - 0.2 * move[::-1]
        points += [begin + aside, end + aside]
        times += [float(d), float(d)]
    points.append(cells[-1, ::-1])
    times.append(float(len(cells)))
    return np.array(points), np.array(times)


def _left_of(move: np.ndarray) -> np.ndarray:
    """(x, y) offset to the left of a move (rows, columns), rows running downwards."""
    return _ASIDE * np.array([move[0], -move[1]])


def _square(cell: Cell, half: float) -> tuple[list[float], list[float]]:
    row, column = cell
    return (
        [column - half, column + half, column + half, column - half],
        [row - half, row - half, row + half, row + half],
    )
