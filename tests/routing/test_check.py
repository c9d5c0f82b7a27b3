"""The checker passes what the router makes and catches every seeded fault by its rule."""

from collections import Counter
from collections.abc import Callable
from dataclasses import replace

import pytest

from mdlcad.placement.placement import Placement
from mdlcad.routing.check import RULES, check_layout
from mdlcad.routing.layout import EndKind, Layout, Rung, Side, Trunk
from tests.routing.made import good

Made = tuple[Placement, Layout]


def swap(items: tuple, index: int, item: object) -> tuple:
    return (*items[:index], item, *items[index + 1 :])


def without(items: tuple, index: int) -> tuple:
    return (*items[:index], *items[index + 1 :])


def shift_rung(rung: Rung, y: float = 0.0, x: float = 0.0) -> Rung:
    left, right = replace(rung.left, x=rung.left.x + x), replace(rung.right, x=rung.right.x + x)
    return replace(rung, y=rung.y + y, left=left, right=right)


def first(items: tuple, test: Callable[[object], bool]) -> int:
    return next(index for index, item in enumerate(items) if test(item))


def moved_rung(placement: Placement, layout: Layout) -> Made:
    return placement, replace(layout, rungs=swap(layout.rungs, 0, shift_rung(layout.rungs[0], y=3.0)))


def two_trunks_on_one_track(placement: Placement, layout: Layout) -> Made:
    def overlap(a: Trunk, b: Trunk) -> bool:
        return a.net != b.net and min(a.y_high, b.y_high) >= max(a.y_low, b.y_low)

    i, j = next(
        (i, j)
        for i, a in enumerate(layout.trunks)
        for j, b in enumerate(layout.trunks)
        if i != j and overlap(a, b)
    )  # fmt: skip
    return placement, replace(layout, trunks=swap(layout.trunks, i, replace(layout.trunks[i], x=layout.trunks[j].x)))


def missing_coupler(placement: Placement, layout: Layout) -> Made:
    return placement, replace(layout, couplers=without(layout.couplers, 0))


def double_coupler(placement: Placement, layout: Layout) -> Made:
    return placement, replace(layout, couplers=(*layout.couplers, layout.couplers[0]))


def swapped_targets(placement: Placement, layout: Layout) -> Made:
    a = layout.couplers[0]
    j = first(layout.couplers, lambda leaf: leaf.coupling.split("->")[1] != a.coupling.split("->")[1])
    b = layout.couplers[j]
    leaves = swap(layout.couplers, 0, replace(a, coupling=b.coupling))
    return placement, replace(layout, couplers=swap(leaves, j, replace(b, coupling=a.coupling)))


def wrong_side(placement: Placement, layout: Layout) -> Made:
    leaf = layout.couplers[0]
    other = Side.LEFT if leaf.side is Side.RIGHT else Side.RIGHT
    return placement, replace(layout, couplers=swap(layout.couplers, 0, replace(leaf, side=other)))


def lost_post(placement: Placement, layout: Layout) -> Made:
    i = first(layout.couplers, lambda leaf: leaf.post_x is not None)
    return placement, replace(layout, couplers=swap(layout.couplers, i, replace(layout.couplers[i], post_x=None)))


def rung_over_post(placement: Placement, layout: Layout) -> Made:
    """A bar of another net on a plate above a bias leaf, across its post."""
    _, rules, _, _ = good()
    bias = next(leaf for leaf in layout.biases if leaf.plate != rules.link_plates[-1])
    i = first(layout.rungs, lambda rung: rung.net != bias.mass and EndKind.TAB not in (rung.left.kind, rung.right.kind))
    rung = layout.rungs[i]
    x = bias.post_x - (rung.left.x + rung.right.x) / 2
    over = replace(shift_rung(rung, bias.post_y - rung.y, x), plate=rules.link_plates[-1])
    return placement, replace(layout, rungs=swap(layout.rungs, i, over))


def crossing_rung(placement: Placement, layout: Layout) -> Made:
    """A bar stretched over the next hub."""
    i, hub_x = next(
        (i, unit.x)
        for i, rung in enumerate(layout.rungs)
        for unit in placement.masses
        if rung.right.kind is EndKind.VIA and unit.y == rung.y and unit.x > rung.right.x and unit.mass != rung.net
    )
    rung = layout.rungs[i]
    far = replace(rung.right, x=hub_x + 10.0)
    return placement, replace(layout, rungs=swap(layout.rungs, i, replace(rung, right=far)))


def cut_carrier(placement: Placement, layout: Layout) -> Made:
    return placement, replace(layout, trunks=without(layout.trunks, 0))


def lost_source_rung(placement: Placement, layout: Layout) -> Made:
    i = first(layout.rungs, lambda rung: {rung.left.kind, rung.right.kind} == {EndKind.HUB, EndKind.VIA})
    return placement, replace(layout, rungs=without(layout.rungs, i))


def missing_bias(placement: Placement, layout: Layout) -> Made:
    return placement, replace(layout, biases=without(layout.biases, 0))


def bias_on_the_other_side(placement: Placement, layout: Layout) -> Made:
    leaf = layout.biases[0]
    other = Side.LEFT if leaf.side is Side.RIGHT else Side.RIGHT
    return placement, replace(layout, biases=swap(layout.biases, 0, replace(leaf, side=other)))


def crowded_hub(placement: Placement, layout: Layout) -> Made:
    """All items of a busy hub side on one plate."""
    network, _, _, _ = good()
    target = {coupling.name: coupling.target for coupling in network.couplings}
    seen: dict[tuple[str, Side], str] = {}
    for i, leaf in enumerate(layout.couplers):
        key = (target[leaf.coupling], leaf.side)
        if key in seen and seen[key] != leaf.plate:
            return placement, replace(layout, couplers=swap(layout.couplers, i, replace(leaf, plate=seen[key])))
        seen[key] = leaf.plate
    raise AssertionError("no hub side has two couplers")


def missing_tab(placement: Placement, layout: Layout) -> Made:
    return placement, replace(layout, tabs=without(layout.tabs, 0))


def tab_elsewhere(placement: Placement, layout: Layout) -> Made:
    tab = layout.tabs[0]
    path = (*tab.path[:-1], (tab.path[-1][0] + 9.0, tab.path[-1][1] + 9.0))
    return placement, replace(layout, tabs=swap(layout.tabs, 0, replace(tab, path=path)))


def unit_outside(placement: Placement, layout: Layout) -> Made:
    unit = placement.masses[0]
    out = replace(unit, x=unit.x - 500.0)
    return replace(placement, masses=swap(placement.masses, 0, out)), layout


def two_units_in_one_slot(placement: Placement, layout: Layout) -> Made:
    other = placement.masses[1]
    both = replace(placement.masses[0], column=other.column, row=other.row, x=other.x, y=other.y)
    return replace(placement, masses=swap(placement.masses, 0, both)), layout


def trunk_in_the_rim(placement: Placement, layout: Layout) -> Made:
    return placement, replace(layout, trunks=swap(layout.trunks, 0, replace(layout.trunks[0], x=3.0)))


FAULTS = {
    moved_rung: "carrier",
    two_trunks_on_one_track: "clearance",
    missing_coupler: "coupler",
    double_coupler: "coupler",
    swapped_targets: "coupler",
    wrong_side: "coupler",
    lost_post: "coupler",
    rung_over_post: "clearance",
    crossing_rung: "clearance",
    cut_carrier: "carrier",
    lost_source_rung: "carrier",
    missing_bias: "bias",
    bias_on_the_other_side: "bias",
    crowded_hub: "hub_side",
    missing_tab: "tab",
    tab_elsewhere: "tab",
    unit_outside: "unit_slot",
    two_units_in_one_slot: "unit_slot",
    trunk_in_the_rim: "containment",
}


def test_a_routed_device_is_sound():
    network, rules, placement, layout = good()
    assert layout.unrealised == ()
    assert check_layout(network, placement, layout, rules) == ()


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
def test_a_seeded_fault_is_caught(fault: Callable[[Placement, Layout], Made]):
    network, rules, placement, layout = good()
    found = check_layout(network, *fault(placement, layout), rules)
    assert FAULTS[fault] in {item.rule for item in found}
    assert {item.rule for item in found} <= set(RULES)
    assert all(item.names and item.message for item in found)


def test_a_leaf_that_runs_into_its_own_carrier_is_caught():
    network, rules, placement, layout = good()
    sources = {coupling.name: coupling.source for coupling in network.couplings}
    rungs_of = Counter(rung.net for rung in layout.rungs)
    leaf = next(leaf for leaf in layout.couplers if rungs_of[sources[leaf.coupling]] > 1)
    source = sources[leaf.coupling]
    low, high = sorted((leaf.start_x, leaf.start_x + (6 if leaf.side is Side.LEFT else -6)))
    i = first(layout.rungs, lambda rung: rung.net == source and leaf.coupling not in (rung.left.ref, rung.right.ref))
    rung = layout.rungs[i]
    across = replace(
        rung, y=leaf.y, plate=leaf.plate, left=replace(rung.left, x=low), right=replace(rung.right, x=high)
    )
    found = check_layout(network, placement, replace(layout, rungs=swap(layout.rungs, i, across)), rules)
    assert "overlap" in {item.rule for item in found}


def test_a_throw_too_large_for_the_rows_is_caught():
    network, rules, placement, layout = good()
    found = check_layout(network, placement, layout, replace(rules, throw=rules.throw + 0.2))
    assert "clearance" in {item.rule for item in found}


def test_what_the_layout_says_it_left_out_is_still_missing():
    """The layout's own list of what it could not realise excuses nothing."""
    network, rules, placement, layout = good()
    name = layout.couplers[0].coupling
    named = check_layout(network, placement, replace(layout, unrealised=((name, "no room"),)), rules)
    assert [(item.rule, item.names) for item in named] == [("coupler", (name,))]
    assert "no room" in named[0].message
    without = replace(layout, couplers=layout.couplers[1:], unrealised=((name, "no room"),))
    assert ("coupler", (name,)) in {
        (item.rule, item.names) for item in check_layout(network, placement, without, rules)
    }
