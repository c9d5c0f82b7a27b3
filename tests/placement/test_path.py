import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mdlcad.placement.path import TOGETHER, Place, path_of


@given(st.lists(st.integers(1, 40), min_size=1, max_size=60), st.integers(2, 15))
def test_steps_to_the_same_column_or_its_neighbour(sizes: list[int], columns: int) -> None:
    path = path_of(sizes, [5] * len(sizes), columns)
    assert len(path) == len(sizes)
    assert path[0] == Place(0, 0)
    for one, two in itertools.pairwise(path):
        assert 0 <= two.column < columns
        assert abs(two.column - one.column) <= 1
        assert two.band - one.band in (0, 1)
        assert two.band == one.band or two.column == one.column


def test_goes_once_across_where_there_are_hardly_more_levels_than_columns() -> None:
    path = path_of([20] * 28, [20] * 28, 20)
    assert {place.band for place in path} == {0}
    assert path[-1].column == 19


@pytest.mark.parametrize("columns", (20, 21, 40))
def test_columns_hold_about_as_many_masses_each(columns: int) -> None:
    rng = np.random.default_rng(1)
    sizes = rng.integers(3, 30, round(1.4 * columns)).tolist()
    held = np.zeros(columns)
    for size, place in zip(sizes, path_of(sizes, [20] * len(sizes), columns), strict=True):
        held[place.column] += size
    # by number, without a look at sizes: the way that was taken before
    plain = np.bincount([rank * columns // len(sizes) for rank in range(len(sizes))], sizes, columns)
    assert np.std(held[1:]) < 0.8 * np.std(plain[1:])


@pytest.mark.parametrize("thin", (36, 38, 40))
def test_turns_where_few_nets_pass(thin: int) -> None:
    cuts = [25] * 90
    cuts[thin] = 3
    path = path_of([20] * 90, cuts, 30)
    turns = [rank for rank in range(1, len(path)) if path[rank].band != path[rank - 1].band]
    assert turns == [thin]


def test_few_share_a_column() -> None:
    path = path_of([10] * 40, [10] * 40, 30)
    assert max(path.count(place) for place in path) <= TOGETHER
