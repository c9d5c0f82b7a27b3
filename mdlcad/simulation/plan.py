"""A system as the kernels walk it.

Masses are walked in order of their number of couplings, so that the length of the inner loop hardly ever changes: a
processor that guesses it wrong loses more time than one coupling takes. Everything is divided by the inertia, and
what the clock modulates, u + w p_k(t), is kept as u + w + (w cos a) sin(2 pi t/T) - (w sin a) cos(2 pi t/T), with
a = 2 pi k/P: two numbers a time then serve all waves.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mdlcad.simulation.system import Floats, Ints, System

Places = NDArray[np.uint64]

# Masses with fewer couplings than this are walked class by class, each in a loop of its own.
UNROLLED = 6


class Plan(NamedTuple):
    """n masses, e coupling entries and h products, in the kernels' order; all coefficients divided by the inertia.

    Attributes:
        order: int[n], the system's index of each mass.
        stiffness: float[3, n], constant, sine and cosine part.
        bias: float[n].
        row_start, column: int[n + 1] and int[e], the couplings of mass i are entries row_start[i]..row_start[i + 1].
        strength: float[3, e], constant, sine and cosine part.
        modulated: whether any sine or cosine part of ``strength`` is not 0.
        class_start: int[UNROLLED + 1], the first mass with at least 0, 1, 2 ... couplings.
        product_start, product_mass, product_first, product_second: int[n + 1] and int[h] each: product_mass is also
            pushed by strength x_first x_second. A latch coupling makes two of these.
        product_strength: float[3, h].
        damping, quartic: b/m and lambda/m.
    """

    order: Ints
    stiffness: Floats
    bias: Floats
    row_start: Places
    column: Places
    strength: Floats
    modulated: bool
    class_start: Places
    product_start: Places
    product_mass: Places
    product_first: Places
    product_second: Places
    product_strength: Floats
    damping: float
    quartic: float

    def place(self) -> Ints:
        """int[n], where in the kernels' order each mass of the system is."""
        place = np.empty_like(self.order)
        place[self.order] = np.arange(len(self.order))
        return place


def plan_of(system: System) -> Plan:
    """Sort and scale ``system``. The order of the couplings of one mass stays, and with it every rounding error."""
    lengths = np.diff(system.row_start)
    owner = np.concatenate([system.latch_clock, system.latch_mass])
    products = np.bincount(owner, minlength=len(lengths))
    order = np.argsort(lengths, kind="stable")
    place = np.empty_like(order)
    place[order] = np.arange(len(order))

    entries = _runs(system.row_start[order], lengths[order])
    owner_order = np.argsort(place[owner], kind="stable")
    other = np.concatenate([system.latch_mass, system.latch_clock])[owner_order]
    latch_base = np.concatenate([system.latch_base, 2.0 * system.latch_base])[owner_order]
    latch_swing = np.concatenate([system.latch_swing, 2.0 * system.latch_swing])[owner_order]
    latch_wave = np.concatenate([system.latch_wave, system.latch_wave])[owner_order]
    second = np.concatenate([system.latch_mass, system.latch_mass])[owner_order]
    per = 1.0 / system.inertia
    return Plan(
        order=order,
        stiffness=_parts(system, system.stiffness_base[order], system.stiffness_swing[order], system.phase[order]),
        bias=per * system.bias[order],
        row_start=_starts(lengths[order]),
        column=_unsigned(place[system.column[entries]]),
        strength=_parts(system, system.base[entries], system.swing[entries], system.wave[entries]),
        modulated=bool(system.swing.any()),
        class_start=_unsigned(np.searchsorted(lengths[order], np.arange(UNROLLED + 1))),
        product_start=_starts(products[order]),
        product_mass=_unsigned(place[owner][owner_order]),
        product_first=_unsigned(place[other]),
        product_second=_unsigned(place[second]),
        product_strength=_parts(system, latch_base, latch_swing, latch_wave),
        damping=per * system.damping,
        quartic=per * system.quartic,
    )


def turn_table(points: int) -> Floats:
    """float[points, 2]: sine and cosine of 2 pi point / points.

    ``math.sin`` and not numpy's, whose last bit depends on the processor's vector units.
    """
    angles = [2.0 * math.pi * point / points for point in range(points)]
    return np.array([[math.sin(angle), math.cos(angle)] for angle in angles])


def _parts(system: System, base: Floats, swing: Floats, wave: Ints) -> Floats:
    angles = [2.0 * math.pi * k / system.phases for k in range(system.phases)]
    sine = np.array([math.cos(angle) for angle in angles])[wave]
    cosine = np.array([-math.sin(angle) for angle in angles])[wave]
    return np.stack([base + swing, swing * sine, swing * cosine]) / system.inertia


def _unsigned(numbers: Ints) -> Places:
    """Without a sign, an index is used as it is: numba need not ask whether it counts from the end."""
    return numbers.astype(np.uint64)


def _starts(lengths: Ints) -> Places:
    return _unsigned(np.concatenate([[0], np.cumsum(lengths)]))


def _runs(starts: Ints, lengths: Ints) -> Ints:
    """start, start + 1 ... start + length - 1 of every pair, one after the other."""
    within: Ints = np.arange(lengths.sum()) - np.repeat(np.cumsum(lengths) - lengths, lengths)
    return within + np.repeat(starts, lengths)
