"""Compensation, once carriers are known: couplers and preloads solved so that masses have what the network asks for.

A routed carrier gives way: its coupler is weaker, and so are its self terms. The coupler is drawn stiffer for it, with
lower legs on the same length, in steps and as far as its strain allows; and for what tilting shuttles take of it, half
way between none and all (``lean``). Then every unit's preload is solved with the
springs that this leaves. Sizing keeps room for every preload down to that of the softest carriers allowed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from mdlcad.artefact import load
from mdlcad.errors import UsageError
from mdlcad.mechanics.findings import Finding, findings_of
from mdlcad.mechanics.lean import NO_LIFTS, Lifts, middle_factors
from mdlcad.mechanics.leaves import LeafSize, stiffened, trim
from mdlcad.mechanics.preload import COUPLER_STEP, RIGID_CARRIER, compensator, leaf_in_row, self_terms
from mdlcad.mechanics.process import Process
from mdlcad.mechanics.sizes import CouplerSize, UnitSize
from mdlcad.mechanics.sizing import Sizing, coupler_size
from mdlcad.mechanics.strains import cases_of, unit_strains
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
class CouplerCompensation:
    """How one coupler makes up for its carrier.

    Attributes:
        carrier: its stiffness, N/mm; asked: the network's strength; given: what the carrier would leave of the
            coupler as sized; left: what it leaves of the coupler as drawn, ``size``.
    """

    carrier: float
    asked: float
    given: float
    left: float
    size: CouplerSize


@dataclass(frozen=True, slots=True)
class Compensation:
    """The artefact compensation.json.

    Attributes:
        strain_peak, strain_settled: of the series springs, with these preloads.
        findings: of sizes and preloads, with these preloads.
    """

    units: tuple[UnitCompensation, ...]
    couplers: tuple[CouplerCompensation, ...]
    strain_peak: float
    strain_settled: float
    findings: tuple[Finding, ...]


def compensate(
    network: Network, process: Process, sizing: Sizing, carriers: Mapping[str, float], lifts: Lifts = NO_LIFTS
) -> Compensation:
    """Solve every coupler's stiffness and every unit's preload.

    Args:
        sizing: as ``size`` made it; carriers: N/mm, by coupling; lifts: how high its flexures pull at shuttles.

    Raises:
        UsageError: the beams of the process find no equilibrium at these preloads.
        ArithmeticError: a unit has no preload that does it.
    """
    law, series = sizing.law, sizing.series
    peaks = {unit.mass: unit.amplitude / process.unit.throw_unit for unit in sizing.units}
    steps, least = (_steps(network, sizing, carriers, above) for above in (lifts, NO_LIFTS))
    known: dict[tuple[LeafSize, int], LeafSize] = {}
    couplers = _couplers(network, process, sizing, carriers, steps, known)
    springs = self_terms(network, [item.size for item in couplers], sizing.biases, law, carriers)
    solver = compensator(network, process, law, series, peaks, springs)
    preloads = solver.preloads(springs)
    # what is drawn stiffer for tilting shuttles asks for more preload: no more of it than the units have room for
    while steps != (steps := _eased(network, sizing, preloads, couplers, least)):
        couplers = _couplers(network, process, sizing, carriers, steps, known)
        springs = self_terms(network, [item.size for item in couplers], sizing.biases, law, carriers)
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
    draft = Compensation(tuple(units), couplers, trim(strains.peak), trim(strains.settled), ())
    new = compensated(sizing, draft)
    found = findings_of(network, process, law, new.series, new.units, new.couplers, sizing.biases, sizing.rules)
    return replace(draft, findings=found)


def _under(network: Network, carriers: Mapping[str, float]) -> list[float]:
    """Stiffness of the carrier under every coupling, N/mm."""
    return [min(carriers.get(coupling.name, RIGID_CARRIER), RIGID_CARRIER) for coupling in network.couplings]


def _steps(network: Network, sizing: Sizing, carriers: Mapping[str, float], lifts: Lifts) -> list[int]:
    """By how many steps every coupler is to be stiffer than sized."""
    leaves, under = [part.leaf for part in sizing.couplers], _under(network, carriers)
    factors = middle_factors(network, leaves, under, sizing.biases, sizing.law, lifts)
    # a carrier no stiffer than its coupler is beyond help, and an error of the design rules
    return [
        round((float(factor) - 1.0) / COUPLER_STEP) if carrier > 2.0 * leaf.own else 0
        for factor, carrier, leaf in zip(factors, under, leaves, strict=True)
    ]


def _eased(
    network: Network,
    sizing: Sizing,
    preloads: Mapping[str, float],
    couplers: Sequence[CouplerCompensation],
    least: Sequence[int],
) -> list[int]:
    """The steps of ``couplers`` as drawn, one less at units with more preload than room, not fewer than ``least``."""
    tight = {unit.mass for unit in sizing.units if preloads[unit.mass] > unit.room[1]}
    steps = []
    for coupling, part, found, low in zip(network.couplings, sizing.couplers, couplers, least, strict=True):
        drawn = round((found.size.leaf.own / part.leaf.own - 1.0) / COUPLER_STEP)
        less = drawn > low and (coupling.source in tight or coupling.target in tight)
        steps.append(drawn - 1 if less else drawn)
    return steps


def _couplers(
    network: Network,
    process: Process,
    sizing: Sizing,
    carriers: Mapping[str, float],
    steps: Sequence[int],
    known: dict[tuple[LeafSize, int], LeafSize],
) -> tuple[CouplerCompensation, ...]:
    law = sizing.law
    found = []
    under = _under(network, carriers)
    for coupling, part, carrier, step in zip(network.couplings, sizing.couplers, under, steps, strict=True):
        leaf = part.leaf
        drawn = coupler_size(coupling, _stiffer(leaf, step, known, process, sizing), process, law)
        found.append(
            CouplerCompensation(
                trim(carrier),
                coupling.strength,
                trim(part.strength * leaf_in_row(leaf, carrier).share),
                trim(drawn.strength * leaf_in_row(drawn.leaf, carrier).share),
                drawn,
            )
        )
    return tuple(found)


def _stiffer(
    leaf: LeafSize, step: int, known: dict[tuple[LeafSize, int], LeafSize], process: Process, sizing: Sizing
) -> LeafSize:
    """``leaf`` stiffer by so many steps, or by as many as leave it within the limits that it keeps itself."""
    if step == 0:
        return leaf
    if (leaf, step) not in known:
        try:
            cases = cases_of(leaf.kind, sizing.rules.throw, 0.0)
            found = stiffened(leaf, 1.0 + step * COUPLER_STEP, cases, process, sizing.law)
        except ValueError:
            found = replace(leaf, misses=("equilibrium",))
        better = len(found.misses) <= len(leaf.misses)
        known[leaf, step] = found if better else _stiffer(leaf, step - 1, known, process, sizing)
    return known[leaf, step]


def compensated(sizing: Sizing, found: Compensation) -> Sizing:
    """The sizing with the preloads and couplers that were solved, and the strains that go with them.

    Raises:
        UsageError: a unit of the sizing has no preload, or a coupling no coupler; the folder's files contradict.
    """
    solved = {item.mass: item for item in found.units}

    def unit(old: UnitSize) -> UnitSize:
        new = solved.get(old.mass)
        if new is None:
            raise UsageError(
                f"{COMPENSATION_FILE}: has no preload for the unit {old.mass!r} of sizing.json; build it again"
            )
        return replace(old, compensation=0.0 - new.springs, preload=new.preload, strain=new.strain)

    drawn = {item.size.coupling: item.size for item in found.couplers}

    def coupler(old: CouplerSize) -> CouplerSize:
        new = drawn.get(old.coupling)
        if new is None:
            raise UsageError(f"{COMPENSATION_FILE}: has no coupler {old.coupling!r} of sizing.json; build it again")
        return new

    return replace(
        sizing,
        units=tuple(map(unit, sizing.units)),
        couplers=tuple(map(coupler, sizing.couplers)),
        series=replace(sizing.series, strain=found.strain_peak, strain_settled=found.strain_settled),
        findings=found.findings,
    )


def final_sizing(folder: Path) -> Sizing:
    """The sizing of a build folder, compensated if the build went as far.

    Raises:
        UsageError: a file is missing or of another shape, or one contradicts the other.
    """
    sizing = load(folder, "sizing.json", Sizing)
    if not (folder / COMPENSATION_FILE).is_file():
        return sizing
    return compensated(sizing, load(folder, COMPENSATION_FILE, Compensation))
