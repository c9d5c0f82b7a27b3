"""Force against displacement of every kind of part, by the large-displacement computation and by its reduced model.

Parts as they are sized: beams and folded series spring of a unit in one model, meanders leg by leg. What sizing takes
as rigid (blocks, hubs, eyes) is rigid here too; every other turn and displacement is free.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mdlcad.mechanics.beam.large import LargeFrame, Pose
from mdlcad.mechanics.beam.unit import held, unit_model
from mdlcad.mechanics.flexure import Chain, driven
from mdlcad.mechanics.frame import TURN, Array, Frame, X, Y, dof
from mdlcad.mechanics.leaves import LeafSize, chain_of
from mdlcad.mechanics.process import PlateRole, Process
from mdlcad.mechanics.reduced import leaf_force, unit_force
from mdlcad.mechanics.series import SeriesSpring, spring_frame
from mdlcad.mechanics.unit import UnitLaw

_POINTS = 25
_CUTS_LEAF = 6


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """What a part does over its working range.

    Attributes:
        part: kind of part; state: where it is driven, in words.
        displacement: float[m], mm. force: float[m], N, by the beam computation; reduced: by the reduced model.
        strain: float[m], largest in any beam; limit: what it is held against.
    """

    part: str
    state: str
    displacement: Array
    force: Array
    reduced: Array
    strain: Array
    limit: float

    @property
    def error(self) -> float:
        """Root mean square of the difference, relative to that of the force."""
        return float(np.sqrt(np.mean((self.force - self.reduced) ** 2) / np.mean(self.force**2)))

    def rests(self) -> list[float]:
        """Displacements, mm, where the part would come to rest by itself: the force passes 0 and grows."""
        force = self.force
        at = [i for i in range(len(force) - 1) if force[i] < 0.0 <= force[i + 1]]
        d = self.displacement
        return [float(d[i] - force[i] * (d[i + 1] - d[i]) / (force[i + 1] - force[i])) for i in at]


def unit_curve(process: Process, law: UnitLaw, series: SeriesSpring, k: float, throw: float) -> Curve:
    """A unit with its clock at the stroke for stiffness ``k`` (units of S0), its shuttle at -``throw`` to ``throw``."""
    model = unit_model(process, series)
    stroke = law.stroke_per_k * (process.unit.kappa0 - k)
    large = LargeFrame(model.frame, model.cuts)
    pose = large.move(large.rest(), held(model, 0.0, throw))
    at = np.linspace(throw, -throw, _POINTS)
    poses = []
    for displacement in at:
        pose = large.move(pose, held(model, stroke, float(displacement)))
        poses.append(pose)
    reduced = unit_force(process, law, series, stroke, at)
    limit = process.material(process.plates(PlateRole.UNIT)[0]).strain_limit
    return _curve(
        "unit", f"k = {k:g}", at[::-1], poses[::-1], dof(model.hub, Y), reduced[::-1], large, model.walls, limit
    )


def series_curve(process: Process, series: SeriesSpring, travel: float) -> Curve:
    """The folded spring between the end block, which does not turn here, and the clock block."""
    made = spring_frame(process, series.wall, series.height, series.clear)
    cuts = [_CUTS_LEAF] * len(made.widths) + [1] * (len(made.beams) - len(made.widths))
    large = LargeFrame(Frame(made.nodes, made.beams), cuts)
    rest = dict.fromkeys([dof(made.pin, i) for i in (X, Y, TURN)] + [dof(0, Y), dof(0, TURN)], 0.0)
    push = dof(0, X)
    at = np.linspace(0.0, travel, _POINTS)
    poses = _swept(large, lambda d: rest | {push: d}, at)
    walls = made.widths + [0.0] * (len(made.beams) - len(made.widths))
    limit = process.material(process.plates(PlateRole.UNIT)[0]).strain_peak
    return _curve("series spring", "", at, poses, push, series.stiffness * at, large, walls, limit)


def leaf_curve(
    process: Process, leaf: LeafSize, state: str, ends: Callable[[float], tuple[float, float]], throw: float
) -> Curve:
    """A coupler, rocker or bias leaf; its left end goes from -``throw`` to ``throw``, ``ends`` says where both are."""
    chain = chain_of(leaf.kind, leaf.shape, process)
    large = LargeFrame(chain.frame, _chain_cuts(chain))
    at = np.linspace(-throw, throw, _POINTS)
    poses = _swept(large, lambda d: driven(chain, *ends(d)), at)
    both = np.array([ends(d) for d in at])
    reduced = leaf_force(leaf, both[:, 0], both[:, 1])
    walls = [leaf.shape.wall] * len(chain.frame.beams)
    limit = process.material(process.plates(PlateRole.RUNG)[0]).strain_limit
    return _curve(leaf.kind.value, state, at, poses, dof(chain.left, Y), reduced, large, walls, limit)


def _chain_cuts(chain: Chain) -> list[int]:
    return [_CUTS_LEAF] * chain.flexible + [1] * (len(chain.frame.beams) - chain.flexible)


def _swept(large: LargeFrame, at_displacement: Callable[[float], dict[int, float]], at: Array) -> list[Pose]:
    pose, poses = large.rest(), []
    for displacement in at:
        pose = large.move(pose, at_displacement(float(displacement)))
        poses.append(pose)
    return poses


def _curve(
    part: str,
    state: str,
    at: Array,
    poses: list[Pose],
    driven: int,
    reduced: Array,
    large: LargeFrame,
    walls: list[float],
    limit: float,
) -> Curve:
    force = np.array([pose.reactions[driven] for pose in poses])
    strain = np.array([large.strains(pose, walls).max() for pose in poses])
    return Curve(part, state, at, force, reduced, strain, limit)
