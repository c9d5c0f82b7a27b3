"""Every placer does the same two things, and the command line knows all of them."""

import numpy as np
import pytest

from mdlcad.cli.build import PLACERS
from mdlcad.placement.columns import Answers
from mdlcad.placement.lattice import lattices, place_ports
from mdlcad.placement.names import PlacerName
from mdlcad.placement.placers import AnnealPlacer, PaperPlacer, Placer, slot_problem
from mdlcad.placement.sites import PaperOptions
from tests.placement.networks import SQUARE, small


def test_the_command_line_knows_them_all() -> None:
    assert tuple(PlacerName) == PLACERS
    assert {AnnealPlacer().name, PaperPlacer().name} == set(PlacerName)


@pytest.mark.parametrize("placer", [AnnealPlacer(), PaperPlacer()])
def test_units_get_slots_of_their_own(placer: Placer) -> None:
    network, ports, rules = small()
    lattice = lattices(SQUARE, place_ports(network, ports, 3.9), rules, 3.9, 18)[0]
    result = placer.on_lattice(network, lattice, rules, 1, 500, Answers())
    seats = [(unit.column, unit.row) for unit in result.placement.masses]
    assert len(set(seats)) == len(network.masses)
    assert set(seats) <= set(lattice.slots)
    assert result == placer.on_lattice(network, lattice, rules, 1, 500, Answers())


def test_the_papers_options_do_what_they_say() -> None:
    network, ports, rules = small()
    lattice = lattices(SQUARE, place_ports(network, ports, 3.9), rules, 3.9, 18)[0]
    problem = slot_problem(network, lattice, rules)
    usual = PaperPlacer().on_sites(problem, 2)
    left = PaperPlacer(PaperOptions(sweeps=0)).on_sites(problem, 2)
    assert usual.crossings < left.crossings
    short = PaperPlacer(PaperOptions(iterations=1, iterations_pinned=1, sweeps=0)).on_sites(problem, 2)
    assert not np.array_equal(short.site_of, left.site_of)
