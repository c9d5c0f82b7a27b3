"""Compensation, once carriers are known: every unit's preload solved so that its mass has the k the network asks for.

Sizing solves preloads with rigid carriers and keeps room for those with the softest carriers that are allowed. A routed
carrier gives way: its coupler is weaker, and so are its self terms, and the preload that makes up for them is less.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from mdlcad.artefact import load
from mdlcad.errors import UsageError
from mdlcad.mechanics.findings import Finding, findings_of
from mdlcad.mechanics.leaves import trim
from mdlcad.mechanics.preload import compensator, leaf_in_row, self_terms
from mdlcad.mechanics.process import Process
from mdlcad.mechanics.sizes import UnitSize
from mdlcad.mechanics.sizing import Sizing
from mdlcad.mechanics.strains import unit_strains
from mdlcad.network.model import Network

COMPENSATION_FILE = "compensation.json"


@dataclass(frozen=True, slots=True)
class UnitCompensation:
    """How one unit makes up for the springs at its mass.

    Attributes:
        asked: the network's k at p = 1. springs: what couplers, in a row with their carriers, and bias leaf add, S0.
        preload_sized: solved with rigid carriers, mm; preload: solved with those that were routed, and drawn.
        left: k of unit and springs together less the k asked for, at p = 0, 1 and 2.
        swing: half of the k from p = 0 to p = 2; swing_asked: the network's k1. All units share one stroke, so what
            differs is left.
        quartic: of the unit's law, in units of the network's.
        strain: largest in its beams with this preload.
    """

    mass: str
    asked: float
    springs: float
    preload_sized: float
    preload: float
    left: tuple[float, float, float]
    swing: float
    swing_asked: float
    quartic: float
    strain: float


@dataclass(frozen=True, slots=True)
class CouplerGive:
    """What a ``carrier`` (N/mm) leaves of a coupling: its strength as ``asked`` by the network, and as ``left``."""

    coupling: str
    carrier: float
    asked: float
    left: float


@dataclass(frozen=True, slots=True)
class Compensation:
    """The artefact compensation.json.

    Attributes:
        strain_peak, strain_settled: of the series springs, with these preloads.
        findings: of sizes and preloads, with these preloads.
    """

    units: tuple[UnitCompensation, ...]
    couplers: tuple[CouplerGive, ...]
    strain_peak: float
    strain_settled: float
    findings: tuple[Finding, ...]


def compensate(network: Network, process: Process, sizing: Sizing, carriers: Mapping[str, float]) -> Compensation:
    """Solve every unit's preload.

    Args:
        sizing: as ``size`` made it; carriers: N/mm, by coupling.

    Raises:
        UsageError: the beams of the process find no equilibrium at these preloads.
        ArithmeticError: a unit has no preload that does it.
    """
    law, series = sizing.law, sizing.series
    peaks = {unit.mass: unit.amplitude / process.unit.throw_unit for unit in sizing.units}
    springs = self_terms(network, sizing.couplers, sizing.biases, law, carriers)
    solver = compensator(network, process, law, series, peaks, springs)
    preloads = solver.preloads(springs)
    strains = unit_strains(network, process, law, series, preloads, peaks)
    units = []
    for mass, unit in zip(network.masses, sizing.units, strict=True):
        fit = solver.curve.at(preloads[mass.name])
        k = [springs[mass.name] + fit.base + p * fit.swing for p in (0.0, 1.0, 2.0)]
        first, middle, last = (trim(found - mass.k0 - p * mass.k1) for p, found in enumerate(k))
        units.append(
            UnitCompensation(
                mass.name,
                mass.k0 + mass.k1,
                trim(springs[mass.name]),
                unit.preload,
                preloads[mass.name],
                (first, round(middle, 6), last),
                trim(fit.swing),
                mass.k1,
                trim(fit.quartic),
                trim(strains.beams[mass.name]),
            )
        )
    couplers = []
    for coupling, part in zip(network.couplings, sizing.couplers, strict=True):
        if coupling.name in carriers:
            share = leaf_in_row(part.leaf, carriers[coupling.name]).share
            left = trim(part.strength * share)
            couplers.append(CouplerGive(coupling.name, carriers[coupling.name], coupling.strength, left))
    draft = Compensation(tuple(units), tuple(couplers), trim(strains.peak), trim(strains.settled), ())
    new = compensated(sizing, draft)
    found = findings_of(network, process, law, new.series, new.units, sizing.couplers, sizing.biases, sizing.rules)
    return replace(draft, findings=found)


def compensated(sizing: Sizing, found: Compensation) -> Sizing:
    """The sizing with the preloads that were solved, and the strains that go with them.

    Raises:
        UsageError: a unit of the sizing has no preload; the files of a folder contradict each other.
    """
    solved = {item.mass: item for item in found.units}

    def unit(old: UnitSize) -> UnitSize:
        new = solved.get(old.mass)
        if new is None:
            raise UsageError(
                f"{COMPENSATION_FILE}: has no preload for the unit {old.mass!r} of sizing.json; build it again"
            )
        return replace(old, compensation=0.0 - new.springs, preload=new.preload, strain=new.strain)

    series = replace(sizing.series, strain=found.strain_peak, strain_settled=found.strain_settled)
    return replace(sizing, units=tuple(map(unit, sizing.units)), series=series, findings=found.findings)


def final_sizing(folder: Path) -> Sizing:
    """The sizing of a build folder, compensated if the build went as far.

    Raises:
        UsageError: a file is missing or of another shape, or one contradicts the other.
    """
    sizing = load(folder, "sizing.json", Sizing)
    if not (folder / COMPENSATION_FILE).is_file():
        return sizing
    return compensated(sizing, load(folder, COMPENSATION_FILE, Compensation))
