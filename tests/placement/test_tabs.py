"""How ports are reached: in corners, on slopes, over hub columns."""

from dataclasses import replace

import numpy as np
import pytest
from shapely import LineString, Polygon

from mdlcad.network.model import PortBit
from mdlcad.placement.anneal import anneal
from mdlcad.placement.costs import VIA_A, VIA_B
from mdlcad.placement.grid import free_intervals, inside, way
from mdlcad.placement.lattice import lattices, place_ports
from mdlcad.placement.ports import PortPlace
from mdlcad.placement.problem import build
from mdlcad.placement.state import start
from tests.placement.networks import HOUSE, LOCK_PORTS, SQUARE, lock, maze, pom_rules, small


def test_a_notch_splits_a_strip_in_two():
    shape = Polygon([(0, 0), (0, 10), (4, 10), (4, 5), (6, 5), (6, 10), (10, 10), (10, 0)])
    assert free_intervals(shape, 6, 8) == ((0, 4), (6, 10))
    assert free_intervals(shape, 1, 3) == ((0, 10),)


def test_a_tab_in_the_corner_passes_the_rim_inside_and_steps_out_to_its_place():
    network, ports, rules = small()
    lattice = lattices(SQUARE, place_ports(network, ports, 5.0), rules, 5.0, 18)[0]
    tab = next(tab for tab in lattice.tabs if tab.bit == "A[0]")
    assert len(tab.path) == 4
    assert tab.path[-1][0] == pytest.approx(195.0)
    assert tab.x + rules.bar_width / 2 <= inside(lattice.boundary, rules).bounds[2] + 1e-6


@pytest.mark.parametrize("place", [(39.0, 0.5, (1.0, 0.0)), (1.0, 0.0, (0.0, -1.0))])
def test_a_tab_that_steps_aside_ends_in_a_foot_as_wide_as_its_bar_around_its_place(place):
    network, ports, rules = small()
    bit, half = ports[1].bit, rules.bar_width / 2
    corner = place_ports(network, (ports[0], PortPlace(bit, "wall", *place), ports[2]), 5.0)
    tab = next(tab for tab in lattices(SQUARE, corner, rules, 5.0, 18)[0].tabs if tab.bit == bit)
    (from_x, from_y), (x, y) = tab.path[0], tab.path[-1]
    along = 0 if tab.vertical else 1
    assert (x, y)[along] == pytest.approx(5.0 * place[along])
    assert abs((from_x, from_y)[along] - (x, y)[along]) > 0.1
    body = LineString(tab.path).buffer(half, cap_style="flat", join_style="mitre")
    back = tab.outside * 2 * half
    upright, level = LineString([(x, y), (x, y - back)]), LineString([(x, y), (x - back, y)])
    foot = (upright if tab.vertical else level).buffer(half, cap_style="flat")
    assert body.buffer(1e-3).contains(foot)


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


def test_as_many_tabs_may_meet_in_one_row_as_there_are_ports():
    """Kernels write what meets a row without looking, so there must be room for whatever a move can bring together."""
    masses, scale = maze().masses[:24], 10.0
    bits = tuple(PortBit(f"A[{i}]", mass.name) for i, mass in enumerate(masses))
    network = replace(maze(), masses=masses, couplings=(), sensors=(), actuators=bits, tick=None)
    rules = pom_rules(network)
    ports = tuple(PortPlace(bit.bit, "bottom", 1.5 * i + 2, 0, (0.0, -1.0)) for i, bit in enumerate(bits))
    grid = lattices(SQUARE, place_ports(network, ports, scale), rules, scale, len(masses))[0]
    problem = build(network, grid, rules)
    column = [slot for slot, (at, _) in enumerate(grid.slots) if at == 0][: len(masses)]
    assert len(column) == len(masses)
    state, random = start(problem, np.array(column, np.int32), 1)
    anneal(problem, state, random, 0, 1.0, 1.0, False)
    # tabs farther right hang on the hub to the right, beside whatever is bent in the channel itself
    left, right = int(state.row[1, 0, VIA_A]), int(state.row[1, 0, VIA_B])
    assert right > 16 > left
    nets = state.items[1, 0, 1, :right] // 2
    assert len(nets) == len(set(nets.tolist())) == right
