"""Preloads: what the springs at every mass add to it, and the preload with which its unit makes up for that."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from mdlcad.errors import UsageError
from mdlcad.mechanics.fit import InRow, Scale, UnitCurve, in_row
from mdlcad.mechanics.leaves import LeafKind, LeafSize
from mdlcad.mechanics.process import Process
from mdlcad.mechanics.reduced import sized_numbers
from mdlcad.mechanics.series import SeriesSpring
from mdlcad.mechanics.sizes import BiasSize, CouplerSize
from mdlcad.mechanics.strains import reach_at
from mdlcad.mechanics.unit import UnitLaw, clock_swing
from mdlcad.network.model import Network

COUPLER_STEP = 0.04
"""Steps of stiffness, relative, in which couplers are drawn stiffer to make up for their carriers' give. A finer one
would leave less (here at most half of it, where strain allows it) and make more parts that differ."""

TILT_STEPS = 2.0
"""Steps by which the couplers of a mass may be stiffer, on average, because shuttles tilt (``lean``): their self terms
ask for more preload, and units have room for this much of it, as far as their series springs allow."""

RIGID_CARRIER = 1e9
"""N/mm of a carrier that is not known yet, or of none."""


def leaf_in_row(leaf: LeafSize, carrier: float) -> InRow:
    """A coupler or rocker as sized in a row with its carrier, N/mm."""
    across = leaf.coupling if leaf.kind is LeafKind.ROCKER else -leaf.coupling
    return in_row(leaf.own, across, leaf.own, min(carrier, RIGID_CARRIER))


def self_terms(
    network: Network,
    couplers: Sequence[CouplerSize],
    biases: Sequence[BiasSize],
    law: UnitLaw,
    carriers: Mapping[str, float],
) -> dict[str, float]:
    """Sum of the self terms of the parts that are built at every mass, in units of S0.

    Args:
        carriers: stiffness of the carrier under each coupling's far end, N/mm; rigid where there is none.
    """
    total = {mass.name: 0.0 for mass in network.masses}
    for coupling, coupler in zip(network.couplings, couplers, strict=True):
        row = leaf_in_row(coupler.leaf, carriers.get(coupling.name, RIGID_CARRIER))
        total[coupling.source] += row.source / law.stiffness_unit
        total[coupling.target] += row.target / law.stiffness_unit
    for bias in biases:
        total[bias.mass] += bias.self_stiffness
    return total


def most_self_terms(
    network: Network,
    couplers: Sequence[CouplerSize],
    biases: Sequence[BiasSize],
    law: UnitLaw,
    ratio: float,
    steps: float = 0.0,
) -> dict[str, float]:
    """The same with couplers drawn stiffer for carriers that are rigid, or ``ratio`` times as stiff as they: the more.

    Over a carrier of K a coupler is drawn 1 / (1 - s / K) times as stiff, to half a step. With that its source gets
    what it was sized for, but the target of a rocker more: s f - c^2 f^2 / (K + f s), and its c is less than its s.
    ``steps`` are added to that.
    """
    total = {mass.name: 0.0 for mass in network.masses}
    for coupling, coupler in zip(network.couplings, couplers, strict=True):
        leaf = coupler.leaf
        rows = []
        for carrier, ideal in ((RIGID_CARRIER, 1.0), (ratio * leaf.own, 1.0 / (1.0 - 1.0 / ratio))):
            factor = ideal + (0.5 + steps) * COUPLER_STEP
            rows.append(in_row(factor * leaf.own, factor * leaf.coupling, factor * leaf.own, carrier))
        total[coupling.source] += max(row.source for row in rows) / law.stiffness_unit
        total[coupling.target] += max(row.target for row in rows) / law.stiffness_unit
    for bias in biases:
        total[bias.mass] += bias.self_stiffness
    return total


@dataclass(frozen=True, slots=True)
class Compensator:
    """Solves preloads: ``asked`` is the network's k at p = 1 of every mass."""

    asked: dict[str, float]
    curve: UnitCurve

    def preloads(self, springs: Mapping[str, float]) -> dict[str, float]:
        """The preload of every unit, mm, with which unit and ``springs`` (by mass, S0) together have the k asked for.

        Raises:
            ArithmeticError: there is none near to what the first term of the law says.
        """
        return {name: round(self.curve.preload_for(asked - springs[name]), 4) for name, asked in self.asked.items()}


def compensator(
    network: Network,
    process: Process,
    law: UnitLaw,
    series: SeriesSpring,
    peaks: Mapping[str, float],
    springs: Mapping[str, float],
) -> Compensator:
    """What solves the preloads of units of this law, with springs of about ``springs`` (by mass, S0).

    Args:
        peaks: largest |x| of every mass in simulation.

    Raises:
        UsageError: the beams of the process find no equilibrium at these preloads.
    """
    asked = {mass.name: mass.k0 + mass.k1 for mass in network.masses}
    # the first term of the law, docs/mechanics.md, and a unit of k to either side
    first = [law.stroke_per_k * (process.unit.kappa0 - asked[name] + springs[name]) for name in asked]
    least, most = min(first) - law.stroke_per_k, max(first) + law.stroke_per_k
    reaches = [process.unit.throw_unit * max(reach_at(network, peaks, p).values()) for p in (0.0, 1.0, 2.0)]
    try:
        curve = UnitCurve(
            sized_numbers(process, law, series),
            clock_swing(network, law),
            reaches,
            Scale(law.stiffness_unit, process.unit.throw_unit),
            least,
            most,
        )
    except ArithmeticError as error:
        raise UsageError(
            f"process {process.name}: unit: with preloads of {least:.2f} to {most:.2f} mm {error}; a stiffer series "
            "spring (fewer series_leaves) or a smaller throw_unit would do"
        ) from error
    return Compensator(asked, curve)


def room_for(least: float, most: float) -> tuple[float, float]:
    """The least and most preload that a slot holds room for, with what rounding takes."""
    return math.floor(min(least, most) * 1e4) / 1e4, math.ceil(max(least, most) * 1e4) / 1e4
