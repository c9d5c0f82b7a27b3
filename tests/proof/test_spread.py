"""Yield under scatter, and the window of the dynamics."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from mdlcad.artefact import to_json
from mdlcad.proof.spread import estimate_yield, wilson
from mdlcad.proof.window import find_window
from mdlcad.simulation.scatter import Scatter, scatter_of, scattered
from tests.proof.devices import toggle, vote, walker


def test_wilson_agrees_with_published_and_limiting_values() -> None:
    assert wilson(0, 10) == (0.0, pytest.approx(0.2775, abs=1e-4))
    assert wilson(10, 10) == (pytest.approx(0.7225, abs=1e-4), 1.0)
    # it solves |share - p| = z sqrt(p (1 - p) / n) for p
    for right, samples in ((3, 10), (29, 30), (500, 1000)):
        for bound in wilson(right, samples):
            z = abs(right / samples - bound) / np.sqrt(bound * (1 - bound) / samples)
            assert z == pytest.approx(1.96, abs=1e-3)
    with pytest.raises(ValueError, match="sample"):
        wilson(0, 0)


def test_scatter_has_the_stated_deviations() -> None:
    network, _ = walker()
    devices = [scattered(network, Scatter(0.1, 0.05, 0.2), 3, sample) for sample in range(300)]
    strength = [c.strength / n.strength for d in devices for c, n in zip(d.couplings, network.couplings, strict=True)]
    own = [c.self_stiffness / 0.3 for d in devices for c in d.couplings]
    k0 = [m.k0 - 3.0 for d in devices for m in d.masses]
    bias = [m.bias / n.bias for d in devices for m, n in zip(d.masses, network.masses, strict=True) if n.bias]
    for values, middle, deviation in ((strength, 1, 0.1), (own, 1, 0.1), (k0, 0, 0.2), (bias, 1, 0.05)):
        assert np.mean(values) == pytest.approx(middle, abs=0.05 * deviation)
        assert np.std(values) == pytest.approx(deviation, rel=0.05)
    assert scattered(network, scatter_of(0.1), 3, 7) == scattered(network, scatter_of(0.1), 3, 7)
    assert scattered(network, scatter_of(0.0), 3, 7) == network


def test_yield_falls_with_scatter() -> None:
    network, machine = toggle()
    perfect = estimate_yield(network, machine, scatter_of(0.0), samples=2, decisions=64)
    assert (perfect.right, perfect.weaknesses) == (2, ())
    small = estimate_yield(network, machine, scatter_of(0.05), samples=8, decisions=64)
    large = estimate_yield(network, machine, scatter_of(0.4), samples=8, decisions=64)
    assert small.right >= 7 > large.right + 2
    assert small.low < small.right / 8 <= small.high
    names = {mass.name for mass in network.masses}
    assert large.weaknesses and all(weakness.mass in names for weakness in large.weaknesses)
    assert sum(weakness.count for weakness in large.weaknesses) <= 8 - large.right
    one, two = (estimate_yield(network, machine, scatter_of(0.4), samples=2, workers=w) for w in (1, 2))
    assert to_json(one) == to_json(two)


def test_the_weak_mass_is_named() -> None:
    """A bias at its limit gives way under little scatter, before any other mass."""
    network, machine = vote()
    weak = tuple(dataclasses.replace(m, bias=0.48) if m.name == "majority" else m for m in network.masses)
    found = estimate_yield(dataclasses.replace(network, masses=weak), machine, Scatter(0.1, 0.1, 0.1), samples=12)
    assert found.right < 12
    assert found.weaknesses[0].mass == "majority"


def test_the_window_has_an_inside_and_an_outside() -> None:
    network, machine = toggle()
    points = find_window(network, machine, (0.2, 5.0, 20.0), (0.1, 0.25))
    assert [(p.period, p.damping) for p in points] == [(t, b) for t in (0.2, 5.0, 20.0) for b in (0.1, 0.25)]
    assert [p.holds for p in points] == [False, False, True, True, True, True]
    assert all(p.margin > 0.5 for p in points[2:])
