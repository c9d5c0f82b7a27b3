"""The closed loop is what a decision-by-decision simulation would do, for right networks and for broken ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mdlcad.language import Actuator, Place, Sensor, Value
from mdlcad.network.model import Network
from mdlcad.proof.prove import SENSOR_FORCE
from mdlcad.proof.timing import NoTick
from mdlcad.scenario.loop import FRAMES_PER_CYCLE, Journey, trace, travel
from mdlcad.scenario.result import decisions_of, failures_of
from mdlcad.scenario.world import Maze, Ports
from mdlcad.simulation.decode import decode, instants
from mdlcad.simulation.run import Stimulus, Watch, simulate
from mdlcad.simulation.system import system_of
from tests.proof.devices import walker

PLACE = (Place("side", 0.5),)


def corridor() -> Maze:
    """X feels to the left and Y to the right; W goes right if it is 0 and left if it is 1."""
    values = (Value("0", "right"), Value("1", "left"))
    sensors = (Sensor("X", PLACE, ()), Sensor("Y", PLACE, ()))
    actuator = Actuator("W", "", PLACE, values)
    ports = Ports(sensors, (actuator,), ("X[0]", "Y[0]"), ("W[0]",))
    moves = {"0": (0, 1), "1": (0, -1)}
    return Maze(ports, ("#.S...E#",), (0, 2), (0, 6), ((0, (0, -1)), (1, (0, 1))), actuator, moves, 14)


def broken(network: Network, number: int) -> Network:
    """The network with one coupling of the wrong sign."""
    couplings = list(network.couplings)
    couplings[number] = replace(couplings[number], strength=-couplings[number].strength)
    return replace(network, couplings=tuple(couplings))


def step_by_step(network: Network, world: Maze) -> list[Maze]:
    """The same loop, simulated anew from power-up for every decision with what was felt so far."""
    system, spp = system_of(network), 400
    sensors = np.array([system.index(port.mass) for port in network.sensors])
    outputs = np.array([system.index(port.mass) for port in network.actuators])
    span = network.cycles_per_tick * spp
    worlds, felt = [world], []
    while not worlds[-1].finished:
        felt.append(worlds[-1].feels())
        force = SENSOR_FORCE * (2.0 * np.array(felt)[:, :, None] - 1.0)
        run = simulate(
            system,
            Stimulus(sensors, np.ascontiguousarray(force), span, span),
            len(felt) * span,
            watch=Watch(outputs, instants(system, outputs, spp)),
        )
        worlds.append(worlds[-1].after(decode(system, outputs, run.readings[-1])[:, 0]))
    return worlds


def journey_of(network: Network) -> Journey:
    return travel(network, walker()[1], corridor())


def test_a_right_network_needs_one_run() -> None:
    network, _ = walker()
    journey = journey_of(network)
    assert journey.runs == 1
    assert list(journey.worlds) == step_by_step(network, corridor())
    assert failures_of(journey) == ()
    assert [world.cell for world in journey.worlds if isinstance(world, Maze)][-1] == (0, 6)
    assert len(decisions_of(journey)) == journey.decisions == len(journey.worlds) - 1


@pytest.mark.parametrize("number", range(0, 30, 3))
def test_a_broken_network_goes_its_own_way_and_is_found_out(number: int) -> None:
    network = broken(walker()[0], number)
    try:
        journey = journey_of(network)
    except NoTick:
        return  # the fault is in the clock ring
    assert list(journey.worlds) == step_by_step(network, corridor())
    # every input is the world's own answer
    assert all(np.array_equal(world.feels(), felt) for world, felt in zip(journey.worlds, journey.inputs, strict=False))
    outputs_differ = bool(np.any(journey.outputs != journey.itinerary.outputs[:, 0]))
    assert not outputs_differ or any("not as its program" in words for words in failures_of(journey))


def test_some_of_those_faults_change_the_way() -> None:
    """Else the test above would show nothing."""
    right = journey_of(walker()[0]).worlds
    ways = []
    for number in range(0, 30, 3):
        try:
            ways.append(journey_of(broken(walker()[0], number)))
        except NoTick:
            continue
    assert any(journey.worlds != right for journey in ways)
    assert any(journey.runs > 1 for journey in ways)


def test_the_trace_is_the_run_that_was_read() -> None:
    network, _ = walker()
    journey = journey_of(network)
    steps, x = trace(network, journey)
    spp = journey.steps_per_period
    assert len(x) == journey.decisions * network.cycles_per_tick * FRAMES_PER_CYCLE + 1
    mass = journey.system.index(network.actuators[0].mass)
    instant = int(instants(journey.system, np.array([mass]), spp)[0])
    moments = (np.arange(journey.decisions) + 1) * network.cycles_per_tick * spp - spp + instant
    at = np.interp(moments, steps, x[:, mass])
    assert ((at > 0) == journey.outputs[:, 0]).all()
