"""The annealer's state: where everything is, and the tallies that its cost is made of."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from mdlcad.placement.chance import random_source
from mdlcad.placement.problem import Floats, Ints, Problem

COLUMN = -2
"""A home of ``COLUMN - c`` is any slot of column c."""


class State(NamedTuple):
    """A *net-channel* 2 m + side is what the net of mass m has in the channel left (0) or right (1) of m.

    Attributes:
        mass: (M, 2) slot, side of the bias leaf. mass_at: mass or -1 by slot. side: (J,) channel side of couplings.
        row: (C, R, 9) tallies of a row of a channel.
        items: (C, R, 2, deep) what meets a row on either side: 2 * net-channel + whether it has a post; ``_deep`` is
            the most that can.
        trunks, trunk_count: the net-channels with a trunk, by band: band B c + b holds those that enter the b-th of
            B equal parts of the rows of channel c.
        window, rows: by net-channel, lowest and highest x (mm) and row of its trunk.
        dirty: bands whose trunks have changed. marked: (2,) the first that may have, and one past the last.
        seat: by net-channel, its place in the band that is being packed. late: by that place, whether the trunk found
            no track. at, due, waits, last, alive, orders: room for packing tracks; an order is (first, second, order
            before it with the same first or -1).
        home: (max(M, J), 3) by mass the slot (or column, see ``COLUMN``) and bias side, by coupling the channel side
            that it should keep, or -1.
        careful: (1,) more than 0 if trunks are packed alike in whatever order they were registered, and rings broken
            one by one, which large networks need to be told what is left of them; and then, what a trunk without a
            track weighs beside other broken rules.
        price: what it costs a mass to leave its home slot, and a leaf or coupling its home side.
    """

    mass: Ints
    mass_at: Ints
    side: Ints
    row: Ints
    items: Ints
    trunks: Ints
    trunk_count: Ints
    window: Floats
    rows: Ints
    dirty: Ints
    marked: Ints
    seat: Ints
    late: Ints
    at: Floats
    due: Floats
    waits: Ints
    last: Ints
    alive: Ints
    orders: Ints
    home: Ints
    careful: Floats
    price: Floats


def start(problem: Problem, slot_of: Ints, seed: int, band: int | None = None) -> tuple[State, npt.NDArray[np.uint64]]:
    """A state with the given slots, and a seeded random source.

    Trunks are packed in bands of at most ``band`` rows; None packs whole channels.
    """
    masses, channels, rows = len(slot_of), problem.limits.shape[0], problem.limits.shape[1]
    deep = _deep(problem)
    together = max(1, rows if band is None else min(rows, band))
    bands = channels * max(1, -(-rows // together))
    mass_at = np.full(len(problem.slot), -1, np.int32)
    mass_at[slot_of] = np.arange(masses, dtype=np.int32)
    state = State(
        mass=np.stack([slot_of, np.zeros_like(slot_of)], axis=1).astype(np.int32),
        mass_at=mass_at,
        side=np.zeros(len(problem.coupling), np.int32),
        row=np.zeros((channels, rows, 9), np.int32),
        items=np.zeros((channels, rows, 2, deep), np.int32),
        trunks=np.zeros((bands, masses + 1), np.int32),
        trunk_count=np.zeros(bands, np.int32),
        window=np.zeros((2 * masses, 2)),
        rows=np.zeros((2 * masses, 2), np.int32),
        dirty=np.zeros(bands, np.int32),
        marked=np.array([bands, 0], np.int32),
        seat=np.zeros(2 * masses, np.int32),
        late=np.zeros(masses + 1, np.int32),
        at=np.zeros(masses + 1),
        due=np.zeros(masses + 1),
        waits=np.zeros(masses + 1, np.int32),
        last=np.zeros(masses + 1, np.int32),
        alive=np.zeros(masses + 1, np.int32),
        orders=np.zeros((min(rows, together) * 3 * deep * deep, 3), np.int32),
        home=np.full((max(masses, len(problem.coupling)), 3), -1, np.int32),
        careful=np.zeros(1),
        price=np.zeros(2),
    )
    return state, random_source(seed)


def _deep(problem: Problem) -> int:
    """Most items that can ever meet one side of a row of a channel; the kernels write without looking.

    A hub there brings a rung of its own net and its inputs; and every tab that leaves in that row may pass, as the
    masses of all may stand in one column.
    """
    inputs = int(np.max(np.diff(problem.mass[:, 1]), initial=0))
    met = np.zeros(problem.limits.shape[1], np.int32)
    for low, high in problem.tab[:, :2].tolist():
        met[low : high + 1] += 1
    return 1 + inputs + int(np.max(met, initial=0))
