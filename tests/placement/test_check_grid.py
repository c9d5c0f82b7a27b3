"""A placement on the grid that breaks one rule is caught, and by that rule."""

import itertools
from dataclasses import replace

import pytest

from mdlcad.network.model import Coupling, Dynamics, Mass, MassKind, Network, PortBit
from mdlcad.placement.check_grid import check_grid
from mdlcad.placement.placers import ANNEAL
from mdlcad.placement.ports import PortPlace
from mdlcad.placement.unit_grid import Seating, place_on_grid

BOUNDARY = ((0, 0), (0, 7), (9, 7), (9, 0))
PORTS = (PortPlace("s[0]", "left", 0.0, 3.5, (-1.0, 0.0)), PortPlace("t[0]", "right", 9.0, 1.4, (1.0, 0.0)))
NAMES = ("s[0]", "a", "b", "c", "t")
NETWORK = Network(
    "made",
    "none",
    Dynamics(0.05, 0.25, 1.0, 1.0, 2),
    tuple(Mass(name, MassKind.GATE, i % 2, 1.0, -2.0, 0.0, 0.0, -1.0) for i, name in enumerate(NAMES)),
    tuple(Coupling(a, b, 0.3, 0.0) for a, b in itertools.pairwise(NAMES)),
    (PortBit("s[0]", "s[0]"),),
    (PortBit("t[0]", "t"),),
    (),
    None,
    1,
)


@pytest.fixture(scope="module")
def placed():
    return place_on_grid(NETWORK, BOUNDARY, PORTS, ANNEAL, Seating.ON_BOUNDARY, 0)


def moved(placement, number, **change):
    masses = list(placement.masses)
    masses[number] = replace(masses[number], **change)
    return replace(placement, masses=tuple(masses))


def test_what_the_placer_makes_is_right(placed):
    assert check_grid(NETWORK, placed, BOUNDARY, PORTS) == []
    seats = {item.mass: (item.x, item.y) for item in placed.masses}
    assert (seats["s[0]"], seats["t"]) == ((0.0, 3.5), (9.0, 1.4))


def test_every_rule_is_held(placed):
    taken = placed.masses[1]
    spoilt = {
        "2 masses are at": moved(placed, 2, x=taken.x, y=taken.y),
        "a is outside the boundary": moved(placed, 1, x=20.0),
        "a is on no site of the grid": moved(placed, 1, x=taken.x + 0.3),
        "s[0] is not at its port s[0]": moved(placed, 0, y=3.0),
        "the masses are not those of the network": replace(placed, masses=placed.masses[1:]),
        "the ports are not those of the network": replace(placed, ports=placed.ports[:1]),
        "port t[0] is not where the program has it": replace(
            placed, ports=(placed.ports[0], replace(placed.ports[1], x=8.0))
        ),
        "the boundary is not the program's": replace(placed, boundary=placed.boundary[1:]),
    }
    for words, wrong in spoilt.items():
        found = check_grid(NETWORK, wrong, BOUNDARY, PORTS)
        assert any(words in item for item in found), (words, found)
