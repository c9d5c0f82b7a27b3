"""Shuttles that tilt, against an independent integrator that solves their angles anew at every moment."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import lsq_linear

from mdlcad.simulation.run import simulate, undriven
from mdlcad.simulation.system import System, system_of
from mdlcad.simulation.tilting import Tilts
from tests.parts.device import small_network
from tests.simulation.test_devices import plain, stimulus


def tilting(system: System, most: float, rub: float = 0.0) -> tuple[Tilts, np.ndarray, np.ndarray, np.ndarray]:
    """Tilts with heights by chance, and the matrices A, B, C between displacements and angles."""
    rng, n = np.random.default_rng(4), len(system.names)
    owner = np.repeat(np.arange(n), np.diff(system.row_start))
    lift = rng.uniform(3.0, 9.0, (n, n))  # of the spring between i and j above i
    own, other = lift[owner, system.column], lift[system.column, owner]
    self_stiffness = 1.3 * np.abs(system.base)
    leaf, stiffness = rng.uniform(3.0, 9.0, n), rng.uniform(0.0, 0.3, n)
    tilts = Tilts(
        stiffness=np.full(n, 30.0),
        low=np.full((n, 1), -most),
        high=np.full((n, 1), most),
        bias_height=leaf,
        bias_stiffness=stiffness,
        force_height=np.zeros(n),
        rub=np.full(n, rub),
        own=own,
        other=other,
        self_stiffness=self_stiffness,
    )
    mixed, turning = np.diag(leaf * stiffness), np.diag(30.0 + leaf**2 * stiffness)
    for e, (i, j) in enumerate(zip(owner, system.column, strict=True)):
        mixed[i, i] += own[e] * self_stiffness[e]
        mixed[i, j] -= other[e] * system.base[e]
        turning[i, i] += own[e] ** 2 * self_stiffness[e]
        turning[i, j] -= own[e] * other[e] * system.base[e]
    return tilts, mixed, turning, leaf * system.bias


@pytest.mark.parametrize("most", [1.0, 0.02])
def test_angles_are_those_of_the_least_energy_between_the_stops(most: float) -> None:
    system = system_of(small_network())
    system = replace(system, initial=np.random.default_rng(6).uniform(-1.5, 1.5, len(system.names)))
    tilts, mixed, turning, lifted = tilting(system, most)
    root = np.linalg.cholesky(turning)
    largest = 0.0

    def slopes(t: float, state: np.ndarray) -> np.ndarray:
        nonlocal largest
        x, v = np.split(state, 2)
        p = np.array([1 + np.sin(2 * np.pi * (t / system.period - k / system.phases)) for k in range(system.phases)])
        pull = -lifted - mixed.T @ x
        angle = np.linalg.solve(turning, pull)
        if np.abs(angle).max() > most:
            angle = lsq_linear(root.T, np.linalg.solve(root, pull), (-most, most), tol=1e-12).x
        largest = max(largest, float(np.abs(angle).max()))
        k = system.stiffness_base + system.stiffness_swing * p[system.phase]
        force = -(k * x + system.quartic * x**3 + system.bias) - mixed @ angle
        owner = np.repeat(np.arange(len(x)), np.diff(system.row_start))
        np.add.at(force, owner, system.base * x[system.column])
        return np.concatenate([v, (force - system.damping * v) / system.inertia])

    steps = 400
    device = replace(system, devices=replace(plain(system), tilts=tilts))
    run = simulate(device, undriven(), steps, trace_stride=100)
    start = np.concatenate([system.initial, np.zeros(len(system.names))])
    end = steps * system.period / 400
    wanted = solve_ivp(slopes, (0.0, end), start, t_eval=np.linspace(0.0, end, 5), rtol=1e-5, atol=1e-6).y
    np.testing.assert_allclose(run.trace[:, :, 0], wanted[: len(system.names)].T, atol=0.006)
    assert run.tilt.max() >= 0.9 * largest > 0.0
    assert (largest == pytest.approx(most)) == (most < 1.0)
    held = simulate(replace(system, devices=plain(system)), undriven(), steps, trace_stride=100)
    assert np.abs(run.trace - held.trace).max() > 0.03


def test_shuttles_between_stops_without_play_are_held() -> None:
    system = system_of(small_network())
    tilts = tilting(system, 0.0)[0]
    held = simulate(replace(system, devices=plain(system)), stimulus(9), 1500, trace_stride=100)
    stopped = simulate(
        replace(system, devices=replace(plain(system), tilts=tilts)), stimulus(9), 1500, trace_stride=100
    )
    np.testing.assert_allclose(stopped.trace, held.trace, atol=1e-12)
    assert held.tilt.max() == 0.0
    assert stopped.tilt.max() > 0.001  # what it would be without stops


def test_what_presses_plates_brakes() -> None:
    system = system_of(small_network())
    runs = []
    for rub in (0.0, 3e4):
        device = replace(system, devices=replace(plain(system), tilts=tilting(system, 1.0, rub)[0]))
        runs.append(simulate(device, stimulus(1), 400, trace_stride=10).trace)
    assert np.abs(np.diff(runs[1], axis=0)).sum() < 0.9 * np.abs(np.diff(runs[0], axis=0)).sum()
