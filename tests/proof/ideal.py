"""The oracle of seeded faults: a three-phase network as threshold logic with an "unknown", without any dynamics.

A mass decides while its neighbours of the phase before hold their bits, those of the phase after are reset (they pull
nothing), and those of its own phase decide with it (they may pull either way). It takes the sign of its bias and of all
that pulls it, whichever way round the spring was meant; where that sign depends on something unknown, or nothing
pulls, it is unknown itself. So a bit that is known here does not hang on a tie, and a wrong one is wrong by logic.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from mdlcad.mapping.cell_library import Library
from mdlcad.network.model import Network
from mdlcad.proof.behaviour import Behaviour
from mdlcad.proof.itinerary import Itinerary

UNKNOWN = 0


class Verdict(Enum):
    """What a fault does to the behaviour: to no decision, to some by logic, or to some that hang on a tie."""

    SAME = "same"
    CHANGED = "changed"
    TIE = "tie"


@dataclass(frozen=True)
class Logic:
    """Signed weights (units of one input), both ways round, and biases (units of one bias)."""

    network: Network
    weights: np.ndarray
    bias: np.ndarray
    phase: np.ndarray
    driven: np.ndarray

    @staticmethod
    def of(network: Network, library: Library) -> Logic:
        row = {mass.name: i for i, mass in enumerate(network.masses)}
        weights = np.zeros((len(row), len(row)))
        for c in network.couplings:
            for a, b in ((c.source, c.target), (c.target, c.source)):
                weights[row[a], row[b]] += c.strength / library.coupling.strength
        sensors = {port.mass for port in network.sensors}
        return Logic(
            network,
            weights,
            np.array([-mass.bias / library.bias.force for mass in network.masses]),
            np.array([mass.phase for mass in network.masses]),
            np.array([mass.name in sensors for mass in network.masses]),
        )

    def power_up(self, lanes: int) -> np.ndarray:
        """int8[n, L]: the masses of phase 2 hold what they were given; one that was given nothing is unknown."""
        held = [int(np.sign(mass.initial)) if mass.phase == 2 else UNKNOWN for mass in self.network.masses]
        return np.repeat(np.array(held, np.int8)[:, None], lanes, axis=1)

    def cycle(self, state: np.ndarray, forced: np.ndarray) -> np.ndarray:
        """One clock cycle later; ``forced`` int8[n, L] are the signs of the driven masses (UNKNOWN: not driven)."""
        state = state.copy()
        for phase in range(3):
            rows = self.phase == phase
            before, same = self.phase == (phase - 1) % 3, rows
            held, known = state[before], state[before] != UNKNOWN
            pull = self.weights[np.ix_(rows, before)]
            doubt = np.abs(pull) @ ~known + np.abs(self.weights[np.ix_(rows, same)]).sum(axis=1)[:, None]
            total = pull @ held + self.bias[rows][:, None]
            decided = np.abs(total) > doubt + 0.5
            value = np.where(decided, np.sign(total), UNKNOWN).astype(np.int8)
            state[rows] = np.where(forced[rows] != UNKNOWN, forced[rows], value)
        return state


def classify(network: Network, library: Library, reference: Behaviour, itinerary: Itinerary) -> Verdict:
    """Whether ``network`` as pure logic does as ``reference`` in every decision of ``itinerary``."""
    logic = Logic.of(network, library)
    row = {mass.name: i for i, mass in enumerate(network.masses)}
    upright = np.array([mass.polarity for mass in network.masses])
    n, (decisions, lanes, _) = network.cycles_per_tick, itinerary.inputs.shape
    tick = None if network.tick is None else row[network.tick]
    tick_cycle = _tick_cycle(logic, tick, upright, n)
    if isinstance(tick_cycle, Verdict):
        return tick_cycle

    taker = {port.bit: row[port.mass] for port in network.sensors}
    state = logic.power_up(lanes)
    forced = np.zeros_like(state)
    tied = False

    def judge(mass: int, bits: np.ndarray) -> bool:
        """Whether a mass is surely wrong in some lane; notes where it is not known."""
        nonlocal tied
        seen = state[mass] * upright[mass]
        tied |= bool((seen == UNKNOWN).any())
        return bool(((seen != UNKNOWN) & (seen != 2 * bits.astype(np.int8) - 1)).any())

    for d in range(decisions):
        for place, bit in enumerate(reference.inputs):
            forced[taker[bit]] = (2 * itinerary.inputs[d, :, place].astype(np.int8) - 1) * upright[taker[bit]]
        for cycle in range(n):
            state = logic.cycle(state, forced)
            if tick is not None:
                if judge(tick, np.full(lanes, cycle == tick_cycle)):
                    return Verdict.CHANGED
                for register in network.registers:
                    mass = row[register.mass]
                    # a register is last read not later than the tick
                    late = logic.phase[mass] > logic.phase[tick]
                    if cycle == tick_cycle - late and judge(
                        mass, itinerary.states[d, :, reference.states.index(register.bit)]
                    ):
                        return Verdict.CHANGED
        for port in network.actuators:
            if judge(row[port.mass], itinerary.outputs[d, :, reference.outputs.index(port.bit)]):
                return Verdict.CHANGED
    return Verdict.TIE if tied else Verdict.SAME


def _tick_cycle(logic: Logic, tick: int | None, upright: np.ndarray, n: int) -> int | Verdict:
    """The cycle of the tick in the network left to itself for four decisions, as the proof finds it."""
    if tick is None:
        return -1
    state = logic.power_up(1)
    seen = []
    for _ in range(4 * n):
        state = logic.cycle(state, np.zeros_like(state))
        seen.append(int(state[tick, 0] * upright[tick]))
    on = [cycle for cycle, value in enumerate(seen) if value > 0]
    if UNKNOWN in seen:
        return Verdict.TIE
    if len(on) != 4 or np.any(np.diff(on) != n):
        return Verdict.CHANGED
    return on[0]
