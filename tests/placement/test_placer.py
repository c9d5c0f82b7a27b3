from dataclasses import replace

import numpy as np
import pytest

from mdlcad.network.model import Coupling, CouplingKind
from mdlcad.placement.anneal import anneal
from mdlcad.placement.costs import HARD
from mdlcad.placement.grid import RESOLUTION, way
from mdlcad.placement.large import BAND
from mdlcad.placement.lattice import Lattice, lattices, place_ports
from mdlcad.placement.linkable import unrealisable
from mdlcad.placement.placer import choose_sides, place
from mdlcad.placement.problem import build
from mdlcad.placement.state import start
from tests.placement.networks import SQUARE, small

SCALE = 3.9


def lattice() -> Lattice:
    network, ports, rules = small()
    return lattices(SQUARE, place_ports(network, ports, SCALE), rules, SCALE, 18)[0]


@pytest.mark.parametrize("seed", range(4))
def test_the_running_tallies_are_exact(seed: int):
    """The cost that incremental moves end with is the cost of the same placement built from nothing."""
    network, _, rules = small()
    problem = build(network, lattice(), rules)
    slots = np.arange(len(network.masses), dtype=np.int32)
    state, random = start(problem, slots, seed)
    # hot: many rules stay broken, so that there is something to compare
    left = anneal(problem, state, random, 3000, 60.0, 60.0, False)
    fresh, other = start(problem, state.mass[:, 0].copy(), seed)
    fresh.mass[:, 1] = state.mass[:, 1]
    fresh.side[:] = state.side
    assert left > 0
    assert anneal(problem, fresh, other, 0, 60.0, 60.0, False) == pytest.approx(left)


def test_annealing_finds_a_sound_placement_and_better_than_chance():
    network, _, rules = small()
    chance = place(network, lattice(), rules, 3, 0).cost
    found = place(network, lattice(), rules, 3)
    assert chance > 5 * HARD
    assert found.cost == 0


def test_a_sound_placement_keeps_nets_and_ports_in_reach():
    network, _, rules = small()
    grid = lattice()
    result = place(network, grid, rules, 3)
    at = {unit.mass: unit for unit in result.placement.masses}
    assert len({(unit.column, unit.row) for unit in at.values()}) == len(network.masses)
    assert {(unit.column, unit.row) for unit in at.values()} <= set(grid.slots)
    for coupling in network.couplings:
        assert abs(at[coupling.source].column - at[coupling.target].column) <= 1
    for tab in grid.tabs:
        found = way(tab, at[tab.mass].column)
        assert found is not None
        rows = (tab.row,) if tab.vertical else tab.rows
        assert not [u for u in at.values() if found.first <= u.column <= found.last and u.row in rows]


def test_a_tall_channel_of_a_small_network_is_packed_whole():
    """In bands, orders asked for in rows far apart would not be seen together."""
    network, ports, rules = small()
    tall = tuple((x, 3 * y) for x, y in SQUARE)
    places = tuple(replace(port, y=3 * port.y) for port in ports)
    grid = lattices(tall, place_ports(network, places, SCALE), rules, SCALE, 18)[0]
    assert len(grid.row_y) > BAND
    problem = build(network, grid, rules)
    state, _ = start(problem, np.arange(len(network.masses), dtype=np.int32), 1)
    assert len(state.trunk_count) == len(grid.column_x) + 1


def test_tracks_are_packed_in_steps_that_the_router_counts_in():
    network, _, rules = small()
    problem = build(network, lattice(), replace(rules, track_pitch=rules.track_pitch + 0.02))
    pitch = float(problem.sizes[1])
    assert rules.track_pitch + 0.02 <= pitch < rules.track_pitch + 0.02 + RESOLUTION
    assert pitch / RESOLUTION == pytest.approx(round(pitch / RESOLUTION))


def test_same_seed_same_placement_other_seed_another():
    network, _, rules = small()
    one, two = place(network, lattice(), rules, 5), place(network, lattice(), rules, 5)
    assert one == two
    assert place(network, lattice(), rules, 6).placement != one.placement


def test_sides_of_a_sound_placement_break_no_rule():
    network, _, rules = small()
    result = place(network, lattice(), rules, 3)
    sides = choose_sides(network, result.placement, lattice(), rules, 3)
    assert sides.cost == 0
    assert set(sides.couplings) == {coupling.name for coupling in network.couplings}
    assert set(sides.biases) == set(rules.biases)


def test_couplings_that_no_hub_can_hold_are_named_with_the_reason():
    network, _, rules = small()
    target = next(iter(rules.biases))
    sources = [mass.name for mass in network.masses if mass.name != target][:3]
    extra = tuple(Coupling(source, f"{target}", -0.3, 0.3) for source in sources)
    names = [coupling.name for coupling in extra]
    kept = tuple(c for c in network.couplings if c.target != target)
    crowded = replace(network, couplings=kept + extra)
    more = replace(
        rules,
        couplers={**rules.couplers, **dict.fromkeys(names, 24.0)},
        post_offset={**rules.post_offset, **dict.fromkeys(names, 12.0)},
    )
    reasons = unrealisable(crowded, more)
    # its bias leaf has one side, one negative coupling the other
    assert sorted(reasons) == sorted(names[1:])
    assert all("post" in reason for reason in reasons.values())


def test_a_latch_coupling_has_no_linkage():
    network, _, rules = small()
    first = replace(network.couplings[0], kind=CouplingKind.LATCH)
    reasons = unrealisable(replace(network, couplings=(first, *network.couplings[1:])), rules)
    assert list(reasons) == [first.name]
