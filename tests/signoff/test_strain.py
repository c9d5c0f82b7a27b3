"""Rule ``strain``: every kind of part that is strained too far at large displacements, and the same part as sized."""

from dataclasses import replace

import pytest

from mdlcad.mechanics.leaves import LeafKind
from mdlcad.mechanics.sizing import Sizing
from mdlcad.mechanics.strains import check_strain, reach_at
from mdlcad.signoff.geometry import check_geometry
from tests.parts.device import Device


def found(device: Device, sizing: Sizing) -> set[tuple[str, str]]:
    findings = check_strain(
        device.network,
        device.process,
        sizing.law,
        sizing.series,
        {unit.mass: unit.preload for unit in sizing.units},
        {unit.mass: unit.amplitude / device.process.unit.throw_unit for unit in sizing.units},
        sizing.couplers,
        sizing.biases,
        sizing.rules.throw,
    )
    assert all(item.value > item.limit for item in findings)
    return {(item.rule, item.subject) for item in findings}


def thicker(sizing: Sizing, kind: LeafKind) -> Sizing:
    """Every leaf of that kind with a wall half as thick again."""

    def cut(item):
        shape = replace(item.leaf.shape, wall=1.5 * item.leaf.shape.wall)
        return replace(item, leaf=replace(item.leaf, shape=shape)) if item.leaf.kind is kind else item

    return replace(sizing, couplers=tuple(map(cut, sizing.couplers)), biases=tuple(map(cut, sizing.biases)))


def test_parts_as_sized_keep_their_strain(device: Device) -> None:
    assert found(device, device.sizing) == set()


@pytest.mark.parametrize(
    ("kind", "subject"),
    [
        (LeafKind.COUPLER, "coupler.m0->m3"),
        (LeafKind.ROCKER, "coupler.m1->m4"),
        (LeafKind.BIAS, "bias.m2"),
    ],
)
def test_a_leaf_with_a_thicker_wall_is_found(device: Device, kind: LeafKind, subject: str) -> None:
    broken = found(device, thicker(device.sizing, kind))
    # a fillet that is small for its wall may break the other rule as well
    assert {("strain", subject)} <= broken <= {("strain", subject), ("strain_root", subject)}


def test_fillets_too_sharp_for_their_walls_are_found(device: Device) -> None:
    """At the fillets' ends all is as it was; within them the strain is much higher."""
    sharp = replace(device.process, machine=replace(device.process.machine, fillet=0.015))

    def cut(item):
        return replace(item, leaf=replace(item.leaf, shape=replace(item.leaf.shape, fillet=0.015)))

    sizing = replace(
        device.sizing,
        couplers=tuple(map(cut, device.sizing.couplers)),
        biases=tuple(map(cut, device.sizing.biases)),
    )
    broken = found(replace(device, process=sharp), sizing)
    assert {rule for rule, _ in broken} == {"strain_root"}
    assert {"coupler.m0->m3", "bias.m2", "unit.m0"} <= {subject for _, subject in broken}


def test_a_bias_leaf_the_wrong_way_up_is_found(device: Device) -> None:
    """Linear theory strains it the same either way; large displacements do not."""
    bias = device.sizing.biases[0]
    turned = replace(bias.leaf, shape=replace(bias.leaf.shape, amplitude=-bias.leaf.shape.amplitude))
    sizing = replace(device.sizing, biases=(replace(bias, leaf=turned),))
    assert found(device, sizing) == {("strain", "bias.m2")}


def test_a_bias_leaf_whose_post_stands_too_far_is_found(device: Device) -> None:
    bias = device.sizing.biases[0]
    sizing = replace(device.sizing, biases=(replace(bias, offset=2.0 * bias.offset),))
    assert found(device, sizing) == {("strain", "bias.m2")}


def test_a_unit_that_swings_too_far_is_found(device: Device) -> None:
    units = tuple(replace(unit, amplitude=3.6) if unit.mass == "m5" else unit for unit in device.sizing.units)
    assert ("strain", "unit.m5") in found(device, replace(device.sizing, units=units))


def test_a_series_spring_preloaded_too_far_is_found(device: Device) -> None:
    units = tuple(replace(unit, preload=5.0 * unit.preload) for unit in device.sizing.units)
    assert ("strain", "unit.series") in found(device, replace(device.sizing, units=units))


def test_the_design_rules_do_not_take_the_sizings_word(device: Device) -> None:
    def count(sizing: Sizing) -> int:
        rules = check_geometry(
            device.network, sizing, device.placement, device.layout, device.bodies(), (), device.process, {}
        )
        return rules.counts["strain"]

    assert count(device.sizing) == 0
    assert count(replace(thicker(device.sizing, LeafKind.ROCKER), findings=())) == 1


def test_a_mass_goes_farther_the_softer_its_clock_makes_it(device: Device) -> None:
    peaks = {mass.name: 1.8 for mass in device.network.masses}
    idle, middle, peak = (reach_at(device.network, peaks, p) for p in (0.0, 1.0, 2.0))
    assert all(idle[name] < middle[name] < peak[name] == 1.8 for name in ("m0", "m1", "m2"))
    # m0: k = 3.5, pushed by its neighbour with 0.25 x 1.8
    assert 3.5 * idle["m0"] / 1.1 + (idle["m0"] / 1.1) ** 3 == pytest.approx(0.45)
