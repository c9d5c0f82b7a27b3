"""The run as an animated GIF: the world on the left, the network's masses at work on the right.

Backgrounds are drawn once; a frame redraws only what moves, and all frames share one palette.
"""

from __future__ import annotations

import io
from itertools import pairwise
from typing import Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PathCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.patches import Circle, Rectangle
from matplotlib.text import Text
from PIL import Image

from mdlcad.network.model import Network
from mdlcad.scenario.figures.maze import draw_map
from mdlcad.scenario.figures.network import couplings, outline
from mdlcad.scenario.figures.page import FAINT, GOOD, INK, NEGATIVE, ONE, PAPER, ZERO, bare, new_figure
from mdlcad.scenario.loop import Journey
from mdlcad.scenario.result import Decision
from mdlcad.scenario.seats import Seats
from mdlcad.scenario.world import Cell, Maze
from mdlcad.simulation.system import Floats, Ints

_WIDTH, _HEIGHT, _DPI = 9.0, 4.7, 80
_MOST_FRAMES = 200
_COLOURS = 80
_MASS_COLOURS = 40

# displacement: 0 blue, 1 orange, in between white
_SHADES = LinearSegmentedColormap.from_list("displacement", [ZERO, "#ffffff", ONE])


class _World(Protocol):
    """The left half: what moves in it."""

    moving: list[Rectangle | Circle | Text]

    def show(self, decision: int, share: float) -> None:
        """Set it to ``share`` (0 to 1) of ``decision``."""
        ...


def animation(
    network: Network, seats: Seats, journey: Journey, steps: Ints, x: Floats, decisions: tuple[Decision, ...]
) -> bytes:
    """GIF of the whole run, at most _MOST_FRAMES frames.

    Args:
        steps, x: int[f] and float[f, n], the trace.
    """
    figure = new_figure(_WIDTH, _HEIGHT, _DPI)
    left = figure.add_axes((0.01, 0.02, 0.47, 0.88))
    right = figure.add_axes((0.51, 0.02, 0.48, 0.88))
    worlds = [world for world in journey.worlds if isinstance(world, Maze)]
    world: _World = _Walk(left, worlds, decisions) if worlds else _Lamps(left, decisions)
    dots = _network(right, network, seats)
    head = figure.text(0.01, 0.955, "", fontsize=10, color=INK, va="center")
    moving = [*world.moving, dots, head]
    for artist in moving:
        artist.set_animated(True)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    background = canvas.copy_from_bbox(figure.bbox)

    polarity = np.array([mass.polarity for mass in network.masses])
    span = journey.timing.period * journey.steps_per_period
    each = _frames_per_decision(journey)
    pictures = []
    for d, decision in enumerate(decisions):
        for frame in range(each):
            share = (frame + 0.5) / each
            now = int(np.searchsorted(steps, (d + share) * span))
            world.show(d, share)
            dots.set_array(x[min(now, len(x) - 1)] * polarity)
            head.set_text(_head(decision, len(decisions)))
            head.set_color(NEGATIVE if decision.wrong else INK)
            canvas.restore_region(background)
            for artist in moving:
                figure.draw_artist(artist)
            pictures.append(Image.frombuffer("RGBA", canvas.get_width_height(), canvas.buffer_rgba()).convert("RGB"))
    return _gif(pictures, max(40, min(160, 900 // each)))


def _frames_per_decision(journey: Journey) -> int:
    """Three a clock cycle, so that with three waves every mass is seen at its peak; fewer in long runs."""
    wanted = 3 * journey.timing.period
    return max(1, min(wanted, _MOST_FRAMES // journey.decisions))


def _gif(pictures: list[Image.Image], milliseconds: int) -> bytes:
    """GIF of ``pictures`` with the palette of some of them; the last one stays for a while."""
    sample = pictures[:: max(1, len(pictures) // 6)]
    width, height = sample[0].size
    sheet = Image.new("RGB", (width, height * len(sample)))
    for number, picture in enumerate(sample):
        sheet.paste(picture, (0, number * height))
    found = sheet.quantize(_COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    # the shades of masses are given, since they cover too little of the picture to be found
    shades = (255 * _SHADES(np.linspace(0.0, 1.0, _MASS_COLOURS))[:, :3]).round().astype(int).ravel().tolist()
    colours = [*(found.getpalette() or [])[: 3 * _COLOURS], *shades]
    palette = Image.new("P", (1, 1))
    palette.putpalette(colours)
    frames = [np.asarray(picture.quantize(palette=palette, dither=Image.Dither.NONE)) for picture in pictures]
    # what stays as it was is left out, which packs far better; the last index is no colour then
    clear = len(colours) // 3
    shown = [frames[0]]
    for before, now in pairwise(frames):
        shown.append(np.where(now == before, np.uint8(clear), now))
    images = []
    for frame in shown:
        image = Image.fromarray(frame, mode="P")
        image.putpalette([*colours, 255, 255, 255])
        images.append(image)
    stream = io.BytesIO()
    times = [milliseconds] * (len(images) - 1) + [2000]
    images[0].save(
        stream,
        "GIF",
        save_all=True,
        append_images=images[1:],
        duration=times,
        loop=0,
        optimize=False,
        transparency=clear,
        disposal=1,
    )
    return stream.getvalue()


def _head(decision: Decision, count: int) -> str:
    words = f"decision {decision.number}, the last is {count - 1}"
    if decision.words:
        words += f": {decision.words}"
    answer = ", ".join(f"{value.port}: {value.label}" for value in decision.actuators)
    return f"{words}   →   {answer}"


def _network(axes: Axes, network: Network, seats: Seats) -> PathCollection:
    """The network's background in ``axes``; the masses, whose colours are their displacements."""
    points = np.array([seats.masses[mass.name] for mass in network.masses])
    corners = np.concatenate([points, np.array(seats.boundary)])
    low, high = corners.min(axis=0), corners.max(axis=0)
    margin = 0.04 * float((high - low).max())
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_aspect("equal")
    bare(axes)
    outline(axes, seats)
    area = float(np.clip(9000.0 / len(points), 6.0, 170.0))
    couplings(axes, network, seats, area**0.5, arrows=False)
    dots: PathCollection = axes.scatter(
        points[:, 0],
        points[:, 1],
        s=area,
        c=np.zeros(len(points)),
        cmap=_SHADES,
        vmin=-1.6,
        vmax=1.6,
        edgecolors=INK,
        linewidths=0.7,
        zorder=3,
    )
    return dots


class _Walk:
    """The device on its map, with its pressed sides."""

    def __init__(self, axes: Axes, worlds: list[Maze], decisions: tuple[Decision, ...]) -> None:
        draw_map(axes, worlds[0])
        self._worlds = worlds
        self._cells = np.array([world.cell for world in worlds], dtype=float)
        self._body = Rectangle((0, 0), 0.56, 0.56, fc="#f3d9a4", ec=INK, lw=1.5)
        axes.add_patch(self._body)
        self._feelers: list[tuple[int, Cell, Circle]] = []
        for place, way in worlds[0].looks:
            dot = Circle((0, 0), 0.1, ec=INK, lw=0.7)
            axes.add_patch(dot)
            self._feelers.append((place, way, dot))
        self.moving: list[Rectangle | Circle | Text] = [self._body, *(dot for *_, dot in self._feelers)]

    def show(self, decision: int, share: float) -> None:
        here, there = self._cells[decision], self._cells[decision + 1]
        # it thinks first, and then goes
        gone = float(np.clip((share - 0.6) / 0.4, 0.0, 1.0))
        row, column = here + gone * (there - here)
        self._body.set_xy((column - 0.28, row - 0.28))
        felt = self._worlds[decision].feels()
        for place, (down, right), dot in self._feelers:
            dot.center = (column + 0.28 * right, row + 0.28 * down)
            dot.set_facecolor(NEGATIVE if felt[place] else "#ffffff")


class _Lamps:
    """The values of sensors and actuators, a lamp a bit; those of actuators change at the end of a decision."""

    def __init__(self, axes: Axes, decisions: tuple[Decision, ...]) -> None:
        self._decisions = decisions
        self.moving: list[Rectangle | Circle | Text] = []
        self._lamps: list[tuple[bool, int, int, Circle]] = []
        self._labels: list[tuple[bool, int, Text]] = []
        rows = len(decisions[0].sensors) + len(decisions[0].actuators)
        wide = max(len(value.digits) for value in (*decisions[0].sensors, *decisions[0].actuators))
        row = 0.0
        for answers, values in ((False, decisions[0].sensors), (True, decisions[0].actuators)):
            for number, value in enumerate(values):
                axes.text(-0.7, row, value.port, ha="right", va="center", fontsize=11, color=GOOD if answers else INK)
                for digit in range(len(value.digits)):
                    lamp = Circle((digit, row), 0.36, ec=INK, lw=1.0)
                    axes.add_patch(lamp)
                    self._lamps.append((answers, number, digit, lamp))
                words = axes.text(len(value.digits) - 0.3, row, "", va="center", fontsize=10, color=INK)
                self._labels.append((answers, number, words))
                row += 1.15
            axes.axhline(row - 0.45, color=FAINT if not answers else "none", lw=1.0)
            row += 0.3
        self.moving += [lamp for *_, lamp in self._lamps]
        self.moving += [words for *_, words in self._labels]
        axes.set_xlim(-4.2, max(wide + 3.0, 5.0))
        axes.set_ylim(max(row, rows) + 0.2, -1.0)
        axes.set_aspect("equal")
        bare(axes)

    def show(self, decision: int, share: float) -> None:
        now = self._decisions[decision]
        answered = now if share > 0.75 or decision == 0 else self._decisions[decision - 1]
        for answers, number, digit, lamp in self._lamps:
            value = (answered.actuators if answers else now.sensors)[number]
            lamp.set_facecolor({"0": PAPER, "1": ONE, "?": NEGATIVE}[value.digits[digit]])
        for answers, number, words in self._labels:
            value = (answered.actuators if answers else now.sensors)[number]
            words.set_text(value.label if value.label != value.digits else "")
