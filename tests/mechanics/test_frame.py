import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mdlcad.mechanics.frame import TURN, Beam, Frame, Spring, X, Y, dof

EA, EI, L = 1e5, 58.0, 12.5
CLAMP = {dof(0, X): 0.0, dof(0, Y): 0.0, dof(0, TURN): 0.0}


def single(angle: float = 0.0) -> Frame:
    return Frame([(0.0, 0.0), (L * np.cos(angle), L * np.sin(angle))], [Beam(0, 1, EA, EI)])


def test_cantilever() -> None:
    solution = single().solve(CLAMP, {dof(1, Y): 1.0})
    assert solution.displacements[dof(1, Y)] == pytest.approx(L**3 / (3 * EI))
    assert solution.displacements[dof(1, TURN)] == pytest.approx(L**2 / (2 * EI))
    assert solution.reactions[dof(0, TURN)] == pytest.approx(-L)


def test_guided() -> None:
    solution = single().solve(CLAMP | {dof(1, Y): 1.0, dof(1, TURN): 0.0})
    assert solution.reactions[dof(1, Y)] == pytest.approx(12 * EI / L**3)
    assert single().end_moments(single().beams[0], solution)[1] == pytest.approx(-6 * EI / L**2)


def test_pinned_ends_and_a_load_in_the_middle() -> None:
    frame = Frame([(0, 0), (L / 2, 0), (L, 0)], [Beam(0, 1, EA, EI), Beam(1, 2, EA, EI)])
    supports = {dof(0, X): 0.0, dof(0, Y): 0.0, dof(2, Y): 0.0}
    assert frame.solve(supports, {dof(1, Y): 1.0}).displacements[dof(1, Y)] == pytest.approx(L**3 / (48 * EI))


def test_axial_and_spring_in_series() -> None:
    frame = Frame([(0, 0), (L, 0)], [Beam(0, 1, EA, EI)], [Spring(dof(0, X), 7.0)])
    seen = frame.condense([dof(1, X)], [dof(0, Y), dof(0, TURN), dof(1, Y), dof(1, TURN)])[0, 0]
    assert seen == pytest.approx(1 / (1 / 7.0 + L / EA))


def test_a_bent_cantilever_by_the_unit_load() -> None:
    # an L of two arms a: tip force along the first arm; y = F a^3 / 3EI + F a^2 a / EI for stiff axial bars
    a = 5.0
    frame = Frame([(0, 0), (0, a), (a, a)], [Beam(0, 1, 1e9, EI), Beam(1, 2, 1e9, EI)])
    moved = frame.solve(CLAMP, {dof(2, Y): 1.0}).displacements[dof(2, Y)]
    assert moved == pytest.approx(a**3 / (3 * EI) + a**3 / EI, rel=1e-4)


def test_an_unsupported_frame_is_refused() -> None:
    with pytest.raises(np.linalg.LinAlgError):
        single().solve({}, {dof(1, Y): 1.0})


@settings(max_examples=25, deadline=None)
@given(st.floats(-3.0, 3.0), st.integers(1, 6))
def test_turning_and_splitting_a_beam_changes_nothing(angle: float, parts: int) -> None:
    points = [(L * i / parts * np.cos(angle), L * i / parts * np.sin(angle)) for i in range(parts + 1)]
    frame = Frame(points, [Beam(i, i + 1, EA, EI) for i in range(parts)])
    load = {dof(parts, X): -np.sin(angle), dof(parts, Y): np.cos(angle)}
    moved = frame.solve(CLAMP, load).displacements
    across = -np.sin(angle) * moved[dof(parts, X)] + np.cos(angle) * moved[dof(parts, Y)]
    assert across == pytest.approx(L**3 / (3 * EI), rel=1e-6)


def test_deformed_shape_of_a_guided_beam() -> None:
    frame = single()
    solution = frame.solve(CLAMP | {dof(1, X): 0.0, dof(1, Y): 2.0, dof(1, TURN): 0.0})
    at = np.linspace(0, 1, 11)
    points, turns = frame.deformed(frame.beams[0], solution, at)
    assert points[:, 1] == pytest.approx(2.0 * (3 * at**2 - 2 * at**3))
    assert turns == pytest.approx(2.0 * (6 * at - 6 * at**2) / L)
    # the shortening coefficient g of a guided beam: g = L/(2 A^2) * integral of slope^2 = 0.6
    fine = frame.deformed(frame.beams[0], solution, np.linspace(0, 1, 2001))[1]
    assert np.mean(fine[:-1] ** 2) * L**2 / (2 * 4.0) == pytest.approx(0.6, rel=1e-3)
