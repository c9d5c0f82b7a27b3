"""What it takes to drive a device: force and torque of the clock plates, force and travel of the tabs.

From a time simulation with random inputs. The clock moves each plate by a half stroke r sin(turn) about its middle;
plate k lags plate 0 by k / P of a turn, as cranks on one shaft that many degrees apart (or scotch yokes) make it.

A unit presses on its plate with K_x (D - 2 g A^2 / l), D the clock displacement with the unit's preload, A its
shuttle's displacement (the energy of docs/mechanics.md differentiated by D). The torque on the shaft is the sum over
plates of force times r cos(turn). Friction of plates on their shims is not in it. What the units of a plate push
unevenly turns the plate about its handle: the sum of force times height over the handle, which its guides bear.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mdlcad.mechanics.process import Process
from mdlcad.mechanics.sizing import Sizing
from mdlcad.mechanics.unit import clock_swing, flexing_span
from mdlcad.network.model import Network
from mdlcad.simulation.decode import instants
from mdlcad.simulation.drive import with_tick
from mdlcad.simulation.run import Stimulus, simulate, steps_for
from mdlcad.simulation.system import Floats, system_of

_DECISIONS = 12
_LANES = 16
_FRAMES = 50
"""Frames a clock period; the harmonics of the force that matter are the first few."""


@dataclass(frozen=True, slots=True)
class ClockPlateLoad:
    """One clock plate.

    Attributes:
        phase: which. stroke_mm: from one end of its motion to the other.
        force_least_n, force_most_n: over all turns; positive where the plate is pushed back by its units.
    """

    phase: int
    stroke_mm: float
    force_least_n: float
    force_most_n: float


@dataclass(frozen=True, slots=True)
class Seat:
    """Where a unit meets the clock: its clock ``plate``'s name, and its ``height`` over that plate's handle, mm."""

    mass: str
    plate: str
    height: float


@dataclass(frozen=True, slots=True)
class PlateTurning:
    """What turns one clock plate, of one deck.

    Attributes:
        moment_nmm: largest moment about its handle, either way.
    """

    plate: str
    moment_nmm: float


@dataclass(frozen=True, slots=True)
class TabLoad:
    """One tab at the boundary.

    Attributes:
        bit: the port. mass: whose shuttle it moves with.
        travel_mm: of a sensor, from its farthest 0 to its farthest 1; of an actuator, what it gives for certain between
            0 and 1 when its unit is deepest in its well.
        force_n: of a sensor, what must push it, either way, for as long as the input is held; of an actuator, the
            force against which its unit still holds when it is deepest in its well.
    """

    bit: str
    mass: str
    travel_mm: float
    force_n: float


@dataclass(frozen=True, slots=True)
class DriveLoads:
    """What must come from outside, and what the device gives.

    Attributes:
        torque_most_nmm: largest |torque| on the clock's shaft.
        energy_per_turn_mj: mean work of the clock a turn, what damping takes away; mJ.
        sensors, actuators: their tabs.
        turning: of every clock plate of every deck.
    """

    plates: tuple[ClockPlateLoad, ...]
    torque_most_nmm: float
    energy_per_turn_mj: float
    sensors: tuple[TabLoad, ...]
    actuators: tuple[TabLoad, ...]
    turning: tuple[PlateTurning, ...] = ()

    @property
    def moments(self) -> dict[str, float]:
        """What turns a clock plate about its handle, N mm, by plate."""
        return {item.plate: item.moment_nmm for item in self.turning}


def drive_loads(
    network: Network, sizing: Sizing, process: Process, sensor_force: float, seed: int, seats: Sequence[Seat] = ()
) -> DriveLoads:
    """Simulate ``network`` with random inputs and say what drives it.

    Args:
        sensor_force: of a sensor, in the network's unit of force, as the proof uses it.
        seats: in any order; units that have none turn no plate.
    """
    system = system_of(network)
    steps = math.ceil(steps_for(system) / _FRAMES) * _FRAMES
    stride = steps // _FRAMES
    sensors = np.array([system.index(port.mass) for port in network.sensors], dtype=np.int64)
    bits = np.random.Generator(np.random.PCG64(seed)).integers(0, 2, (_DECISIONS, len(sensors), _LANES))
    signs = (2.0 * bits - 1.0) * system.polarity[sensors][:, None]
    force = np.asarray(sensor_force * signs, dtype=np.float64)
    span = network.cycles_per_tick * steps
    stimulus = with_tick(network, system, Stimulus(sensors, force, span, span), steps)
    cycles = _DECISIONS * network.cycles_per_tick
    trace = simulate(system, stimulus, cycles * steps, trace_stride=stride, steps_per_period=steps).trace
    turn = 2.0 * math.pi * np.arange(len(trace)) / _FRAMES
    force_by_unit = _clock_forces(network, sizing, process, trace, turn)
    plates, torque = _clock(network, sizing, force_by_unit, turn)
    return DriveLoads(
        plates=plates,
        torque_most_nmm=round(float(np.abs(torque).max()), 3),
        energy_per_turn_mj=round(float(torque[: cycles * _FRAMES].mean()) * 2.0 * math.pi, 4),
        sensors=tuple(
            TabLoad(
                port.bit,
                port.mass,
                round(process.unit.throw_unit * float(np.ptp(trace[:, index])), 3),
                round(sensor_force * sizing.law.force_unit, 3),
            )
            for port, index in zip(network.sensors, sensors, strict=True)
        ),
        actuators=_actuators(network, sizing, process, trace, steps, stride),
        turning=_turning(network, force_by_unit, seats),
    )


def _clock_forces(network: Network, sizing: Sizing, process: Process, trace: Floats, turn: Floats) -> Floats:
    """float[frames, masses, lanes]: how hard every unit pushes its clock plate back, N."""
    law, unit, phases = sizing.law, process.unit, network.dynamics.phases
    span = flexing_span(process).bend
    swing = clock_swing(network, law)
    preload = {item.mass: item.preload for item in sizing.units}
    force = np.empty_like(trace)
    for index, mass in enumerate(network.masses):
        pushed = preload[mass.name] + swing * np.sin(turn - 2.0 * math.pi * mass.phase / phases)
        eased = 2.0 * unit.shape * (unit.throw_unit * trace[:, index]) ** 2 / span
        force[:, index] = law.axial_stiffness * (pushed[:, None] - eased)
    return force


def _clock(
    network: Network, sizing: Sizing, force_by_unit: Floats, turn: Floats
) -> tuple[tuple[ClockPlateLoad, ...], Floats]:
    """The plates' loads, and the shaft's torque float[frames, lanes] in N mm."""
    phases = network.dynamics.phases
    swing = clock_swing(network, sizing.law)
    phase = np.array([mass.phase for mass in network.masses])
    torque = np.zeros((len(turn), force_by_unit.shape[2]))
    plates = []
    for k in range(phases):
        force = force_by_unit[:, phase == k].sum(axis=1)
        torque += force * swing * np.cos(turn - 2.0 * math.pi * k / phases)[:, None]
        least, most = float(force.min()), float(force.max())
        plates.append(ClockPlateLoad(k, round(2.0 * swing, 4), round(least, 2), round(most, 2)))
    return tuple(plates), torque


def _turning(network: Network, force_by_unit: Floats, seats: Sequence[Seat]) -> tuple[PlateTurning, ...]:
    """The largest moment of every plate about its handle."""
    index = {mass.name: i for i, mass in enumerate(network.masses)}
    moments: dict[str, Floats] = {}
    for seat in seats:
        moment = force_by_unit[:, index[seat.mass]] * seat.height
        moments[seat.plate] = moments[seat.plate] + moment if seat.plate in moments else moment
    return tuple(PlateTurning(plate, round(float(np.abs(moments[plate]).max()), 1)) for plate in sorted(moments))


def _actuators(
    network: Network, sizing: Sizing, process: Process, trace: Floats, steps: int, stride: int
) -> tuple[TabLoad, ...]:
    """Travel at the instant when each actuator is deepest in its well, and the force to leave it.

    The greatest force of V = k x^2 / 2 + x^4 / 4 with k < 0 within its well is 2 / (3 sqrt 3) |k|^(3/2), at
    x = sqrt(-k / 3), where V'' = 0.
    """
    system = system_of(network)
    masses = np.array([system.index(port.mass) for port in network.actuators], dtype=np.int64)
    frames = np.rint(instants(system, masses, steps) / stride).astype(np.int64)
    # the first decision settles
    first = network.cycles_per_tick * _FRAMES
    result = []
    by_name = {mass.name: mass for mass in network.masses}
    for port, index, frame in zip(network.actuators, masses, frames, strict=True):
        mass = by_name[port.mass]
        deepest = min(mass.k0, mass.k0 + 2.0 * mass.k1)
        hold = 2.0 / (3.0 * math.sqrt(3.0)) * max(0.0, -deepest) ** 1.5
        sure = float(np.abs(trace[first + frame :: _FRAMES, index]).min())
        result.append(
            TabLoad(
                port.bit,
                port.mass,
                round(2.0 * process.unit.throw_unit * sure, 3),
                round(hold * sizing.law.force_unit, 3),
            )
        )
    return tuple(result)
