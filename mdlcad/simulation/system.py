"""A network as the flat arrays that the kernel walks.

Every linear coupling of strength c pushes its two ends by c d x_other, d = d0 + d1 p_source; so the couplings form a
symmetric sparse matrix, kept row by row (CSR). Self stiffness, k0 and compensation are one number per mass.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mdlcad.errors import UsageError
from mdlcad.network.model import CouplingKind, Network
from mdlcad.simulation.devices import Devices

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class System:
    """Arrays of one network with n masses, e coupling entries (two a linear coupling) and h latch couplings.

    All quantities are dimensionless, as in ``network.model``. A modulated number is ``base + swing * p_wave``.

    Attributes:
        names: mass names; a mass's index is its place in the network.
        phase: int[n], the clock wave of each mass.
        stiffness_base, stiffness_swing: float[n], so that k = base + swing p_phase; base holds k0, the compensation
            and the self stiffness of all springs at the mass.
        bias: float[n], q.
        initial: float[n], displacement at t = 0 (velocity is 0).
        polarity: int[n], +1 or -1.
        row_start, column: int[n + 1] and int[e], the couplings of mass i are entries row_start[i]..row_start[i + 1].
        base, swing, wave: float[e], float[e], int[e], strength of each entry and the wave that modulates it.
        latch_clock, latch_mass: int[h], the source C and the target M of each latch coupling.
        latch_base, latch_swing, latch_wave: float[h], float[h], int[h], its strength.
        inertia, damping, quartic, period, phases: m, b, lambda, T, P.
        devices: devices of this structure with numbers of their own, which are then what is simulated.
    """

    names: tuple[str, ...]
    phase: Ints
    stiffness_base: Floats
    stiffness_swing: Floats
    bias: Floats
    initial: Floats
    polarity: Ints
    row_start: Ints
    column: Ints
    base: Floats
    swing: Floats
    wave: Ints
    latch_clock: Ints
    latch_mass: Ints
    latch_base: Floats
    latch_swing: Floats
    latch_wave: Ints
    inertia: float
    damping: float
    quartic: float
    period: float
    phases: int
    devices: Devices | None = None

    def index(self, name: str) -> int:
        """Index of the mass called ``name``; UsageError if there is none."""
        try:
            return self.names.index(name)
        except ValueError:
            raise UsageError(f"the network has no mass called {name!r}") from None


def system_of(network: Network) -> System:
    """Flatten ``network``.

    Raises:
        UsageError: two masses share a name, a coupling names an unknown mass or couples a mass to itself, a phase is
            out of range, a number is not finite, inertia or period is not positive, or a latch coupling has self
            stiffness (the model gives it none).
    """
    names = tuple(mass.name for mass in network.masses)
    place = {name: index for index, name in enumerate(names)}
    if len(place) != len(names):
        raise UsageError("two masses of the network share a name")
    dynamics = network.dynamics
    if not (dynamics.inertia > 0 and dynamics.period > 0 and dynamics.phases >= 1):
        raise UsageError("inertia, period and the number of phases must be positive")
    for mass in network.masses:
        if not 0 <= mass.phase < dynamics.phases:
            raise UsageError(f"mass {mass.name!r} has phase {mass.phase}, but there are {dynamics.phases} phases")
        if not all(map(math.isfinite, (mass.k0, mass.k1, mass.compensation, mass.bias, mass.initial))):
            raise UsageError(f"mass {mass.name!r} has a number that is not finite")

    self_stiffness = np.zeros(len(names))
    rows: list[list[tuple[int, float, float, int]]] = [[] for _ in names]
    latches: list[tuple[int, int, float, float, int]] = []
    for coupling in network.couplings:
        for end in (coupling.source, coupling.target):
            if end not in place:
                raise UsageError(f"coupling {coupling.name!r} names an unknown mass {end!r}")
        source, target = place[coupling.source], place[coupling.target]
        if source == target:
            raise UsageError(f"coupling {coupling.name!r} couples a mass to itself")
        base, swing = coupling.strength * coupling.d0, coupling.strength * coupling.d1
        if not (math.isfinite(base) and math.isfinite(swing) and math.isfinite(coupling.self_stiffness)):
            raise UsageError(f"coupling {coupling.name!r} has a number that is not finite")
        wave = network.masses[source].phase
        if coupling.kind is CouplingKind.LATCH:
            if coupling.self_stiffness != 0.0:
                raise UsageError(f"latch coupling {coupling.name!r} has self stiffness; the model gives it none")
            latches.append((source, target, base, swing, wave))
            continue
        self_stiffness[source] += coupling.self_stiffness
        self_stiffness[target] += coupling.self_stiffness
        rows[source].append((target, base, swing, wave))
        rows[target].append((source, base, swing, wave))

    entries = [entry for row in rows for entry in row]
    return System(
        names=names,
        phase=_ints([mass.phase for mass in network.masses]),
        stiffness_base=_floats([mass.k0 + mass.compensation for mass in network.masses]) + self_stiffness,
        stiffness_swing=_floats([mass.k1 for mass in network.masses]),
        bias=_floats([mass.bias for mass in network.masses]),
        initial=_floats([mass.initial for mass in network.masses]),
        polarity=_ints([mass.polarity for mass in network.masses]),
        row_start=np.cumsum([0] + [len(row) for row in rows], dtype=np.int64),
        column=_ints([entry[0] for entry in entries]),
        base=_floats([entry[1] for entry in entries]),
        swing=_floats([entry[2] for entry in entries]),
        wave=_ints([entry[3] for entry in entries]),
        latch_clock=_ints([latch[0] for latch in latches]),
        latch_mass=_ints([latch[1] for latch in latches]),
        latch_base=_floats([latch[2] for latch in latches]),
        latch_swing=_floats([latch[3] for latch in latches]),
        latch_wave=_ints([latch[4] for latch in latches]),
        inertia=dynamics.inertia,
        damping=dynamics.damping,
        quartic=dynamics.quartic,
        period=dynamics.period,
        phases=dynamics.phases,
    )


def wave_table(phases: int, points: int) -> Floats:
    """float[points, phases]: p_k = 1 + sin(2 pi t/T - 2 pi k/P) at t = T point / points."""
    turn = 2.0 * math.pi
    return _floats(
        [[1.0 + math.sin(turn * (point / points - k / phases)) for k in range(phases)] for point in range(points)]
    )


def energy(system: System, x: Floats, v: Floats, waves: Floats) -> float:
    """Kinetic energy plus V (see ``network.model``) of state ``x``, ``v`` (float[n] each) at clock waves float[P]."""
    stiffness = system.stiffness_base + system.stiffness_swing * waves[system.phase]
    local = 0.25 * system.quartic * x**4 + 0.5 * stiffness * x**2 + system.bias * x
    owner = np.repeat(np.arange(len(x)), np.diff(system.row_start))
    strength = system.base + system.swing * waves[system.wave]
    linear = -0.5 * strength * x[owner] * x[system.column]  # every coupling has two entries
    latch_strength = system.latch_base + system.latch_swing * waves[system.latch_wave]
    latch = -latch_strength * x[system.latch_clock] * x[system.latch_mass] ** 2
    return float(0.5 * system.inertia * (v @ v) + local.sum() + linear.sum() + latch.sum())


def _floats(values: list[float] | list[list[float]]) -> Floats:
    return np.array(values, dtype=np.float64)


def _ints(values: list[int]) -> Ints:
    return np.array(values, dtype=np.int64)
