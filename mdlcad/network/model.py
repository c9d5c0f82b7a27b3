"""The mass-spring network: one model for every cell library.

    V = sum_i [ lambda/4 x_i^4 + 1/2 (k0_i + compensation_i + k1_i p_phase(i)) x_i^2 + q_i x_i ]
      + sum_linear [ 1/2 s (x_i^2 + x_j^2) - c (d0 + d1 p_source) x_i x_j ]
      - sum_latch  [ c (d0 + d1 p_source) x_C x_M^2 ]
    m x'' + b x' + dV/dx = F(t),        p_k(t) = 1 + sin(2 pi t / T - 2 pi k / P)

All quantities are dimensionless; ``mechanics`` gives them millimetres and newtons.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class MassKind(StrEnum):
    """What a mass is for. The physics is the same for all."""

    SENSOR = "sensor"
    GATE = "gate"
    BUFFER = "buffer"
    REGISTER = "register"
    TICK = "tick"


class CouplingKind(StrEnum):
    """LINEAR: a spring between two masses. LATCH: the source modulates the target's stiffness."""

    LINEAR = "linear"
    LATCH = "latch"


@dataclass(frozen=True, slots=True)
class Mass:
    """One bistable mass.

    Attributes:
        name: stable, readable, derived from the program's own nets; unique in the network.
        phase: index of the power-clock wave that modulates it, 0..P-1.
        k0, k1: stiffness k0 + k1 p that the mass is to have *after* its springs' self terms are absorbed.
        compensation: added to k0 to absorb the self terms of the couplings (minus their sum, or 0).
        bias: q, a constant force -q.
        initial: displacement at t = 0.
        polarity: +1 if logic 1 is at positive x, -1 if the mass is used upside down.
        port: the sensor or actuator bit it serves, as "NAME[i]", or None.
    """

    name: str
    kind: MassKind
    phase: int
    k0: float
    k1: float
    compensation: float
    bias: float
    initial: float
    polarity: int = 1
    port: str | None = None


@dataclass(frozen=True, slots=True)
class Coupling:
    """A spring from ``source`` to ``target``; strength c is signed, s is the self stiffness it adds to both ends.

    d0, d1: the coupling's modulation d0 + d1 p_phase(source); (1, 0) for a passive spring.
    """

    source: str
    target: str
    strength: float
    self_stiffness: float
    kind: CouplingKind = CouplingKind.LINEAR
    d0: float = 1.0
    d1: float = 0.0

    @property
    def name(self) -> str:
        return f"{self.source}->{self.target}"


@dataclass(frozen=True, slots=True)
class Dynamics:
    """Numbers common to all masses: inertia m, damping b, quartic lambda, clock period T, number of phases P."""

    inertia: float
    damping: float
    quartic: float
    period: float
    phases: int


@dataclass(frozen=True, slots=True)
class Register:
    """One state bit of the program: the RTL's name for it and the mass that holds it."""

    bit: str
    mass: str
    initial: bool


@dataclass(frozen=True, slots=True)
class PortBit:
    """One bit of a sensor or actuator ("NAME[i]") and the mass that takes or gives it."""

    bit: str
    mass: str


@dataclass(frozen=True, slots=True)
class Network:
    """The compiled network.

    Attributes:
        tick: the mass of the tick ring that the registers see (None for a device without state).
        cycles_per_tick: power-clock cycles from one decision to the next (for a device without state: cycles until
            the outputs follow the inputs).
        tick_drive: the cycle of every decision in which ``tick`` has to be pushed to 1 from outside, and to 0 in all
            others; None where the network ticks by itself.
    """

    design: str
    cells: str
    dynamics: Dynamics
    masses: tuple[Mass, ...]
    couplings: tuple[Coupling, ...]
    sensors: tuple[PortBit, ...]
    actuators: tuple[PortBit, ...]
    registers: tuple[Register, ...]
    tick: str | None
    cycles_per_tick: int
    tick_drive: int | None = None
