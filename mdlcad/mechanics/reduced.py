"""The reduced models of parts, beyond their first term: what one spring or one potential leaves out.

A unit's beam is a beam-column. With p = P l^2 / (E I), P its compression, a guided beam's stiffness and shortening are

    K(P) = E I / l^3 (12 - 6/5 p - p^2 / 700),   e = A^2 / (2 l) (6/5 + p / 350),

the expansion of the exact transcendental law to second order (S. Awtar, A. H. Slocum and E. Sevincer, Characteristics
of Beam-Based Flexure Modules, J. Mech. Des. 129 (2007); its beam constraint model). Without the terms in p^2 and with
P eliminated, this is the potential of ``docs/mechanics.md``. The end block gives way in y as well, and with it goes
the right beams' force.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlcad.mechanics.frame import TURN, Array, Frame, X, Y, dof
from mdlcad.mechanics.leaves import LeafKind, LeafSize
from mdlcad.mechanics.process import Process
from mdlcad.mechanics.series import SeriesSpring, spring_frame
from mdlcad.mechanics.unit import UnitLaw, flexing_span


def block_stiffness(process: Process, series: SeriesSpring) -> float:
    """Stiffness of the end block in y, N/mm: the folded spring alone; the pair of beams keeps it from turning."""
    made = spring_frame(process, series.wall, series.height, series.clear)
    pin = [dof(made.pin, i) for i in (X, Y, TURN)]
    return float(Frame(made.nodes, made.beams).condense([dof(0, Y)], [*pin, dof(0, TURN)])[0, 0])


_ROUNDS = 200


@dataclass(frozen=True, slots=True)
class UnitNumbers:
    """What the law of a unit needs: mm, N.

    Attributes:
        beams: a side; span: of each, as far as it flexes; bending: E I of each, N mm^2.
        axial: stiffness in x of beams and series spring in a row, N/mm; across: of the end block in y, N/mm.
    """

    beams: int
    span: float
    bending: float
    axial: float
    across: float


def unit_force(process: Process, law: UnitLaw, series: SeriesSpring, clock: float, displacement: Array) -> Array:
    """Force in N that holds a shuttle at each of ``displacement`` (mm), its clock pushed in by ``clock`` mm."""
    return force_of(sized_numbers(process, law, series), clock, displacement)


def sized_numbers(process: Process, law: UnitLaw, series: SeriesSpring) -> UnitNumbers:
    """The law's numbers of every unit as sized."""
    unit, span = process.unit, flexing_span(process).bend
    return UnitNumbers(
        unit.beams,
        span,
        law.beam_stiffness * span**3 / (24.0 * unit.beams),
        1.0 / (1.0 / law.beams_axial + 1.0 / series.stiffness),
        block_stiffness(process, series),
    )


def force_of(numbers: UnitNumbers, clock: float, displacement: Array) -> Array:
    """``unit_force`` of a unit with these numbers.

    The push along the beams depends on itself through the terms of second order only, so it is found by putting it in.

    Raises:
        ArithmeticError: it is not found so.
    """
    scale = numbers.span**2 / (numbers.beams * numbers.bending)

    def side(push: Array) -> Array:
        p = push * scale
        return np.asarray(numbers.beams * numbers.bending / numbers.span**3 * (12.0 - 1.2 * p - p * p / 700.0))

    push = np.full(displacement.shape, numbers.axial * clock)
    for _ in range(_ROUNDS):
        before = push
        right = displacement / (
            1.0 + side(push) / numbers.across
        )  # the right beams' part; the end block takes the rest
        shortening = (displacement**2 + right**2) / (2.0 * numbers.span) * (1.2 + push * scale / 350.0)
        push = numbers.axial * (clock - shortening)
        if np.max(np.abs(push - before), initial=0.0) < 1e-10 * (1.0 + numbers.axial * abs(clock)):
            break
    else:
        raise ArithmeticError("the push of a unit's beams is not found: its end block is too soft")
    stiffness = side(push)
    return (stiffness + stiffness / (1.0 + stiffness / numbers.across)) * displacement


def leaf_force(leaf: LeafSize, left: Array, right: Array) -> Array:
    """Force in N on the left end of a flexure whose ends are at ``left`` and ``right`` (mm, each of the same shape)."""
    apart, sum_ = left - right, left + right
    if leaf.kind is LeafKind.ROCKER:
        even = leaf.skew * (apart**2 + 2.0 * sum_ * apart)
        return leaf.own * left + leaf.coupling * right + leaf.quartic * apart**3 + leaf.common * sum_**3 + even
    return leaf.own * apart + leaf.quartic * apart**3 + leaf.skew * apart**2
