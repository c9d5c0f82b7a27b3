"""Netlist to a network of masses and springs, by a cell library of either kind."""

from mdlcad.mapping.dispatch import CELLS_FILE, Library, liberty_view, load_library, map_netlist, recorded_library
from mdlcad.mapping.mapper import Effort
from mdlcad.mapping.mend import Before
from mdlcad.mapping.request import MappingRequest

__all__ = [
    "CELLS_FILE",
    "Before",
    "Effort",
    "Library",
    "MappingRequest",
    "liberty_view",
    "load_library",
    "map_netlist",
    "recorded_library",
]
