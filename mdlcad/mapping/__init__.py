"""Netlist to a network of masses and springs, by a cell library of either kind."""

from mdlcad.mapping.dispatch import Library, liberty_view, load_library, map_netlist
from mdlcad.mapping.mapper import Effort

__all__ = ["Effort", "Library", "liberty_view", "load_library", "map_netlist"]
