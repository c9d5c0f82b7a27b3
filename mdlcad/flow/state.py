"""What a build knows so far."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import TypeVar

from mdlcad.flow.earlier import EarlierBuild
from mdlcad.flow.outline import Outline
from mdlcad.language import Device
from mdlcad.mapping import Library
from mdlcad.mechanics import Process, Sizing
from mdlcad.mechanics.compensation import Compensation
from mdlcad.mechanics.drive import DriveLoads
from mdlcad.network.model import Network
from mdlcad.parts.body import Body
from mdlcad.parts.stiffness import CarrierStiffness
from mdlcad.placement.placement import Placement
from mdlcad.placement.placers import ANNEAL, Placer
from mdlcad.placement.unit_grid import GridPlacement
from mdlcad.proof.outcome import Proof
from mdlcad.report.report import Search
from mdlcad.routing.decks import process_of
from mdlcad.routing.driver import SMALLEST, Size
from mdlcad.routing.layout import Layout
from mdlcad.signoff.extraction import BuiltDevice
from mdlcad.signoff.lvs import LvsResult
from mdlcad.signoff.margins import Margins
from mdlcad.signoff.mixtures import Mixtures
from mdlcad.signoff.summary import DesignRules
from mdlcad.signoff.tilting import TiltingProof
from mdlcad.synthesis.netlist import Netlist

T = TypeVar("T")


class Outlines(StrEnum):
    """What DXF files draw: parts as designed, or what the cutter's middle has to follow to leave them so."""

    AS_DESIGNED = "as designed"
    KERF = "kerf"


@dataclass(frozen=True, slots=True)
class Job:
    """What was asked for.

    Attributes:
        source: the MDL file; None if the build starts from the artefacts of a folder.
        folder: where this build writes; moved to its place when it is whole.
        workers: how many processors may be used; never changes a result.
        size: how large the device may be.
        placer: decides who sits where. seeds: how many seeds placement tries, from ``seed`` on.
        like: the build that this one is to be like.
    """

    source: Path | None
    cells: Library
    process: Process
    seed: int
    folder: Path
    workers: int
    size: Size = SMALLEST
    outlines: Outlines = Outlines.AS_DESIGNED
    placer: Placer = ANNEAL
    seeds: int = 1
    like: EarlierBuild | None = None

    @property
    def kerf_mm(self) -> float:
        """Kerf that DXF files allow for."""
        return self.process.machine.kerf if self.outlines is Outlines.KERF else 0.0


@dataclass(frozen=True, slots=True)
class State:
    """The artefacts made so far, each by the step of its name; a step returns a new state.

    Attributes:
        grid: what the placement is with a library that has no parts yet.
        search: how the placement was found.
        sizing: from the step "compensation" on, with the preloads that it solved.
        guide, files, pictures: paths in the folder, of the assembly guide, the files for other programs and the views.
    """

    device: Device | None = None
    outline: Outline | None = None
    netlist: Netlist | None = None
    network: Network | None = None
    proof: Proof | None = None
    sizing: Sizing | None = None
    placement: Placement | None = None
    grid: GridPlacement | None = None
    search: Search | None = None
    layout: Layout | None = None
    compensation: Compensation | None = None
    bodies: tuple[Body, ...] | None = None
    carriers: tuple[CarrierStiffness, ...] = ()
    rules: DesignRules | None = None
    drive: DriveLoads | None = None
    guide: tuple[str, ...] = ()
    files: tuple[str, ...] = ()
    pictures: tuple[str, ...] = ()
    lvs: LvsResult | None = None
    extracted: Proof | None = None
    tilting: TiltingProof | None = None
    built: BuiltDevice | None = None
    mixtures: Mixtures | None = None
    margins: Margins | None = None


def narrowed(state: State, fields: tuple[str, ...]) -> State:
    """A state that holds nothing but ``fields``: what a step does not say that it needs, it does not see."""
    return replace(State(), **{field: getattr(state, field) for field in fields})


def joined(state: State, result: State, fields: tuple[str, ...]) -> State:
    """``state`` with ``fields`` as they are in ``result``."""
    return replace(state, **{field: getattr(result, field) for field in fields})


def need(artefact: T | None) -> T:
    """The artefact, which an earlier step of the list has made (``check_order`` proves that of the list)."""
    if artefact is None:
        raise AssertionError("a step ran before the one that makes what it needs")
    return artefact


def stacked(process: Process, state: State) -> Process:
    """The process with as many decks as the device has."""
    return process_of(process, need(state.placement))
