"""One routed device, made once for all tests."""

from functools import cache

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.placement import Placement
from mdlcad.routing import place_and_route
from mdlcad.routing.layout import Layout
from tests.placement.networks import SQUARE, small


@cache
def good() -> tuple[Network, LayoutRules, Placement, Layout]:
    network, ports, rules = small()
    placement, layout = place_and_route(network, SQUARE, ports, rules, 1)
    return network, rules, placement, layout
