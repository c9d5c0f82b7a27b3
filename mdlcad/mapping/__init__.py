"""Netlist to a network of threshold-gate masses, by a cell library."""

from mdlcad.mapping.library import Library, load_library
from mdlcad.mapping.mapper import Effort, map_netlist

__all__ = ["Effort", "Library", "load_library", "map_netlist"]
