"""Several hundred masses are placed without a conflict and routed without a finding."""

import pytest

from mdlcad.placement.lattice import lattices, place_ports
from mdlcad.placement.placer import place
from mdlcad.routing import route
from mdlcad.routing.check import check_layout
from tests.placement.networks import MAZE_PORTS, SQUARE, maze, pom_rules
from tests.placement.tiles import tiled


@pytest.mark.long
def test_hundreds_of_masses_are_placed_and_routed_legally() -> None:
    network = tiled(maze(), 10, 0.1, 1, 1)
    rules = pom_rules(network)
    scale = 26.0  # a third of the slots are taken
    lattice = lattices(SQUARE, place_ports(network, MAZE_PORTS, scale), rules, scale, len(network.masses))[0]
    placed = place(network, lattice, rules, 1)
    assert placed.cost == 0
    layout = route(network, placed.placement, rules, 1, sides=placed.sides)
    assert check_layout(network, placed.placement, layout, rules) == ()
    assert {leaf.coupling for leaf in layout.couplers} == {coupling.name for coupling in network.couplings}
