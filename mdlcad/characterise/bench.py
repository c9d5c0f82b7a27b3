"""A test bench: a small network, what it should do, and whether a sampled device of it does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from mdlcad.network.model import Network
from mdlcad.proof.behaviour import Behaviour, Bits
from mdlcad.proof.compare import compare
from mdlcad.proof.itinerary import Itinerary, make_itinerary
from mdlcad.proof.prove import SENSOR_FORCE
from mdlcad.proof.timing import NoTick, find_timing
from mdlcad.simulation.run import steps_for
from mdlcad.simulation.scatter import scatter_of, scattered
from mdlcad.simulation.system import system_of

_LANES = 16

# random decisions of every lane of a bench without state; with 16 lanes, each of 7 input bits' vectors twice
_DECISIONS = 16


@dataclass(frozen=True, slots=True, eq=False)
class Gates:
    """The behaviour of a bench without state: ``rule`` gives uint8[n, O] for uint8[n, I]."""

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    rule: Callable[[Bits], Bits]

    @property
    def states(self) -> tuple[str, ...]:
        return ()

    @property
    def initial(self) -> Bits:
        return np.zeros(0, np.uint8)

    def step(self, states: Bits, inputs: Bits) -> tuple[Bits, Bits]:
        """One decision; see ``Behaviour``."""
        return states, self.rule(inputs)


@dataclass(frozen=True, slots=True, eq=False)
class Bench:
    """A cell in the surroundings that it may meet, or a whole circuit.

    Attributes:
        cell: what it tries.
        itinerary: the decisions of every device of it.
    """

    cell: str
    network: Network
    behaviour: Behaviour
    itinerary: Itinerary


@dataclass(frozen=True, slots=True, order=True)
class Setting:
    """Where a device is tried: clock period T, damping b, spread (0: the nominal device) and which sample."""

    period: float
    damping: float
    spread: float = 0.0
    sample: int = 0


def make_bench(cell: str, network: Network, behaviour: Behaviour, seed: int) -> Bench:
    """A bench of random inputs; with state, of no more decisions than show every transition."""
    if behaviour.states:
        return Bench(cell, network, behaviour, _shortest(make_itinerary(behaviour, 0, seed, lanes=_LANES)))
    inputs = np.random.default_rng([seed, 4]).integers(0, 2, (_DECISIONS, _LANES, len(behaviour.inputs)), np.uint8)
    states = np.zeros((_DECISIONS + 1, _LANES, 0), np.uint8)
    outputs = np.array([behaviour.step(states[0], felt)[1] for felt in inputs])
    itinerary = Itinerary(inputs, states, outputs, 0, 0, False, 0, "random input vectors")
    return Bench(cell, network, behaviour, itinerary)


def _shortest(itinerary: Itinerary) -> Itinerary:
    """As many first decisions of ``itinerary`` as show all of its transitions."""
    pairs = np.concatenate([itinerary.states[:-1], itinerary.inputs], axis=2)
    wanted = len(np.unique(pairs.reshape(-1, pairs.shape[2]), axis=0))
    length = 1
    while len(np.unique(pairs[:length].reshape(-1, pairs.shape[2]), axis=0)) < wanted:
        length += 1
    return replace(
        itinerary,
        inputs=itinerary.inputs[:length],
        states=itinerary.states[: length + 1],
        outputs=itinerary.outputs[:length],
    )


def is_right(bench: Bench, setting: Setting, seed: int) -> bool:
    """Whether one device of ``bench`` is right in every decision, under the clock and damping of ``setting``."""
    network = replace(
        bench.network, dynamics=replace(bench.network.dynamics, period=setting.period, damping=setting.damping)
    )
    if setting.spread:
        network = scattered(network, scatter_of(setting.spread), seed, setting.sample)
    system = system_of(network)
    steps = steps_for(system)
    try:
        timing = find_timing(network, system, steps)
    except NoTick:
        return False
    found = compare(
        network,
        bench.behaviour,
        system,
        bench.itinerary,
        timing,
        sensor_force=SENSOR_FORCE,
        steps_per_period=steps,
        workers=1,
    )
    return bool((found.wrong == len(bench.itinerary.inputs)).all())
