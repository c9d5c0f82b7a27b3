"""A whole unit at large displacements: both sides' beams, its end block free to lift and turn, all series leaves.

What sizing takes as rigid (blocks, hub) is rigid here too; every other turn and displacement is free.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mdlcad.mechanics.beam.large import LargeFrame
from mdlcad.mechanics.fillet import zones_of
from mdlcad.mechanics.flexure import RIGID, Sheet
from mdlcad.mechanics.frame import TURN, Frame, X, Y, dof
from mdlcad.mechanics.process import PlateRole, Process
from mdlcad.mechanics.series import SeriesSpring, spring_frame
from mdlcad.mechanics.unit import beam_heights, beam_roots, end_block_arm

_CUTS_BEAM = 12
_CUTS_LEAF = 6
_CUTS_ARM = 3
_AMPLITUDES = 5


@dataclass(frozen=True, slots=True, eq=False)
class UnitModel:
    """A whole unit: its frame and how its beams are cut; ``ribs``, ``hub`` and ``pin`` (the clock block) are nodes.

    Attributes:
        walls: thickness of every beam, 0 for rigid ones; the first ``series`` of them are the series spring's.
    """

    frame: Frame
    cuts: list[int]
    ribs: list[int]
    walls: list[float]
    series: int
    hub: int
    pin: int


def unit_model(process: Process, series: SeriesSpring) -> UnitModel:
    """Frame rib, two times N beams, the shuttle, the end block, the folded spring and the clock block's pin."""
    unit = process.unit
    plate = process.plates(PlateRole.UNIT)[0]
    material = process.material(plate)
    sheet = Sheet(material.modulus, plate.thickness, material.strain_limit)
    half, wall = unit.block_width / 2.0, unit.beam_wall
    # the spring's own frame begins at the end block's middle
    spring = spring_frame(process, series.wall, series.height, series.clear)
    nodes = list(spring.nodes)
    flexible = list(zip(spring.beams, spring.widths, strict=False))
    stiff = spring.beams[len(spring.widths) :]
    arms = []  # of the end block: they bend, and are so thick that strain is elsewhere
    hub = len(nodes)
    nodes.append((-half - unit.span - half, 0.0))
    ribs = []
    for number, y in enumerate(beam_heights(process)):
        at_rib, at_block = beam_roots(process, number)
        rib, left, right, end = range(len(nodes), len(nodes) + 4)
        x_hub = nodes[hub][0]
        nodes += [(x_hub - half - unit.span, y), (x_hub - half, y), (x_hub + half, y), (-half, y)]
        sides = zones_of(unit.span, wall, at_rib, at_block), zones_of(unit.span, wall, at_block, at_block)
        flexible += [
            (sheet.shearing(a, b, wall, zones), wall) for a, b, zones in ((rib, left, sides[0]), (right, end, sides[1]))
        ]
        stiff += [sheet.beam(a, b, wall, RIGID) for a, b in ((left, hub), (hub, right))]
        tip, foot, arm = 0, 0, end_block_arm(y, unit.series_arm)
        if arm:  # it begins within the stem
            tip, foot = len(nodes), len(nodes) + 1
            nodes += [(0.0, y), (0.0, y - math.copysign(arm, y))]
            arms.append(sheet.shearing(foot, tip, unit.block_width))
            stiff.append(sheet.beam(foot, 0, wall, RIGID))
        stiff.append(sheet.beam(end, tip, wall, RIGID))
        ribs.append(rib)
    beams = [beam for beam, _ in flexible] + arms + stiff
    leaves = len(spring.widths)
    cuts = [_CUTS_LEAF] * leaves + [_CUTS_BEAM] * (len(flexible) - leaves) + [_CUTS_ARM] * len(arms) + [1] * len(stiff)
    widths = [width for _, width in flexible] + [0.0] * (len(arms) + len(stiff))
    return UnitModel(Frame(nodes, beams), cuts, ribs, widths, leaves, hub, spring.pin)


def held(model: UnitModel, stroke: float, displacement: float) -> dict[int, float]:
    """What is prescribed with the clock block pushed in by ``stroke`` and the shuttle held at ``displacement``, mm."""
    ribs = dict.fromkeys((dof(rib, i) for rib in model.ribs for i in (X, Y, TURN)), 0.0)
    pin = {dof(model.pin, X): -stroke, dof(model.pin, Y): 0.0, dof(model.pin, TURN): 0.0}
    return ribs | pin | {dof(model.hub, Y): displacement}


@dataclass(frozen=True, slots=True)
class StrainCurve:
    """Largest strain in a unit's beams with its clock at one place, by the shuttle's displacement (mm, rising)."""

    amplitudes: tuple[float, ...]
    strains: tuple[float, ...]

    def at(self, amplitude: float) -> float:
        """At ``amplitude`` mm: between two of the computed ones, hardly ever less (it curves upwards)."""
        return float(np.interp(amplitude, self.amplitudes, self.strains))


@dataclass(frozen=True, slots=True)
class SpringStrains:
    """Largest strain in the series spring: ``settled`` with the shuttle in its well, ``peak`` with it held at 0."""

    settled: float
    peak: float


def beam_strains(process: Process, series: SeriesSpring, stroke: float, amplitude: float) -> StrainCurve:
    """Strains of the beams, bending and stretching, with the clock block pushed in by ``stroke`` mm.

    Args:
        amplitude: the largest displacement of the shuttle, mm.

    Raises:
        ArithmeticError: the beams find no equilibrium there.
    """
    model = unit_model(process, series)
    large = LargeFrame(model.frame, model.cuts)
    # bent first and then pushed: a straight beam pushed beyond its load could go either way
    pose = large.move(large.rest(), held(model, 0.0, amplitude))
    amplitudes = np.linspace(amplitude, 0.0, _AMPLITUDES)
    strains = []
    for displacement in amplitudes:
        pose = large.move(pose, held(model, stroke, float(displacement)))
        strains.append(float(large.strains(pose, model.walls)[model.series :].max()))
    return StrainCurve(tuple(map(float, amplitudes[::-1])), tuple(strains[::-1]))


def spring_strains(process: Process, series: SeriesSpring, stroke: float, well: float) -> SpringStrains:
    """Strains of the series spring with the clock block pushed in by ``stroke`` mm and the shuttle at ``well`` or 0.

    Raises:
        ArithmeticError: the beams find no equilibrium there.
    """
    model = unit_model(process, series)
    large = LargeFrame(model.frame, model.cuts)
    pose = large.move(large.rest(), held(model, 0.0, well))
    found = []
    for displacement in (well, 0.5 * well, 0.0):
        pose = large.move(pose, held(model, stroke, displacement))
        found.append(float(large.strains(pose, model.walls)[: model.series].max()))
    return SpringStrains(found[0], found[-1])
