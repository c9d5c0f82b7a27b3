"""Carriers against sums by hand: with one trunk a carrier is statically determinate, so unit loads give its give."""

from dataclasses import replace

import pytest

from mdlcad.mechanics.process import PlateRole
from mdlcad.mechanics.sizing import turn_stiffness
from mdlcad.parts.stiffness import carrier_faults, carrier_stiffnesses, tilt_limit
from tests.parts.device import Device, small_device


@pytest.fixture(scope="module")
def device() -> Device:
    return small_device()


def test_a_carrier_gives_what_its_bars_and_pins_give(device: Device) -> None:
    """Virtual work along m0's chain: shuttle, hub pin, rung, via, trunk, via, rung; the pull is mid-coupler."""
    rules, process = device.sizing.rules, device.process
    pom, metal, steel = (process.materials[name].modulus for name in ("pom", "aluminium", "steel"))
    unit, trunk_plate = process.plates(PlateRole.UNIT)[0], process.plates(PlateRole.TRUNK)[0]
    rung_plate = process.plate("H0")
    hub = device.placement.masses[0]
    trunk, leaf = device.layout.trunks[0], device.layout.couplers[0]
    pull = leaf.start_x + device.sizing.couplers[0].leaf.reach / 2.0
    bar = pom * rung_plate.thickness * rules.hub_height**3 / 12.0
    section = metal * trunk_plate.thickness * rules.bar_width
    height = trunk.y_high - trunk.y_low

    def pin(length: float, arm: float) -> float:
        inertia, torsion = rules.pin**4 / 12.0, 0.1406 * rules.pin**4
        return length**3 / (3.0 * steel * inertia) + arm**2 * length / (steel / 2.6 * torsion)

    hub_pin = 2.0 * process.stack.z_gap + trunk_plate.thickness  # from the unit plate up to H0
    give = (pull - hub.x) ** 2 / turn_stiffness(device.sizing.law, device.sizing.series)
    give += pin(hub_pin, pull - hub.x - rules.hub_pin_offset)
    give += ((pull - hub.x - rules.hub_half) ** 3 - (pull - trunk.x) ** 3) / (3.0 * bar)
    give += 2.0 * pin(process.stack.z_gap, pull - trunk.x)
    give += height / section + (pull - trunk.x) ** 2 * height / (section * rules.bar_width**2 / 12.0)
    give += ((pull - trunk.x) ** 3 - (pull - leaf.start_x) ** 3) / (3.0 * bar)
    found = carrier_stiffnesses(device.network, device.placement, device.layout, device.sizing, process)[0]
    # the frame's rigid blocks give a little
    assert found.stiffness == pytest.approx(1.0 / give, rel=2e-3)
    assert unit.thickness > 0.0
    assert found.ratio == pytest.approx(found.stiffness / device.sizing.couplers[0].leaf.own)


def test_tilt_is_force_times_height(device: Device) -> None:
    process, law = device.process, device.sizing.law
    found = carrier_stiffnesses(device.network, device.placement, device.layout, device.sizing, process)[0]
    stack = [process.plate(name).thickness for name in ("unit", "V", "H0")]
    height = stack[0] / 2.0 + stack[1] + stack[2] / 2.0 + 2.0 * process.stack.z_gap
    force = 0.25 * law.stiffness_unit * 2.0 * 1.8 * process.unit.throw_unit
    assert found.tilt == pytest.approx(force * height / law.shuttle_tilt, rel=1e-3)


def test_tilt_adds_up_over_the_fan_out_and_is_an_error(device: Device) -> None:
    """As many couplers as it takes to tilt the shuttle into its neighbours: each alone is well within the limit."""
    found = carrier_stiffnesses(device.network, device.placement, device.layout, device.sizing, device.process)
    limit = tilt_limit(device.sizing, device.process)
    assert found[0].tilt < limit
    network = device.network
    more = replace(network.couplings[0], target="m5")
    both = replace(network, couplings=(network.couplings[0], more, network.couplings[1]))
    twin = next(rung for rung in device.layout.rungs if rung.name == "m0.1")
    end = replace(twin.right, ref=more.name)
    layout = replace(device.layout, rungs=(*device.layout.rungs, replace(twin, name="m0.2", right=end)))
    parts = device.sizing.couplers
    sizing = replace(device.sizing, couplers=(parts[0], replace(parts[0], coupling=more.name), parts[1]))
    summed = carrier_stiffnesses(both, device.placement, layout, sizing, device.process)
    assert summed[0].tilt == summed[1].tilt == pytest.approx(2.0 * found[0].tilt)
    soft = replace(sizing, law=replace(sizing.law, shuttle_tilt=sizing.law.shuttle_tilt * 1.5 * found[0].tilt / limit))
    faults = carrier_faults(
        carrier_stiffnesses(both, device.placement, layout, soft, device.process), soft, device.process
    )
    assert {fault.coupling for fault in faults if fault.rule == "shuttle_tilt"} == {"m0->m3", more.name}
    alone = carrier_stiffnesses(network, device.placement, device.layout, soft, device.process)
    assert not [fault for fault in carrier_faults(alone, soft, device.process) if fault.rule == "shuttle_tilt"]
