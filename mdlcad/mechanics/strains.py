"""Strains of units over what their shuttles do, and the rule that holds every part's strain against its limit.

All by the large-displacement computation. How far a mass goes is known at the peak of its clock only (``peak`` of the
simulation). At the other clock positions it goes as far as its neighbours, its bias and its sensor can push it
together: to the root of x^3 + k x = force, and a tenth more for what it overshoots.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from scipy.optimize import brentq

from mdlcad.errors import UsageError
from mdlcad.mechanics.beam.unit import beam_strains, spring_strains
from mdlcad.mechanics.fillet import notch_factor
from mdlcad.mechanics.findings import Finding
from mdlcad.mechanics.leaves import LeafKind, LeafSize, large_strain
from mdlcad.mechanics.process import PlateRole, Process
from mdlcad.mechanics.series import SeriesSpring
from mdlcad.mechanics.sizes import BiasSize, CouplerSize
from mdlcad.mechanics.unit import UnitLaw, beam_roots, clock_swing
from mdlcad.network.model import Mass, Network
from mdlcad.proof.prove import SENSOR_FORCE

_OVERSHOOT = 1.1


@dataclass(frozen=True, slots=True)
class UnitStrains:
    """Largest strain of every unit's beams, and of the series spring: settled, and at a peak with its shuttle at 0."""

    beams: dict[str, float]
    settled: float
    peak: float


def unit_strains(
    network: Network,
    process: Process,
    law: UnitLaw,
    series: SeriesSpring,
    preloads: Mapping[str, float],
    peaks: Mapping[str, float],
) -> UnitStrains:
    """Strains of all units.

    Args:
        preloads: mm, by mass; peaks: largest |x| of every mass in simulation.

    Raises:
        UsageError: the beams of the process find no equilibrium at these displacements.
    """
    swing = clock_swing(network, law)
    low, high = min(preloads.values()), max(preloads.values())
    reaches = {p: reach_at(network, peaks, float(p)) for p in (0, 1, 2)}
    # the least compressed unit at the clock's bottom, either in its middle, the most compressed one at its peak
    positions = ((0, low - swing), (1, low), (1, high), (2, low + swing), (2, high + swing))
    beams = dict.fromkeys((mass.name for mass in network.masses), 0.0)
    least = min(min(mass.k0, mass.k0 + 2.0 * mass.k1) for mass in network.masses)
    well = process.unit.throw_unit * math.sqrt(max(0.0, -least))
    try:
        for p, stroke in positions:
            most = process.unit.throw_unit * max(reaches[p].values())
            curve = beam_strains(process, series, stroke, most)
            for name, reach in reaches[p].items():
                beams[name] = max(beams[name], curve.at(process.unit.throw_unit * reach))
        spring = spring_strains(process, series, high + swing, well)
    except ArithmeticError as error:
        raise UsageError(
            f"process {process.name}: unit: at {max(peaks.values()):.2f} times throw_unit its beams find no "
            "equilibrium; a longer span or a smaller throw_unit would do"
        ) from error
    return UnitStrains(beams, spring.settled, spring.peak)


def reach_at(network: Network, peaks: Mapping[str, float], p: float) -> dict[str, float]:
    """Largest |x| of every mass while its clock wave is at ``p`` (0 to 2); at most its peak."""
    if p == 2.0:
        return dict(peaks)
    pushes = {mass.name: abs(mass.bias) for mass in network.masses}
    for port in network.sensors:
        pushes[port.mass] += SENSOR_FORCE
    for coupling in network.couplings:
        pushes[coupling.source] += abs(coupling.strength) * peaks[coupling.target]
        pushes[coupling.target] += abs(coupling.strength) * peaks[coupling.source]
    return {
        mass.name: min(peaks[mass.name], _OVERSHOOT * _pushed_to(mass, p, pushes[mass.name])) for mass in network.masses
    }


def _pushed_to(mass: Mass, p: float, push: float) -> float:
    """The greatest x with x^3 + k x = push."""
    k = mass.k0 + mass.k1 * p
    most = 1.0 + push + math.sqrt(max(0.0, -k)) + abs(k)
    trough = math.sqrt(max(0.0, -k) / 3.0)
    return float(brentq(lambda x: x**3 + k * x - push, trough, most))


def check_strain(
    network: Network,
    process: Process,
    law: UnitLaw,
    series: SeriesSpring,
    preloads: Mapping[str, float],
    peaks: Mapping[str, float],
    couplers: Sequence[CouplerSize],
    biases: Sequence[BiasSize],
    throw: float,
) -> list[Finding]:
    """Rules ``strain``, ``strain_root`` and ``strain_peak``, on every part's large-displacement strain, computed anew.

    The strain is that of the bare wall, at the ends of its fillets; within a fillet it is the notch factor higher
    (``strain_root``), and must be less than what the material bears at a peak.
    """
    material = process.material(process.plates(PlateRole.UNIT)[0])
    sheet = process.material(process.plates(PlateRole.RUNG)[0])
    limit, sheet_limit, fillet = material.strain_limit, sheet.strain_limit, process.machine.fillet
    units = unit_strains(network, process, law, series, preloads, peaks)
    values = [("strain", f"unit.{name}", strain, limit, "of its beams") for name, strain in units.beams.items()]
    values.append(("strain", "unit.series", units.settled, limit, "of the series leaves with settled shuttles"))
    if fillet:
        sides = min(root.sides for beam in range(process.unit.beams) for root in beam_roots(process, beam))
        beam = notch_factor(process.unit.beam_wall, fillet, sides)
        values += [
            ("strain_root", f"unit.{name}", beam * strain, material.strain_peak, "in a fillet of its beams")
            for name, strain in units.beams.items()
        ]
        root = notch_factor(series.wall, fillet) * units.settled
        words = "in a fillet of the series leaves with settled shuttles"
        values.append(("strain_root", "unit.series", root, material.strain_peak, words))
    peak = "of the series leaves if a clock peak finds a shuttle held at 0"
    values.append(("strain_peak", "unit.series", units.peak, material.strain_peak, peak))
    known: dict[tuple[LeafSize, float], float] = {}
    leaves = [(f"coupler.{item.coupling}", item.leaf, 0.0) for item in couplers]
    leaves += [(f"bias.{item.mass}", item.leaf, item.offset) for item in biases]
    for name, leaf, offset in leaves:
        if (leaf, offset) not in known:
            known[leaf, offset] = large_strain(leaf.kind, leaf.shape, cases_of(leaf.kind, throw, offset), process)
        values.append(("strain", name, known[leaf, offset], sheet_limit, f"of the {leaf.kind.value} at its farthest"))
        if leaf.shape.fillet:
            root = notch_factor(leaf.shape.wall, leaf.shape.fillet) * known[leaf, offset]
            values.append(("strain_root", name, root, sheet.strain_peak, f"in a fillet of the {leaf.kind.value}"))
    return [
        Finding(rule, name, value, most, f"{100 * value:.2f} % strain {words}, {100 * most:.2f} % allowed")
        for rule, name, value, most, words in values
        if value > most
    ]


def cases_of(kind: LeafKind, throw: float, offset: float) -> tuple[tuple[float, float], ...]:
    """Deflections (y left, y right), mm, at the ends of what a flexure must bear; ``offset`` of a bias leaf's post."""
    if kind is LeafKind.BIAS:
        return ((throw - offset, 0.0), (-throw - offset, 0.0))
    if kind is LeafKind.ROCKER:
        return ((throw, -throw), (throw, throw), (-throw, -throw))
    return ((throw, -throw),)
