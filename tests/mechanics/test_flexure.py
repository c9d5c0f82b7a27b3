from itertools import pairwise

import numpy as np
import pytest

from mdlcad.mechanics.flexure import (
    Meander,
    Sheet,
    axial_stiffness,
    bias_chain,
    coupler_chain,
    deflect,
    examine,
    pitch_for,
    rocker_chain,
    signal_matrix,
)

SHEET = Sheet(2800.0, 3.0, 0.03)
SHAPE = Meander(wall=0.6, legs=4, pitch=3.0, amplitude=2.9)
STRAIGHT = Meander(wall=0.6, legs=2, pitch=4.0, amplitude=1e-6)  # no legs to speak of: a straight leaf
BENDING = 2800.0 * 3.0 * 0.6**3 / 12.0


def unit_load(path: list[tuple[float, float]]) -> tuple[float, float]:
    """(k_y, k_x) = EI over the integrals of (x - xm)^2 and (y - ym)^2 along the centre line (ends do not turn)."""
    points = np.array(path)
    ends = list(pairwise(points))
    lengths = [float(np.hypot(*(b - a))) for a, b in ends]
    middle = sum((a + b) / 2 * s for (a, b), s in zip(ends, lengths, strict=True)) / sum(lengths)
    second = np.zeros(2)
    for (a, b), s in zip(ends, lengths, strict=True):
        p, q = a - middle, b - middle
        second += s / 3 * (p * p + p * q + q * q)
    return BENDING / second[0], BENDING / second[1]


def test_coupler_against_the_unit_load_integrals() -> None:
    chain = coupler_chain(SHAPE, SHEET)
    matrix = signal_matrix(chain)
    along_y, along_x = unit_load(SHAPE.path())
    assert matrix[0, 0] == pytest.approx(along_y, rel=0.02)  # the frame stretches a little, the integrals do not
    assert matrix == pytest.approx(matrix[0, 0] * np.array([[1, -1], [-1, 1]]))
    assert axial_stiffness(chain) == pytest.approx(along_x, rel=0.02)


def test_a_straight_rocker_has_the_closed_form() -> None:
    # V = k [3.75 (xl^2 + xr^2) + 4.5 xl xr] with k = EI / r^3: s = 7.5 k, coupling 4.5 k
    chain = rocker_chain(STRAIGHT, SHEET, 1e-3)
    matrix = signal_matrix(chain)
    k = BENDING / STRAIGHT.length**3
    assert matrix[0, 0] == pytest.approx(7.5 * k, rel=2e-3)
    assert matrix[0, 1] == pytest.approx(4.5 * k, rel=2e-3)
    a = 2.0
    turned = examine(chain, deflect(chain, a, -a))
    assert turned.eye == pytest.approx(1.5 * a / STRAIGHT.length, rel=2e-3)
    assert examine(chain, deflect(chain, a, a)).eye == pytest.approx(0.0, abs=1e-7)


def test_a_straight_bias_leaf_is_a_guided_pinned_beam() -> None:
    chain = bias_chain(STRAIGHT, SHEET, 1e-3)
    assert signal_matrix(chain)[0, 0] == pytest.approx(3 * BENDING / STRAIGHT.length**3, rel=2e-3)


def test_strain_and_slope_of_a_straight_leaf() -> None:
    chain = coupler_chain(STRAIGHT, SHEET)
    seen = examine(chain, deflect(chain, 1.0, -1.0))
    length, relative = STRAIGHT.length, 2.0
    assert seen.strain == pytest.approx(3 * STRAIGHT.wall * relative / length**2, rel=2e-3)
    assert seen.slope == pytest.approx(1.5 * relative / length, rel=2e-2)
    assert seen.shortening == pytest.approx(0.6 * relative**2 / length, rel=2e-2)


def test_a_meander_stiffens_far_less_than_a_straight_leaf() -> None:
    def quartic(shape: Meander) -> float:
        chain = coupler_chain(shape, SHEET)
        stiffness = signal_matrix(chain)[0, 0]
        g = examine(chain, deflect(chain, 1.0, 0.0)).shortening
        return float(2 * axial_stiffness(chain) * g**2 / stiffness)

    assert quartic(SHAPE) < quartic(STRAIGHT) / 20


def test_clearance_sees_legs_that_would_meet() -> None:
    tight = Meander(wall=0.6, legs=6, pitch=1.1, amplitude=2.9)
    chain = coupler_chain(tight, SHEET)
    assert examine(chain, deflect(chain, 0.0, 0.0)).clearance == pytest.approx(0.5)
    assert examine(chain, deflect(chain, 2.7, -2.7)).clearance < 0.2


def test_pitch_for_finds_its_target_or_says_none() -> None:
    found = pitch_for(lambda p: 100.0 / p**3, 0.5, 1.0, 20.0)
    assert found == pytest.approx(200 ** (1 / 3), abs=6e-4)
    assert pitch_for(lambda p: 100.0 / p**3, 1e6, 1.0, 20.0) is None
    assert pitch_for(lambda p: 100.0 / p**3, 1e-6, 1.0, 20.0) is None
