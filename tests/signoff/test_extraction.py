"""Numbers read off written STEP files, held against what was sized, and against dimensions changed in the files."""

from dataclasses import replace

import numpy as np
import pytest
from shapely import Polygon, box
from shapely.affinity import translate

from mdlcad.errors import SignoffError
from mdlcad.export.step import step_assembly
from mdlcad.mechanics.compensation import compensate
from mdlcad.mechanics.fit import Scale
from mdlcad.mechanics.flexure import signal_matrix
from mdlcad.mechanics.leaves import LargeLeaf, LeafKind, chain_of, rung_sheet
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.stiffness import carrier_stiffnesses, lifts_of
from mdlcad.signoff.drawn import Drawn, measure_device
from mdlcad.signoff.extraction import Built
from mdlcad.signoff.lvs import compare, recover
from mdlcad.signoff.measure import measure_unit, spans_at_x
from mdlcad.signoff.measure_leaf import chain_of_leaf, measure_leaf
from mdlcad.signoff.numbers import bias_numbers
from mdlcad.signoff.readback import ReadBody, read_step
from mdlcad.signoff.stops import stops_of
from mdlcad.signoff.tilting import rubbing
from tests.parts.device import Device


def built_of(device: Device, found: tuple[ReadBody, ...], cut: dict[str, Polygon]) -> Built:
    recovered = recover(found)
    assert compare(recovered, device.network).matched
    drawn = measure_device(found, cut, recovered, device.process)
    carriers = carrier_stiffnesses(device.network, device.placement, device.layout, device.sizing, device.process)
    return Built(drawn, device.network, device.sizing, carriers, device.process)


@pytest.fixture(scope="module")
def built(device: Device, files) -> Built:
    return built_of(device, *files)


def drawn_of(built: Built) -> Drawn:
    return built.record().drawn


def rewritten(body: Body, section: Polygon, folder) -> ReadBody:
    """The body with another outline, through a STEP file."""
    path = folder / "one.step"
    path.write_bytes(step_assembly("one", [replace(body, section=section, assembled=None)]))
    return read_step(path)[0]


def test_every_dimension_is_found(device: Device, built: Built) -> None:
    fillet = device.process.machine.fillet
    unit, series, preloads = device.process.unit, device.sizing.series, {u.mass: u.preload for u in device.sizing.units}
    for mass, seen in drawn_of(built).units.items():
        for beam in (*seen.left, *seen.right):
            assert (beam.wall, beam.span) == pytest.approx((unit.beam_wall, unit.span), abs=2e-4)
            # the beams run flush with the outer edges of shuttle and end block, and meet the rib in their middle
            rib = beam in seen.left
            assert [root.sides for root in beam.roots] == [2 if rib else 1, 1]
            assert [root.radius for root in beam.roots] == pytest.approx([fillet] * 2, abs=5e-4)
        assert seen.plan.fillet == pytest.approx(fillet, abs=2e-3)
        assert seen.preload == pytest.approx(preloads[mass], abs=1e-3)
        for _, *walls in (*seen.plan.near, *seen.plan.far):
            assert walls == pytest.approx([series.wall] * 2, abs=1e-3)
        assert seen.plan.height == pytest.approx(series.height, abs=2e-4)
    leaves = {item.name: item.leaf for item in drawn_of(built).couplers}
    for item in (*drawn_of(built).couplers, *drawn_of(built).biases):
        for half in item.leaf.halves:
            assert half.bends == pytest.approx([fillet] * (len(half.nodes) - 2), abs=5e-4)
            assert [root.radius for root in half.ends] == pytest.approx([fillet] * 2, abs=2e-3)
            assert [root.sides for root in half.ends] == [2, 2]
    for size in device.sizing.couplers:
        for half in leaves[size.coupling].halves:
            assert half.walls == pytest.approx([size.leaf.shape.wall] * len(half.walls), abs=2e-4)
            np.testing.assert_allclose(half.nodes, size.leaf.shape.path(), atol=2e-4)
    (bias,), size = drawn_of(built).biases, device.sizing.biases[0]
    np.testing.assert_allclose(bias.leaf.halves[0].nodes, size.leaf.shape.path(), atol=2e-4)
    assert bias.offset == pytest.approx(size.offset, abs=2e-4)


def test_the_numbers_are_the_networks(device: Device, built: Built) -> None:
    """A coupler is softer by its carrier; k follows the potential to within the law's second order."""
    carriers = carrier_stiffnesses(device.network, device.placement, device.layout, device.sizing, device.process)
    ratio = {item.coupling: item.ratio for item in carriers}
    wanted = {item.name: item.strength for item in device.network.couplings}
    for item in built.network.couplings:
        softer = ratio[item.name] / (1.0 + ratio[item.name])
        assert item.strength == pytest.approx(wanted[item.name] * softer, rel=5e-3)
    for mass, nominal in zip(built.network.masses, device.network.masses, strict=True):
        # solved with rigid carriers: what they give is what is left
        assert mass.k0 + mass.k1 == pytest.approx(nominal.k0 + nominal.k1, abs=0.04)
        assert mass.k1 == pytest.approx(nominal.k1, rel=0.05)
    m2 = built.network.masses[2]
    assert m2.bias == pytest.approx(0.5, rel=0.02)


def test_preloads_that_know_the_carriers_leave_nothing_in_the_middle(device: Device, built: Built) -> None:
    """The device as drawn, its clock pins where the solved preloads put them: k read off it is the k asked for."""
    carriers = carrier_stiffnesses(device.network, device.placement, device.layout, device.sizing, device.process)
    stiffness = {item.coupling: item.stiffness for item in carriers}
    found = compensate(device.network, device.process, device.sizing, stiffness)
    solved = {item.mass: item for item in found.units}
    drawn = drawn_of(built)
    units = {mass: replace(seen, preload=solved[mass].preload) for mass, seen in drawn.units.items()}
    shapes = {item.size.coupling: tuple(item.size.leaf.shape.path()) for item in found.couplers}
    couplers = tuple(
        replace(
            item, leaf=replace(item.leaf, halves=tuple(replace(h, nodes=shapes[item.name]) for h in item.leaf.halves))
        )
        for item in drawn.couplers
    )
    moved = Built(
        replace(drawn, units=units, couplers=couplers), device.network, device.sizing, carriers, device.process
    )
    for mass, nominal in zip(moved.network.masses, device.network.masses, strict=True):
        assert mass.k0 + mass.k1 == pytest.approx(nominal.k0 + nominal.k1, abs=0.01)
        left = solved[mass.name].left
        assert (mass.k0 - nominal.k0, mass.k0 + 2 * mass.k1 - nominal.k0 - 2 * nominal.k1) == pytest.approx(
            (left[0], left[2]), abs=0.01
        )


def test_shuttles_that_tilt_have_heights_and_stops_as_drawn(device: Device, built: Built, files) -> None:
    drawn, process = drawn_of(built), device.process
    recovered = recover(files[0])
    stops = stops_of(files[0], recovered, drawn.units, process, device.sizing.rules)
    carriers = carrier_stiffnesses(device.network, device.placement, device.layout, device.sizing, process)
    loose = Built(drawn, device.network, device.sizing, carriers, process, stops=stops)
    assert built.system.devices is not None and loose.system.devices is not None
    assert built.system.devices.tilts is None
    tilts = loose.system.devices.tilts
    assert tilts is not None
    # what layout says of heights, the files' bodies say too
    lifts = lifts_of(device.placement, device.layout, process)
    for item in drawn.couplers:
        assert item.lifts == pytest.approx(lifts.couplings[item.name])
    assert {item.mass: item.lift for item in drawn.biases} == pytest.approx(dict(lifts.biases))
    names, x0 = loose.system.names, process.unit.throw_unit
    assert np.abs(tilts.own).max() == pytest.approx(max(max(map(abs, pair)) for pair in lifts.couplings.values()) / x0)
    assert list(tilts.high[:, 0]) == [stops[name].high for name in names]
    # the larger the gaps, the farther a shuttle can tilt
    wide = replace(process, stack=replace(process.stack, z_gap=2.0 * process.stack.z_gap))
    assert rubbing(wide, device.sizing.law) == pytest.approx(rubbing(process, device.sizing.law) / 2.0)


def test_both_sides_of_a_hub_are_carried_by_its_shuttle(device: Device, files) -> None:
    carried = recover(files[0]).carriers
    for body in device.bodies():
        if body.kind in (BodyKind.RUNG, BodyKind.TRUNK, BodyKind.TAB) and body.moves_with[0].startswith("mass:"):
            assert body.name in carried[body.moves_with[0].removeprefix("mass:")]


def test_the_quartic_is_kept(device: Device, built: Built) -> None:
    record = built.record()
    assert all(item.quartic == pytest.approx(1.0, abs=0.15) for item in record.masses)
    numbers = {item.coupling: item.numbers for item in record.couplers}
    scale = device.process.unit.throw_unit**2 / device.sizing.law.stiffness_unit
    coupler = next(item for item in device.sizing.couplers if item.leaf.kind is LeafKind.COUPLER)
    assert numbers["m0->m3"].apart == pytest.approx(coupler.leaf.quartic * scale, rel=0.4)
    assert numbers["m0->m3"].together == 0.0
    assert numbers["m1->m4"].together != 0.0


def test_friction_of_what_has_no_eye_is_that_of_its_weight(device: Device, built: Built) -> None:
    lying, *rest = built.friction["m5"]
    assert 0.0 < lying < 0.02
    assert rest == [0.0, 0.0]
    weight = lying * device.sizing.law.force_unit / device.process.stack.friction
    unit = next(body for body in device.bodies() if body.name == "unit.m5")
    light = unit.section.area * unit.thickness * 1.41e-6 * 9.81
    assert light < weight < 4.0 * light  # its pins are of steel


def test_friction_of_a_bias_leaf_is_what_its_eye_takes_on_the_way(device: Device, built: Built) -> None:
    """Work of friction over a stroke: the coefficient times force times way of the point of contact, in fine steps."""
    (bias,), process = drawn_of(built).biases, device.process
    chain = chain_of_leaf(bias.leaf, bias.sheet)
    large, throw, radius = LargeLeaf(chain), device.sizing.rules.throw, process.link.post_radius
    work, last = 0.0, None
    for y in np.linspace(-throw, throw, 200):
        pose = large.at(float(y) - bias.offset, 0.0)
        x, _, turn = pose.displacements[3 * chain.right : 3 * chain.right + 3]
        pull = large.hold(pose)
        here = np.array([x, turn])
        if last is not None:
            along, turned = here - last
            work += process.stack.friction * abs(pull) * abs(along + np.sign(pull) * radius * turned)
        last = here
    x = np.linspace(-throw, throw, 200) / process.unit.throw_unit
    lying = built.friction["m5"][0]  # a unit like it, without a bias
    bound = np.polynomial.polynomial.polyval(x, built.friction["m2"]) - lying
    taken = np.trapezoid(bound, x) * device.sizing.law.force_unit * process.unit.throw_unit
    assert work < taken < 1.4 * work
    relaxed = np.interp(bias.offset / process.unit.throw_unit, x, bound)
    assert 0.0 <= relaxed < 0.3 * bound.max()  # where it does not pull, it does not rub


def test_friction_of_a_rocker_is_its_posts(device: Device, built: Built) -> None:
    """Force on the post and turn of the eye, at large displacements."""
    record, process = built.record(), device.process
    (rocker,) = [item for item in record.couplers if item.rub > 0.0]
    assert rocker.coupling == "m1->m4"
    drawn = next(item for item in drawn_of(built).couplers if item.name == rocker.coupling)
    chain, throw = chain_of_leaf(drawn.leaf, drawn.sheet), 0.5 * device.sizing.rules.throw
    assert chain.eye is not None
    pressed = abs(LargeLeaf(chain).at(throw, throw).reactions[3 * chain.eye + 1])
    turned = abs(LargeLeaf(chain).at(throw, -throw).displacements[3 * chain.eye + 2])
    # ends that meet at x = throw with a speed of 1 each: the eye turns by turned / throw a mm that both move
    power = process.stack.friction * pressed * process.link.post_radius * turned / throw
    x = throw / process.unit.throw_unit
    assert rocker.rub * 2 * x * 2 * device.sizing.law.force_unit == pytest.approx(power, rel=0.1)


def test_beams_thinned_in_the_file_are_felt(device: Device, bodies, built: Built, files, tmp_path) -> None:
    """K_b goes with t^3: k falls by kappa0 (1 - (1 - d/t)^3)."""
    body, thinner = bodies["unit.m5"], 0.02
    section = body.assembled or body.section
    left = section.bounds[0] + 1.0
    away = [box(section.bounds[0] - 1, top - thinner, left + 11.4, top + 0.2) for _, top in spans_at_x(section, left)]
    seen = measure_unit("unit.m5", section)
    right = seen.x + seen.half_hub
    tops = [top for _, top in spans_at_x(section, left)]
    away += [box(right + 0.05, top - thinner, right + 12.45, top + 0.2) for top in tops]
    for hole in away:
        section = section.difference(hole)
    found, cut = files
    read = rewritten(body, section, tmp_path)
    changed = built_of(device, tuple(read if item.name == "unit.m5" else item for item in found), cut)
    fallen = built.network.masses[5].k0 - changed.network.masses[5].k0
    assert fallen == pytest.approx(1.5 * (1.0 - (1.0 - thinner / 0.5) ** 3), rel=0.25)
    assert changed.network.masses[4] == built.network.masses[4]


def test_a_coupler_thinned_in_the_file_is_felt(device: Device, bodies, built: Built, files, tmp_path) -> None:
    """c goes with t^3."""
    body, found = bodies["coupler.m0->m3"], files[0]
    wall = device.sizing.couplers[0].leaf.shape.wall
    hub = next(place for place in device.placement.masses if place.mass == "m3")
    face = hub.x - device.sizing.rules.hub_half
    block = body.section.intersection(box(face, -1000, face + 100, 1000))
    far = body.section.bounds[0]
    flexure = body.section.buffer(-0.05, join_style="mitre")
    stubs = [box(x, hub.y - wall / 2 + 0.05, x + 0.1, hub.y + wall / 2 - 0.05) for x in (face - 0.09, far - 0.01)]
    section = flexure.difference(block).union(block).union(stubs[0]).union(stubs[1]).intersection(body.section)
    read = rewritten(body, section, tmp_path)
    changed = built_of(device, tuple(read if item.name == body.name else item for item in found), files[1])
    strength = changed.network.couplings[0].strength / built.network.couplings[0].strength
    assert strength == pytest.approx(((wall - 0.1) / wall) ** 3, rel=0.06)


def test_a_post_moved_is_felt(device: Device, built: Built, files) -> None:
    found = list(files[0])
    at = next(i for i, item in enumerate(found) if item.name == "post.bias.m2")
    found[at] = replace(found[at], section=translate(found[at].section, 0.0, 0.1))
    changed = built_of(device, tuple(found), files[1])
    bias = device.sizing.biases[0]
    moved = built.network.masses[2].bias - changed.network.masses[2].bias
    assert moved == pytest.approx(bias.self_stiffness * 0.1 / device.process.unit.throw_unit, rel=0.1)


def test_a_bias_leafs_terms_are_the_force_of_its_beams(device: Device, built: Built) -> None:
    """From the sized shape, not the drawn one."""
    bias, size, law = drawn_of(built).biases[0], device.sizing.biases[0], device.sizing.law
    scale = Scale(law.stiffness_unit, device.process.unit.throw_unit)
    found = bias_numbers(chain_of_leaf(bias.leaf, bias.sheet), bias.offset, device.sizing.rules.throw, scale, 1.5)
    leaf = LargeLeaf(chain_of(LeafKind.BIAS, size.leaf.shape, device.process))
    for x in (-1.7, -0.6, 0.0, 1.1, 1.8):
        force = leaf.force(device.process.unit.throw_unit * x - size.offset, 0.0) / law.force_unit
        assert found.bias + found.stiffness * x + found.cubic * x**2 + found.quartic * x**3 == pytest.approx(
            force, abs=0.01
        )


def test_what_is_no_flexure_is_refused(bodies: dict[str, Body]) -> None:
    with pytest.raises(SignoffError, match=r"unit\.x"):
        measure_unit("unit.x", box(0, 0, 10, 10))
    with pytest.raises(SignoffError, match="coupler"):
        measure_leaf("coupler.x", box(0, 0, 10, 4), 0.0, None)


def test_a_fillet_left_out_is_found(device: Device, tmp_path) -> None:
    """Without the fillet at its block a coupler is a little softer; without any, as soft as sharp corners make it."""
    body = next(body for body in device.bodies() if body.name == "coupler.m0->m3")
    (hub,) = [place for place in device.placement.masses if place.mass == "m3"]
    face, row = hub.x - device.sizing.rules.hub_half, hub.y
    size = device.sizing.couplers[0].leaf
    wall, fillet = size.shape.wall, size.shape.fillet
    above, below = (box(face - 0.3, row + y, face, row + y + 0.3) for y in (wall / 2.0, -wall / 2.0 - 0.3))

    def stiffness(section: Polygon) -> tuple[float, tuple[float, float]]:
        found = rewritten(body, section, tmp_path)
        leaf = measure_leaf(body.name, found.section, hub.x, None)
        sheet = rung_sheet(device.process)
        return float(signal_matrix(chain_of_leaf(leaf, sheet))[0, 0]), tuple(
            root.radius for root in leaf.halves[0].ends
        )

    whole, radii = stiffness(body.section)
    assert radii == pytest.approx((fillet, fillet), abs=5e-4)
    assert whole == pytest.approx(size.own, rel=5e-4)
    less, radii = stiffness(body.section.difference(above).difference(below))
    assert radii == pytest.approx((0.0, fillet), abs=5e-4)
    sharp = float(signal_matrix(chain_of(LeafKind.COUPLER, replace(size.shape, fillet=0.0), device.process))[0, 0])
    assert sharp < less < 0.999 * whole
