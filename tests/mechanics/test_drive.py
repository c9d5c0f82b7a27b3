import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mdlcad.language import read_device
from mdlcad.mapping import load_library, map_netlist
from mdlcad.mechanics import load_process, size
from mdlcad.mechanics.drive import DriveLoads, drive_loads
from mdlcad.network.model import Network
from mdlcad.proof.prove import SENSOR_FORCE
from mdlcad.simulation.run import simulate, steps_for, undriven
from mdlcad.simulation.system import system_of
from mdlcad.synthesis import synthesise

EXAMPLES = Path(__file__).parents[2] / "examples"
PROCESS = load_process("pom_cut")


@pytest.fixture(scope="module")
def network() -> Network:
    device = read_device(EXAMPLES / "traffic_light.mdl")
    return map_netlist(synthesise(device), load_library("parametron"))


@pytest.fixture(scope="module")
def sizing(network: Network):
    return size(network, PROCESS, {mass.name: 1.8 for mass in network.masses})


@pytest.fixture(scope="module")
def loads(network: Network, sizing) -> DriveLoads:
    return drive_loads(network, sizing, PROCESS, SENSOR_FORCE, 0)


def test_the_clock_gives_what_damping_takes(network: Network, sizing) -> None:
    """No sensor works here: the shaft's work a turn is the energy that dampers take, found from the speeds alone."""
    alone = replace(network, sensors=())
    loads = drive_loads(alone, sizing, PROCESS, SENSOR_FORCE, 0)
    system = system_of(alone)
    steps = steps_for(system)
    cycles = 12 * network.cycles_per_tick
    trace = simulate(system, undriven(), cycles * steps, trace_stride=1, steps_per_period=steps).trace[:, :, 0]
    step = system.period / steps
    speed = np.diff(trace, axis=0) / step
    taken = system.damping * (speed**2).sum() * step / cycles
    taken_mj = taken * sizing.law.force_unit * PROCESS.unit.throw_unit
    # what the masses' energy changes between start and end is spread over the turns
    assert loads.energy_per_turn_mj == pytest.approx(taken_mj, rel=0.1)


def test_every_phase_has_its_plate_with_the_stroke_of_the_process(network: Network, sizing, loads: DriveLoads) -> None:
    assert [plate.phase for plate in loads.plates] == [0, 1, 2]
    swing = max(abs(mass.k1) for mass in network.masses) * sizing.law.stroke_per_k
    for plate in loads.plates:
        assert plate.stroke_mm == pytest.approx(2.0 * swing, abs=1e-3)
        assert plate.force_least_n < plate.force_most_n


def test_a_unit_alone_presses_as_its_spring_is_pushed(network: Network, sizing) -> None:
    """Held in the middle (no swing at all) a unit is a spring of K_x between its preload and the clock's throw."""
    mass = replace(network.masses[0], k0=50.0, initial=0.0, bias=0.0)
    one = replace(network, masses=(mass,), couplings=(), sensors=(), actuators=(), registers=(), tick=None)
    unit = next(item for item in sizing.units if item.mass == mass.name)
    loads = drive_loads(one, replace(sizing, units=(unit,)), PROCESS, SENSOR_FORCE, 0)
    plate = loads.plates[mass.phase]
    middle = (plate.force_most_n + plate.force_least_n) / 2.0
    half = (plate.force_most_n - plate.force_least_n) / 2.0
    assert middle == pytest.approx(sizing.law.axial_stiffness * unit.preload, abs=0.02)
    assert half == pytest.approx(sizing.law.axial_stiffness * plate.stroke_mm / 2.0, rel=0.005)


def test_tabs(network: Network, sizing, loads: DriveLoads) -> None:
    assert [tab.bit for tab in loads.sensors] == [port.bit for port in network.sensors]
    for tab in loads.sensors:
        assert tab.force_n == pytest.approx(sizing.law.force_unit, abs=5e-4)
    for tab in loads.actuators:
        # wells of k = -2.5 are at sqrt(2.5) = 1.58; couplings and bias move them
        assert tab.travel_mm == pytest.approx(2 * 1.5 * math.sqrt(2.5), rel=0.15)
        assert tab.force_n > 0.0
