"""Small three-phase devices built by hand, and their behaviours: what a mapper should make, without a mapper."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from mdlcad.network.model import Coupling, Dynamics, Mass, MassKind, Network, PortBit, Register

WELL = 1.6


@dataclass(frozen=True)
class Machine:
    """A behaviour given by a function (states, inputs) -> (next states, outputs in ``states``)."""

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    states: tuple[str, ...]
    initial: np.ndarray
    rule: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]

    def step(self, states: np.ndarray, inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        after, _ = self.rule(states, inputs)
        _, outputs = self.rule(after, inputs)
        return after.astype(np.uint8), outputs.astype(np.uint8)


@dataclass
class Draft:
    """A three-phase network under construction: k 3 - 2.75 p, springs 0.3, bias 0.5."""

    name: str
    cycles: int
    masses: list[Mass] = field(default_factory=list)
    couplings: list[Coupling] = field(default_factory=list)
    sensors: list[PortBit] = field(default_factory=list)
    actuators: list[PortBit] = field(default_factory=list)
    registers: list[Register] = field(default_factory=list)
    tick: str | None = None

    def mass(self, name: str, phase: int, bias: float = 0.0, value: bool = False) -> str:
        initial = (WELL if value else -WELL) if phase == 2 else 0.0  # at t = 0, phase 2 holds
        self.masses.append(Mass(name, MassKind.GATE, phase, 3.0, -2.75, 0.0, bias, initial))
        return name

    def gate(self, name: str, phase: int, *sources: str, bias: float = 0.0, value: bool = False) -> str:
        """A threshold gate; a source written "~x" is inverted."""
        self.mass(name, phase, bias, value)
        for source in sources:
            sign = -1.0 if source.startswith("~") else 1.0
            self.couplings.append(Coupling(source.lstrip("~"), name, 0.3 * sign, 0.3))
        return name

    def both(self, name: str, phase: int, a: str, b: str) -> str:
        return self.gate(name, phase, a, b, bias=0.5)

    def either(self, name: str, phase: int, a: str, b: str) -> str:
        return self.gate(name, phase, a, b, bias=-0.5)

    def sensor(self, bit: str, phase: int = 0) -> str:
        self.sensors.append(PortBit(bit, self.mass(f"in {bit}", phase)))
        return f"in {bit}"

    def clock(self) -> None:
        """A ring of 3 N masses. The token is placed so that registers change in cycle 2 of a decision (1 if N = 2)."""
        size = 3 * self.cycles
        tick_cycle = min(1, self.cycles - 2)
        token = size - 1 - 3 * (tick_cycle + 1)
        for i in range(size):
            self.gate(f"ring{i}", i % 3, f"ring{(i - 1) % size}", value=i == token)
        self.tick = f"ring{size - 1}"

    def register(self, bit: str, data: str, value: bool = False) -> str:
        """Q, of phase 2; ``data`` may be inverted. The masses are made here, Q must be made before by ``state``."""
        assert self.tick
        load = self.both(f"{bit} load", 0, self.tick, data)
        keep = self.both(f"{bit} keep", 0, f"~{self.tick}", f"q {bit}")
        self.either(f"{bit} r", 1, load, keep)
        self.gate(f"q {bit}", 2, f"{bit} r", value=value)
        self.registers.append(Register(bit, f"q {bit}", value))
        return f"q {bit}"

    def actuator(self, bit: str, mass: str) -> None:
        self.actuators.append(PortBit(bit, mass))

    def network(self) -> Network:
        """The compensated network."""
        load = dict.fromkeys((mass.name for mass in self.masses), 0.0)
        for coupling in self.couplings:
            load[coupling.source] += coupling.self_stiffness
            load[coupling.target] += coupling.self_stiffness
        return Network(
            self.name,
            "hand",
            Dynamics(inertia=0.05, damping=0.25, quartic=1.0, period=10.0, phases=3),
            tuple(replace(mass, compensation=-load[mass.name]) for mass in self.masses),
            tuple(self.couplings),
            tuple(self.sensors),
            tuple(self.actuators),
            tuple(self.registers),
            self.tick,
            self.cycles,
        )


def toggle() -> tuple[Network, Machine]:
    """One bit that flips when EN is 1; OUT shows it, NEXT (a Mealy output) what EN would make of it."""
    draft = Draft("toggle", 4)
    enable = draft.sensor("EN[0]")
    draft.clock()
    q = draft.gate("q now", 0, "q T[0]")
    rising = draft.both("rising", 1, enable, f"~{q}")
    staying = draft.both("staying", 1, f"~{enable}", q)
    data = draft.either("data", 2, rising, staying)
    draft.actuator("OUT[0]", draft.register("T[0]", data))
    draft.actuator("NEXT[0]", data)

    def rule(states: np.ndarray, inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        after = states ^ inputs
        return after, np.concatenate([states, after], axis=1)

    return draft.network(), Machine(("EN[0]",), ("OUT[0]", "NEXT[0]"), ("T[0]",), np.zeros(1, np.uint8), rule)


def walker() -> tuple[Network, Machine]:
    """Two bits: A takes X, B takes (A and not Y); starts at A = 0, B = 1. W is (X and Y) or (A and B)."""
    draft = Draft("walker", 4)
    x, y = draft.sensor("X[0]"), draft.sensor("Y[0]")
    draft.clock()
    x2 = draft.gate("x2", 2, draft.gate("x1", 1, x))
    a0 = draft.gate("a0", 0, "q A[0]")
    b0 = draft.gate("b0", 0, "q B[0]")
    b1 = draft.both("b1", 1, a0, f"~{y}")
    b2 = draft.gate("b2", 2, b1)
    draft.register("A[0]", x2)
    draft.register("B[0]", b2, value=True)
    w = draft.either("w", 2, draft.both("xy", 1, x, y), draft.both("ab", 1, a0, b0))
    draft.actuator("W[0]", w)

    def rule(states: np.ndarray, inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        a, b, x, y = *states.T, *inputs.T
        return np.stack([x, a & (1 - y)], axis=1), ((x & y) | (a & b))[:, None]

    initial = np.array([0, 1], np.uint8)
    return draft.network(), Machine(("X[0]", "Y[0]"), ("W[0]",), ("A[0]", "B[0]"), initial, rule)


def vote() -> tuple[Network, Machine]:
    """No state: majority of three sensors, and its inverse one gate later."""
    draft = Draft("vote", 2)
    votes = [draft.sensor(f"V[{i}]") for i in range(3)]
    majority = draft.gate("majority", 1, *votes)
    draft.actuator("YES[0]", majority)
    draft.actuator("NO[0]", draft.gate("no", 2, f"~{majority}"))

    def rule(states: np.ndarray, inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        yes = (inputs.sum(axis=1) >= 2).astype(np.uint8)
        return states, np.stack([yes, 1 - yes], axis=1)

    names = tuple(f"V[{i}]" for i in range(3))
    return draft.network(), Machine(names, ("YES[0]", "NO[0]"), (), np.zeros(0, np.uint8), rule)
