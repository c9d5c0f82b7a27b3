"""The buckling-beam unit: from the template to its stiffnesses and its clock stroke.

Symbols and derivations are in ``docs/mechanics.md``. Lengths in mm, forces in N, stiffness in N/mm.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from mdlcad.errors import UsageError
from mdlcad.mechanics.fillet import Root, Seat, flat_root, shear_area, shear_length, shortening
from mdlcad.mechanics.process import PlateRole, Process
from mdlcad.network.model import Network


@dataclass(frozen=True, slots=True)
class UnitLaw:
    """What every unit of the device shares.

    Attributes:
        beam_stiffness: K_b = 2 N E w t^3 / l^3, N/mm; l here and below is the flexing span.
        stiffness_unit: S0 = K_b / kappa0, N/mm; force_unit: F0 = S0 X0, N.
        axial_stiffness: K_x = l^2 S0 / (8 g^2 X0^2), N/mm, of the whole unit in x.
        beams_axial: N E w t / (2 l), N/mm: the beams of both sides in series, and the end block's arms.
        series_stiffness: k_s = 1 / (1/K_x - 1/beams_axial), N/mm.
        stroke_per_k: clock displacement that changes k by -1: 2 g X0^2 / l, mm.
        wall_per_k: change of beam wall that changes k by 1: t / (3 kappa0), mm (K_b goes with t^3).
        clock_force_unit: K_x times stroke_per_k, N per unit of k and unit.
        shuttle_height: mm in y, over the outer faces of the beams.
        shuttle_turn: stiffness of the shuttle against turning in the plane, N mm/rad.
        shuttle_tilt: its stiffness against tilting about x (out of the plane), N mm/rad, without help of other plates.
    """

    beam_stiffness: float
    stiffness_unit: float
    force_unit: float
    axial_stiffness: float
    beams_axial: float
    series_stiffness: float
    stroke_per_k: float
    wall_per_k: float
    clock_force_unit: float
    shuttle_height: float
    shuttle_turn: float
    shuttle_tilt: float


@dataclass(frozen=True, slots=True)
class FlexingSpan:
    """The span of a unit's beams less what their fillets take from it, mm, the mean of all beams.

    Attributes:
        bend: as the beams bend in the plane, with what their blocks give and what they shear; stretch: as they stretch,
            with what their blocks give; out: as they bend out of the plane, between blocks taken as rigid.
    """

    bend: float
    stretch: float
    out: float


def beam_roots(process: Process, beam: int) -> tuple[Root, Root]:
    """The roots of a side's beam number ``beam``: at the rib, and at the shuttle or the end block.

    The outermost beams run flush with the edges of shuttle and end block: only their inner sides have a corner there.
    """
    fillet, count = process.machine.fillet, process.unit.beams
    outer = count > 1 and beam in (0, count - 1)
    return flat_root(fillet, 2, seat=Seat.BLOCK), flat_root(fillet, 1 if outer else 2, seat=Seat.BLOCK)


def beam_heights(process: Process) -> list[float]:
    """Heights of the beams of one side, from the shuttle's centre, mm."""
    count, spacing = process.unit.beams, process.unit.pair_spacing
    return [spacing * (i / (count - 1) - 0.5) for i in range(count)] if count > 1 else [0.0]


def flexing_span(process: Process) -> FlexingSpan:
    """See ``FlexingSpan``; of a unit's two sides, one has a rib and a shuttle, the other a shuttle and an end block."""
    unit = process.unit
    bend = stretch = out = 0.0
    for beam in range(unit.beams):
        roots = beam_roots(process, beam)
        rib, block = (shortening(unit.beam_wall, root) for root in roots)
        bend += (rib[0] + 3.0 * block[0]) / 2.0
        stretch += (rib[1] + 3.0 * block[1]) / 2.0
        rib, block = (shortening(unit.beam_wall, replace(root, seat=Seat.RIGID)) for root in roots)
        out += (rib[1] + 3.0 * block[1]) / 2.0
    seems = unit.span + shear_length(unit.beam_wall, unit.span)
    return FlexingSpan(seems - bend / unit.beams, unit.span - stretch / unit.beams, unit.span - out / unit.beams)


_ROOTED = 0.2
"""An end block's arms bend as if they began within the stem, this share of its width from its middle: plane stress."""


def end_block_arm(height: float, stem: float) -> float:
    """How long the arm of an end block is that carries a beam at ``height`` from its middle, mm."""
    return max(0.0, abs(height) - _ROOTED * stem)


def end_block_give(stretch: float, width: float, stem: float, heights: Sequence[float]) -> float:
    """By how much an end block gives way in x under the push of its beams, mm/N: its arms bend and shear.

    Args:
        stretch: modulus times depth, N/mm; width: of the block in x; heights: of the beams, which push alike.
    """
    arms = [end_block_arm(height, stem) for height in heights]
    inertia = width**3 / 12.0
    return sum(arm**3 / 3.0 + shear_area(width) * arm for arm in arms) / inertia / stretch / len(arms) ** 2


HUB_TURN = 2.0
"""A shuttle that is turned by its pins gives way so many walls more under the push of a beam than one that is pushed
through; plane stress."""


def unit_law(process: Process) -> UnitLaw:
    """The laws of the unit template.

    Raises:
        UsageError: the throw unit X0 is so small that even rigid beam ends are too soft (no series spring exists).
    """
    unit, span = process.unit, flexing_span(process)
    plate = process.plates(PlateRole.UNIT)[0]
    modulus, depth = process.material(plate).modulus, plate.thickness
    beam = unit.beams * modulus * depth * unit.beam_wall**3 / span.bend**3
    beam_stiffness = 2.0 * beam
    stiffness_unit = beam_stiffness / unit.kappa0
    axial = span.bend**2 * stiffness_unit / (8.0 * unit.shape**2 * unit.throw_unit**2)
    heights = beam_heights(process)
    block = end_block_give(modulus * depth, unit.block_width, unit.series_arm, heights)
    beams_axial = 1.0 / (2.0 * span.stretch / (unit.beams * modulus * depth * unit.beam_wall) + block)
    if axial >= beams_axial:
        least = span.bend / unit.shape * math.sqrt(stiffness_unit / (8.0 * beams_axial))
        raise UsageError(
            f"process {process.name}: unit.throw_unit: {unit.throw_unit} mm leaves no room for a series spring; "
            f"it must be greater than {least:.3f} mm"
        )
    one_axial = modulus * depth * unit.beam_wall / (span.stretch + HUB_TURN * unit.beam_wall)
    inertia_z = unit.beam_wall * depth**3 / 12.0
    count = 2 * unit.beams
    spread = sum(height**2 for height in heights)
    return UnitLaw(
        beam_stiffness=beam_stiffness,
        stiffness_unit=stiffness_unit,
        force_unit=stiffness_unit * unit.throw_unit,
        axial_stiffness=axial,
        beams_axial=beams_axial,
        series_stiffness=1.0 / (1.0 / axial - 1.0 / beams_axial),
        stroke_per_k=2.0 * unit.shape * unit.throw_unit**2 / span.bend,
        wall_per_k=unit.beam_wall / (3.0 * unit.kappa0),
        clock_force_unit=axial * 2.0 * unit.shape * unit.throw_unit**2 / span.bend,
        shuttle_height=unit.pair_spacing + unit.beam_wall,
        shuttle_turn=2.0 * one_axial * spread + count * 4.0 * modulus * depth * unit.beam_wall**3 / 12.0 / span.bend,
        shuttle_tilt=2.0 * 12.0 * modulus * inertia_z / span.out**3 * spread,
    )


def clock_swing(network: Network, law: UnitLaw) -> float:
    """Half stroke of the clock, mm: from p = 1 to p = 2."""
    return law.stroke_per_k * max(abs(mass.k1) for mass in network.masses)
