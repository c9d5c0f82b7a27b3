"""The state machine as it was walked: states that were met, and the transitions between them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, FancyArrowPatch

from mdlcad.scenario.figures.page import INK, NEGATIVE, PAPER, POSITIVE, bare, new_figure, png
from mdlcad.scenario.registers import RegisterValue
from mdlcad.scenario.result import Decision, ScenarioResult

_RADIUS = 0.34

# input vectors written at an arrow; of more, the first are written
_VECTORS = 4

State = tuple[RegisterValue, ...]


@dataclass(frozen=True, slots=True)
class Move:
    """All decisions that led from one state to another: their inputs, in order of first use, and how many."""

    source: int
    target: int
    inputs: tuple[str, ...]
    count: int
    wrong: bool


def walked(result: ScenarioResult) -> tuple[tuple[State, ...], tuple[Move, ...]]:
    """States in the order in which they were met (power-up first), and the moves between them."""
    history = [decision.before for decision in result.decisions] + [result.after]
    states = tuple(dict.fromkeys(history))
    found: dict[tuple[int, int], list[int]] = {}
    for decision, after in zip(result.decisions, history[1:], strict=True):
        found.setdefault((states.index(decision.before), states.index(after)), []).append(decision.number)
    moves = []
    for (source, target), numbers in sorted(found.items()):
        felt = [_vector(result.decisions[number]) for number in numbers]
        wrong = any(result.decisions[number].wrong for number in numbers)
        moves.append(Move(source, target, tuple(dict.fromkeys(felt)), len(numbers), wrong))
    return states, tuple(moves)


def machine(result: ScenarioResult, reachable: str) -> bytes:
    """PNG of the machine.

    Args:
        reachable: how many states the program can reach, in words.
    """
    states, moves = walked(result)
    n = len(states)
    # circles on the ring are at least 2.6 radii apart
    ring = max(1.35, 1.3 * _RADIUS / math.sin(math.pi / n)) if n > 1 else 0.0
    figure = new_figure(2.2 * ring + 4.0, 2.2 * ring + 4.0)
    axes = figure.add_axes((0.0, 0.06, 1.0, 0.86))
    # the first at the top, then clockwise; two side by side
    turn = math.pi if n == 2 else math.pi / 2
    place = [
        (ring * math.cos(turn - 2 * math.pi * i / n), ring * math.sin(turn - 2 * math.pi * i / n))
        if n > 1
        else (0.0, 0.0)
        for i in range(n)
    ]
    circles = []
    for number, (state, spot) in enumerate(zip(states, place, strict=True)):
        circle = Circle(spot, _RADIUS, fc=PAPER, ec=INK, lw=1.4, zorder=3)
        axes.add_patch(circle)
        circles.append(circle)
        if number == 0:
            axes.add_patch(Circle(spot, _RADIUS * 0.9, fc="none", ec=INK, lw=0.8, zorder=4))
        label = _shown_in(result, state)
        words = "\n".join(map(str, state))
        axes.text(
            *spot, f"{label}\n{words}" if label else words, ha="center", va="center", fontsize=8, color=INK, zorder=5
        )
    pairs = {(move.source, move.target) for move in moves}
    for move in moves:
        if move.source == move.target:
            _loop(axes, place[move.source], move)
        else:
            _arrow(axes, circles[move.source], circles[move.target], move, (move.target, move.source) in pairs)
    reach = 2.2 * _RADIUS + 0.35
    axes.set_xlim(min(x for x, _ in place) - reach, max(x for x, _ in place) + reach)
    axes.set_ylim(min(y for _, y in place) - reach, max(y for _, y in place) + reach)
    axes.set_aspect("equal")
    bare(axes)
    axes.set_title(
        f"{result.scenario}: {n} of {reachable} states, {len(moves)} transitions between them", fontsize=10.5, color=INK
    )
    order = " ".join(value.port for value in result.decisions[0].sensors)
    axes.text(
        0.5,
        -0.01,
        f"at an arrow: sensors ({order}), × how often; double circle: power-up",
        transform=axes.transAxes,
        ha="center",
        va="top",
        fontsize=8,
        color=INK,
    )
    return png(figure)


def _shown_in(result: ScenarioResult, state: State) -> str:
    """What the actuators always showed after a decision that led to ``state``; "" if that depends on the inputs."""
    after = [decision.before for decision in result.decisions[1:]] + [result.after]
    shown = {
        ", ".join(value.label for value in decision.actuators)
        for decision, state_after in zip(result.decisions, after, strict=True)
        if state_after == state
    }
    return shown.pop() if len(shown) == 1 else ""


def _vector(decision: Decision) -> str:
    """What was felt, as digits in the order of the sensors, with gaps between sensors of several bits."""
    gap = " " if any(len(value.digits) > 1 for value in decision.sensors) else ""
    return gap.join(value.digits for value in decision.sensors)


def _words(move: Move) -> str:
    lines = [*move.inputs[:_VECTORS]]
    if len(move.inputs) > _VECTORS:
        lines.append(f"and {len(move.inputs) - _VECTORS} more")
    return "\n".join(lines) + (f"\n× {move.count}" if move.count > 1 else "")


def _arrow(axes: Axes, source: Circle, target: Circle, move: Move, both_ways: bool) -> None:
    a, b = source.center, target.center
    bend = 0.22 if both_ways else 0.06
    colour = NEGATIVE if move.wrong else INK
    axes.add_patch(
        FancyArrowPatch(
            a,
            b,
            connectionstyle=f"arc3,rad={bend}",
            arrowstyle="-|>",
            mutation_scale=14,
            shrinkA=0,
            shrinkB=0,
            patchA=source,
            patchB=target,
            color=colour,
            lw=1.3,
            zorder=2,
        )
    )
    (ax, ay), (bx, by) = a, b
    dx, dy = bx - ax, by - ay
    # arc3 bends to the right of the way from a to b
    x, y = (ax + bx) / 2 + bend / 2 * dy, (ay + by) / 2 - bend / 2 * dx
    _label(axes, x, y, move)


def _loop(axes: Axes, spot: tuple[float, float], move: Move) -> None:
    out = np.array(spot) / (math.hypot(*spot) or 1.0) if any(spot) else np.array([0.0, 1.0])
    side = np.array([-out[1], out[0]])
    a, b = (np.array(spot) + _RADIUS * (0.86 * out + sign * 0.5 * side) for sign in (1.0, -1.0))
    axes.add_patch(
        FancyArrowPatch(
            tuple(a),
            tuple(b),
            connectionstyle="arc3,rad=-1.6",
            arrowstyle="-|>",
            mutation_scale=12,
            shrinkA=0,
            shrinkB=0,
            color=NEGATIVE if move.wrong else POSITIVE,
            lw=1.3,
            zorder=2,
        )
    )
    middle = np.array(spot) + 2.15 * _RADIUS * out
    _label(axes, float(middle[0]), float(middle[1]), move)


def _label(axes: Axes, x: float, y: float, move: Move) -> None:
    axes.text(
        x,
        y,
        _words(move),
        ha="center",
        va="center",
        fontsize=7,
        family="monospace",
        color=INK,
        zorder=6,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
    )
