"""Preloads solved with the carriers' give, held against the fit itself and against the beam computation."""

from dataclasses import replace

import numpy as np
import pytest

from mdlcad.errors import UsageError
from mdlcad.mechanics.beam.large import LargeFrame
from mdlcad.mechanics.beam.unit import held, unit_model
from mdlcad.mechanics.compensation import Compensation, compensate, compensated
from mdlcad.mechanics.fit import Scale, UnitCurve, fit_unit, in_row
from mdlcad.mechanics.flexure import signal_matrix
from mdlcad.mechanics.frame import Y, dof
from mdlcad.mechanics.leaves import chain_of
from mdlcad.mechanics.preload import COUPLER_STEP
from mdlcad.mechanics.process import PlateRole
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


def test_couplers_make_up_for_their_carriers(device: Device, solved: Compensation) -> None:
    """The drawn leaf's own frame, in a row with its carrier, has the strength asked for to half a step."""
    for item in solved.couplers:
        matrix = signal_matrix(chain_of(item.size.leaf.kind, item.size.leaf.shape, device.process))
        across = matrix[0, 1] * item.carrier / (item.carrier + matrix[1, 1])
        assert -across / device.sizing.law.stiffness_unit == pytest.approx(item.left, rel=2e-3)
        assert item.left == pytest.approx(item.asked, rel=COUPLER_STEP / 2 + 0.005)
        assert abs(item.given) < 0.97 * abs(item.asked) and abs(item.given) < abs(item.left)
        assert not item.size.leaf.misses
    sized = {item.coupling: item.leaf for item in device.sizing.couplers}
    for item in solved.couplers:
        before, after = sized[item.size.coupling], item.size.leaf
        assert (after.reach, after.shape.pitch, after.shape.wall) == (
            before.reach,
            before.shape.pitch,
            before.shape.wall,
        )
        assert 0.7 * before.shape.amplitude < after.shape.amplitude < before.shape.amplitude


def test_a_coupler_is_not_drawn_stiffer_than_its_strain_allows(device: Device, carriers: dict[str, float]) -> None:
    """Its sheet's limit just above what the rocker is strained as sized: the coupler is mended, the rocker is not."""
    (plate,) = {device.process.material(plate) for plate in device.process.plates(PlateRole.RUNG)}
    straight, turned = sorted(device.sizing.couplers, key=lambda item: item.leaf.strain)
    name = next(key for key, material in device.process.materials.items() if material == plate)
    tight = replace(plate, strain_limit=turned.leaf.strain * 1.0001)
    process = replace(device.process, materials=device.process.materials | {name: tight})
    found = {item.size.coupling: item for item in compensate(device.network, process, device.sizing, carriers).couplers}
    assert found[turned.coupling].size == turned
    assert found[turned.coupling].left == found[turned.coupling].given
    assert abs(found[straight.coupling].left) > abs(found[straight.coupling].given)


def test_rigid_carriers_leave_all_as_it_was_sized(device: Device) -> None:
    found = compensate(device.network, device.process, device.sizing, {})
    assert [item.size for item in found.couplers] == list(device.sizing.couplers)
    assert [unit.preload for unit in found.units] == [unit.preload for unit in device.sizing.units]


def test_preloads_stay_within_the_room_that_is_kept(device: Device, solved: Compensation) -> None:
    for unit, sized in zip(solved.units, device.sizing.units, strict=True):
        assert sized.room[0] <= unit.preload <= sized.room[1]
        assert unit.preload_sized == sized.preload
    assert solved.units[5].preload == solved.units[5].preload_sized  # m5 has no springs


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
    assert [item.leaf for item in new.couplers] == [item.size.leaf for item in solved.couplers]
    with pytest.raises(UsageError, match="no coupler 'm0->m3'"):
        compensated(device.sizing, replace(solved, couplers=solved.couplers[1:]))
    with pytest.raises(UsageError, match="no preload for the unit 'm5'"):
        compensated(device.sizing, replace(solved, units=solved.units[:-1]))
