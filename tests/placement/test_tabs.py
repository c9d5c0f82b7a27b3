"""How ports are reached: in corners, on slopes, over hub columns."""

import pytest
from shapely import Polygon

from mdlcad.placement.grid import free_intervals, inside, way
from mdlcad.placement.lattice import lattices, place_ports
from mdlcad.placement.ports import PortPlace
from tests.placement.networks import HOUSE, LOCK_PORTS, SQUARE, lock, pom_rules, small


def test_a_notch_splits_a_strip_in_two():
    shape = Polygon([(0, 0), (0, 10), (4, 10), (4, 5), (6, 5), (6, 10), (10, 10), (10, 0)])
    assert free_intervals(shape, 6, 8) == ((0, 4), (6, 10))
    assert free_intervals(shape, 1, 3) == ((0, 10),)


def test_a_tab_in_the_corner_passes_the_rim_inside_and_steps_out_to_its_place():
    network, ports, rules = small()
    lattice = lattices(SQUARE, place_ports(network, ports, 5.0), rules, 5.0, 18)[0]
    tab = next(tab for tab in lattice.tabs if tab.bit == "A[0]")
    assert len(tab.path) == 3
    assert tab.path[-1][0] == pytest.approx(195.0)
    assert tab.x + rules.bar_width / 2 <= inside(lattice.boundary, rules).bounds[2] + 1e-6


def test_a_tab_is_reached_over_the_columns_between():
    network = lock()
    rules = pom_rules(network)
    lattice = lattices(HOUSE, place_ports(network, LOCK_PORTS, 7.2), rules, 7.2, 60)[0]
    left = next(tab for tab in lattice.tabs if not tab.vertical and tab.outside < 0)
    near, far = way(left, 0), way(left, 2)
    assert near is not None and near.first > near.last
    assert far is not None and (far.channel, far.first, far.last) == (2, 0, 1)


def test_a_roof_port_leaves_through_the_slope():
    network, ports, rules = small()
    roof = PortPlace("S1[0]", "roof", 10.0, 42.0, (-0.573, 0.819))
    lattice = lattices(HOUSE, place_ports(network, (ports[0], roof, ports[2]), 6.0), rules, 6.0, 18)[0]
    tab = next(tab for tab in lattice.tabs if tab.bit == "S1[0]")
    assert tab.vertical and tab.x == pytest.approx(60.0, abs=0.03)
    assert tab.y < 42.0 * 6.0 < tab.path[-1][1]
