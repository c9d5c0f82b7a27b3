"""What tilting shuttles take, against a stiffness matrix that has their angles as unknowns of their own."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mdlcad.parts.lean import Pull, lean_stiffnesses

TILT = 956.0


def test_one_coupling_is_weakened_by_both_levers() -> None:
    (lean,) = lean_stiffnesses([Pull("a", "b", 0.3, 8.0, 12.0, -1.0)], TILT)
    assert lean == pytest.approx(TILT / (8.0**2 + 12.0**2))


def test_on_stiff_shuttles_it_is_none() -> None:
    (lean,) = lean_stiffnesses([Pull("a", "b", 0.3, 8.0, 12.0, 1.0)], 1e15)
    assert lean == pytest.approx(1e9)
    assert lean_stiffnesses([], TILT) == ()


def test_many_couplings_of_one_net_take_more_from_each() -> None:
    one = lean_stiffnesses([Pull("a", "b0", 0.3, 8.0, 8.0, -1.0)], TILT)
    many = lean_stiffnesses([Pull("a", f"b{i}", 0.3, 8.0, 8.0, -1.0) for i in range(4)], TILT)
    assert max(many) < min(one)
    assert many == pytest.approx([many[0]] * 4)


def test_a_coupling_that_others_overwhelm_is_next_to_nothing() -> None:
    strong = [Pull(f"a{i}", "b", 50.0, 1.0, 1.0, -1.0) for i in range(3)]
    (lean, *_) = lean_stiffnesses([Pull("a", "b", 0.01, 40.0, 40.0, -1.0), *strong], 10.0)
    assert 0.0 < lean < 0.0001


@given(
    st.lists(
        st.tuples(st.floats(0.05, 0.6), st.floats(4.0, 14.0), st.floats(4.0, 26.0), st.sampled_from([-1.0, 1.0])),
        min_size=1,
        max_size=8,
    ),
    st.randoms(use_true_random=False),
)
def test_it_is_what_a_matrix_with_all_angles_says(couplings, random) -> None:
    pairs = [(a, b) for a in range(5) for b in range(5) if a < b]
    random.shuffle(pairs)
    joined = [(pair, numbers) for pair, numbers in zip(pairs, couplings, strict=False)]
    pulls = [Pull(str(a), str(b), *numbers) for (a, b), numbers in joined]
    # unknowns: y and angle of every shuttle; each coupling is a spring between two points above them
    matrix = np.zeros((10, 10))
    for (a, b), (stiffness, low, high, turning) in joined:
        reach = np.zeros(10)
        reach[a], reach[5 + a], reach[b], reach[5 + b] = 1.0, low, turning, turning * high
        matrix += stiffness * np.outer(reach, reach)
    angles = matrix[5:, 5:] + TILT * np.eye(5)
    held = matrix[:5, :5] - matrix[:5, 5:] @ np.linalg.solve(angles, matrix[5:, :5])
    for ((a, b), (stiffness, _, _, turning)), lean in zip(joined, lean_stiffnesses(pulls, TILT), strict=True):
        left = min(max(turning * held[b, a], 1e-3 * stiffness), stiffness)  # where others add to it, it has no lean
        assert lean * stiffness / (lean + stiffness) == pytest.approx(left, rel=1e-6)
