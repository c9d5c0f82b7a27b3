"""The large-displacement beam against closed solutions."""

import numpy as np
import pytest

from mdlcad.mechanics.beam.large import LargeFrame
from mdlcad.mechanics.frame import TURN, Beam, Frame, X, Y, dof

L, EA, EI = 12.5, 2800.0, 58.3
ONE = Frame([(0.0, 0.0), (L, 0.0)], [Beam(0, 1, EA, EI)])
CLAMP = dict.fromkeys((dof(0, X), dof(0, Y), dof(0, TURN)), 0.0)


def test_an_end_moment_rolls_a_cantilever_into_a_circle() -> None:
    large = LargeFrame(ONE, [40])
    pose = large.rest()
    for turn in np.linspace(0.0, 2.0 * np.pi, 13)[1:]:
        pose = large.move(pose, CLAMP | {dof(1, TURN): float(turn)})
    assert pose.reactions[dof(1, TURN)] == pytest.approx(2.0 * np.pi * EI / L, rel=1e-6)
    assert pose.displacements[[dof(1, X), dof(1, Y)]] == pytest.approx([-L, 0.0], abs=1e-6)


def test_small_displacements_are_the_linear_frames() -> None:
    held = CLAMP | {dof(1, Y): 1e-4, dof(1, TURN): 0.0}
    large = LargeFrame(ONE, [3])
    assert large.move(large.rest(), held).reactions[dof(1, Y)] == pytest.approx(
        float(ONE.solve(held).reactions[dof(1, Y)]), rel=1e-6
    )


def test_turning_the_whole_strains_nothing() -> None:
    large = LargeFrame(ONE, [4])
    turn = 2.0
    end = {dof(1, X): L * (np.cos(turn) - 1.0), dof(1, Y): L * np.sin(turn), dof(1, TURN): turn}
    pose = large.rest()
    for share in np.linspace(0.1, 1.0, 10):
        part = {
            dof(1, X): L * (np.cos(share * turn) - 1.0),
            dof(1, Y): L * np.sin(share * turn),
            dof(1, TURN): share * turn,
        }
        pose = large.move(pose, CLAMP | {dof(0, TURN): share * turn} | part)
    assert pose.displacements[list(end)] == pytest.approx(list(end.values()))
    assert large.strains(pose, [0.5]).max() < 1e-9


def test_a_guided_beam_buckles_at_eulers_load() -> None:
    """Its stiffness across falls to 0 at pi^2 E I / l^2."""
    large = LargeFrame(ONE, [20])
    load = np.pi**2 * EI / L**2
    stiffness = []
    for share in (0.99, 1.01):
        end = dof(1, X)
        pressed = CLAMP | {end: -share * load * L / EA, dof(1, TURN): 0.0}
        pose = large.move(large.rest(), pressed | {dof(1, Y): 1e-4})
        stiffness.append(pose.reactions[dof(1, Y)])
    assert stiffness[0] > 0.0 > stiffness[1]
