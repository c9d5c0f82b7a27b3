"""Sizes of couplers, rockers and bias leaves: the shortest meander of the template's that keeps all limits."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import StrEnum

from mdlcad.mechanics import flexure
from mdlcad.mechanics.beam.large import LargeFrame
from mdlcad.mechanics.flexure import Chain, Deflection, Meander, Sheet
from mdlcad.mechanics.frame import Y, dof
from mdlcad.mechanics.process import PlateRole, Process
from mdlcad.mechanics.unit import UnitLaw


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
        strain, slope, eye_turn, clearance, sweep: at the worst deflection; see ``flexure.Deflection``.
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
        cases: deflections (y left, y right) in mm that it must bear.

    Of the walls and leg counts of the template, the pitch that gives the stiffness is found by bisection. If none
    keeps all limits, the one that misses the fewest (then the shortest) is returned with their names.
    """
    link, sheet = process.link, rung_sheet(process)
    steps = math.floor((link.wall_max - process.machine.min_wall) / link.wall_step + 1e-9)
    best: LeafSize | None = None
    for legs in link.legs:
        for step in range(steps + 1):
            wall = round(process.machine.min_wall + step * link.wall_step, 6)
            amplitude = (law.shuttle_height - wall) / 2.0
            pitch = flexure.pitch_for(_stiffness(kind, wall, legs, amplitude, process), stiffness, wall, 40.0)
            if pitch is None:
                continue
            found = _examine(kind, Meander(wall, legs, pitch, amplitude), cases, process, sheet, law)
            if best is None or (len(found.misses), found.reach) < (len(best.misses), best.reach):
                best = found
            if not found.misses:
                break  # a thicker wall makes a longer leaf
    if best is None:
        raise ValueError(f"no meander of the process {process.name} has a stiffness of {stiffness} N/mm")
    return _with_quartic(best, cases, process)


def _with_quartic(leaf: LeafSize, cases: tuple[tuple[float, float], ...], process: Process) -> LeafSize:
    """``leaf`` with its quartic terms from the large-displacement computation at its largest deflections."""
    chain = chain_of(leaf.kind, leaf.shape, process)
    cuts = [4] * chain.flexible + [1] * (len(chain.frame.beams) - chain.flexible)
    large = LargeFrame(chain.frame, cuts)
    across = leaf.coupling if leaf.kind is LeafKind.ROCKER else -leaf.coupling
    quartic = common = skew = most = 0.0
    for left, right in cases:
        together = left * right > 0.0
        if not together and abs(left) <= most:
            continue  # of a bias leaf's two ways, the farther
        both = []
        for way in (1.0, -1.0):
            pose = large.move(large.rest(), flexure.driven(chain, way * left, way * right))
            both.append(float(pose.reactions[dof(chain.left, Y)]) - way * (leaf.own * left + across * right))
        odd, even = (both[0] - both[1]) / 2.0, (both[0] + both[1]) / 2.0
        if together:
            common = odd / (left + right) ** 3
        else:
            most = abs(left)
            quartic, skew = odd / (left - right) ** 3, even / (left - right) ** 2
    if leaf.kind is LeafKind.COUPLER:
        skew = 0.0
    return replace(leaf, quartic=trim(quartic), common=trim(common), skew=trim(skew))


def _stiffness(kind: LeafKind, wall: float, legs: int, amplitude: float, process: Process) -> Callable[[float], float]:
    column = 1 if kind is LeafKind.ROCKER else 0

    def at(pitch: float) -> float:
        matrix = flexure.signal_matrix(chain_of(kind, Meander(wall, legs, pitch, amplitude), process))
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
    slot = (0.0, 0.0)
    if kind is LeafKind.BIAS:
        drawn = [flexure.drawn_in(chain, flexure.deflect(chain, *case)) for case in (*cases, (0.0, 0.0))]
        slot = (math.floor(min(drawn) * 100.0) / 100.0, math.ceil(max(drawn) * 100.0) / 100.0)
    limits = {
        "strain": worst.strain <= sheet.strain_limit,
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
        slot=slot,
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
