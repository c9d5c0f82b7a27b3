"""Slots lie inside the boundary, and ports where the program put them."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import pytest
from shapely import Point, Polygon, box

from mdlcad.errors import UsageError
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.lattice import Lattice, lattices, place_ports
from mdlcad.placement.ports import PortPlace
from tests.placement.networks import HOUSE, LOCK_PORTS, MAZE_PORTS, SQUARE, lock, maze, pom_rules

SCALE = 8.0
NETWORKS = {
    "square": (maze(), SQUARE, MAZE_PORTS),
    "house": (lock(), HOUSE, LOCK_PORTS),
}

Setting = tuple[Network, tuple[tuple[int, int], ...], LayoutRules, tuple[Lattice, ...]]


@pytest.fixture(scope="module", params=sorted(NETWORKS))
def setting(request: pytest.FixtureRequest) -> Setting:
    network, boundary, ports = NETWORKS[request.param]
    rules = pom_rules(network)
    found = lattices(boundary, place_ports(network, ports, SCALE), rules, SCALE, len(network.masses))
    return network, boundary, rules, found


def footprint(lattice: Lattice, slot: tuple[int, int], rules: LayoutRules) -> Polygon:
    x, y = lattice.column_x[slot[0]], lattice.row_y[slot[1]]
    return box(x - rules.unit_left, y - rules.row_pitch / 2, x + rules.unit_right, y + rules.row_pitch / 2)


def test_there_are_lattices_with_a_slot_for_every_mass(setting: Setting) -> None:
    network, _, _, found = setting
    assert found
    for lattice in found:
        assert len(set(lattice.slots)) == len(lattice.slots) >= len(network.masses)


def test_every_slot_keeps_rim_and_gap_to_the_boundary(setting: Setting) -> None:
    _, boundary, rules, found = setting
    outline = Polygon([(x * SCALE, y * SCALE) for x, y in boundary])
    for lattice in found:
        for slot in lattice.slots:
            shape = footprint(lattice, slot, rules)
            assert outline.contains(shape)
            assert outline.exterior.distance(shape) >= rules.frame_width + rules.gap - 1e-5


def test_no_two_slots_overlap(setting: Setting) -> None:
    _, _, rules, found = setting
    for lattice in found:
        columns, rows = lattice.column_x, lattice.row_y
        assert all(b - a >= rules.column_pitch - 1e-6 for a, b in pairwise(columns))
        assert all(b - a >= rules.row_pitch - 1e-5 for a, b in pairwise(rows))


def test_a_slanted_roof_takes_slots_away() -> None:
    """The corners of the house's bounding box lie outside it, so no lattice may fill its rows and columns there."""
    network, boundary, ports = NETWORKS["house"]
    rules = pom_rules(network)
    roof = Polygon([(x * SCALE, y * SCALE) for x, y in boundary])
    missed = 0
    for lattice in lattices(boundary, place_ports(network, ports, SCALE), rules, SCALE, len(network.masses)):
        for column in range(len(lattice.column_x)):
            for row in range(len(lattice.row_y)):
                if not roof.contains(footprint(lattice, (column, row), rules)):
                    assert (column, row) not in lattice.slots
                    missed += 1
    assert missed > 0


@pytest.mark.parametrize("scale", [3.7, 8.0, 11.0 / 3.0])
@pytest.mark.parametrize("name", sorted(NETWORKS))
def test_ports_stand_at_their_scaled_places(name: str, scale: float) -> None:
    network, boundary, places = NETWORKS[name]
    placed = place_ports(network, places, scale)
    want = {place.bit: place for place in places}
    drives = {bit.bit: bit.mass for bit in (*network.sensors, *network.actuators)}
    assert [port.bit for port in placed] == [bit.bit for bit in (*network.sensors, *network.actuators)]
    outline = Polygon([(x * scale, y * scale) for x, y in boundary])
    for port in placed:
        place = want[port.bit]
        assert math.dist((port.x, port.y), (place.x * scale, place.y * scale)) < 2e-6
        assert outline.exterior.distance(Point(port.x, port.y)) < 2e-6
        assert (port.line, port.normal, port.mass) == (place.line, place.normal, drives[port.bit])


def test_lattices_leave_ports_where_they_are(setting: Setting) -> None:
    """Rows are moved to suit the ports, never the other way about."""
    network, boundary, _, found = setting
    places = next(ports for _, outline, ports in NETWORKS.values() if outline == boundary)
    for lattice in found:
        assert lattice.ports == place_ports(network, places, SCALE)
        assert lattice.mm_per_grid == SCALE
        want = [(x * SCALE, y * SCALE) for x, y in boundary]
        assert all(math.dist(a, b) < 2e-6 for a, b in zip(lattice.boundary, want, strict=True))


def test_every_tab_ends_beyond_its_port(setting: Setting) -> None:
    """The tip passes the boundary by the stroke at least, straight out from the port."""
    _, _, rules, found = setting
    for lattice in found:
        ports = {port.bit: port for port in lattice.ports}
        assert sorted(tab.bit for tab in lattice.tabs) == sorted(ports)
        for tab in lattice.tabs:
            port, (x, y) = ports[tab.bit], tab.path[-1]
            out = (x - port.x) * port.normal[0] + (y - port.y) * port.normal[1]
            aside = (x - port.x) * port.normal[1] - (y - port.y) * port.normal[0]
            assert out >= rules.throw
            assert abs(aside) < 0.1


def test_a_port_without_a_place_is_refused() -> None:
    network, _, ports = NETWORKS["square"]
    with pytest.raises(UsageError, match=r"port A\[1\] has no place"):
        place_ports(network, ports[:-1], SCALE)


def test_a_place_that_nothing_reads_gets_no_tab() -> None:
    network, _, ports = NETWORKS["square"]
    spare: PortPlace = replace(ports[0], bit="spare[0]")
    assert "spare[0]" not in {port.bit for port in place_ports(network, (*ports, spare), SCALE)}


def test_a_boundary_that_is_all_rim_has_no_lattice() -> None:
    network, boundary, ports = NETWORKS["square"]
    rules = pom_rules(network)
    scale = 2 * rules.frame_width / 39
    assert lattices(boundary, place_ports(network, ports, scale), rules, scale, 1) == ()


def test_more_masses_than_slots_have_no_lattice(setting: Setting) -> None:
    _, boundary, rules, found = setting
    most = max(len(lattice.column_x) * len(lattice.row_y) for lattice in found)
    assert lattices(boundary, found[0].ports, rules, SCALE, 4 * most) == ()
