"""Instants and bits."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from mdlcad.network.model import Dynamics, Mass, MassKind, Network
from mdlcad.simulation.decode import UNDECIDED, decode, instants, wells
from mdlcad.simulation.run import simulate, steps_for, undriven
from mdlcad.simulation.system import system_of, wave_table
from tests.simulation.networks import random_network


def masses(phases: int, **numbers: float) -> Network:
    made = tuple(
        Mass(
            f"m{k}",
            MassKind.GATE,
            k,
            **({"k0": 3.0, "k1": -2.75, "compensation": 0.0, "bias": 0.0} | numbers),
            initial=1,
        )
        for k in range(phases)
    )
    return Network("x", "none", Dynamics(0.05, 0.25, 1.0, 10.0, phases), made, (), (), (), (), None, 1)


@pytest.mark.parametrize("phases", [1, 2, 3, 4, 5])
@pytest.mark.parametrize("steps", [400, 500])
def test_a_mass_is_read_when_its_wells_are_deepest(phases: int, steps: int) -> None:
    every = np.arange(phases)
    table = wave_table(phases, steps)
    at = instants(system_of(masses(phases)), every, steps)
    assert table[at, every] == pytest.approx(table.max(axis=0), abs=1e-3)
    rising = instants(system_of(masses(phases, k0=-2.5, k1=2.75)), every, steps)
    assert table[rising, every] == pytest.approx(table.min(axis=0), abs=1e-3)


def test_bits_follow_sign_and_polarity_and_nothing_is_not_zero() -> None:
    network = masses(2)
    upside_down = dataclasses.replace(network.masses[1], polarity=-1)
    system = system_of(dataclasses.replace(network, masses=(network.masses[0], upside_down)))
    both = np.arange(2)
    assert wells(system, both) == pytest.approx(np.sqrt(2.5))
    x = np.array([1.5, -1.5, 0.0, 0.3, -0.3, 0.5, np.nan, np.inf])
    bits = decode(system, both, np.stack([x, x]))
    u = UNDECIDED
    np.testing.assert_array_equal(bits, [[1, 0, u, u, u, 1, u, u], [0, 1, u, u, u, 0, u, u]])
    assert (decode(system_of(masses(1, k1=0.0)), np.arange(1), np.zeros((1, 1))) == u).all()


@pytest.mark.parametrize("period", [1.0, 10.0, 300.0])
def test_the_step_is_fine_enough_for_any_clock(period: float) -> None:
    """Half the step changes little; the step of a fast clock would not do for a slow one."""
    network = random_network(1)
    network = dataclasses.replace(network, dynamics=dataclasses.replace(network.dynamics, period=period))
    system = system_of(network)
    steps = steps_for(system)
    coarse = simulate(system, undriven(), 2 * steps, steps_per_period=steps).x
    fine = simulate(system, undriven(), 4 * steps, steps_per_period=2 * steps).x
    assert np.abs(coarse - fine).max() < 1e-3
    if period == 300.0:
        assert steps > 2000
        assert not np.isfinite(simulate(system, undriven(), 800, steps_per_period=400).x).all()
