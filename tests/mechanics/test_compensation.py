"""Preloads solved with the carriers' give, held against the fit itself and against the beam computation."""

from dataclasses import replace

import numpy as np
import pytest

from mdlcad.errors import UsageError
from mdlcad.mechanics.beam.large import LargeFrame
from mdlcad.mechanics.beam.unit import held, unit_model
from mdlcad.mechanics.compensation import Compensation, compensate, compensated
from mdlcad.mechanics.fit import Scale, UnitCurve, fit_unit, in_row
from mdlcad.mechanics.frame import Y, dof
from mdlcad.mechanics.reduced import sized_numbers
from mdlcad.mechanics.strains import reach_at
from mdlcad.mechanics.unit import clock_swing
from mdlcad.parts.stiffness import carrier_stiffnesses
from tests.parts.device import Device, small_device


@pytest.fixture(scope="module")
def device() -> Device:
    return small_device()


@pytest.fixture(scope="module")
def carriers(device: Device) -> dict[str, float]:
    found = carrier_stiffnesses(device.network, device.placement, device.layout, device.sizing, device.process)
    return {item.coupling: item.stiffness for item in found}


@pytest.fixture(scope="module")
def solved(device: Device, carriers: dict[str, float]) -> Compensation:
    return compensate(device.network, device.process, device.sizing, carriers)


def test_the_curve_is_the_fit(device: Device) -> None:
    law = device.sizing.law
    numbers, scale = (
        sized_numbers(device.process, law, device.sizing.series),
        Scale(law.stiffness_unit, device.process.unit.throw_unit),
    )
    given = (numbers, clock_swing(device.network, law), (0.9, 1.8, 2.4), scale)
    curve = UnitCurve(*given, 0.0, 0.6)
    for preload in (0.0, 0.07, 0.31, 0.55, 0.6):
        one, other = curve.at(preload), fit_unit(numbers, preload, *given[1:])
        assert (one.base, one.swing, one.quartic) == pytest.approx((other.base, other.swing, other.quartic), abs=1e-5)
    own = curve.at(0.2).base + curve.at(0.2).swing
    assert curve.preload_for(own) == pytest.approx(0.2, abs=1e-6)
    with pytest.raises(ArithmeticError, match=r"no preload from 0\.000 to 0\.600"):
        curve.preload_for(9.0)


def test_springs_in_a_row_add_up_as_a_frame_does() -> None:
    """A flexure between y1 (hub) and y2 (far end), and a carrier from there to the source at y3: eliminate y2."""
    own, across, far, carrier = 0.5, -0.4, 0.6, 7.0
    whole = np.array([[own, across, 0.0], [across, far + carrier, -carrier], [0.0, -carrier, carrier]])
    reduced = whole[np.ix_([0, 2], [0, 2])] - np.outer(whole[[0, 2], 1], whole[1, [0, 2]]) / whole[1, 1]
    row = in_row(own, across, far, carrier)
    assert (row.target, row.strength, row.source) == pytest.approx((reduced[0, 0], reduced[0, 1], reduced[1, 1]))


def test_every_mass_has_the_k_that_is_asked_for(device: Device, solved: Compensation) -> None:
    for unit in solved.units:
        assert abs(unit.left[1]) < 1e-3
        assert max(map(abs, unit.left)) < 0.12
        assert unit.left[2] - unit.left[0] == pytest.approx(2.0 * (unit.swing - unit.swing_asked), abs=1e-6)
    assert not [item for item in solved.findings if item.rule == "preload_room"]


def test_softer_carriers_ask_for_less_preload_within_the_room_kept(
    device: Device, carriers: dict[str, float], solved: Compensation
) -> None:
    bound = {unit.mass: unit for unit in device.sizing.units}
    coupled = {name for coupling in device.network.couplings for name in (coupling.source, coupling.target)}
    for unit in solved.units:
        assert bound[unit.mass].room[0] <= unit.preload <= bound[unit.mass].room[1]
        if unit.mass in coupled:
            assert unit.preload < unit.preload_sized
        else:
            assert unit.preload == unit.preload_sized


def test_a_preload_beyond_its_room_is_found(device: Device, carriers: dict[str, float]) -> None:
    """Carriers ten times softer than the process allows: the clock block would overrun its slot."""
    soft = {name: stiffness / 100.0 for name, stiffness in carriers.items()}
    found = compensate(device.network, device.process, device.sizing, soft).findings
    rooms = [item for item in found if item.rule == "preload_room"]
    assert {item.subject for item in rooms} == {"unit.m0", "unit.m1", "unit.m3", "unit.m4"}
    assert all(item.value < item.limit for item in rooms)


def test_the_beam_computation_agrees(device: Device, solved: Compensation) -> None:
    """A unit of beams at large displacements, pushed by the solved preload, with its springs: k asked for to 0.1."""
    process, sizing = device.process, compensated(device.sizing, solved)
    model = unit_model(process, sizing.series)
    large, unit = LargeFrame(model.frame, model.cuts), process.unit
    peaks = {item.mass: item.amplitude / unit.throw_unit for item in sizing.units}
    reach = unit.throw_unit * max(reach_at(device.network, peaks, 1.0).values())
    for name in ("m0", "m5"):  # with a coupler, and with no spring at all
        item = next(row for row in solved.units if row.mass == name)
        at = np.linspace(reach, 0.25 * reach, 4)
        pose = large.move(large.rest(), held(model, 0.0, float(at[0])))
        forces = []
        for y in at:
            pose = large.move(pose, held(model, item.preload, float(y)))
            forces.append(pose.reactions[dof(model.hub, Y)] / sizing.law.force_unit)
        x = at / unit.throw_unit
        k = float(x @ (np.array(forces) - item.quartic * x**3) / (x @ x))
        assert k + item.springs == pytest.approx(item.asked, abs=0.1)


def test_the_sizing_takes_over_what_was_solved(device: Device, solved: Compensation) -> None:
    new = compensated(device.sizing, solved)
    assert [unit.preload for unit in new.units] == [unit.preload for unit in solved.units]
    assert (new.series.strain, new.findings) == (solved.strain_peak, solved.findings)
    assert new.rules == device.sizing.rules
    with pytest.raises(UsageError, match="no preload for the unit 'm5'"):
        compensated(device.sizing, replace(solved, units=solved.units[:-1]))
