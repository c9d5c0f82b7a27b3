"""What becomes of a network that asks more of a hub, or of a boundary, than there is room for."""

from __future__ import annotations

import pytest

from mdlcad.errors import SignoffError
from mdlcad.network.model import Coupling, Dynamics, Mass, MassKind, Network
from mdlcad.routing import place_and_route
from mdlcad.routing.check import check_layout
from tests.placement.networks import SQUARE, pom_rules

DRIVERS = 19


def star() -> Network:
    """Many masses drive one."""
    masses = tuple(Mass(f"g{i}", MassKind.GATE, 0, 3.0, -2.75, 0.0, 0.0, 0.0) for i in range(DRIVERS + 1))
    couplings = tuple(Coupling(f"g{i}", "g0", 0.3, 0.3) for i in range(1, DRIVERS + 1))
    return Network("star", "parametron", Dynamics(0.05, 0.25, 1.0, 10.0, 3), masses, couplings, (), (), (), None, 4)


def test_a_huge_fan_in_is_owned_up_to_with_its_hub() -> None:
    """A hub holds one item a side and plate; every input beyond that is listed, none is dropped in silence."""
    network = star()
    rules = pom_rules(network)
    placement, layout = place_and_route(network, SQUARE, (), rules, 1)
    room = 2 * len(rules.link_plates)
    assert len(layout.couplers) == room
    assert {leaf.coupling for leaf in layout.couplers} | {name for name, _ in layout.unrealised} == {
        coupling.name for coupling in network.couplings
    }
    assert len(layout.unrealised) == DRIVERS - room
    assert all(f"hub of g0 holds at most {room}" in reason for _, reason in layout.unrealised)
    found = check_layout(network, placement, layout, rules)
    left_out = {name for name, _ in layout.unrealised}
    assert {item.names[0] for item in found if item.rule == "coupler"} == left_out
    assert {item.names[0] for item in found if item.rule != "coupler"} <= {name.partition("->")[0] for name in left_out}


@pytest.mark.parametrize("boundary", [((0, 0), (0, 1), (2000, 1), (2000, 0)), ((0, 0), (0, 2000), (1, 2000), (1, 0))])
def test_a_sliver_of_a_boundary_is_refused_and_the_reason_told(boundary: tuple[tuple[int, int], ...]) -> None:
    network = star()
    with pytest.raises(SignoffError, match=r"star: no lattice of 21 slots fits the boundary") as caught:
        place_and_route(network, boundary, (), pom_rules(network), 1)
    assert caught.value.picture is not None
    assert b"<svg" in caught.value.picture.data
