"""Couplers drawn for shuttles that may tilt: half way between held and free they have what was asked for."""

from dataclasses import replace

import numpy as np
import pytest

from mdlcad.mechanics.lean import NO_LIFTS, Lifts, lean_of, middle_factors
from tests.parts.device import Device, small_device


@pytest.fixture(scope="module")
def device() -> Device:
    return small_device()


def parts_of(device: Device):
    sizing = device.sizing
    leaves = [part.leaf for part in sizing.couplers]
    return device.network, leaves, [20.0 * leaf.own for leaf in leaves], sizing.biases, sizing.law


def lifts_of(device: Device, height: float, bias: float) -> Lifts:
    couplings = {item.name: (height, height) for item in device.network.couplings}
    return Lifts(couplings, {item.mass: bias for item in device.sizing.biases})


def test_without_heights_it_is_the_carrier_alone(device: Device) -> None:
    network, leaves, carriers, biases, law = parts_of(device)
    factors = middle_factors(network, leaves, carriers, biases, law, NO_LIFTS)
    # f c K / (K + f s) = c
    assert factors == pytest.approx([1.0 / (1.0 - 1.0 / 20.0)] * len(leaves))


def test_half_way_every_coupling_has_what_its_target_can_compare(device: Device) -> None:
    network, leaves, carriers, biases, law = parts_of(device)
    lifts = lifts_of(device, 9.9, 13.2)
    factors = middle_factors(network, leaves, carriers, biases, law, lifts)
    lean = lean_of(network, leaves, factors, carriers, biases, law, lifts)
    places = [mass.name for mass in network.masses]
    assert np.abs(lean.free / lean.held - 1.0).max() > 0.02
    assert lean.biases.min() < 0.98
    for coupling, leaf, factor, held, free in zip(
        network.couplings, leaves, factors, lean.held, lean.free, strict=True
    ):
        share = 0.5 * (1.0 + lean.biases[places.index(coupling.target)])
        got = abs(0.5 * (held + free)) / leaf.coupling
        assert got == pytest.approx(share, rel=1e-3) or (factor == 1.0 and got > share)


def test_a_bias_that_pulls_at_a_height_is_felt_less(device: Device) -> None:
    """One mass, one coupling held fast at its other end: statics by hand."""
    network, leaves, _, biases, law = parts_of(device)
    (leaf, *_), (bias, *_) = leaves, biases
    coupling = network.couplings[0]
    bias = replace(bias, mass=coupling.target)
    alone = replace(network, couplings=(coupling,))
    at, up = 10.0, 12.0
    lifts = Lifts({coupling.name: (0.0, at)}, {bias.mass: up})
    lean = lean_of(alone, [leaf], np.ones(1), [1e9], [bias], law, lifts)
    own, pulled = leaf.own, bias.self_stiffness * law.stiffness_unit
    mixed = own * at + pulled * up
    turning = law.shuttle_tilt + own * at**2 + pulled * up**2
    share = dict(zip([mass.name for mass in network.masses], lean.biases, strict=True))
    assert share[bias.mass] == pytest.approx(1.0 - mixed * up / turning, rel=1e-6)
