"""The series spring k_s of a unit: leaves along y between the beams' end block and the clock block.

A folded spring: from the stem of the end block, banks of leaves run up and down to a truss at the top and one at the
bottom of the row, and from there banks of leaves run back to the stem of the clock block. It is symmetric about the
line of the force, so that a push in x neither lifts nor turns the end block (leaves on one side only would do both).
Stems and trusses bend too, so the whole is solved as a frame. Lengths in mm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from mdlcad.errors import UsageError
from mdlcad.mechanics.fillet import Zone, bar_root, zones_of
from mdlcad.mechanics.flexure import RIGID, Sheet
from mdlcad.mechanics.frame import TURN, Beam, Frame, Spring, X, Y, dof
from mdlcad.mechanics.process import PlateRole, Process
from mdlcad.mechanics.unit import UnitLaw


@dataclass(frozen=True, slots=True)
class SeriesSpring:
    """The series spring as cut and what it does.

    Attributes:
        leaves: in each of the four banks; length, wall: of a leaf; pitch: of the leaves in a bank.
        arm: width of stems and trusses; height: half height of the row that the unit may fill.
        clear_block: between end block and first leaf; clear: between the two stems (least gap and travel).
        stiffness: N/mm, of the frame with this wall.
        travel: largest bend, mm, at the worst of the clock with the shuttle held at x = 0.
        strain: the largest there, strain_settled: the same when the shuttle has buckled, both at large displacements
            once sizing knows the preloads (``series_spring`` itself gives linear theory's).
        turn_stiffness: N mm/rad, of the end block against turning.
        reach: length in x of end block, leaves and clock block.
    """

    leaves: int
    length: float
    wall: float
    pitch: float
    arm: float
    height: float
    clear_block: float
    clear: float
    stiffness: float
    travel: float
    strain: float
    strain_settled: float
    turn_stiffness: float
    reach: float


def series_spring(process: Process, law: UnitLaw, row_pitch: float, k_least: float, self_most: float) -> SeriesSpring:
    """Leaves that give k_s in the height a row leaves them; their wall is found by bisection.

    Args:
        k_least: least stiffness k of any unit; self_most: largest sum of self terms that a unit's preload absorbs.

    Raises:
        UsageError: the row is too low for leaves of that stiffness.
    """
    unit, gap = process.unit, process.machine.min_gap
    height = (row_pitch - process.link.gap) / 2.0
    share = law.axial_stiffness / law.series_stiffness
    travel = share * law.stroke_per_k * (unit.kappa0 - min(k_least, 0.0) + self_most)
    settled = share * law.stroke_per_k * (unit.kappa0 + self_most)
    clear = round(math.ceil((gap + travel) / 0.01 - 1e-9) * 0.01, 6)

    def excess(wall: float) -> float:
        return _solve(process, law, wall, height, clear)[0] / law.series_stiffness - 1.0

    low, high = 0.1, height / 2.0
    if height <= 2.0 * unit.series_arm or excess(high) < 0.0 or excess(low) > 0.0:
        raise UsageError(
            f"process {process.name}: unit.series_leaves: no wall from {low} to {high:.2f} mm gives the series spring "
            f"{law.series_stiffness:.2f} N/mm in a row of {row_pitch} mm; change series_leaves or series_arm"
        )
    wall = round(brentq(excess, low, high, xtol=1e-6), 3)
    stiffness, strain, turning = _solve(process, law, wall, height, clear)
    bank = unit.series_leaves * wall + (unit.series_leaves - 1) * gap
    return SeriesSpring(
        leaves=unit.series_leaves,
        length=round(height - 1.5 * unit.series_arm, 6),
        wall=wall,
        pitch=round(wall + gap, 6),
        arm=unit.series_arm,
        height=round(height, 6),
        clear_block=round(clear - gap / 2.0, 6),
        clear=clear,
        stiffness=round(stiffness, 6),
        travel=round(travel, 6),
        strain=round(strain * travel, 6),
        strain_settled=round(strain * settled, 6),
        turn_stiffness=round(turning, 4),
        reach=round(
            unit.block_width
            + 2.0 * (clear - gap / 2.0)
            + 2.0 * bank
            + clear
            + process.pin.side
            + 2.0 * process.pin.wall,
            6,
        ),
    )


@dataclass(frozen=True, slots=True)
class SpringFrame:
    """The spring's centre lines: node 0 is the end block, ``pin`` the clock block; width of each strained beam."""

    nodes: list[tuple[float, float]]
    beams: list[Beam]
    widths: list[float]
    pin: int


@dataclass(frozen=True, slots=True)
class SpringPlan:
    """Centre lines and widths of a folded spring, mm, from the middle of the end block.

    Attributes:
        near, far: x of the leaves of a bank and their walls, (x, wall above, wall below) each, outwards.
        stem, truss: widths in y of the stems and of the trusses; height: of the trusses' outer edges.
        fillet: radius at the leaves' roots.
        block: half the width of the end block; clock: from the last leaf's centre line to the clock block.
    """

    near: tuple[tuple[float, float, float], ...]
    far: tuple[tuple[float, float, float], ...]
    stem: float
    truss: float
    height: float
    fillet: float
    block: float
    clock: float


def spring_plan(process: Process, wall: float, height: float, clear: float) -> SpringPlan:
    """The plan that sizing draws: all leaves alike."""
    unit, gap = process.unit, process.machine.min_gap
    to_leaf = clear - gap / 2.0 + wall / 2.0
    first = unit.block_width / 2.0 + to_leaf
    near = [first + i * (wall + gap) for i in range(unit.series_leaves)]
    far = [near[-1] + wall + clear + i * (wall + gap) for i in range(unit.series_leaves)]
    banks = [tuple((x, wall, wall) for x in bank) for bank in (near, far)]
    arm, fillet = unit.series_arm, process.machine.fillet
    return SpringPlan(banks[0], banks[1], arm, arm, height, fillet, unit.block_width / 2.0, to_leaf)


_AT_LEAF = 0.3
"""Compliance of a stem or truss where a leaf is rooted in it, over that beside it; from the computations of whole
springs that ``fillet.Seat.BAR`` is from."""


def spring_frame(process: Process, wall: float, height: float, clear: float) -> SpringFrame:
    """The folded spring as sizing draws it."""
    plate = process.plates(PlateRole.UNIT)[0]
    material = process.material(plate)
    sheet = Sheet(material.modulus, plate.thickness, material.strain_limit)
    return frame_of(spring_plan(process, wall, height, clear), sheet)


def frame_of(plan: SpringPlan, sheet: Sheet) -> SpringFrame:
    """A folded spring as beams: first the strained ones (``widths``), then those taken as rigid.

    Its leaves are short, so they shear as well, and so do stems and trusses.
    """
    truss_y, face, edge = plan.height - plan.truss / 2.0, plan.height - plan.truss, plan.stem / 2.0
    nodes = [(0.0, 0.0), (plan.block, 0.0)]
    parts: list[tuple[Beam, float]] = []  # beams that may be strained, with their width
    stiff = [sheet.beam(0, 1, plan.stem, RIGID)]
    stem = [1]
    tops: dict[float, list[int]] = {1.0: [], -1.0: []}
    inmost, outmost = (plan.near[0][0], plan.far[-1][0]), (plan.near[-1][0], plan.far[0][0])
    for x, *walls in plan.near + plan.far:
        # stems end flush with a bank's last leaf, trusses with the spring's: no corner on that side
        root = bar_root(plan.fillet, 1 if x in outmost else 2, plan.stem)
        head = bar_root(plan.fillet, 1 if x in inmost else 2, plan.truss)
        centre = len(nodes)
        nodes.append((x, 0.0))
        if x != plan.far[0][0]:
            before = 0.0 if len(stem) == 1 else walls[0] / 2.0
            zones = _leafed(x - nodes[stem[-1]][0], before, walls[0] / 2.0)
            parts.append((sheet.shearing(stem[-1], centre, plan.stem, zones), plan.stem))
        stem.append(centre)
        for (side, truss), wall in zip(tops.items(), walls, strict=True):
            foot = len(nodes)
            nodes += [(x, side * edge), (x, side * face), (x, side * truss_y)]
            stiff += [sheet.beam(centre, foot, wall, RIGID), sheet.beam(foot + 1, foot + 2, wall, RIGID)]
            zones = zones_of(face - edge, wall, root, head)
            parts.append((sheet.shearing(foot, foot + 1, wall, zones), wall))
            if truss:
                zones = _leafed(x - nodes[truss[-1]][0], wall / 2.0, wall / 2.0)
                parts.append((sheet.shearing(truss[-1], foot + 2, plan.truss, zones), plan.truss))
            truss.append(foot + 2)
    pin, last = len(nodes), plan.far[-1]
    nodes.append((last[0] + plan.clock, 0.0))
    zones = _leafed(plan.clock, last[1] / 2.0, 0.0)
    parts.append((sheet.shearing(stem[-1], pin, plan.stem, zones), plan.stem))
    return SpringFrame(nodes, [beam for beam, _ in parts] + stiff, [width for _, width in parts], pin)


def _leafed(length: float, before: float, after: float) -> tuple[Zone, ...]:
    """The stretches of a stem or truss that are stiffer for a leaf being rooted there, at either end of it."""
    ends = ((0.0, before), (length - after, length))
    return tuple(Zone(start, stop, _AT_LEAF, _AT_LEAF) for start, stop in ends if stop > start)


@dataclass(frozen=True, slots=True)
class SpringStiffness:
    """Of the end block, N/mm: ``push`` in x, as it is held by the beams; ``across`` in y, alone and not turning."""

    push: float
    across: float


def spring_stiffness(made: SpringFrame, beams_y: float, beams_turn: float) -> SpringStiffness:
    """What a folded spring does; its end block is free to turn and to move in y against the beams it ends.

    Args:
        beams_y, beams_turn: stiffness of those beams, N/mm and N mm/rad (the shuttle at rest).
    """
    block = [dof(0, i) for i in (X, Y, TURN)]
    matrix = Frame(made.nodes, made.beams).condense(block, [dof(made.pin, i) for i in (X, Y, TURN)])
    across = matrix[1, 1] - matrix[0, 1] ** 2 / matrix[0, 0]
    held = matrix[1:, 1:] + np.diag([beams_y, beams_turn])
    push = matrix[0, 0] - matrix[0, 1:] @ np.linalg.solve(held, matrix[1:, 0])
    return SpringStiffness(float(push), float(across))


def _solve(process: Process, law: UnitLaw, wall: float, height: float, clear: float) -> tuple[float, float, float]:
    """Stiffness (N/mm), strain per mm and turning stiffness of the end block (N mm/rad) of the spring's frame.

    The end block is free to turn and to move in y against the beams it ends.
    """
    made = spring_frame(process, wall, height, clear)
    # what the pair of beams holds the end block by (the shuttle at rest)
    springs = [Spring(dof(0, Y), law.beam_stiffness / 2.0), Spring(dof(0, TURN), law.shuttle_turn / 2.0)]
    frame = Frame(made.nodes, made.beams, springs)
    pin = [dof(made.pin, i) for i in (X, Y, TURN)]
    solution = frame.solve(dict.fromkeys(pin, 0.0) | {dof(0, X): 1.0})
    strain = 0.0
    for beam, width in zip(made.beams, made.widths, strict=False):  # the rigid ones have no width
        moment = frame.wall_moment(beam, solution)
        strain = max(strain, moment * width / (2.0 * beam.bending))
    turning = float(Frame(made.nodes, made.beams).condense([dof(0, TURN)], pin)[0, 0])
    return float(solution.reactions[dof(0, X)]), strain, turning
