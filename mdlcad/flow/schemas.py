"""JSON schemas of every artefact, from the types themselves."""

from __future__ import annotations

from typing import Any

import msgspec

from mdlcad.artefact import to_json
from mdlcad.compare.change import Comparison
from mdlcad.compare.history import History
from mdlcad.errors import UsageError
from mdlcad.language import Device
from mdlcad.mapping.cell_library import Library
from mdlcad.mapping.two_phase import TwoPhaseLibrary
from mdlcad.mechanics import Sizing
from mdlcad.mechanics.compensation import Compensation
from mdlcad.mechanics.drive import DriveLoads
from mdlcad.network.model import Network
from mdlcad.parts.store import Parts
from mdlcad.placement.placement import Placement
from mdlcad.placement.unit_grid import GridPlacement
from mdlcad.proof.outcome import Proof
from mdlcad.report.report import Report, Search
from mdlcad.routing.layout import Layout
from mdlcad.scenario.result import ScenarioResult
from mdlcad.signoff.extraction import BuiltDevice
from mdlcad.signoff.lvs import LvsResult
from mdlcad.signoff.margins import Margins
from mdlcad.signoff.mixtures import Mixtures
from mdlcad.signoff.summary import DesignRules
from mdlcad.signoff.tilting import TiltingProof
from mdlcad.synthesis.netlist import Netlist

ARTEFACTS: dict[str, Any] = {
    "device": Device,
    "netlist": Netlist,
    "network": Network,
    "proof": Proof,
    "sizing": Sizing,
    "placement": Placement,
    "placement-on-grid": GridPlacement,
    "cells-parametron": Library,
    "cells-two_phase": TwoPhaseLibrary,
    "search": Search,
    "layout": Layout,
    "compensation": Compensation,
    "parts": Parts,
    "drc": DesignRules,
    "drive": DriveLoads,
    "extraction": tuple[LvsResult, Proof],
    "built": BuiltDevice,
    "tilting": TiltingProof,
    "mixtures": Mixtures,
    "margins": Margins,
    "report": Report,
    "result": ScenarioResult,
    "diff": Comparison,
    "history": History,
}


def schema(name: str) -> bytes:
    """The JSON schema of the artefact NAME.json.

    Raises:
        UsageError: there is no such artefact.
    """
    if name not in ARTEFACTS:
        raise UsageError(f"no artefact '{name}'; the artefacts are {', '.join(sorted(ARTEFACTS))}")
    return to_json(msgspec.json.schema(ARTEFACTS[name]))
