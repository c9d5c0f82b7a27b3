"""One way in for every kind of cell library: the file says which kind it is."""

from __future__ import annotations

from pathlib import Path

import msgspec

from mdlcad.artefact import load
from mdlcad.errors import UsageError
from mdlcad.mapping import cell_library as parametron
from mdlcad.mapping import mapper
from mdlcad.mapping.liberty import threshold_liberty
from mdlcad.mapping.mend import Before
from mdlcad.mapping.request import AS_WRITTEN, MappingRequest
from mdlcad.mapping.two_phase import TwoPhaseLibrary, liberty, load_two_phase, map_two_phase
from mdlcad.mapping.two_phase.load import library_kind
from mdlcad.network.model import Network
from mdlcad.synthesis.netlist import Netlist

Library = parametron.Library | TwoPhaseLibrary

CELLS_FILE = "cells.json"
"""In a build folder: the library, with all options of the build."""


class _Kind(msgspec.Struct):
    kind: str


def load_library(name_or_path: str, request: MappingRequest = AS_WRITTEN) -> Library:
    """The library of that name in ``cells/``, or the one in the folder or TOML file at that path.

    Raises:
        UsageError: no such library, its file is not a valid library, or it does not know what is requested; names the
            file and the key, or the option.
    """
    kind = library_kind(name_or_path)
    if kind == "two_phase":
        return load_two_phase(name_or_path, request)
    if kind not in (None, "parametron"):
        raise UsageError(f"{name_or_path}: kind is '{kind}'; the kinds of cell library are parametron and two_phase")
    library = parametron.load_library(name_or_path)
    for option in request.stated():
        raise UsageError(
            f"{option}: the cell library {library.name} has no such option (its gates need neither buffers nor a long "
            "clock, and its file has one set of numbers); leave it out, or use --cells two_phase"
        )
    return library


def recorded_library(folder: Path) -> Library:
    """The library of a build folder, as the build wrote it down with all its options.

    Raises:
        UsageError: the file is missing or is not a library.
    """
    if load(folder, CELLS_FILE, _Kind).kind == "two_phase":
        return load(folder, CELLS_FILE, TwoPhaseLibrary)
    return load(folder, CELLS_FILE, parametron.Library)


def map_netlist(
    netlist: Netlist, library: Library, effort: mapper.Effort | None = None, before: Before | None = None
) -> Network:
    """Map ``netlist`` to masses and springs of ``library``.

    The result is a function of the arguments alone; ``effort`` and ``before`` (a network to be like) are for the
    parametron mapper alone.

    Raises:
        UsageError: the device needs more than the library allows; says what.
    """
    if isinstance(library, TwoPhaseLibrary):
        return map_two_phase(netlist, library)
    return mapper.map_netlist(netlist, library, effort or mapper.Effort(), before)


def liberty_view(library: Library) -> str:
    """The cells of ``library`` as Liberty text.

    Of a two-phase library it is what ABC maps with; of a threshold library the gates that our own mapper chooses from.
    """
    return liberty(library) if isinstance(library, TwoPhaseLibrary) else threshold_liberty(library)
