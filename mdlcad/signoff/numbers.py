"""From measured flexures to the numbers of the network's model: stiffnesses, biases and what is beyond them.

Lengths in mm, forces in N on the one side; on the other everything in units of X0, S0 and F0 = S0 X0 of the process, as
in ``network.model`` and ``simulation.devices``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mdlcad.mechanics.fillet import shear_length, shortening
from mdlcad.mechanics.fit import Scale, in_row
from mdlcad.mechanics.flexure import Chain, Sheet, deflect, signal_matrix
from mdlcad.mechanics.frame import TURN, Array, X, dof
from mdlcad.mechanics.leaves import LargeLeaf, LeafKind, higher_terms
from mdlcad.mechanics.reduced import UnitNumbers
from mdlcad.mechanics.series import SpringPlan, frame_of, spring_stiffness
from mdlcad.mechanics.strains import cases_of
from mdlcad.mechanics.unit import end_block_give
from mdlcad.signoff.measure import BeamSeen, UnitSeen, widened


@dataclass(frozen=True, slots=True)
class SpringNumbers:
    """A coupler or rocker: c, the stiffness that it adds to its two ends, and Q, C, B of ``simulation.devices``."""

    strength: float
    self_source: float
    self_target: float
    apart: float
    together: float
    skew: float


Bound = tuple[float, float, float]
"""A bound of friction over x: f + f' x + f'' x^2, nowhere less than what it bounds."""


@dataclass(frozen=True, slots=True)
class BiasNumbers:
    """A bias leaf: q, and the terms of second to fourth order in x that it adds to its mass.

    Attributes:
        rub: force of its eye on its post times the share of the shuttle's motion by which they slide on each other,
            in F0: times the coefficient of friction it is what the shuttle feels.
    """

    bias: float
    stiffness: float
    cubic: float
    quartic: float
    rub: Bound


def unit_numbers(seen: UnitSeen, sheet: Sheet, beams: float = 0.0, leaves: float = 0.0) -> UnitNumbers:
    """The law's numbers of a unit as drawn, or with its beams and the leaves of its series spring thicker.

    Beams of a side are in parallel, both sides and the series spring in a row in x. Beams that differ count by the sum
    of their stiffnesses.

    Args:
        beams, leaves: extra thickness, mm.
    """

    def less(beam: BeamSeen) -> tuple[float, float]:
        wall = beam.wall + beams
        taken = [shortening(wall, widened(root, beams)) for root in beam.roots]
        return sum(bend for bend, _ in taken) - shear_length(wall, beam.span), sum(stretch for _, stretch in taken)

    def bending(side: Sequence[BeamSeen]) -> float:
        return sum(
            sheet.modulus * sheet.depth * ((beam.wall + beams) / (beam.span - less(beam)[0])) ** 3 for beam in side
        )

    def stretching(side: Sequence[BeamSeen]) -> float:
        return sum(sheet.modulus * sheet.depth * (beam.wall + beams) / (beam.span - less(beam)[1]) for beam in side)

    count = len(seen.left)
    span = float(np.mean([beam.span - less(beam)[0] for beam in (*seen.left, *seen.right)]))
    across = bending(seen.left) + bending(seen.right)
    one = across * span**3 / (24.0 * count)
    turn = sum(
        stretching([beam]) * beam.y**2 + bending([beam]) * (beam.span - less(beam)[0]) ** 2 / 3.0 for beam in seen.right
    )
    plan = seen.plan
    thick = SpringPlan(
        tuple((x, above + leaves, below + leaves) for x, above, below in plan.near),
        tuple((x, above + leaves, below + leaves) for x, above, below in plan.far),
        plan.stem + leaves,
        plan.truss + leaves,
        plan.height,
        max(0.0, plan.fillet - leaves / 2.0),
        plan.block,
        plan.clock,
    )
    spring = spring_stiffness(frame_of(thick, sheet), bending(seen.right), turn)
    stretch, heights = sheet.modulus * sheet.depth, [beam.y for beam in seen.right]
    block = end_block_give(stretch, 2.0 * plan.block, plan.stem, heights)
    axial = 1.0 / (1.0 / stretching(seen.left) + 1.0 / stretching(seen.right) + block + 1.0 / spring.push)
    return UnitNumbers(count, span, one, axial, spring.across)


@dataclass(frozen=True, slots=True)
class LeafLaw:
    """A coupler or rocker by itself: N/mm at its hub's end, across, at its far end; Q, C, B in N/mm^3 and N/mm^2."""

    own: float
    across: float
    far: float
    quartic: float
    common: float
    skew: float


def leaf_law(chain: Chain, kind: LeafKind, throw: float) -> LeafLaw:
    """What a coupler or rocker does; ``throw``: the largest displacement of either end, mm.

    Raises:
        ArithmeticError: it finds no equilibrium at its farthest.
    """
    matrix = signal_matrix(chain)
    own, across, far = float(matrix[0, 0]), float(matrix[0, 1]), float(matrix[1, 1])
    terms = higher_terms(LargeLeaf(chain), kind, own, across, cases_of(kind, throw, 0.0))
    return LeafLaw(own, across, far, terms.quartic, terms.common, terms.skew)


def spring_numbers(law: LeafLaw, carrier: float, scale: Scale) -> SpringNumbers:
    """A coupler or rocker in a row with its carrier (N/mm), which gives way under its far end, the source's.

    Exact for what is linear; what is beyond takes place in the share of the motion that the flexure itself makes.
    """
    row = in_row(law.own, law.across, law.far, carrier)
    stiff = scale.length**2 / scale.stiffness
    return SpringNumbers(
        strength=-row.strength / scale.stiffness,
        self_source=row.source / scale.stiffness,
        self_target=row.target / scale.stiffness,
        apart=law.quartic * row.share**4 * stiff,
        together=law.common * row.share**4 * stiff,
        skew=law.skew * row.share**3 * scale.length / scale.stiffness,
    )


_POINTS = 9


def bias_numbers(chain: Chain, offset: float, throw: float, scale: Scale, post_radius: float) -> BiasNumbers:
    """A bias leaf whose post stands ``offset`` mm above the row: its force on the shuttle over +-``throw`` mm.

    Where the eye bears on the post it moves with the eye: along its slot, and around the post as the leaf turns.

    Raises:
        ArithmeticError: it finds no equilibrium there.
    """
    large = LargeLeaf(chain)
    at = np.linspace(-throw, throw, _POINTS)
    poses = [large.at(float(y) - offset, 0.0) for y in at]
    force: Array = np.array([large.hold(pose) for pose in poses]) / scale.force
    eye: Array = np.array(
        [(pose.displacements[dof(chain.right, X)], pose.displacements[dof(chain.right, TURN)]) for pose in poses]
    )
    x = at / scale.length
    q, stiffness, cubic, quartic = np.polynomial.polynomial.polyfit(x, force, 3)
    along, turn = np.gradient(eye, at, axis=0).T
    # a leaf that pulls its shuttle up bears on the post from above, at its top
    slip = np.abs(along + np.sign(force) * post_radius * turn)
    rub = _bound(x, np.abs(force) * slip)
    return BiasNumbers(float(q), float(stiffness), float(cubic), float(quartic), rub)


def _bound(x: Array, values: Array) -> Bound:
    """The parabola that comes nearest to ``values``, lifted until it is nowhere less."""
    fitted = np.polynomial.polynomial.polyfit(x, values, 2)
    fitted[0] += float(np.max(values - np.polynomial.polynomial.polyval(x, fitted)))
    return float(fitted[0]), float(fitted[1]), float(fitted[2])


def post_rub(chain: Chain, law: LeafLaw, scale: Scale, post_radius: float) -> float:
    """Of a rocker: force on its post times how fast its eye rubs there, in F0, for x + x' = 1 and ends moving apart.

    For ends at y and y' the post is pressed by (own + across) y + (far + across) y', and the eye turns with y - y'
    (docs/mechanics.md); its carrier's give only lessens that.
    """
    if chain.eye is None:
        raise ValueError("a coupler has no eye")
    turn = abs(float(deflect(chain, 1.0, 0.0).displacements[dof(chain.eye, TURN)]))
    pressed = (max(law.own, law.far) + law.across) / scale.stiffness
    return pressed * turn * post_radius
