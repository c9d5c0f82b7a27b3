"""Runs: a system, the forces on its sensors, and what is to be kept."""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from mdlcad.simulation.devices import advance_devices
from mdlcad.simulation.kernel_lanes import BLOCK, advance_block
from mdlcad.simulation.kernel_single import advance_one
from mdlcad.simulation.plan import plan_of, turn_table
from mdlcad.simulation.system import Floats, Ints, System, wave_table
from mdlcad.simulation.tilting import held

STEPS_PER_PERIOD = 400

# Largest step in units of 1 / (highest frequency). RK4 is stable to 2.8; at 0.5 its error of a whole decision is far
# below any margin at which a bit is read.
_STEP_LIMIT = 0.5

# Below this many lanes, one lane after the other is faster than a block padded to BLOCK lanes.
_SINGLES = 4

# From this many masses on, a block no longer fits the processor's cache, and one lane after the other is faster.
_CACHED = 15_000


@dataclass(frozen=True, slots=True, eq=False)
class Stimulus:
    """External forces, constant within an interval.

    Attributes:
        masses: int[s], the masses that are driven.
        force: float[intervals, s, lanes]; the last interval goes on for ever.
        first_steps: length of interval 0, in time steps.
        interval_steps: length of every later interval, in time steps.
    """

    masses: Ints
    force: Floats
    first_steps: int
    interval_steps: int


@dataclass(frozen=True, slots=True, eq=False)
class Watch:
    """Read mass ``masses[w]`` in every clock cycle, ``instants[w]`` time steps after the cycle begins."""

    masses: Ints
    instants: Ints


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """What a run left behind, for n masses and L lanes.

    Attributes:
        readings: float[cycles, watched, L], displacements at the watch's instants (NaN where the run ended before).
        trace: float[frames, n, L], displacements at steps 0, stride, 2 stride ... (no frames without a stride).
        peak: float[n, L], largest |x| at any time step.
        x, v: float[n, L], the final state.
        tilt: float[n, L], largest angle of each shuttle, rad, if nothing stopped it; 0 where they are held.
    """

    readings: Floats
    trace: Floats
    peak: Floats
    x: Floats
    v: Floats
    tilt: Floats


def steps_for(system: System) -> int:
    """Steps a period that resolve every mass: 400, or more if the clock is slow against the masses.

    The highest frequency is bounded by the stiffness at 1.3 times the deepest well, all couplings pulling together.
    """
    lowest = system.stiffness_base + 2.0 * np.minimum(system.stiffness_swing, 0.0)
    highest = system.stiffness_base + 2.0 * np.maximum(system.stiffness_swing, 0.0)
    throw2 = 1.3**2 * np.maximum(-lowest, 0.0) / system.quartic if system.quartic else 0.0
    owner = np.repeat(np.arange(len(system.names)), np.diff(system.row_start))
    pull = np.zeros(len(system.names))
    np.add.at(pull, owner, np.abs(system.base) + 2.0 * np.abs(system.swing))
    stiffness = float((np.maximum(highest, lowest + 3.0 * system.quartic * throw2) + pull).max(initial=0.0))
    needed = system.period * math.sqrt(max(stiffness, 0.0) / system.inertia) / _STEP_LIMIT
    return max(STEPS_PER_PERIOD, 100 * math.ceil(needed / 100))


def undriven(lanes: int = 1) -> Stimulus:
    """The stimulus without any force."""
    return Stimulus(np.zeros(0, dtype=np.int64), np.zeros((1, 0, lanes)), 0, 1)


def simulate(
    system: System,
    stimulus: Stimulus,
    steps: int,
    *,
    watch: Watch | None = None,
    trace_stride: int = 0,
    steps_per_period: int = STEPS_PER_PERIOD,
    workers: int = 1,
) -> Run:
    """Run every lane of ``stimulus`` from ``system.initial`` at rest for ``steps`` steps of T / steps_per_period.

    The result of a lane does not depend on the other lanes, nor on ``workers`` (threads over blocks of lanes).

    Raises:
        ValueError: the stimulus or the watch does not fit the system, or it has latches and devices of their own.
    """
    lanes = stimulus.force.shape[2]
    watch = watch or Watch(np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64))
    _check(system, stimulus, watch, steps, steps_per_period)
    n = len(system.names)
    blocks = _blocks(lanes, n) if system.devices is None else [(start, BLOCK) for start in range(0, lanes, BLOCK)]
    # The last block may be padded with undriven lanes, which are dropped at the end.
    padded = blocks[-1][0] + blocks[-1][1]
    force = np.zeros((stimulus.force.shape[0], stimulus.force.shape[1], padded))
    force[:, :, :lanes] = stimulus.force / system.inertia
    x = np.ascontiguousarray(np.repeat(system.initial[:, None], padded, axis=1))
    v = np.zeros((n, padded))
    peak = np.zeros((n, padded))
    tilt = np.zeros((n, padded))
    readings = np.full((-(-steps // steps_per_period), len(watch.masses), padded), np.nan)
    trace = np.zeros((steps // trace_stride + 1 if trace_stride else 0, n, padded))
    turn = turn_table(2 * steps_per_period)

    plan = plan_of(system)
    place = plan.place()
    waves = wave_table(system.phases, 2 * steps_per_period) if system.devices is not None else turn

    def advance(block: tuple[int, int]) -> None:
        start, width = block
        if system.devices is not None:
            masses, springs = system.devices.block(start)
            tilts = system.devices.tilts
            tilting, lifts = (tilts or held(n, len(system.column))).block(start)
            advance_devices(
                start,
                x,
                v,
                peak,
                masses,
                springs,
                system.row_start,
                system.column,
                system.phase,
                waves,
                system.inertia,
                system.damping,
                stimulus.masses,
                force * system.inertia,
                stimulus.first_steps,
                stimulus.interval_steps,
                steps,
                system.period / steps_per_period,
                watch.masses,
                watch.instants,
                readings,
                trace_stride,
                trace,
                tilt,
                tilts is not None,
                tilting,
                lifts,
            )
            return
        kernel = advance_one if width == 1 else advance_block
        kernel(
            start,
            x,
            v,
            peak,
            plan,
            turn,
            place[stimulus.masses],
            force,
            stimulus.first_steps,
            stimulus.interval_steps,
            steps,
            system.period / steps_per_period,
            place[watch.masses],
            watch.instants,
            readings,
            trace_stride,
            trace,
        )

    if workers > 1 and len(blocks) > 1:
        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(advance, blocks))
    else:
        for block in blocks:
            advance(block)
    return Run(
        readings[:, :, :lanes], trace[:, :, :lanes], peak[:, :lanes], x[:, :lanes], v[:, :lanes], tilt[:, :lanes]
    )


def _blocks(lanes: int, masses: int) -> list[tuple[int, int]]:
    """(first lane, width) of blocks that cover ``lanes`` lanes; the last may reach beyond."""
    if masses >= _CACHED:
        return [(lane, 1) for lane in range(lanes)]
    whole = lanes - lanes % BLOCK
    blocks = [(start, BLOCK) for start in range(0, whole, BLOCK)]
    rest = lanes - whole
    if 0 < rest < _SINGLES:
        blocks += [(start, 1) for start in range(whole, lanes)]
    elif rest:
        blocks.append((whole, BLOCK))
    return blocks


def _check(system: System, stimulus: Stimulus, watch: Watch, steps: int, steps_per_period: int) -> None:
    n = len(system.names)
    intervals, driven, lanes = stimulus.force.shape
    devices = system.devices
    counts = [] if devices is None else [devices.count, devices.tilts.count if devices.tilts is not None else 1]
    if any(count not in (1, lanes) for count in counts) or (devices is not None and len(system.latch_mass)):
        raise ValueError("devices are one for all lanes or one a lane, and have no latches")
    if lanes < 1 or intervals < 1 or driven != len(stimulus.masses):
        raise ValueError("a stimulus needs at least one lane and one interval, and a force for every driven mass")
    if stimulus.interval_steps < 1 or stimulus.first_steps < 0 or steps < 0 or steps_per_period < 1:
        raise ValueError("intervals and steps must be positive")
    for masses in (stimulus.masses, watch.masses):
        if len(masses) and not (masses.min() >= 0 and masses.max() < n):
            raise ValueError("a driven or watched mass is not in the system")
    if len(watch.instants) != len(watch.masses) or any(not 0 <= i < steps_per_period for i in watch.instants):
        raise ValueError("every watched mass needs an instant within the clock cycle")
