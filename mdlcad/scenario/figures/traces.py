"""Displacements over time: sensors, tick, registers and actuators, with the decisions and what was read."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from mdlcad.network.model import Network
from mdlcad.scenario.figures.page import FAINT, GOOD, INK, NEGATIVE, ONE, ZERO, new_figure, png
from mdlcad.scenario.loop import Journey
from mdlcad.scenario.result import Decision
from mdlcad.simulation.decode import DECIDED, decode, instants, wells
from mdlcad.simulation.system import Floats, Ints

_ROW = 0.55
_HEAD = 0.75

# inches of a decision, with and without the scenario's words over it; wider decisions of many cycles
_TOLD, _UNTOLD, _CYCLE = 1.5, 0.85, 0.36

_WIDTH = 14.0

# a picture of more is too tall to look at
MOST_SHOWN = 64


@dataclass(frozen=True, slots=True)
class _Row:
    label: str
    mass: int
    colour: str


def traces(network: Network, journey: Journey, steps: Ints, x: Floats, decisions: tuple[Decision, ...]) -> bytes:
    """PNG of the first MOST_SHOWN decisions, in as many strips, one below the other, as they need.

    Args:
        steps, x: int[f] and float[f, n], the trace.
    """
    rows = _rows(network, journey)
    shown = min(MOST_SHOWN, journey.decisions)
    wide = max(_TOLD if any(item.words for item in decisions) else _UNTOLD, _CYCLE * journey.timing.period)
    strips = max(1, math.ceil(shown * wide / _WIDTH))
    length = math.ceil(shown / strips)
    strip_height = _ROW * len(rows) + _HEAD
    figure = new_figure(length * wide + 1.8, strips * strip_height + 0.5)
    grid = figure.add_gridspec(strips, 1, hspace=_HEAD / strip_height * 1.6)
    for strip in range(strips):
        first = strip * length
        inner = grid[strip, 0].subgridspec(len(rows), 1, hspace=0.12)
        axes = [figure.add_subplot(inner[number, 0]) for number in range(len(rows))]
        _strip(axes, rows, journey, steps, x, first, first + length, min(shown, first + length))
        _heads(axes[0], decisions[first : min(shown, first + length)])
    more = f"; {journey.decisions - shown} more decisions follow" if shown < journey.decisions else ""
    cycles = "1 clock cycle" if journey.timing.period == 1 else f"{journey.timing.period} clock cycles"
    axes[-1].set_xlabel(
        f"decision ({cycles} each){more}. "
        "Dots: where a mass is read, blue 0, orange 1, red neither. Upside-down masses are turned.",
        fontsize=8.5,
        color=INK,
    )
    return png(figure)


def _strip(
    axes: list[Axes], rows: list[_Row], journey: Journey, steps: Ints, x: Floats, first: int, end: int, last: int
) -> None:
    """Decisions ``first`` to ``last`` (not included) on a time axis that reaches to ``end``."""
    span = journey.timing.period * journey.steps_per_period
    seen = (steps >= first * span) & (steps <= last * span)
    masses = np.array([row.mass for row in rows], dtype=np.int64)
    instant = instants(journey.system, masses, journey.steps_per_period)
    depth = wells(journey.system, masses)
    for number, (row, here) in enumerate(zip(rows, axes, strict=True)):
        # so that up is 1 in every row
        up = x[seen, row.mass] * journey.system.polarity[row.mass]
        _bands(here, first, last, float(depth[number]))
        here.plot(steps[seen] / span, up, color=row.colour, lw=1.0)
        _dots(here, journey, steps, x, row, int(instant[number]), first, last)
        reach = 1.25 * max(1.0, float(depth[number]), float(np.abs(up).max(initial=0.0)))
        here.set_ylim(-reach, reach)
        here.set_xlim(first, end)
        here.set_yticks([])
        here.text(
            -0.006, 0.5, row.label, transform=here.transAxes, ha="right", va="center", fontsize=9, color=row.colour
        )
        for spine in here.spines.values():
            spine.set_visible(False)
        here.set_xticks(np.arange(first, last + 1))
        lowest = number == len(rows) - 1
        here.tick_params(bottom=False, labelbottom=lowest, labelsize=7.5, labelcolor=INK)


def _rows(network: Network, journey: Journey) -> list[_Row]:
    place = journey.system.index
    taker = {port.bit: port.mass for port in network.sensors}
    giver = {port.bit: port.mass for port in network.actuators}
    rows = [_Row(bit, place(taker[bit]), "#4a5568") for bit in journey.reference.inputs]
    if network.tick is not None:
        rows.append(_Row("tick", place(network.tick), "#8a6d1d"))
    outputs = [_Row(bit, place(giver[bit]), GOOD) for bit in journey.reference.outputs]
    given = {row.mass for row in outputs}
    # a register that is an actuator itself is drawn once, as the actuator
    kept = [_Row(register.bit, place(register.mass), "#5b4a8a") for register in network.registers]
    return rows + [row for row in kept if row.mass not in given] + outputs


def _bands(axes: Axes, first: int, last: int, depth: float) -> None:
    """Where a mass counts as 0 and as 1, and the boundaries of the decisions."""
    far = 10.0 + depth
    for low, high, colour in ((DECIDED * depth, far, ONE), (-far, -DECIDED * depth, ZERO)):
        axes.fill_between([first, last], low, high, color=colour, alpha=0.09, lw=0)
    for d in range(first, last + 1):
        axes.axvline(d, color=FAINT, lw=0.8, zorder=0)


def _dots(axes: Axes, journey: Journey, steps: Ints, x: Floats, row: _Row, instant: int, first: int, last: int) -> None:
    """The mass at its own instant of every clock cycle, coloured by the bit that it reads as."""
    spp = journey.steps_per_period
    span = journey.timing.period * spp
    moments = np.arange(first * span, last * span, spp) + instant
    at = np.interp(moments, steps, x[:, row.mass])
    bits = decode(journey.system, np.array([row.mass]), at[:, None, None])[:, 0, 0]
    colours = np.array([ZERO, ONE, NEGATIVE])[bits]
    axes.scatter(moments / span, at * journey.system.polarity[row.mass], s=9, c=colours, zorder=3, lw=0)


def _heads(axes: Axes, decisions: tuple[Decision, ...]) -> None:
    """Over every decision the scenario's words and the answer; wrong decisions in red."""
    for decision in decisions:
        words = ", ".join(value.label for value in decision.actuators)
        if decision.words:
            words = f"{_fold(decision.words)}\n→ {words}"
        axes.text(
            decision.number + 0.5,
            1.08,
            words,
            transform=axes.get_xaxis_transform(),
            ha="center",
            va="bottom",
            fontsize=8,
            color=NEGATIVE if decision.wrong else INK,
        )


def _fold(words: str, width: int = 18) -> str:
    lines = [""]
    for word in words.split():
        if len(lines[-1]) + len(word) > width:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return "\n".join(lines)
