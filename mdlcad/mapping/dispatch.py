"""One way in for every kind of cell library: the file says which kind it is."""

from __future__ import annotations

from mdlcad.mapping import library as parametron
from mdlcad.mapping import mapper
from mdlcad.mapping.two_phase import TwoPhaseLibrary, liberty, load_two_phase, map_two_phase
from mdlcad.mapping.two_phase.load import library_kind
from mdlcad.network.model import Network
from mdlcad.synthesis.netlist import Netlist

Library = parametron.Library | TwoPhaseLibrary


def load_library(name_or_path: str) -> Library:
    """The library of that name in ``cells/``, or the one in the folder or TOML file at that path.

    Raises:
        UsageError: no such library, or its file is not a valid library; names the file and the key.
    """
    if library_kind(name_or_path) == "two_phase":
        return load_two_phase(name_or_path)
    return parametron.load_library(name_or_path)


def map_netlist(netlist: Netlist, library: Library, effort: mapper.Effort | None = None) -> Network:
    """Map ``netlist`` to masses and springs of ``library``.

    The result is a function of the arguments alone; ``effort`` is for the parametron mapper alone.

    Raises:
        UsageError: the device needs more than the library allows; says what.
    """
    if isinstance(library, TwoPhaseLibrary):
        return map_two_phase(netlist, library)
    return mapper.map_netlist(netlist, library, effort or mapper.Effort())


def liberty_view(library: Library) -> str | None:
    """The Liberty text that logic synthesis sees of ``library``; None if it is mapped without."""
    return liberty(library) if isinstance(library, TwoPhaseLibrary) else None
