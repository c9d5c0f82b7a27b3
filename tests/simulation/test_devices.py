"""Devices with numbers of their own: the network's kernel where they have none, and an independent integrator."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mdlcad.simulation.devices import Devices
from mdlcad.simulation.run import Stimulus, simulate
from mdlcad.simulation.system import System, system_of
from tests.parts.device import small_network


def plain(system: System) -> Devices:
    """The system's own numbers, without higher terms."""
    masses, entries = len(system.names), len(system.base)
    return Devices(
        system.stiffness_base[:, None],
        system.stiffness_swing[:, None],
        system.bias[:, None],
        np.full((masses, 1), system.quartic),
        *np.zeros((4, masses, 1)),
        system.base[:, None],
        *np.zeros((4, entries, 1)),
    )


def stimulus(lanes: int) -> Stimulus:
    force = np.random.default_rng(1).uniform(-1.0, 1.0, (3, 2, lanes))
    return Stimulus(np.array([0, 1]), force, 400, 800)


@pytest.mark.parametrize("lanes", [1, 9])
def test_without_terms_of_their_own_they_are_the_network(lanes: int) -> None:
    system = system_of(small_network())
    wanted = simulate(system, stimulus(lanes), 2000, trace_stride=100)
    found = simulate(replace(system, devices=plain(system)), stimulus(lanes), 2000, trace_stride=100)
    assert np.abs(wanted.trace).max() > 1.0
    np.testing.assert_allclose(found.trace, wanted.trace, atol=1e-9)
    np.testing.assert_allclose(found.peak, wanted.peak, atol=1e-9)


def test_every_term_is_that_of_the_energy() -> None:
    """Against SciPy, with the forces differentiated from V by central differences."""
    system = system_of(small_network())
    rng = np.random.default_rng(2)
    own = plain(system)
    pair = rng.uniform(0.0, 0.1, (4, len(small_network().couplings)))
    terms = np.zeros((4, len(system.base)))
    pairs = [(system.index(c.source), system.index(c.target)) for c in small_network().couplings]
    for i in range(len(system.names)):
        for e in range(system.row_start[i], system.row_start[i + 1]):
            which = next(m for m, ends in enumerate(pairs) if {i, int(system.column[e])} == set(ends))
            terms[:, e] = pair[:, which]
    devices = replace(
        own,
        quartic=rng.uniform(0.8, 1.2, own.quartic.shape),
        cubic=rng.uniform(-0.2, 0.2, own.cubic.shape),
        friction=rng.uniform(0.0, 0.1, own.friction.shape),
        friction_slope=rng.uniform(-0.1, 0.1, own.friction.shape),
        friction_curve=rng.uniform(0.0, 0.1, own.friction.shape),
        apart=terms[0][:, None],
        together=terms[1][:, None],
        skew=terms[2][:, None],
        rub=terms[3][:, None],
    )

    def energy(x: np.ndarray, p: np.ndarray) -> float:
        k = (devices.base + devices.swing * p[system.phase][:, None])[:, 0]
        v = (0.25 * devices.quartic[:, 0] * x**4 + devices.cubic[:, 0] / 3 * x**3 + 0.5 * k * x**2).sum()
        v += (devices.bias[:, 0] * x).sum()
        for coupling, (i, j), (q, c, b, _) in zip(small_network().couplings, pairs, pair.T, strict=True):
            d, t = x[i] - x[j], x[i] + x[j]
            v += -coupling.strength * x[i] * x[j] + q / 4 * d**4 + c / 4 * t**4 + b * t * d**2
        return float(v)

    def slopes(t: float, state: np.ndarray) -> np.ndarray:
        x, v = np.split(state, 2)
        p = np.array([1 + np.sin(2 * np.pi * (t / system.period - k / system.phases)) for k in range(system.phases)])
        push = np.array([energy(x - h, p) - energy(x + h, p) for h in 1e-5 * np.eye(len(x))]) / 2e-5
        push[0] += 0.7
        bound = devices.friction + devices.friction_slope * x[:, None] + devices.friction_curve * x[:, None] ** 2
        push -= np.maximum(bound[:, 0], 0.0) * v / (np.abs(v) + 0.05)
        for (i, j), rub in zip(pairs, pair[3], strict=True):
            apace = v[i] - v[j]
            drag = rub * abs(x[i] + x[j]) * apace / (abs(apace) + 0.05)
            push[i] -= drag
            push[j] += drag
        return np.concatenate([v, (push - system.damping * v) / system.inertia])

    begin = rng.uniform(-0.5, 0.5, len(system.names))
    started = replace(system, initial=begin, devices=devices)
    found = simulate(started, Stimulus(np.array([0]), np.full((1, 1, 1), 0.7), 1, 1), 400).x[:, 0]
    wanted = solve_ivp(slopes, (0.0, system.period), np.concatenate([begin, 0 * begin]), rtol=1e-7, atol=1e-8).y[:, -1]
    np.testing.assert_allclose(found, wanted[: len(begin)], atol=2e-4)  # one mass rolls off a hilltop
