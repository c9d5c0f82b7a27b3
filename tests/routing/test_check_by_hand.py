"""The layout checker against a device that no router made: nothing is wrong with it, and what is spoilt is found.

Every case is spoilt in one way only, so that the rule named is the one that has to see it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import pytest

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network, PortBit
from mdlcad.placement.placement import PlacedPort, Placement
from mdlcad.routing.check import RULES, Finding, check_layout
from mdlcad.routing.layout import EndKind, Layout, Rung, RungEnd, Side, Trunk
from tests.parts.device import small_device

AROUND = 0.2
"""The hand-laid boundary leaves its units 0.5 mm to the rim, which is less than the gap; it is let out by this, mm."""


@dataclass(frozen=True)
class Case:
    """A layout with all that it is checked against."""

    network: Network
    placement: Placement
    layout: Layout
    rules: LayoutRules

    def findings(self) -> tuple[Finding, ...]:
        return check_layout(self.network, self.placement, self.layout, self.rules)

    def rung(self, name: str) -> Rung:
        return next(rung for rung in self.layout.rungs if rung.name == name)

    def trunk(self, name: str) -> Trunk:
        return next(trunk for trunk in self.layout.trunks if trunk.name == name)

    def laid(self, **changes: object) -> Case:
        return replace(self, layout=replace(self.layout, **changes))

    def with_rung(self, name: str, **changes: object) -> Case:
        return self.laid(rungs=tuple(replace(r, **changes) if r.name == name else r for r in self.layout.rungs))

    def with_trunk(self, name: str, **changes: object) -> Case:
        return self.laid(trunks=tuple(replace(t, **changes) if t.name == name else t for t in self.layout.trunks))

    def with_coupler(self, name: str, **changes: object) -> Case:
        leaves = self.layout.couplers
        return self.laid(couplers=tuple(replace(c, **changes) if c.coupling == name else c for c in leaves))

    def with_unit(self, mass: str, **changes: object) -> Case:
        masses = tuple(replace(u, **changes) if u.mass == mass else u for u in self.placement.masses)
        return replace(self, placement=replace(self.placement, masses=masses))

    def with_bias(self, **changes: object) -> Case:
        return self.laid(biases=(replace(self.layout.biases[0], **changes),))

    def with_tab(self, **changes: object) -> Case:
        return self.laid(tabs=(replace(self.layout.tabs[0], **changes),))

    def on_track(self, net: str, x: float) -> Case:
        """Both rungs of a net follow its trunk to a new track, so that nothing but the track is wrong."""
        via = RungEnd(EndKind.VIA, x, f"{net}.t")
        return self.with_rung(f"{net}.0", right=via).with_rung(f"{net}.1", left=via).with_trunk(f"{net}.t", x=x)


@cache
def good() -> Case:
    """The hand-laid device with room for its rim, and with the place on the boundary that its tab leads to."""
    device = small_device()
    _, top = device.placement.boundary[1]
    right, _ = device.placement.boundary[2]
    low, high, far = -AROUND, top + AROUND, right + AROUND
    hub = next(unit for unit in device.placement.masses if unit.mass == "m5")
    placement = replace(
        device.placement,
        boundary=((low, low), (low, high), (far, high), (far, low)),
        ports=(PlacedPort("out[0]", "m5", "right", far, hub.y, (1.0, 0.0)),),
    )
    network = replace(device.network, actuators=(PortBit("out[0]", "m5"),))
    return Case(network, placement, device.layout, device.sizing.rules)


def rung_moved_in_y(case: Case) -> Case:
    return case.with_rung("m1.1", y=case.rung("m1.1").y + 1.0)


def rung_off_its_hub(case: Case) -> Case:
    return case.with_rung("m0.0", y=case.rung("m0.0").y + 1.0)


def rung_in_another_row(case: Case) -> Case:
    return case.with_rung("m1.1", y=case.placement.row_y[0])


def rung_without_length(case: Case) -> Case:
    rung = case.rung("m0.0")
    return case.with_rung("m0.0", left=rung.right, right=rung.left)


def carrier_cut_in_two(case: Case) -> Case:
    trunk = case.trunk("m0.t")
    return case.with_trunk("m0.t", y_high=(trunk.y_low + trunk.y_high) / 2)


def trunk_named_twice(case: Case) -> Case:
    return case.laid(trunks=(*case.layout.trunks, case.trunk("m0.t")))


def trunk_of_a_stranger(case: Case) -> Case:
    return case.with_trunk("m0.t", net="nobody")


def coupler_left_out(case: Case) -> Case:
    return case.laid(couplers=case.layout.couplers[1:])


def coupler_twice(case: Case) -> Case:
    return case.laid(couplers=(*case.layout.couplers, replace(case.layout.couplers[0], plate="H1")))


def coupler_of_nothing(case: Case) -> Case:
    stranger = replace(case.layout.couplers[0], coupling="m0->m5", plate="H2")
    return case.laid(couplers=(*case.layout.couplers, stranger))


def target_swapped(case: Case) -> Case:
    """The network wants m0 to drive m3 and m1 to drive m4; the carriers keep their ends but change flexures."""
    other = {"m0->m3": "m1->m4", "m1->m4": "m0->m3"}
    rungs = tuple(
        replace(r, right=replace(r.right, ref=other.get(r.right.ref, r.right.ref))) for r in case.layout.rungs
    )
    leaves = tuple(replace(leaf, coupling=other[leaf.coupling]) for leaf in case.layout.couplers)
    return case.laid(rungs=rungs, couplers=leaves)


def coupler_too_short(case: Case) -> Case:
    """The bar goes on for 1 mm and the flexure, which sets the strength, is that much shorter."""
    rung = case.rung("m0.1")
    start = rung.right.x + 1.0
    return case.with_rung("m0.1", right=replace(rung.right, x=start)).with_coupler("m0->m3", start_x=start)


def coupler_on_another_plate(case: Case) -> Case:
    return case.with_coupler("m0->m3", plate="H1")


def coupler_on_the_trunk_plate(case: Case) -> Case:
    return case.with_rung("m0.1", plate="V").with_coupler("m0->m3", plate="V")


def rocker_without_post(case: Case) -> Case:
    return case.with_coupler("m1->m4", post_x=None)


def post_on_a_straight_coupler(case: Case) -> Case:
    return case.with_coupler("m0->m3", post_x=case.layout.couplers[0].start_x + 5.0)


def rocker_post_shifted(case: Case) -> Case:
    return case.with_coupler("m1->m4", post_x=case.layout.couplers[1].post_x + 0.5)


def trunk_beside_a_hub_pin(case: Case) -> Case:
    """m0's trunk ends in the row of m1, whose pin moves beside it."""
    return case.on_track("m0", case.placement.column_x[0] + case.rules.hub_pin_offset + 1.0)


def two_trunks_on_one_track(case: Case) -> Case:
    return case.on_track("m0", case.trunk("m1.t").x)


def trunks_too_near(case: Case) -> Case:
    """A hundredth of a millimetre less than bars and gap need."""
    return case.on_track("m0", case.trunk("m1.t").x + case.rules.bar_width + case.rules.gap - 0.01)


def post_under_an_item(case: Case) -> Case:
    """The pivot of m1->m4 comes down from the cover to H0 and meets a bar of m1 itself on H1: a pivot is fixed."""
    left = RungEnd(EndKind.VIA, case.trunk("m1.t").x, "m1.t")
    right = RungEnd(EndKind.TAB, case.layout.couplers[1].post_x + 2.0, "none")
    return case.laid(rungs=(*case.layout.rungs, Rung("m1.2", "m1", "H1", case.placement.row_y[2], left, right)))


def rung_over_another(case: Case) -> Case:
    """m0's rung in m1's row reaches back over m1's own on the same plate."""
    rung = case.rung("m0.1")
    return case.with_rung("m0.1", left=replace(rung.left, x=rung.left.x - 8.0))


def rung_through_its_flexure(case: Case) -> Case:
    """Another bar of m0 lies where the flexure of m0->m3 must bend."""
    rung = case.rung("m0.1")
    across = replace(rung, name="m0.2", right=RungEnd(EndKind.TAB, rung.right.x + 5.0, "none"))
    return case.laid(rungs=(*case.layout.rungs, across))


def rung_into_the_rim(case: Case) -> Case:
    """A bar to the right of m4, up to the boundary; only a tab may go through the rim."""
    x, y, far = case.placement.column_x[1], case.placement.row_y[2], case.placement.boundary[2][0]
    rung = Rung("m4.0", "m4", "H0", y, RungEnd(EndKind.HUB, x, "m4"), RungEnd(EndKind.VIA, far, "m4.t"))
    return case.laid(rungs=(*case.layout.rungs, rung), trunks=(*case.layout.trunks, Trunk("m4.t", "m4", far, y, y)))


def two_items_on_a_hub_side(case: Case) -> Case:
    """A rung of m2 is fixed to the hub side that its bias leaf is cut from."""
    x, y = case.placement.column_x[0], case.placement.row_y[2]
    rung = Rung("m2.0", "m2", "H1", y, RungEnd(EndKind.HUB, x, "m2"), RungEnd(EndKind.TAB, x + 10.0, "none"))
    return case.laid(rungs=(*case.layout.rungs, rung))


def bias_left_out(case: Case) -> Case:
    return case.laid(biases=())


def bias_twice(case: Case) -> Case:
    return case.laid(biases=(*case.layout.biases, replace(case.layout.biases[0], plate="H2")))


def bias_of_another_mass(case: Case) -> Case:
    return case.with_bias(mass="m1")


def bias_post_shifted(case: Case) -> Case:
    return case.with_bias(post_x=case.layout.biases[0].post_x + 0.5)


def bias_post_mirrored(case: Case) -> Case:
    """The leaf would push its mass the other way."""
    return case.with_bias(post_y=2 * case.placement.row_y[2] - case.layout.biases[0].post_y)


def bias_on_the_other_side(case: Case) -> Case:
    return case.with_bias(side=Side.LEFT)


def bias_without_a_size(case: Case) -> Case:
    return replace(case, rules=replace(case.rules, biases={}))


def tab_missing(case: Case) -> Case:
    return case.laid(tabs=())


def tab_twice(case: Case) -> Case:
    return case.laid(tabs=case.layout.tabs * 2)


def tab_of_another_net(case: Case) -> Case:
    return case.with_tab(net="m3")


def tab_too_short(case: Case) -> Case:
    """At one end of the stroke of what it touches, nothing of it would stand out."""
    start, (_, y) = case.layout.tabs[0].path
    return case.with_tab(path=(start, (case.placement.ports[0].x + case.rules.throw / 2, y)))


def tab_beside_its_place(case: Case) -> Case:
    port = case.placement.ports[0]
    return replace(case, placement=replace(case.placement, ports=(replace(port, y=port.y + 1.0),)))


def tab_askew(case: Case) -> Case:
    start, (x, y) = case.layout.tabs[0].path
    return case.with_tab(path=(start, (x, y + 0.05)))


def tab_not_held(case: Case) -> Case:
    return case.with_tab(plate="H1")


def units_into_the_rim(case: Case) -> Case:
    """The first column moves left by a little more than was let out."""
    x = case.placement.column_x[0] - 2 * AROUND
    masses = tuple(replace(u, x=x) if u.column == 0 else u for u in case.placement.masses)
    columns = (x, case.placement.column_x[1])
    return replace(case, placement=replace(case.placement, column_x=columns, masses=masses))


def two_units_in_one_slot(case: Case) -> Case:
    host = next(unit for unit in case.placement.masses if unit.mass == "m2")
    return case.with_unit("m3", column=host.column, row=host.row, x=host.x, y=host.y)


def unit_off_its_lattice_point(case: Case) -> Case:
    return case.with_unit("m3", row=0)


def unit_left_out(case: Case) -> Case:
    return replace(case, placement=replace(case.placement, masses=case.placement.masses[1:]))


def unit_twice(case: Case) -> Case:
    masses = (*case.placement.masses, case.placement.masses[0])
    return replace(case, placement=replace(case.placement, masses=masses))


BAD: tuple[tuple[str, Callable[[Case], Case], str], ...] = (
    ("unit_slot", units_into_the_rim, "m0"),
    ("unit_slot", two_units_in_one_slot, "m3"),
    ("unit_slot", unit_off_its_lattice_point, "m3"),
    ("unit_slot", unit_left_out, "m0"),
    ("unit_slot", unit_twice, "m0"),
    ("containment", rung_into_the_rim, "rung m4.0"),
    ("clearance", trunk_beside_a_hub_pin, "trunk m0.t"),
    ("clearance", two_trunks_on_one_track, "trunk m0.t"),
    ("clearance", trunks_too_near, "trunk m0.t"),
    ("clearance", post_under_an_item, "rung m1.2"),
    ("clearance", rung_over_another, "rung m0.1"),
    ("overlap", rung_through_its_flexure, "rung m0.2"),
    ("hub_side", two_items_on_a_hub_side, "bias m2"),
    ("carrier", rung_off_its_hub, "m0.0"),
    ("carrier", rung_without_length, "m0.0"),
    ("carrier", rung_in_another_row, "m1.1"),
    ("carrier", carrier_cut_in_two, "m0.1"),
    ("carrier", trunk_named_twice, "m0.t"),
    ("carrier", trunk_of_a_stranger, "nobody"),
    ("coupler", rung_moved_in_y, "m1->m4"),
    ("coupler", rung_in_another_row, "m1->m4"),
    ("coupler", coupler_left_out, "m0->m3"),
    ("coupler", coupler_twice, "m0->m3"),
    ("coupler", coupler_of_nothing, "m0->m5"),
    ("coupler", target_swapped, "m0->m3"),
    ("coupler", coupler_too_short, "m0->m3"),
    ("coupler", coupler_on_another_plate, "m0->m3"),
    ("coupler", coupler_on_the_trunk_plate, "m0->m3"),
    ("coupler", rocker_without_post, "m1->m4"),
    ("coupler", post_on_a_straight_coupler, "m0->m3"),
    ("coupler", rocker_post_shifted, "m1->m4"),
    ("bias", bias_left_out, "m2"),
    ("bias", bias_twice, "m2"),
    ("bias", bias_of_another_mass, "m1"),
    ("bias", bias_post_shifted, "m2"),
    ("bias", bias_post_mirrored, "m2"),
    ("bias", bias_on_the_other_side, "m2"),
    ("bias", bias_without_a_size, "m2"),
    ("tab", tab_missing, "out[0]"),
    ("tab", tab_twice, "out[0]"),
    ("tab", tab_of_another_net, "out[0]"),
    ("tab", tab_too_short, "out[0]"),
    ("tab", tab_beside_its_place, "out[0]"),
    ("tab", tab_askew, "out[0]"),
    ("tab", tab_not_held, "out[0]"),
)


def test_nothing_is_wrong_with_the_hand_laid_device() -> None:
    assert good().findings() == ()


@pytest.mark.parametrize(("rule", "spoil", "name"), BAD, ids=[f"{rule}-{spoil.__name__}" for rule, spoil, _ in BAD])
def test_what_is_spoilt_is_found_by_its_rule(rule: str, spoil: Callable[[Case], Case], name: str) -> None:
    found = spoil(good()).findings()
    assert any(item.rule == rule and name in item.names for item in found), found
    assert list(found) == sorted(set(found))


def test_every_rule_has_a_fixture() -> None:
    assert {rule for rule, _, _ in BAD} == set(RULES)
