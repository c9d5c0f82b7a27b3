"""The closed loop: the world presses the sensors, the network decides, the world moves.

What a network does until the end of decision d depends on the inputs up to d alone. So the loop is closed by whole
runs from power-up: guess all inputs with the program's reference in the network's place, simulate, and let the world
answer to what the *network* did. If it ever presses other sensors than guessed, keep what it pressed up to there,
guess the rest again, and repeat. In the end every input is the world's true answer to the network's own outputs, and
the run is the very call by which a proof compares a network with its program, with its timing and its sensor forces.
A network that does as its program says needs one run.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlcad.network.model import Network
from mdlcad.proof.behaviour import Behaviour
from mdlcad.proof.compare import Comparison, compare
from mdlcad.proof.itinerary import Itinerary
from mdlcad.proof.prove import SENSOR_FORCE, check_names
from mdlcad.proof.timing import Timing, find_timing
from mdlcad.scenario.ports import Bits
from mdlcad.scenario.world import World
from mdlcad.simulation.decode import UNDECIDED
from mdlcad.simulation.drive import with_tick
from mdlcad.simulation.run import Stimulus, simulate, steps_for
from mdlcad.simulation.system import Floats, Ints, System, system_of

# enough to draw a clock cycle smoothly; a multiple of what the phases of two- and three-phase clocks need
FRAMES_PER_CYCLE = 40


@dataclass(frozen=True, slots=True, eq=False)
class Journey:
    """D decisions of a network in a world.

    Attributes:
        worlds: D + 1 worlds, before each decision and after the last.
        itinerary: the inputs, and what the reference makes of them.
        comparison: what the network made of them, as read (one lane).
        runs: how many simulations closed the loop.
    """

    reference: Behaviour
    worlds: tuple[World, ...]
    itinerary: Itinerary
    comparison: Comparison
    system: System
    timing: Timing
    steps_per_period: int
    runs: int

    @property
    def decisions(self) -> int:
        return len(self.worlds) - 1

    @property
    def inputs(self) -> Bits:
        """uint8[D, I]."""
        felt: Bits = self.itinerary.inputs[:, 0]
        return felt

    @property
    def outputs(self) -> Bits:
        """uint8[D, O], 2 where undecided."""
        read: Bits = self.comparison.outputs[:, :, 0]
        return read

    @property
    def states(self) -> Bits:
        """uint8[D + 1, r], the registers that have a mass (``comparison.registers``), 2 where undecided."""
        read: Bits = self.comparison.states[:, :, 0]
        return read

    @property
    def register_bits(self) -> tuple[str, ...]:
        """Names of the places in ``states``."""
        return tuple(bit for bit, _ in self.comparison.registers)


def travel(network: Network, reference: Behaviour, world: World) -> Journey:
    """Run ``network`` in ``world`` until that is finished.

    Raises:
        UsageError: the bits of the network are not those of the reference, or the network is broken.
        NoTick: the network's clock ring does not run.
    """
    check_names(network, reference)
    system = system_of(network)
    steps_per_period = steps_for(system)
    timing = find_timing(network, system, steps_per_period)
    inputs = _guess(reference, reference.initial, world)
    runs = 0
    while True:
        itinerary = follow(reference, inputs)
        comparison = compare(
            network,
            reference,
            system,
            itinerary,
            timing,
            sensor_force=SENSOR_FORCE,
            steps_per_period=steps_per_period,
            workers=1,
        )
        runs += 1
        worlds, felt = _answer(world, inputs, comparison.outputs[:, :, 0])
        if worlds[-1].finished and len(felt) == len(inputs):
            return Journey(reference, worlds, itinerary, comparison, system, timing, steps_per_period, runs)
        d = len(felt)
        rest = _guess(reference, _state_now(reference, itinerary, comparison, d), worlds[-1])
        inputs = np.concatenate([felt, rest])


def follow(reference: Behaviour, inputs: Bits) -> Itinerary:
    """What ``reference`` makes of ``inputs`` (uint8[D, I]) from power-up, as a single lane."""
    states = np.empty((len(inputs) + 1, 1, len(reference.states)), np.uint8)
    outputs = np.empty((len(inputs), 1, len(reference.outputs)), np.uint8)
    states[0] = reference.initial
    for d, felt in enumerate(inputs):
        states[d + 1], outputs[d] = reference.step(states[d], felt[None])
    return Itinerary(inputs[:, None], states, outputs, 0, 0, False, 0, "what a world pressed")


def trace(network: Network, journey: Journey) -> tuple[Ints, Floats]:
    """Displacements over the whole journey, by the same forces.

    Returns:
        int[f], time steps, and float[f, n], displacements then; FRAMES_PER_CYCLE frames a clock cycle.
    """
    system, spp = journey.system, journey.steps_per_period
    taker = {port.bit: port.mass for port in network.sensors}
    sensors = np.array([system.index(taker[bit]) for bit in journey.reference.inputs], dtype=np.int64)
    drive = SENSOR_FORCE * (2.0 * journey.inputs[:, :, None] - 1.0) * system.polarity[sensors][:, None]
    span = journey.timing.period * spp
    stride = spp // FRAMES_PER_CYCLE
    run = simulate(
        system,
        with_tick(network, system, Stimulus(sensors, np.ascontiguousarray(drive), span, span), spp),
        journey.decisions * span,
        trace_stride=stride,
        steps_per_period=spp,
    )
    return stride * np.arange(len(run.trace)), run.trace[:, :, 0]


def _guess(reference: Behaviour, state: Bits, world: World) -> Bits:
    """uint8[D, I], the inputs until ``world`` is finished if the device did as the reference from ``state`` on."""
    felt: list[Bits] = []
    while not world.finished:
        felt.append(world.feels())
        state, outputs = reference.step(state.reshape(1, -1), felt[-1][None])
        world = world.after(outputs[0])
    return np.array(felt, dtype=np.uint8).reshape(len(felt), len(reference.inputs))


def _answer(world: World, inputs: Bits, outputs: Bits) -> tuple[tuple[World, ...], Bits]:
    """Let the world answer to ``outputs`` (uint8[D, O]).

    Returns:
        The worlds before decisions 0..k and after the last, and uint8[k, I], the inputs that were truly felt, where k
        is the first decision whose inputs are not those of ``inputs``, or at which the world was finished, or D.
    """
    worlds = [world]
    for felt, answer in zip(inputs, outputs, strict=True):
        if world.finished or np.any(world.feels() != felt):
            break
        world = world.after(answer)
        worlds.append(world)
    return tuple(worlds), inputs[: len(worlds) - 1]


def _state_now(reference: Behaviour, itinerary: Itinerary, comparison: Comparison, d: int) -> Bits:
    """The network's state before decision d as far as it can be read, else the reference's."""
    state: Bits = itinerary.states[d, 0].copy()
    for r, (_, place) in enumerate(comparison.registers):
        if comparison.states[d, r, 0] != UNDECIDED:
            state[place] = comparison.states[d, r, 0]
    return state
