from dataclasses import replace

import pytest
import shapely
from shapely.affinity import translate

from mdlcad.parts import Body, BodyKind
from mdlcad.parts.arcs import rings, with_arcs
from mdlcad.parts.leaf import occupied
from tests.parts.device import Device, small_device


@pytest.fixture(scope="module")
def device() -> Device:
    return small_device()


@pytest.fixture(scope="module")
def bodies(device: Device) -> tuple[Body, ...]:
    return device.bodies()


def overlaps(bodies: tuple[Body, ...] | list[Body]) -> list[tuple[str, str, float]]:
    """Pairs of bodies that share room in the assembled device, with the area, mm2."""
    found = []
    for i, one in enumerate(bodies):
        for other in bodies[i + 1 :]:
            if min(one.z + one.thickness, other.z + other.thickness) - max(one.z, other.z) < 1e-6:
                continue
            area = occupied(one).intersection(occupied(other)).area
            if area > 1e-3:
                found.append((one.name, other.name, area))
    return found


def region(body: Body) -> shapely.Geometry:
    """What a body covers over its motion, by many small steps."""
    if body.envelope is not None:
        return body.envelope
    steps = [i / 20 - 1 for i in range(41)]
    shape = occupied(body)
    for x, y in ((body.throw[0], 0.0), (0.0, body.throw[1])):
        if x or y:
            shape = shapely.union_all([translate(shape, x * s, y * s) for s in steps])
    return shape


def near_misses(bodies: tuple[Body, ...] | list[Body], gap: float) -> list[tuple[str, str, float]]:
    """Pairs that share no body of reference and come closer than ``gap`` over their motions."""
    regions = [region(body) for body in bodies]
    found = []
    for i, one in enumerate(bodies):
        for j in range(i + 1, len(bodies)):
            other = bodies[j]
            if min(one.z + one.thickness, other.z + other.thickness) - max(one.z, other.z) < 1e-6:
                continue
            rigid = len(one.moves_with) == 1 or len(other.moves_with) == 1
            common = set(one.moves_with) & set(other.moves_with)
            if (rigid and common) or any(ref.startswith("mass:") for ref in common):
                continue
            distance = regions[i].distance(regions[j])
            if distance < gap - 1e-3:
                found.append((one.name, other.name, distance))
    return found


def test_nothing_overlaps_as_assembled(bodies: tuple[Body, ...]) -> None:
    assert overlaps(bodies) == []


def test_nothing_that_moves_independently_comes_too_near(device: Device, bodies: tuple[Body, ...]) -> None:
    assert near_misses(bodies, device.sizing.rules.gap) == []


def test_the_two_checks_above_see_a_moved_unit(device: Device, bodies: tuple[Body, ...]) -> None:
    def moved(body: Body, by: float) -> Body:
        shapes = {key: translate(getattr(body, key), 0.0, by) for key in ("section", "assembled", "envelope")}
        return replace(body, **shapes)

    near = [moved(b, 0.1) if b.name == "unit.m0" else b for b in bodies]
    assert ("unit.m0", "unit.m1") in [pair[:2] for pair in near_misses(near, device.sizing.rules.gap)]
    assert overlaps([moved(b, 3.0) if b.name == "unit.m0" else b for b in bodies])


def rubbed(bodies: tuple[Body, ...]) -> list[tuple[str, str]]:
    """Shims, and what moves over or under them without any gap."""
    shims = [body for body in bodies if body.plate == "shims"]
    moving = [body for body in bodies if any(body.throw)]
    return [
        (shim.name, body.name)
        for shim in shims
        for body in moving
        if shim.z <= body.z + body.thickness + 1e-6
        and body.z <= shim.z + shim.thickness + 1e-6
        and shapely.intersection(shim.section, region(body)).area > 1e-6
    ]


def test_nothing_that_moves_rubs_on_shims(bodies: tuple[Body, ...]) -> None:
    assert rubbed(bodies) == []


def test_a_shim_that_goes_on_over_a_tab_is_seen(bodies: tuple[Body, ...]) -> None:
    tab = next(body for body in bodies if body.kind is BodyKind.TAB)
    shim = next(body for body in bodies if body.plate == "shims" and abs(body.z - tab.z - tab.thickness) < 1e-6)
    uncut = replace(shim, section=shapely.convex_hull(shim.section))
    assert (shim.name, tab.name) in rubbed((uncut, tab))


def test_every_polygon_is_valid_and_has_no_slivers(bodies: tuple[Body, ...]) -> None:
    for body in bodies:
        for shape in (body.section, body.assembled, body.envelope):
            if shape is None:
                continue
            assert shape.geom_type == "Polygon" and shape.is_valid, body.name
            assert all(shapely.Polygon(hole).area > 0.01 for hole in shape.interiors), body.name
        coordinates = shapely.get_coordinates(body.section)
        assert abs(coordinates - coordinates.round(4)).max() < 1e-9, body.name
        edges = sum(len(with_arcs(ring)) for ring in rings(body.section))
        assert edges < 160 or body.kind in (BodyKind.CLOCK, BodyKind.FRAME), body.name


def test_names_are_unique_and_every_mass_has_its_parts(device: Device, bodies: tuple[Body, ...]) -> None:
    names = [body.name for body in bodies]
    assert len(set(names)) == len(names)
    for mass in device.network.masses:
        assert {f"unit.{mass.name}", f"pin.clock.{mass.name}"} <= set(names)
    assert {"coupler.m0->m3", "rocker.m1->m4", "bias.m2", "tab.out[0]", "post.bias.m2", "post.m1->m4"} <= set(names)
    assert {"base", "cover", "clock-0", "clock-1", "clock-2", "frame.unit", "frame.V", "frame.H0"} <= set(names)


def test_the_unit_plate_is_one_sheet(bodies: tuple[Body, ...]) -> None:
    whole = shapely.union_all([body.section for body in bodies if body.plate == "unit"], grid_size=1e-4)
    assert whole.geom_type == "Polygon"


def test_flexures_touch_what_they_join(device: Device, bodies: tuple[Body, ...]) -> None:
    by_name = {body.name: body for body in bodies}
    walls = {coupler.coupling: coupler.leaf.shape.wall for coupler in device.sizing.couplers}
    for flexure, rung in (("coupler.m0->m3", "rung.m0.1"), ("rocker.m1->m4", "rung.m1.1")):
        shared = by_name[flexure].section.intersection(by_name[rung].section)
        # the stub's wall, and a fillet on either side of it
        fillets = 2.0 * device.process.machine.fillet
        assert shared.length == pytest.approx(walls[flexure.partition(".")[2]] + fillets, abs=1e-3)
        assert by_name[flexure].z == by_name[rung].z


def test_pins_fill_their_holes(bodies: tuple[Body, ...]) -> None:
    by_name = {body.name: body for body in bodies}
    for pin, part in (
        ("pin.hub.m0.right", "unit.m0"),
        ("pin.hub.m3.left", "coupler.m0->m3"),
        ("pin.clock.m4", "unit.m4"),
        ("pin.clock.m4", "clock-1"),
        ("pin.via.m0.t.0", "trunk.m0.t"),
    ):
        edge = by_name[pin].section.exterior
        assert edge.intersection(occupied(by_name[part])).length == pytest.approx(edge.length, abs=1e-3), (pin, part)


def test_the_bias_post_stands_where_sizing_put_it(device: Device, bodies: tuple[Body, ...]) -> None:
    post = next(body for body in bodies if body.name == "post.bias.m2")
    leaf = next(body for body in bodies if body.name == "bias.m2")
    row = next(place.y for place in device.placement.masses if place.mass == "m2")
    offset = device.sizing.biases[0].offset
    assert offset < 0 < device.network.masses[2].bias  # q pulls towards -x
    assert post.section.centroid.y - row == pytest.approx(offset, abs=1e-3)
    assert leaf.assembled is not None
    # the eye is around the post in the assembled state, and not as cut
    assert leaf.assembled.distance(post.section) == pytest.approx(device.process.link.post_fit, abs=0.02)
    assert leaf.section.intersection(post.section).area > 0.1


def test_a_layout_that_moves_the_bias_post_is_refused(device: Device) -> None:
    wrong = replace(device.layout, biases=(replace(device.layout.biases[0], post_y=1.0),))
    with pytest.raises(ValueError, match="its post is at"):
        replace(device, layout=wrong).bodies()


def test_clock_holes_are_displaced_by_the_preload(device: Device, bodies: tuple[Body, ...]) -> None:
    for unit in device.sizing.units:
        body = next(item for item in bodies if item.name == f"unit.{unit.mass}")
        pin = next(item for item in bodies if item.name == f"pin.clock.{unit.mass}")
        assert body.assembled is not None
        shift = body.section.bounds[2] - body.assembled.bounds[2]
        assert shift == pytest.approx(unit.preload, abs=2e-4)
        assert body.assembled.intersection(pin.section).area == pytest.approx(0.0, abs=1e-6)
        assert body.section.intersection(pin.section).area > 0.1  # as cut, the hole is elsewhere


def test_same_input_same_bodies(device: Device, bodies: tuple[Body, ...]) -> None:
    again = device.bodies()
    assert [(b.name, b.section.wkb, b.z) for b in again] == [(b.name, b.section.wkb, b.z) for b in bodies]
