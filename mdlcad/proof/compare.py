"""The network's side of a proof: run the itinerary, read the masses, compare every decision."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mdlcad.network.model import Network
from mdlcad.proof.behaviour import Behaviour, Bits
from mdlcad.proof.itinerary import Itinerary
from mdlcad.proof.outcome import Mismatch
from mdlcad.proof.timing import Timing
from mdlcad.simulation.decode import decode, instants
from mdlcad.simulation.drive import with_tick
from mdlcad.simulation.run import Stimulus, Watch, simulate
from mdlcad.simulation.system import Floats, System


@dataclass(frozen=True, slots=True, eq=False)
class Comparison:
    """Decisions of the network beside those of the reference; lanes L, decisions D.

    Attributes:
        registers: names of the state bits that have a mass; places of those bits in the reference's state.
        states: uint8[D + 1, r, L] and outputs: uint8[D, O, L], as read (2: neither 0 nor 1).
        ticks: bool[D, L], the tick came when it should, and only then, in each decision.
        wrong: int[L], first wrong decision of each lane, D if there is none.
        margin, margin_mass: smallest |x| at a read-out and its mass.
        peak: float[n], largest |x| of each mass.
        tilt: float[n], largest angle of its shuttle, rad, if nothing stopped it.
    """

    registers: tuple[tuple[str, int], ...]
    states: Bits
    outputs: Bits
    ticks: NDArray[np.bool_]
    wrong: NDArray[np.int64]
    margin: float
    margin_mass: str
    peak: Floats
    tilt: Floats


def compare(
    network: Network,
    reference: Behaviour,
    system: System,
    itinerary: Itinerary,
    timing: Timing,
    *,
    sensor_force: float,
    steps_per_period: int,
    workers: int,
) -> Comparison:
    """Simulate ``itinerary`` on the network and compare. The names of bits must agree (``prove`` checks them)."""
    decisions, lanes, _ = itinerary.inputs.shape
    registers = tuple((register.bit, reference.states.index(register.bit)) for register in network.registers)
    state_masses = [system.index(register.mass) for register in network.registers]
    giver = {port.bit: port.mass for port in network.actuators}
    output_masses = [system.index(giver[bit]) for bit in reference.outputs]
    tick_masses = [] if network.tick is None else [system.index(network.tick)]
    masses = np.array(state_masses + output_masses + tick_masses, dtype=np.int64)
    instant = instants(system, masses, steps_per_period)

    stimulus = stimulus_of(network, reference, system, itinerary, timing, sensor_force, steps_per_period)
    cycles = decisions * timing.period + timing.tick_cycle + 1
    run = simulate(
        system,
        stimulus,
        cycles * steps_per_period,
        watch=Watch(masses, instant),
        steps_per_period=steps_per_period,
        workers=workers,
    )

    r, o = len(state_masses), len(output_masses)
    begin = timing.period * np.arange(decisions + 1)[:, None]
    state_cycle = timing.state_cycle(instant[:r]) + begin
    output_cycle = begin[:-1] + timing.period - 1
    state_x = run.readings[np.maximum(state_cycle, 0), np.arange(r)]
    output_x = run.readings[output_cycle, np.arange(r, r + o)]
    states = decode(system, masses[:r], state_x)
    outputs = decode(system, masses[r : r + o], output_x)
    ticks = np.ones((decisions, lanes), dtype=bool)
    if tick_masses:
        seen = decode(system, np.array(tick_masses), run.readings[:, r + o :])[:, 0]
        ticks = _ticks_right(seen, timing, decisions)

    expected_states = itinerary.states.transpose(0, 2, 1)[:, [place for _, place in registers]]
    states = np.where(state_cycle[:, :, None] < 0, expected_states, states)
    state_right = (states == expected_states).all(axis=1)
    output_right = (outputs == itinerary.outputs.transpose(0, 2, 1)).all(axis=1)
    right = state_right[:-1] & state_right[1:] & output_right & ticks
    wrong = np.where(right.all(axis=0), decisions, np.argmin(right, axis=0))

    read = np.concatenate([state_x[1:], output_x], axis=1)
    distance = np.nan_to_num(np.abs(read), nan=0.0, posinf=0.0).min(axis=(0, 2))
    weakest = int(np.argmin(distance)) if len(distance) else -1
    peak = np.nan_to_num(run.peak, nan=np.finfo(float).max).max(axis=1)
    return Comparison(
        registers=registers,
        states=states,
        outputs=outputs,
        ticks=ticks,
        wrong=wrong,
        margin=float(distance[weakest]) if len(distance) else 0.0,
        margin_mass=system.names[masses[weakest]] if len(distance) else "",
        peak=peak,
        tilt=np.nan_to_num(run.tilt, nan=np.finfo(float).max).max(axis=1),
    )


def stimulus_of(
    network: Network,
    reference: Behaviour,
    system: System,
    itinerary: Itinerary,
    timing: Timing,
    sensor_force: float,
    steps_per_period: int,
) -> Stimulus:
    """The forces on the sensors: (2 b - 1) ``sensor_force``, upside down where the mass is, held for each decision.

    And that on the tick, where the network has none of its own.
    """
    taker = {port.bit: port.mass for port in network.sensors}
    sensors = np.array([system.index(taker[bit]) for bit in reference.inputs], dtype=np.int64)
    force = sensor_force * (2.0 * itinerary.inputs.transpose(0, 2, 1) - 1.0) * system.polarity[sensors][:, None]
    span = timing.period * steps_per_period
    return with_tick(network, system, Stimulus(sensors, np.ascontiguousarray(force), span, span), steps_per_period)


def _ticks_right(seen: Bits, timing: Timing, decisions: int) -> NDArray[np.bool_]:
    """bool[D, L] from the tick mass's bits uint8[cycles, L]: each decision has its tick, in its cycle, and no other."""
    due = np.arange(timing.period) == timing.tick_cycle
    whole = seen[: decisions * timing.period].reshape(decisions, timing.period, -1)
    right: NDArray[np.bool_] = (whole == due[:, None]).all(axis=1)
    return right


def describe(
    reference: Behaviour, itinerary: Itinerary, comparison: Comparison, tick: str | None, lane: int
) -> Mismatch:
    """The first wrong decision of ``lane`` in words."""
    d = int(comparison.wrong[lane])
    pairs: list[tuple[str, int, int]] = []
    for moment, prefix in ((d, "power-up " if d == 0 else ""), (d + 1, "next ")):
        for r, (bit, place) in enumerate(comparison.registers):
            pairs.append(
                (prefix + bit, int(itinerary.states[moment, lane, place]), int(comparison.states[moment, r, lane]))
            )
    for o, bit in enumerate(reference.outputs):
        pairs.append((bit, int(itinerary.outputs[d, lane, o]), int(comparison.outputs[d, o, lane])))
    differing = [pair for pair in pairs if pair[1] != pair[2]]
    expected = [f"{name}={want}" for name, want, _ in differing]
    got = [f"{name}={'01?'[have]}" for name, _, have in differing]
    if not comparison.ticks[d, lane]:
        expected.append(f"one tick of {tick}, in its cycle")
        got.append("none, or others too")
    return Mismatch(
        lane=lane,
        decision=d,
        state=" ".join(f"{bit}={v}" for bit, v in zip(reference.states, itinerary.states[d, lane], strict=True)),
        inputs=" ".join(f"{bit}={v}" for bit, v in zip(reference.inputs, itinerary.inputs[d, lane], strict=True)),
        expected=" ".join(expected),
        got=" ".join(got),
    )
