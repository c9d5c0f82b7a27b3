"""Placement: a lattice of unit slots inside the boundary, and who sits where."""

from mdlcad.placement.placer import place
from mdlcad.placement.ports import PortPlace

__all__ = ["PortPlace", "place"]
