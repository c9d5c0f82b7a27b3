"""Places kept from an earlier placement: none is left without need, and who is new finds a place."""

from dataclasses import replace

import pytest

from mdlcad.network.model import Coupling, Mass, MassKind, Network
from mdlcad.placement.keep import PRICES, Kept, place_kept
from mdlcad.placement.keep_grid import place_on_grid_like
from mdlcad.placement.lattice import Lattice, lattices, place_ports
from mdlcad.placement.placement import Placement
from mdlcad.placement.placer import choose_sides, place
from mdlcad.placement.placers import AnnealPlacer, PaperPlacer
from mdlcad.placement.unit_grid import Seating, place_on_grid
from tests.placement.networks import MAZE_PORTS, SQUARE, maze, pom_rules, small

SCALE = 3.9


def slots(placement: Placement) -> dict[str, tuple[int, int]]:
    return {unit.mass: (unit.column, unit.row) for unit in placement.masses}


def with_one_more(network: Network) -> Network:
    """The network with a mass between two that are coupled."""
    link = next(item for item in network.couplings if item.strength > 0)
    new = Mass("new", MassKind.GATE, 0, 3.0, -2.75, 0.0, 0.0, 0.0)
    extra = Coupling(link.source, "new", 0.3, 0.3)
    return replace(network, masses=(*network.masses, new), couplings=(*network.couplings, extra))


@pytest.fixture(scope="module")
def grid() -> Lattice:
    network, ports, rules = small()
    return lattices(SQUARE, place_ports(network, ports, SCALE), rules, SCALE, 18)[0]


@pytest.fixture(scope="module")
def kept(grid: Lattice) -> Kept:
    network, _, rules = small()
    found = place(network, grid, rules, 3)
    assert found.cost == 0
    sides = choose_sides(network, found.placement, grid, rules, 3)
    return Kept(slots(found.placement), sides.couplings, sides.biases)


@pytest.mark.parametrize("price", PRICES)
def test_nobody_moves_without_need(grid: Lattice, kept: Kept, price: float) -> None:
    network, _, rules = small()
    result = place_kept(network, grid, rules, kept, price, 8)
    assert result.cost == 0
    assert slots(result.placement) == kept.slots


def test_at_the_first_price_only_who_is_new_is_placed(grid: Lattice, kept: Kept) -> None:
    network, _, rules = small()
    edited = with_one_more(network)
    rules = replace(rules, couplers=pom_rules(edited).couplers)
    result = place_kept(edited, grid, rules, kept, PRICES[0], 8)
    now = slots(result.placement)
    assert {mass: now[mass] for mass in kept.slots} == kept.slots
    assert now["new"] not in kept.slots.values()


def test_who_stands_where_it_cannot_moves_for_a_price(grid: Lattice, kept: Kept) -> None:
    """Two masses exchanged over the whole lattice break rules, which the first price may not mend but a lower may."""
    network, _, rules = small()
    order = sorted(kept.slots, key=lambda mass: kept.slots[mass])
    swapped = {**kept.slots, order[0]: kept.slots[order[-1]], order[-1]: kept.slots[order[0]]}
    wrong = replace(kept, slots=swapped)
    stiff = place_kept(network, grid, rules, wrong, PRICES[0], 8)
    assert slots(stiff.placement) == swapped
    assert stiff.cost > 0
    assert place_kept(network, grid, rules, wrong, PRICES[-1], 8).cost == 0


def test_who_has_changed_moves_for_nothing_and_nobody_else_does(grid: Lattice, kept: Kept) -> None:
    """The same two masses exchanged, but known to have changed: even the first price may mend that, by them alone."""
    network, _, rules = small()
    order = sorted(kept.slots, key=lambda mass: kept.slots[mass])
    swapped = {**kept.slots, order[0]: kept.slots[order[-1]], order[-1]: kept.slots[order[0]]}
    freed = replace(kept, slots=swapped, changed=frozenset((order[0], order[-1])))
    result = place_kept(network, grid, rules, freed, PRICES[0], 8)
    now = slots(result.placement)
    assert result.cost == 0
    assert {mass for mass in order if now[mass] != swapped[mass]} <= freed.changed


@pytest.mark.parametrize("placer", [AnnealPlacer(), PaperPlacer()])
def test_on_the_programs_grid_all_stay_but_the_new(placer: AnnealPlacer | PaperPlacer) -> None:
    network = maze()
    first = place_on_grid(network, SQUARE, MAZE_PORTS, placer, Seating.TAB, 0)
    again = place_on_grid_like(network, SQUARE, MAZE_PORTS, placer, Seating.TAB, 5, network, first)
    assert again == replace(first, seed=5)
    edited = with_one_more(network)
    after = place_on_grid_like(edited, SQUARE, MAZE_PORTS, placer, Seating.TAB, 0, network, first)
    before = {item.mass: (item.x, item.y) for item in first.masses}
    now = {item.mass: (item.x, item.y) for item in after.masses}
    assert {mass: now[mass] for mass in before} == before
    assert now["new"] not in before.values()
