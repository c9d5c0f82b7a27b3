"""The reduced models of parts, beyond their first term: what one spring or one potential leaves out.

A unit's beam is a beam-column. With p = P l^2 / (E I), P its compression, a guided beam's stiffness and shortening are

    K(P) = E I / l^3 (12 - 6/5 p - p^2 / 700),   e = A^2 / (2 l) (6/5 + p / 350),

the expansion of the exact transcendental law to second order (S. Awtar, A. H. Slocum and E. Sevincer, Characteristics
of Beam-Based Flexure Modules, J. Mech. Des. 129 (2007); its beam constraint model). Without the terms in p^2 and with
P eliminated, this is the potential of ``docs/mechanics.md``. The end block gives way in y as well, and with it goes
the right beams' force.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from mdlcad.mechanics.frame import TURN, Array, Frame, X, Y, dof
from mdlcad.mechanics.leaves import LeafKind, LeafSize
from mdlcad.mechanics.process import Process
from mdlcad.mechanics.series import SeriesSpring, spring_frame
from mdlcad.mechanics.unit import UnitLaw


def block_stiffness(process: Process, series: SeriesSpring) -> float:
    """Stiffness of the end block in y, N/mm: the folded spring alone; the pair of beams keeps it from turning."""
    made = spring_frame(process, series.wall, series.height, series.clear)
    pin = [dof(made.pin, i) for i in (X, Y, TURN)]
    return float(Frame(made.nodes, made.beams).condense([dof(0, Y)], [*pin, dof(0, TURN)])[0, 0])


def unit_force(process: Process, law: UnitLaw, series: SeriesSpring, clock: float, displacement: Array) -> Array:
    """Force in N that holds a shuttle at each of ``displacement`` (mm), its clock pushed in by ``clock`` mm."""
    unit, across = process.unit, block_stiffness(process, series)
    bending = law.beam_stiffness * unit.span**3 / (24.0 * unit.beams)  # E I of one beam
    axial = 1.0 / (1.0 / law.beams_axial + 1.0 / series.stiffness)

    def side(push: float) -> float:
        p = push / unit.beams * unit.span**2 / bending
        return unit.beams * bending / unit.span**3 * (12.0 - 1.2 * p - p * p / 700.0)

    def force(a: float) -> float:
        def excess(push: float) -> float:
            p = push / unit.beams * unit.span**2 / bending
            right = a / (1.0 + side(push) / across)  # the right beams' part of it; the end block takes the rest
            shortening = (a**2 + right**2) / (2.0 * unit.span) * (1.2 + p / 350.0)
            return push - axial * (clock - shortening)

        reach = axial * (abs(clock) + 2.0 * a**2 / unit.span) + 1.0
        push = float(brentq(excess, -2.0 * reach, 2.0 * reach, xtol=1e-9))
        stiffness = side(push)
        return (stiffness + stiffness / (1.0 + stiffness / across)) * a

    return np.array([force(float(a)) for a in displacement])


def leaf_force(leaf: LeafSize, left: Array, right: Array) -> Array:
    """Force in N on the left end of a flexure whose ends are at ``left`` and ``right`` (mm, each of the same shape)."""
    apart, sum_ = left - right, left + right
    if leaf.kind is LeafKind.ROCKER:
        even = leaf.skew * (apart**2 + 2.0 * sum_ * apart)
        return leaf.own * left + leaf.coupling * right + leaf.quartic * apart**3 + leaf.common * sum_**3 + even
    return leaf.own * apart + leaf.quartic * apart**3 + leaf.skew * apart**2
