"""The clock: one loop of cells round which a single 1 travels, or two of co-prime lengths joined by an AND."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mdlcad.mapping.two_phase.cell_library import AND_TABLE, TwoPhaseLibrary

TICK = "tick"

_LEAST_LOOP = 2


@dataclass(frozen=True, slots=True)
class Clock:
    """Lengths of the loops, in power-clock cycles; one or two of them."""

    loops: tuple[int, ...]

    @property
    def length(self) -> int:
        """Cycles from tick to tick."""
        return math.prod(self.loops)


def plan_clock(length: int, join_cells: int) -> Clock:
    """The loops with the fewest cells whose ticks are ``length`` cycles apart; for equal numbers a single loop.

    Args:
        join_cells: cells that joining two loops takes beyond the buffer that a single loop ends in.
    """
    best = length
    loops: tuple[int, ...] = (length,)
    for short in range(_LEAST_LOOP, math.isqrt(length) + 1):
        long = length // short
        if short * long == length and math.gcd(short, long) == 1 and short + long + join_cells < best:
            best, loops = short + long + join_cells, (short, long)
    return Clock(loops)


@dataclass(frozen=True, slots=True)
class ClockCell:
    """A cell of the clock by the name of its output net, and what it reads."""

    net: str
    cell: str
    sources: tuple[str, ...]


def join_cells(library: TwoPhaseLibrary) -> int:
    """Cells that joining two loops takes beyond the buffer that a single loop ends in."""
    return 0 if library.cell(library.roles.join).function == AND_TABLE else 2


def loop_net(loop: int, place: int) -> str:
    """The net of a loop's cell; place 0 is where the loop is tapped."""
    return f"{TICK}.{'ab'[loop]}{place}"


def clock_cells(clock: Clock, library: TwoPhaseLibrary) -> tuple[ClockCell, ...]:
    """The loops and what makes the net ``TICK`` of them."""
    buffer, roles = library.options.buffer, library.roles
    cells = [
        ClockCell(loop_net(loop, place), buffer, (loop_net(loop, (place - 1) % length),))
        for loop, length in enumerate(clock.loops)
        for place in range(length)
    ]
    taps = [loop_net(loop, 0) for loop in range(len(clock.loops))]
    if len(taps) == 1:
        return (*cells, ClockCell(TICK, buffer, (taps[0],)))
    if join_cells(library):
        cells += [ClockCell(f"{tap}.{roles.inverter.lower()}", roles.inverter, (tap,)) for tap in taps]
        taps = [cell.net for cell in cells[-2:]]
    return (*cells, ClockCell(TICK, roles.join, tuple(taps)))


def tap_delay(clock: Clock, library: TwoPhaseLibrary) -> int:
    """Cycles from the taps of the loops to the tick."""
    return 2 if len(clock.loops) == 2 and join_cells(library) else 1
