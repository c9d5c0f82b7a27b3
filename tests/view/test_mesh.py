"""Merged meshes are the bodies, and move as the mechanics says."""

import numpy as np
import pytest
import trimesh

from mdlcad.view.mesh import Merged, Model, make_model
from mdlcad.view.motion import displacements, references_of
from tests.view.small import small_built


@pytest.fixture(scope="module")
def model() -> Model:
    return make_model(small_built())


def group_of(model: Model, name: str) -> tuple[Merged, np.ndarray]:
    """The group a body is in, and the numbers of the body's points in it."""
    number = next(i for i, body in enumerate(model.built.bodies) if body.name == name)
    group = next(group for group in model.groups if number in group.members)
    return group, np.unique(group.faces[group.body == number])


def moved(model: Model, name: str, **shifts: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Points of a body, and how far they go when references ("mass_m0", "clock_1") are displaced."""
    names = references_of(model.built.network).names
    where = np.zeros((len(names), 2))
    for ref, shift in shifts.items():
        where[names.index(ref.replace("_", ":"))] = shift
    group, chosen = group_of(model, name)
    return group.points[chosen], (group.placed(0.0, where) - group.points)[chosen, :2]


def test_every_group_is_closed_and_has_the_volume_of_its_bodies(model: Model) -> None:
    bodies = model.built.bodies
    for group in model.groups:
        mesh = trimesh.Trimesh(group.points, group.faces, process=False)
        wanted = sum(
            body.thickness * (body.assembled or body.section).area for body in (bodies[i] for i in group.members)
        )
        assert mesh.is_watertight
        assert mesh.volume == pytest.approx(wanted, rel=1e-9)


def test_all_bodies_are_in_few_groups(model: Model) -> None:
    assert sorted(number for group in model.groups for number in group.members) == list(range(len(model.built.bodies)))
    assert len({(group.plate, group.kind) for group in model.groups}) == len(model.groups)


def test_plates_come_apart_in_their_order_and_pins_are_drawn_out_between_them(model: Model) -> None:
    assert model.plates[:5] == ("base", "clock-2", "clock-1", "clock-0", "unit")
    assert model.plates[-2:] == ("shims", "pins")
    group, chosen = group_of(model, "unit.m0")
    lifted = group.placed(10.0, None)[chosen, 2] - group.points[chosen, 2]
    assert np.all(lifted == 10.0 * model.plates.index("unit"))
    group, chosen = group_of(model, "pin.clock.m0")  # from the clock plate 0 to the unit plate above it
    lifted = group.placed(10.0, None)[chosen, 2] - group.points[chosen, 2]
    assert set(lifted) == {10.0 * model.plates.index("clock-0"), 10.0 * model.plates.index("unit")}


def test_displacements_are_the_mechanics_lengths(model: Model) -> None:
    built = model.built
    x = np.array([1.0, -1.0, 0.0, 0.5, 0.0, 0.0])
    found = displacements(built, x, np.array([2.0, 1.0, 0.0]))
    assert np.all(found[0] == 0.0)
    # k falls by 3 as the wave of phase 0 rises from 1 to 2, so the plate pushes towards the shuttles, to lower x
    assert found[1, 0] == pytest.approx(-3.0 * built.sizing.law.stroke_per_k)
    assert found[2, 0] == 0.0
    assert found[3, 0] == pytest.approx(3.0 * built.sizing.law.stroke_per_k)
    assert abs(found[1, 0]) <= built.sizing.rules.clock_throw
    assert np.all(found[4:, 1] == built.process.unit.throw_unit * x)
    assert np.all(found[4:, 0] == 0.0)


def test_a_unit_s_shuttle_sways_its_frame_end_stands_and_its_clock_block_goes_with_the_clock(model: Model) -> None:
    built = model.built
    hub = next(place for place in built.placement.masses if place.mass == "m0")
    span = built.process.unit.span
    points, by = moved(model, "unit.m0", mass_m0=(0.0, 2.0))
    x = points[:, 0] - hub.x
    shuttle = np.abs(x) <= built.sizing.rules.hub_half
    assert shuttle.sum() > 4 and np.allclose(by[shuttle], (0.0, 2.0))
    ends = np.abs(np.abs(x) - built.sizing.rules.hub_half - span) < 1e-3
    assert ends.any() and np.allclose(by[ends], 0.0)
    middle = np.abs(np.abs(x) - built.sizing.rules.hub_half - span / 2) < 0.9
    assert np.all((by[middle, 1] > 0.5) & (by[middle, 1] < 1.5))
    points, by = moved(model, "unit.m0", clock_0=(0.5, 0.0))
    x = points[:, 0] - hub.x
    block = x > x.max() - built.process.pin.wall
    assert block.any() and np.allclose(by[block], (0.5, 0.0))
    assert np.allclose(by[x < built.sizing.rules.hub_half + span - 0.1], 0.0)
    # the series spring takes up what is between: it goes monotonically from end block to clock block on the axis
    assert np.all(by[:, 0] >= -1e-12) and np.all(by[:, 0] <= 0.5 + 1e-12)


@pytest.mark.parametrize(("name", "source", "target"), [("m0->m3", "m0", "m3"), ("m1->m4", "m1", "m4")])
def test_a_coupling_s_flexure_joins_its_target_s_hub_to_its_source_s_carrier(
    model: Model, name: str, source: str, target: str
) -> None:
    built = model.built
    kind = "coupler" if name == "m0->m3" else "rocker"
    hub = next(place for place in built.placement.masses if place.mass == target)
    for ref, near, far in ((target, 1.0, 0.0), (source, 0.0, 1.0)):
        points, by = moved(model, f"{kind}.{name}", **{f"mass_{ref}": (0.0, 1.0)})
        start = np.abs(points[:, 0] - hub.x) - built.sizing.rules.hub_half
        assert np.allclose(by[start <= 0.0, 1], near)
        assert np.allclose(by[start >= start.max() - 1e-6, 1], far, atol=0.02)
        assert np.all(by[:, 0] == 0.0)


def test_a_rocker_turns_about_its_post(model: Model) -> None:
    leaf = next(item for item in model.built.sizing.couplers if item.coupling == "m1->m4").leaf
    hub = next(place for place in model.built.placement.masses if place.mass == "m4")
    points, by = moved(model, "rocker.m1->m4", mass_m1=(0.0, 1.0), mass_m4=(0.0, -1.0))
    along = np.abs(points[:, 0] - hub.x) - model.built.sizing.rules.hub_half - leaf.reach / 2
    assert np.allclose(by[:, 1], np.clip(along / (leaf.reach / 2), -1.0, 1.0), atol=1e-9)


def test_a_bias_leaf_s_eye_stands_still(model: Model) -> None:
    points, by = moved(model, "bias.m2", mass_m2=(0.0, 1.0))
    hub = next(place for place in model.built.placement.masses if place.mass == "m2")
    far = np.abs(points[:, 0] - hub.x)
    assert np.allclose(by[far <= model.built.sizing.rules.hub_half, 1], 1.0)
    assert np.allclose(by[far >= far.max() - 1.0, 1], 0.0, atol=0.02)


def test_what_is_rigid_goes_as_one(model: Model) -> None:
    for name in ("rung.m0.0", "trunk.m0.t", "pin.hub.m0.right"):
        _, by = moved(model, name, mass_m0=(0.0, 1.5))
        assert np.allclose(by, (0.0, 1.5))
    _, by = moved(model, "clock-1", clock_1=(-0.4, 0.0))
    assert np.allclose(by, (-0.4, 0.0))
    _, by = moved(model, "base", mass_m0=(0.0, 1.5), clock_1=(-0.4, 0.0))
    assert np.all(by == 0.0)
