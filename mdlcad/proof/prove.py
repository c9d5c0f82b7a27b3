"""Prove by time simulation that a network behaves as its program says.

Every lane starts at power-up (``Mass.initial``, at rest) and walks through the program's own state machine by its
inputs alone; no state is ever forced. The walks are planned on the reference, run on the network, and compared at
every decision: state before, outputs, state after, and that the tick comes exactly when it should.
"""

from __future__ import annotations

import numpy as np
from msgspec import UNSET, UnsetType
from numpy.typing import NDArray

from mdlcad.errors import UsageError
from mdlcad.network.model import Network
from mdlcad.proof.behaviour import Behaviour
from mdlcad.proof.compare import compare, describe
from mdlcad.proof.itinerary import Itinerary, make_itinerary
from mdlcad.proof.outcome import Mismatch, Proof
from mdlcad.proof.timing import NoTick, find_timing
from mdlcad.simulation.run import steps_for
from mdlcad.simulation.system import System, system_of

SENSOR_FORCE = 1.0

_REPORTED = 10


def prove(
    network: Network,
    reference: Behaviour,
    *,
    decisions: int = 20_000,
    seed: int = 0,
    workers: int = 2,
    sensor_force: float = SENSOR_FORCE,
    steps_per_period: int | None = None,
    built: System | None = None,
) -> Proof:
    """Check ``network`` against ``reference``; see ``Proof.holds`` for the verdict.

    Machines whose reachable transitions are all known and not more than ``decisions`` (always so with at most 12 bits
    of state and inputs) are checked exhaustively; of others, every state that was found is visited and at least
    ``decisions`` decisions are simulated. A sensor bit b drives its mass with the constant force (2 b - 1)
    ``sensor_force``. Without ``steps_per_period`` the step is fine enough for the network's masses. The result
    depends on the arguments alone, not on ``workers``. ``built`` is simulated instead of the network's own system: the
    same masses and springs with the numbers of a device.

    Raises:
        UsageError: the bits of the network are not those of the reference.
    """
    system = built if built is not None else system_of(network)
    check_names(network, reference)
    steps_per_period = steps_per_period or steps_for(system)
    itinerary = make_itinerary(reference, decisions, seed)
    length, lanes, _ = itinerary.inputs.shape
    checked = visited = mismatches = simulated = 0
    tick_cycle = -1
    first: tuple[Mismatch, ...] = ()
    margin, margin_mass, peaks = 0.0, "", dict[str, float]()
    tilts: dict[str, float] | UnsetType = UNSET
    try:
        timing = find_timing(network, system, steps_per_period)
        comparison = compare(
            network,
            reference,
            system,
            itinerary,
            timing,
            sensor_force=sensor_force,
            steps_per_period=steps_per_period,
            workers=workers,
        )
    except NoTick as problem:
        mismatches = 1
        first = (Mismatch(0, 0, "", "", f"a tick every {network.cycles_per_tick} cycles", str(problem)),)
    else:
        bad = [int(lane) for lane in np.flatnonzero(comparison.wrong < length)]
        bad.sort(key=lambda lane: (int(comparison.wrong[lane]), lane))
        first = tuple(describe(reference, itinerary, comparison, network.tick, lane) for lane in bad[:_REPORTED])
        checked, visited = _met(itinerary, np.minimum(comparison.wrong + 1, length))
        mismatches, simulated, tick_cycle = len(bad), length * lanes, timing.tick_cycle
        margin, margin_mass = comparison.margin, comparison.margin_mass
        peaks = dict(zip(system.names, map(float, comparison.peak), strict=True))
        if system.devices is not None and system.devices.tilts is not None:
            tilts = dict(zip(system.names, map(float, comparison.tilt), strict=True))

    unmapped = sorted(set(reference.states) - {register.bit for register in network.registers})
    method = f"{itinerary.method}; time simulation from power-up, then random inputs to the end of every lane"
    if unmapped:
        method += f"; state bits without a mass, seen only through the others and the outputs: {', '.join(unmapped)}"
    return Proof(
        design=network.design,
        cells=network.cells,
        transitions_total=itinerary.total,
        transitions_checked=checked,
        transitions_unreachable=itinerary.unreachable,
        mismatches=mismatches,
        exhaustive=itinerary.exhaustive,
        first_mismatches=first,
        reachable_states=itinerary.reachable_states,
        states_visited=visited,
        decisions=simulated,
        lanes=lanes,
        tick_cycle=tick_cycle,
        cycles_per_tick=network.cycles_per_tick,
        steps_per_period=steps_per_period,
        sensor_force=sensor_force,
        seed=seed,
        margin=margin,
        margin_mass=margin_mass,
        peaks=peaks,
        method=method,
        tilts=tilts,
    )


def transitions_met(itinerary: Itinerary) -> int:
    """Distinct transitions that the itinerary makes."""
    length, lanes, _ = itinerary.inputs.shape
    return _met(itinerary, np.full(lanes, length))[0]


def _met(itinerary: Itinerary, lengths: NDArray[np.int64]) -> tuple[int, int]:
    """Distinct transitions and distinct states among the first ``lengths[lane]`` decisions of every lane."""
    done = np.arange(len(itinerary.inputs))[:, None] < lengths
    states, inputs = itinerary.states[:-1][done], itinerary.inputs[done]
    if not len(states):
        return 0, 0
    pairs = np.concatenate([states, inputs], axis=1)
    transitions = len(np.unique(pairs, axis=0)) if pairs.shape[1] else 1
    return transitions, len(np.unique(states, axis=0)) if states.shape[1] else 1


def check_names(network: Network, reference: Behaviour) -> None:
    """UsageError unless the bits of sensors and actuators are the same and every register is a state bit."""

    def names(what: str, found: list[str], wanted: tuple[str, ...], subset: bool) -> None:
        if len(set(found)) != len(found):
            raise UsageError(f"the network has two masses for one {what} bit")
        strange = sorted(set(found) - set(wanted))
        absent = [] if subset else sorted(set(wanted) - set(found))
        if strange:
            raise UsageError(f"the network has {what} bits that the program has not: {', '.join(strange)}")
        if absent:
            raise UsageError(f"the network has no mass for {what} bits: {', '.join(absent)}")

    names("sensor", [port.bit for port in network.sensors], reference.inputs, False)
    names("actuator", [port.bit for port in network.actuators], reference.outputs, False)
    # synthesis may have merged state bits; what the others and the outputs show must still agree
    names("register", [register.bit for register in network.registers], reference.states, True)
    if network.registers and network.tick is None:
        raise UsageError("the network has registers but no tick")
