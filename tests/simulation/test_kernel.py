"""The kernel against theory, against scipy, and against itself."""

from __future__ import annotations

import dataclasses
import hashlib
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mdlcad.errors import UsageError
from mdlcad.network.model import CouplingKind, Dynamics, Mass, MassKind, Network
from mdlcad.simulation.run import Stimulus, Watch, simulate, undriven
from mdlcad.simulation.system import energy, system_of, wave_table
from tests.simulation.networks import random_network


def potential(network: Network, x: np.ndarray, t: float) -> Any:
    """V of ``network.model``, written down a second time, term by term."""
    place = {mass.name: i for i, mass in enumerate(network.masses)}
    d = network.dynamics

    def p(phase: int) -> float:
        return float(1 + np.sin(2 * np.pi * t / d.period - 2 * np.pi * phase / d.phases))

    v: Any = 0.0  # complex when a force is taken from it
    for mass, xi in zip(network.masses, x, strict=True):
        k = mass.k0 + mass.compensation + mass.k1 * p(mass.phase)
        v += d.quartic / 4 * xi**4 + 0.5 * k * xi**2 + mass.bias * xi
    for c in network.couplings:
        xs, xt = x[place[c.source]], x[place[c.target]]
        strength = c.strength * (c.d0 + c.d1 * p(network.masses[place[c.source]].phase))
        if c.kind is CouplingKind.LATCH:
            v -= strength * xs * xt**2
        else:
            v += 0.5 * c.self_stiffness * (xs**2 + xt**2) - strength * xs * xt
    return v


def solve_with_scipy(network: Network, time: float) -> np.ndarray:
    """Displacements at ``time`` by scipy, with the forces taken from ``potential`` by complex steps."""
    n = len(network.masses)
    d = network.dynamics

    def slope(t: float, y: np.ndarray) -> np.ndarray:
        force = np.empty(n)
        for i in range(n):
            x = y[:n].astype(complex)
            x[i] += 1e-30j
            force[i] = -potential(network, x, t).imag / 1e-30
        return np.concatenate([y[n:], (force - d.damping * y[n:]) / d.inertia])

    start = np.concatenate([[mass.initial for mass in network.masses], np.zeros(n)])
    solution = solve_ivp(slope, (0, time), start, method="DOP853", rtol=1e-9, atol=1e-11)
    return solution.y[:n, -1]


@pytest.mark.parametrize("seed", [0, 1])
def test_agrees_with_scipy_on_a_network_derived_independently(seed: int) -> None:
    network = random_network(seed)
    run = simulate(system_of(network), undriven(), 1000, steps_per_period=400)
    assert run.x[:, 0] == pytest.approx(solve_with_scipy(network, 2.5 * network.dynamics.period), abs=1e-5)


def test_every_term_matters_to_that_agreement() -> None:
    """The comparison above would notice each kind of term: without it, the result is elsewhere."""
    network = random_network(0)
    whole = simulate(system_of(network), undriven(), 1000).x
    for kind in CouplingKind:
        fewer = tuple(c for c in network.couplings if c.kind is not kind)
        without = dataclasses.replace(network, couplings=fewer)
        assert np.abs(simulate(system_of(without), undriven(), 1000).x - whole).max() > 1e-3


def test_error_falls_with_the_fourth_power_of_the_step() -> None:
    system = system_of(random_network(2))
    exact = simulate(system, undriven(), 2 * 12800, steps_per_period=12800).x
    counts = np.array([50, 100, 200, 400])
    errors = [
        np.abs(simulate(system, undriven(), 2 * int(count), steps_per_period=int(count)).x - exact).max()
        for count in counts
    ]
    slope = np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert -4.4 < slope < -3.7


def test_energy_is_kept_without_damping_and_clock() -> None:
    network = random_network(3, damping=0.0)
    still = dataclasses.replace(
        network,
        masses=tuple(dataclasses.replace(mass, k1=0.0) for mass in network.masses),
        couplings=tuple(dataclasses.replace(c, d0=1.0, d1=0.0) for c in network.couplings),
    )
    system = system_of(still)
    waves = wave_table(3, 1)[0]
    before = energy(system, system.initial, np.zeros(len(system.initial)), waves)
    assert before == pytest.approx(potential(still, system.initial, 0.0))
    run = simulate(system, undriven(), 40000, steps_per_period=4000)
    after = energy(system, run.x[:, 0], run.v[:, 0], waves)
    assert np.abs(run.v).max() > 0.1
    assert after == pytest.approx(before, abs=1e-6)
    damped = dataclasses.replace(system, damping=0.25)
    lossy = simulate(damped, undriven(), 40000, steps_per_period=4000)
    assert energy(damped, lossy.x[:, 0], lossy.v[:, 0], waves) < before - 0.1


def drive(lanes: int) -> Stimulus:
    force = np.random.default_rng(5).uniform(-1, 1, (4, 2, lanes))
    return Stimulus(np.array([0, 4]), force, 150, 300)


@pytest.mark.parametrize("lanes", [2, 16, 23, 37])
def test_lanes_equal_single_runs_bit_for_bit(lanes: int) -> None:
    system = system_of(random_network(4))
    watch = Watch(np.arange(9), np.full(9, 100))
    stimulus = drive(lanes)
    together = simulate(system, stimulus, 1250, watch=watch, trace_stride=100)
    threaded = simulate(system, stimulus, 1250, watch=watch, trace_stride=100, workers=2)
    for field in dataclasses.fields(together):
        a, b = getattr(together, field.name), getattr(threaded, field.name)
        assert a.tobytes() == b.tobytes()
    for lane in range(lanes):
        alone = simulate(
            system,
            dataclasses.replace(stimulus, force=stimulus.force[:, :, lane : lane + 1].copy()),
            1250,
            watch=watch,
            trace_stride=100,
        )
        assert together.x[:, lane].tobytes() == alone.x[:, 0].tobytes()
        assert together.readings[:, :, lane].tobytes() == alone.readings[:, :, 0].tobytes()
        assert together.trace[:, :, lane].tobytes() == alone.trace[:, :, 0].tobytes()
        assert together.peak[:, lane].tobytes() == alone.peak[:, 0].tobytes()


def test_intervals_drive_when_they_should() -> None:
    """A free, overdamped mass moves only while it is pushed, and in the direction of the push."""
    mass = Mass("a", MassKind.SENSOR, 0, 0.0, 0.0, 0.0, 0.0, 0.0)
    network = Network("one", "none", Dynamics(0.05, 5.0, 0.0, 10.0, 1), (mass,), (), (), (), (), None, 1)
    force = np.array([0.0, 1.0, -2.0])[:, None, None]
    trace = simulate(system_of(network), Stimulus(np.array([0]), force, 100, 50), 250, trace_stride=1).trace[:, 0, 0]
    assert not trace[:101].any()
    assert (np.diff(trace[100:151]) > 0).all()
    assert (np.diff(trace[155:]) < 0).all()  # the last interval goes on


def test_readings_and_peak_agree_with_the_trace() -> None:
    system = system_of(random_network(6))
    watch = Watch(np.array([3, 0, 7]), np.array([0, 133, 399]))
    run = simulate(system, drive(3), 1000, watch=watch, trace_stride=1)
    assert run.readings.shape == (3, 3, 3)
    for w, (mass, instant) in enumerate(zip(watch.masses, watch.instants, strict=True)):
        for cycle in range(3):
            at = 400 * cycle + instant
            expected = run.trace[at, mass] if at <= 1000 else np.full(3, np.nan)
            np.testing.assert_array_equal(run.readings[cycle, w], expected)
    np.testing.assert_array_equal(run.peak, np.abs(run.trace).max(axis=0))
    np.testing.assert_array_equal(run.trace[-1], run.x)


def test_what_does_not_fit_is_refused() -> None:
    network = random_network(7)
    system = system_of(network)
    with pytest.raises(ValueError, match="not in the system"):
        simulate(system, Stimulus(np.array([99]), np.zeros((1, 1, 1)), 0, 1), 10)
    with pytest.raises(ValueError, match="instant"):
        simulate(system, undriven(), 10, watch=Watch(np.array([0]), np.array([400])))
    first = network.couplings[0]
    for broken in (
        dataclasses.replace(network, couplings=(dataclasses.replace(first, target="nobody"),)),
        dataclasses.replace(network, couplings=(dataclasses.replace(first, target=first.source),)),
        dataclasses.replace(network, couplings=(dataclasses.replace(first, strength=float("nan")),)),
        dataclasses.replace(network, couplings=(dataclasses.replace(first, kind=CouplingKind.LATCH),)),
        dataclasses.replace(network, masses=network.masses + network.masses[:1]),
        dataclasses.replace(network, dynamics=dataclasses.replace(network.dynamics, phases=1)),
    ):
        with pytest.raises(UsageError):
            system_of(broken)


def digest() -> str:
    """Hash of everything a driven run leaves behind."""
    run = simulate(system_of(random_network(4)), drive(18), 900, trace_stride=90, workers=2)
    return hashlib.sha256(b"".join(getattr(run, f.name).tobytes() for f in dataclasses.fields(run))).hexdigest()


def test_another_process_without_a_cache_gives_the_same_bytes(tmp_path: Path) -> None:
    code = "from tests.simulation.test_kernel import digest; print(digest())"
    fresh = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "PYTHONHASHSEED": "7"}
    result = subprocess.run(
        [sys.executable, "-c", code],
        env=fresh,
        cwd=Path(__file__).parents[2],
        capture_output=True,
        text=True,
        check=True,
    )
    assert result.stdout.strip() == digest() == digest()
