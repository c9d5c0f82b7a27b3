from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mdlcad.mapping.frustration import SignedGraph, least_frustration, violated


@st.composite
def graphs(draw: st.DrawFn) -> SignedGraph:
    nodes = draw(st.integers(2, 6))
    ends = draw(st.lists(st.tuples(st.integers(0, nodes - 1), st.integers(0, nodes - 1)), min_size=1, max_size=12))
    negative = draw(st.lists(st.booleans(), min_size=len(ends), max_size=len(ends)))
    groups = draw(
        st.lists(
            st.tuples(
                st.lists(st.integers(0, len(ends) - 1), min_size=1, max_size=5, unique=True).map(tuple),
                st.integers(0, 2),
            ),
            max_size=3,
        )
    )
    return SignedGraph(nodes, tuple(ends), tuple(negative), tuple(groups))


def price(graph: SignedGraph, negative: list[bool]) -> tuple[int, int]:
    crowded = sum(max(0, sum(negative[i] for i in group) - room) for group, room in graph.groups)
    return crowded, sum(negative)


@given(graphs())
@settings(max_examples=120, deadline=None)
def test_no_choice_of_signs_is_better(graph: SignedGraph) -> None:
    found = least_frustration(graph)
    assert found.proven
    every = (
        [minus ^ (signs[a] != signs[b]) for (a, b), minus in zip(graph.ends, graph.negative, strict=True)]
        for signs in product((1, -1), repeat=graph.nodes)
    )
    assert (found.crowded, sum(found.negative)) == min(price(graph, negative) for negative in every)


def test_an_odd_cycle_is_found_and_an_even_one_is_not() -> None:
    ring = ((0, 1), (1, 2), (2, 3), (3, 0))
    odd = SignedGraph(4, ring, (True, False, False, False))
    even = SignedGraph(4, ring, (True, False, True, False))
    assert violated(odd, np.zeros(4)) == [(0, 1, 2, 3)]
    assert violated(even, np.zeros(4)) == []
    assert violated(odd, np.array([1.0, 0.0, 0.0, 0.0])) == []


@pytest.mark.parametrize("doubled", [(0, 1), (1, 0)])
def test_two_couplings_of_opposite_sign_between_two_masses(doubled: tuple[int, int]) -> None:
    graph = SignedGraph(2, ((0, 1), doubled), (True, False))
    assert sum(least_frustration(graph).negative) == 1
