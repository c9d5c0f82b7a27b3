"""Guides of clock plates: their formulas against frames of beams, linear, at large displacements, and exudyn's."""

from dataclasses import replace

import numpy as np
import pytest

from mdlcad.mechanics import Process, load_process, process_names
from mdlcad.mechanics.beam.large import LargeFrame, Pose
from mdlcad.mechanics.fillet import Seat, Zone, flat_root, notch_factor, zones_of
from mdlcad.mechanics.frame import TURN, Beam, Frame, X, Y, dof
from mdlcad.mechanics.guides import (
    BUCKLING_SHARE,
    STROKE_SHARE,
    GuideLeaf,
    guide_findings,
    guide_leaf,
    guide_load,
    walls,
)
from mdlcad.mechanics.process import Plate, PlateRole
from tests.mechanics.beam import oracle

STROKE, SPAN, HEIGHT = 0.53, 150.0, -70.0
"""mm: half of the plate's way; leaves apart; their roots under the handle."""
HANDLE, ROOTS = 0, (1, 2)
SHEET = (1e8, 1e12)
"""E A in N, E I in N mm^2: rigid beside the leaves."""


def plate_of(process: Process) -> Plate:
    return process.plates(PlateRole.CLOCK)[0]


def zones(leaf: GuideLeaf) -> tuple[Zone, ...]:
    root = flat_root(leaf.fillet, 2, seat=Seat.BLOCK)
    return zones_of(leaf.length, leaf.wall, root, root)


def frame_of(leaf: GuideLeaf) -> Frame:
    """A rigid plate on its two leaves; node 0 is the handle."""
    axial, bending = (leaf.modulus * leaf.depth * value for value in (leaf.wall, leaf.wall**3 / 12.0))
    xs = (-SPAN / 2.0, SPAN / 2.0)
    nodes = [(0.0, 0.0), *((x, HEIGHT) for x in xs), *((x, HEIGHT + leaf.length) for x in xs)]
    stiff = [Beam(0, 3, *SHEET), Beam(0, 4, *SHEET)]
    return Frame(nodes, [Beam(1, 3, axial, bending, zones(leaf)), Beam(2, 4, axial, bending, zones(leaf)), *stiff])


def clamped(**handle: float) -> dict[int, float]:
    held = {dof(root, direction): 0.0 for root in ROOTS for direction in (X, Y, TURN)}
    return held | {dof(HANDLE, {"x": X, "turn": TURN}[name]): value for name, value in handle.items()}


CUTS = [12, 12, 1, 1]


@pytest.fixture(params=process_names())
def leaf(request: pytest.FixtureRequest) -> GuideLeaf:
    process = load_process(request.param)
    return guide_leaf(process, plate_of(process), STROKE, process.machine.min_wall)


def test_a_plate_turns_as_its_leaves_are_pulled_and_pushed(leaf: GuideLeaf) -> None:
    solution = frame_of(leaf).solve(clamped(x=0.0, turn=1e-4), {})
    moment = solution.reactions[dof(HANDLE, TURN)]
    load = guide_load(leaf, SPAN, 0.0, moment, 0.0, 80.0)
    assert load.turn == pytest.approx(1e-4, rel=0.01)
    assert load.error == pytest.approx(80.0 * load.turn)
    assert load.load == pytest.approx(abs(solution.reactions[dof(ROOTS[0], Y)]), rel=0.01)


def at_the_end_of_the_stroke(leaf: GuideLeaf) -> Pose:
    large = LargeFrame(frame_of(leaf), CUTS)
    return large.move(large.rest(), clamped(x=STROKE, turn=2e-5))


def test_a_leaf_at_the_end_of_its_stroke_is_strained_and_pushes_back_as_said(leaf: GuideLeaf) -> None:
    pose = at_the_end_of_the_stroke(leaf)
    forces = pose.reactions
    assert forces[dof(HANDLE, X)] == pytest.approx(2.0 * leaf.sway * STROKE, rel=0.05)
    strains = []
    for root in ROOTS:
        moment, load = (abs(forces[dof(root, direction)]) for direction in (TURN, Y))
        half = moment * leaf.wall / 2.0 / (leaf.modulus * leaf.depth * leaf.wall**3 / 12.0)
        strains.append((half + load / (leaf.modulus * leaf.depth * leaf.wall), load))
    strain, load = max(strains)
    # the frame's is that of bare walls, and at the root: a little more than at the fillets' ends
    assert leaf.strain(STROKE, load) / notch_factor(leaf.wall, leaf.fillet) == pytest.approx(strain, rel=0.05)


@pytest.mark.parametrize("load", [-15.0, 0.0, 15.0])
def test_exudyn_agrees_on_a_leaf_that_is_bent_and_pulled(leaf: GuideLeaf, load: float) -> None:
    axial, bending = (leaf.modulus * leaf.depth * value for value in (leaf.wall, leaf.wall**3 / 12.0))
    frame = Frame([(0.0, 0.0), (0.0, leaf.length)], [Beam(0, 1, axial, bending, zones(leaf))])
    shortened = 0.6 * STROKE**2 / leaf.length
    held = {dof(0, direction): 0.0 for direction in (X, Y, TURN)}
    held |= {dof(1, X): STROKE, dof(1, Y): load / leaf.along - shortened, dof(1, TURN): 0.0}
    large = LargeFrame(frame, [24])
    ours, found = large.move(large.rest(), held).reactions, oracle.forces(frame, [24], held, 20)
    assert ours[dof(1, Y)] == pytest.approx(load, abs=1.0)
    for place in (dof(1, X), dof(0, TURN)):
        assert ours[place] == pytest.approx(found[place], rel=0.02)


def test_the_shortest_leaf_that_the_stroke_may_strain(leaf: GuideLeaf) -> None:
    shorter = replace(leaf, length=leaf.length - 0.5)
    limit = STROKE_SHARE * 0.002
    assert leaf.strain(STROKE, 0.0) <= limit < shorter.strain(STROKE, 0.0)


def test_a_leaf_buckles_where_the_frame_loses_its_stiffness(leaf: GuideLeaf) -> None:
    """Euler's load of a beam clamped at both ends, by the sign of the tangent of a beam that is bent a little."""
    axial, bending = (leaf.modulus * leaf.depth * value for value in (leaf.wall, leaf.wall**3 / 12.0))
    # bowed by a hundredth of its wall, so that it bends the way it buckles
    s = np.linspace(0.0, 1.0, 41)
    bow = 0.005 * leaf.wall * (1.0 - np.cos(2.0 * np.pi * s))
    nodes = [(float(b), float(leaf.length * t)) for b, t in zip(bow, s, strict=True)]
    large = LargeFrame(Frame(nodes, [Beam(i, i + 1, axial, bending) for i in range(40)]), [1] * 40)
    held = {dof(node, direction): 0.0 for node in (0, 40) for direction in (X, Y, TURN)}
    pose, loads = large.rest(), []
    for push in np.linspace(0.2, 3.0, 15):
        pose = large.move(pose, held | {dof(40, Y): -float(push) * leaf.buckling / leaf.along})
        loads.append(abs(float(pose.reactions[dof(40, Y)])))
    assert max(loads) == pytest.approx(leaf.buckling, rel=0.03)


def test_walls_are_those_that_other_flexures_try() -> None:
    process = load_process("pom_cut")
    assert list(walls(process)) == [0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2]


@pytest.mark.parametrize(
    ("span", "moment", "rules"),
    [
        (150.0, 1500.0, set()),
        (150.0, 5000.0, {"guide_strain"}),
        (150.0, 9000.0, {"guide_strain", "guide_buckling"}),
        (150.0, 40000.0, {"guide_strain", "guide_buckling", "guide_turn"}),
        (20.0, 280.0, set()),
        (4.0, 40.0, {"guide_turn"}),
    ],
)
def test_every_limit_is_held(span: float, moment: float, rules: set[str]) -> None:
    process = load_process("pom_cut")
    plate = plate_of(process)
    leaf = guide_leaf(process, plate, STROKE, 0.5)
    load = guide_load(leaf, span, STROKE, moment, 0.0, 80.0)
    found = guide_findings("guide.clock-0", leaf, load, process, plate)
    assert {item.rule for item in found} == rules
    assert all(item.value > item.limit for item in found)
    assert ("guide_buckling" in rules) == (load.load > BUCKLING_SHARE * leaf.buckling)
