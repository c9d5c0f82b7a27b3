"""Routing: carriers, couplers, bias leaves and tabs for a placed network, and the checker of what came out."""

from mdlcad.routing.driver import find_lack, place_and_route
from mdlcad.routing.router import route

__all__ = ["find_lack", "place_and_route", "route"]
