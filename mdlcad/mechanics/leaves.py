"""Sizes of couplers, rockers and bias leaves: the shortest meander of the template's that keeps all limits.

Linear theory finds the pitch and throws out most candidates; what it leaves is held against the strain limit by the
large-displacement computation (``beam.large``), which is what the strain of a size says.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from scipy.optimize import brentq

from mdlcad.mechanics import flexure
from mdlcad.mechanics.beam.large import LargeFrame, Pose
from mdlcad.mechanics.fillet import notch_factor
from mdlcad.mechanics.flexure import Chain, Deflection, Meander, Sheet
from mdlcad.mechanics.frame import X, Y, dof
from mdlcad.mechanics.process import PlateRole, Process
from mdlcad.mechanics.unit import UnitLaw

_HOPELESS = 1.25
"""A leaf that linear theory strains so many times its limit is not computed at large displacements."""


class LeafKind(StrEnum):
    """COUPLER: positive coupling; ROCKER: negative; BIAS: from a hub to a fixed post."""

    COUPLER = "coupler"
    ROCKER = "rocker"
    BIAS = "bias"


@dataclass(frozen=True, slots=True)
class LeafSize:
    """A sized flexure.

    Attributes:
        shape: the meander (for a rocker, one half of it).
        reach: end to end along x, mm; for a bias leaf to the post's centre.
        coupling: stiffness between its two ends, N/mm (for a bias leaf, to the post).
        own: stiffness it adds to each end by itself (self term), N/mm.
        axial: stiffness in x, N/mm.
        quartic: Q of 1/4 Q d^4, N/mm^3, d being how far its ends are apart in y, so that its force at the worst
            deflection is that of the large-displacement computation.
        common: the same for a rocker whose ends move together: of 1/4 C (yl + yr)^4; 0 for the others.
        skew: what a meander does otherwise upwards than downwards, N/mm^2: B of B (yl + yr) (yl - yr)^2 for a rocker,
            of 1/3 B d^3 for a bias leaf; a coupler is the same both ways.
        strain: largest at any deflection that it must bear, bending and stretching, by the large-displacement
            computation.
        slope, eye_turn, clearance, sweep: at the worst deflection; see ``flexure.Deflection``.
        slot: how far the eye of a bias leaf is drawn in, mm: (least, most); (0, 0) for the others.
        misses: names of the limits that no candidate of the template keeps; empty if all is well.
    """

    kind: LeafKind
    shape: Meander
    reach: float
    coupling: float
    own: float
    axial: float
    quartic: float
    common: float
    skew: float
    strain: float
    slope: float
    eye_turn: float
    clearance: float
    sweep: float
    slot: tuple[float, float]
    misses: tuple[str, ...]


def trim(value: float) -> float:
    """Nine significant digits: what linear algebra libraries differ in is not written to artefacts."""
    return float(f"{value:.9g}")


def eye_radius(process: Process) -> float:
    """Outer radius of an eye, mm."""
    return process.link.post_radius + process.link.post_fit + process.link.eye_wall


def rung_sheet(process: Process) -> Sheet:
    """What couplers are cut from (the lowest rung plate; ``size`` reports rung plates that differ)."""
    plate = process.plates(PlateRole.RUNG)[0]
    material = process.material(plate)
    return Sheet(material.modulus, plate.thickness, material.strain_limit)


def strain_allowed(wall: float, process: Process) -> float:
    """What a flexure's strain may be, at its fillets' ends: within them it is higher, and to stay below the peak's."""
    material, fillet = process.material(process.plates(PlateRole.RUNG)[0]), process.machine.fillet
    if not fillet:
        return material.strain_limit
    return min(material.strain_limit, material.strain_peak / notch_factor(wall, fillet))


def chain_of(kind: LeafKind, shape: Meander, process: Process) -> Chain:
    """The frame of a flexure."""
    sheet = rung_sheet(process)
    if kind is LeafKind.COUPLER:
        return flexure.coupler_chain(shape, sheet)
    if kind is LeafKind.ROCKER:
        return flexure.rocker_chain(shape, sheet, eye_radius(process))
    return flexure.bias_chain(shape, sheet, eye_radius(process))


def size_leaf(
    kind: LeafKind, stiffness: float, cases: tuple[tuple[float, float], ...], process: Process, law: UnitLaw
) -> LeafSize:
    """The shortest meander with that coupling stiffness (N/mm) whose limits hold in every case.

    Args:
        cases: deflections (y left, y right) in mm that it must bear; of a bias leaf, the two ends of its range.

    Of the walls and leg counts of the template, the pitch that gives the stiffness is found by bisection. If none
    keeps all limits, the one that misses the fewest (then the shortest) is returned with their names.
    """
    link, sheet, fillet = process.link, rung_sheet(process), process.machine.fillet
    steps = math.floor((link.wall_max - process.machine.min_wall) / link.wall_step + 1e-9)
    best: LeafSize | None = None
    for legs in link.legs:
        for step in range(steps + 1):
            wall = round(process.machine.min_wall + step * link.wall_step, 6)
            amplitude = (law.shuttle_height - wall) / 2.0
            tightest = wall + 2.0 * fillet  # the fillets of two neighbouring legs meet
            pitch = flexure.pitch_for(_stiffness(kind, wall, legs, amplitude, process), stiffness, tightest, 40.0)
            if pitch is None:
                continue
            found = _examine(kind, Meander(wall, legs, pitch, amplitude, fillet), cases, process, sheet, law)
            if not found.misses or (
                found.misses == ("strain",) and found.strain < _HOPELESS * strain_allowed(wall, process)
            ):
                found = _held_to_strain(found, cases, process, sheet, law)
            if best is None or (len(found.misses), found.reach) < (len(best.misses), best.reach):
                best = found
            if not found.misses:
                break  # a thicker wall makes a longer leaf
    if best is None:
        raise ValueError(f"no meander of the process {process.name} has a stiffness of {stiffness} N/mm")
    if best.misses:
        best = _held_to_strain(best, cases, process, sheet, law)
    return _with_quartic(best, cases, process)


LOWEST_LEGS = 0.3
"""Least amplitude of a meander, as a share of the height it may fill: lower ones are more bridge than leg, and
extraction looks for legs at a fifth of the height."""


def stiffened(
    leaf: LeafSize, factor: float, cases: tuple[tuple[float, float], ...], process: Process, law: UnitLaw
) -> LeafSize:
    """A coupler or rocker ``factor`` times as stiff and as long: the same meander with lower legs.

    The fields ``misses`` and ``strain`` say whether it still keeps all limits in ``cases``.

    Raises:
        ValueError: legs would be too low, or it finds no equilibrium at its farthest.
    """
    shape = leaf.shape

    def excess(amplitude: float) -> float:
        at = _stiffness(leaf.kind, shape.wall, shape.legs, amplitude, process)
        return at(shape.pitch) / (factor * leaf.coupling) - 1.0

    amplitude = round(brentq(excess, LOWEST_LEGS * law.shuttle_height, shape.amplitude, xtol=1e-5), 3)
    found = _examine(leaf.kind, replace(shape, amplitude=amplitude), cases, process, rung_sheet(process), law)
    return _with_quartic(_held_to_strain(found, cases, process, rung_sheet(process), law), cases, process)


def _held_to_strain(
    leaf: LeafSize, cases: tuple[tuple[float, float], ...], process: Process, sheet: Sheet, law: UnitLaw
) -> LeafSize:
    """``leaf`` with its true strain; a bias leaf the way up that its one-sided range strains less.

    A meander with all its legs on one side is stiffer, and more strained, towards one side than the other.
    """
    ways = [leaf]
    if leaf.kind is LeafKind.BIAS:
        turned = replace(leaf.shape, amplitude=-leaf.shape.amplitude)
        ways.append(_examine(leaf.kind, turned, cases, process, sheet, law))
    held, allowed = [], strain_allowed(leaf.shape.wall, process)
    for way in ways:
        strain = large_strain(way.kind, way.shape, cases, process)
        misses = [name for name in way.misses if name != "strain"] + ["strain"] * (strain > allowed)
        held.append(replace(way, strain=trim(strain), misses=tuple(misses)))
    return min(held, key=lambda way: (len(way.misses), way.strain))


class LargeLeaf:
    """A flexure at large displacements, its ends driven in y."""

    def __init__(self, chain: Chain) -> None:
        self.chain = chain
        beams = len(self.chain.frame.beams)
        self._walls = [chain.wall] * self.chain.flexible + [0.0] * (beams - self.chain.flexible)
        self._frame = LargeFrame(self.chain.frame, [4] * self.chain.flexible + [1] * (beams - self.chain.flexible))
        self._pose = self._frame.rest()

    def at(self, left: float, right: float) -> Pose:
        """The equilibrium with its ends at these heights, mm; continues from the last.

        Raises:
            ArithmeticError: there is none.
        """
        self._pose = self._frame.move(self._pose, flexure.driven(self.chain, left, right))
        return self._pose

    def force(self, left: float, right: float) -> float:
        """What holds its left end in y, N."""
        return self.hold(self.at(left, right))

    def hold(self, pose: Pose) -> float:
        """What holds its left end in y in ``pose``, N."""
        return float(pose.reactions[dof(self.chain.left, Y)])

    def strain(self, left: float, right: float) -> float:
        """Largest strain of any wall."""
        return float(self._frame.strains(self.at(left, right), self._walls).max())


def large_strain(kind: LeafKind, shape: Meander, cases: tuple[tuple[float, float], ...], process: Process) -> float:
    """Largest strain of a flexure in any of ``cases`` (as ``size_leaf``); infinite if it has no equilibrium there."""
    leaf = LargeLeaf(chain_of(kind, shape, process))
    try:
        return max(leaf.strain(*case) for case in cases)
    except ArithmeticError:
        return math.inf


def bias_offset(leaf: LeafSize, force: float, process: Process) -> float:
    """How far, mm, a bias leaf must be bent to pull with ``force`` (N, of either sign): solved at large displacements.

    Raises:
        ValueError: it cannot be bent so far.
    """
    large, most = LargeLeaf(chain_of(leaf.kind, leaf.shape, process)), 2.0 * force / leaf.own
    try:
        bent = brentq(lambda d: large.force(float(d), 0.0) - force, *sorted((0.0, most)), xtol=1e-5)
    except (ArithmeticError, ValueError) as error:
        raise ValueError(f"no offset of its post makes the leaf pull with {abs(force):.3f} N") from error
    return float(bent)


def _slot(large: LargeLeaf, ends: tuple[float, float]) -> tuple[float, float]:
    """How far the eye of a bias leaf is drawn in while it is bent between ``ends`` (mm): least and most.

    In truth and as linear theory says, by which it is drawn.
    """
    drawn = []
    for bent in np.linspace(*ends, 9):
        drawn.append(-float(large.at(bent, 0.0).displacements[dof(large.chain.right, X)]))
        drawn.append(flexure.drawn_in(large.chain, flexure.deflect(large.chain, bent, 0.0)))
    return math.floor(min(drawn) * 100.0) / 100.0, math.ceil(max(drawn) * 100.0) / 100.0


@dataclass(frozen=True, slots=True)
class HigherTerms:
    """What a coupler or rocker does beyond its stiffness: Q, C and B of ``LeafSize``, N/mm^3 and N/mm^2."""

    quartic: float
    common: float
    skew: float


def higher_terms(
    large: LargeLeaf, kind: LeafKind, own: float, across: float, cases: tuple[tuple[float, float], ...]
) -> HigherTerms:
    """Terms that make the reduced model exact at the ends of ``cases``.

    Raises:
        ArithmeticError: there is no equilibrium there.
    """

    def beyond(left: float, right: float) -> float:
        return large.force(left, right) - (own * left + across * right)

    quartic = common = skew = 0.0
    for left, right in cases:
        one, other = beyond(left, right), beyond(-left, -right)
        odd, even = (one - other) / 2.0, (one + other) / 2.0
        if left * right > 0.0:
            common = odd / (left + right) ** 3
        else:
            quartic, skew = odd / (left - right) ** 3, even / (left - right) ** 2
    return HigherTerms(quartic, common, skew if kind is LeafKind.ROCKER else 0.0)


def _with_quartic(leaf: LeafSize, cases: tuple[tuple[float, float], ...], process: Process) -> LeafSize:
    """``leaf`` with its higher terms from the large-displacement computation at its largest deflections."""
    large = LargeLeaf(chain_of(leaf.kind, leaf.shape, process))
    try:
        if leaf.kind is LeafKind.BIAS:
            # of force = own d + skew d^2 + quartic d^3, exact at both ends of the range
            first, second = cases[0][0], cases[1][0]
            rows = [[first**2, first**3], [second**2, second**3]]
            rest = [large.force(bent, 0.0) - leaf.own * bent for bent in (first, second)]
            skew, quartic = np.linalg.solve(rows, rest)
            slot = _slot(large, (min(first, second, 0.0), max(first, second, 0.0)))
            return replace(leaf, quartic=trim(float(quartic)), skew=trim(float(skew)), slot=slot)
        across = leaf.coupling if leaf.kind is LeafKind.ROCKER else -leaf.coupling
        terms = higher_terms(large, leaf.kind, leaf.own, across, cases)
    except ArithmeticError as error:
        raise ValueError(f"a {leaf.kind.value} that is soft enough finds no equilibrium at its farthest") from error
    return replace(leaf, quartic=trim(terms.quartic), common=trim(terms.common), skew=trim(terms.skew))


def _stiffness(kind: LeafKind, wall: float, legs: int, amplitude: float, process: Process) -> Callable[[float], float]:
    column = 1 if kind is LeafKind.ROCKER else 0

    def at(pitch: float) -> float:
        matrix = flexure.signal_matrix(
            chain_of(kind, Meander(wall, legs, pitch, amplitude, process.machine.fillet), process)
        )
        return float(matrix[0, column])

    return at


def _examine(
    kind: LeafKind,
    shape: Meander,
    cases: tuple[tuple[float, float], ...],
    process: Process,
    sheet: Sheet,
    law: UnitLaw,
) -> LeafSize:
    link = process.link
    chain = chain_of(kind, shape, process)
    matrix = flexure.signal_matrix(chain)
    axial = flexure.axial_stiffness(chain)
    seen = [flexure.examine(chain, flexure.deflect(chain, *case)) for case in cases]
    # the shortening coefficient does not depend on the size of the deflection: take it at 1 mm
    one = flexure.examine(chain, flexure.deflect(chain, 1.0, 0.0))
    stiffening = 2.0 * axial * one.shortening**2  # an estimate, on the safe side
    worst = _worst(seen)
    limits = {
        "strain": worst.strain <= strain_allowed(shape.wall, process),
        "slope": worst.slope <= link.slope_limit,
        "clearance": worst.clearance >= link.leg_gap,
        "quartic": stiffening <= link.quartic_limit * law.stiffness_unit / process.unit.throw_unit**2,
    }
    return LeafSize(
        kind=kind,
        shape=shape,
        reach=round(float(chain.frame.nodes[chain.right][0]), 6),
        coupling=trim(float(matrix[0, 1] if kind is LeafKind.ROCKER else matrix[0, 0])),
        own=trim(float(matrix[0, 0])),
        axial=trim(axial),
        quartic=0.0,
        common=0.0,
        skew=0.0,
        strain=trim(worst.strain),
        slope=trim(worst.slope),
        eye_turn=trim(worst.eye),
        clearance=trim(worst.clearance),
        sweep=trim(worst.sweep),
        slot=(0.0, 0.0),
        misses=tuple(name for name, holds in limits.items() if not holds),
    )


def _worst(seen: list[Deflection]) -> Deflection:
    return Deflection(
        strain=max(item.strain for item in seen),
        slope=max(item.slope for item in seen),
        eye=max(item.eye for item in seen),
        clearance=min(item.clearance for item in seen),
        sweep=max(item.sweep for item in seen),
        shortening=max(item.shortening for item in seen),
    )
