"""Fan-out trees: everything is driven, in its polarity, by outputs that keep their limit, with the fewest nodes."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mdlcad.mapping.two_phase.trees import Branch, TreePlanner


def leaves(direct: tuple[Branch, ...], inverted: bool = False) -> list[tuple[int, bool]]:
    found = []
    for branch in direct:
        if branch.inner is None:
            found.append((branch.ref, inverted))
        else:
            found += leaves(branch.inner.branches, inverted != branch.inner.flips)
    return found


def fan_outs(direct: tuple[Branch, ...]) -> list[int]:
    return [len(direct)] + [n for b in direct if b.inner for n in fan_outs(b.inner.branches)]


@given(st.lists(st.booleans(), max_size=40), st.integers(2, 4))
def test_a_tree_drives_all_in_their_polarity(wanted: list[bool], limit: int) -> None:
    planner = TreePlanner(limit)
    direct = planner.plan([Branch(ref, inverted, ref % 5) for ref, inverted in enumerate(wanted)])
    assert sorted(leaves(direct)) == list(enumerate(wanted))
    sizes = fan_outs(direct)
    assert max(sizes) <= limit
    assert len(sizes) - 1 == planner.nodes(wanted.count(False), wanted.count(True))


@pytest.mark.parametrize(
    ("plain", "inverted", "nodes"),
    [(0, 0, 0), (2, 0, 0), (3, 0, 1), (4, 0, 2), (7, 0, 5), (0, 1, 1), (0, 2, 1), (1, 1, 1), (3, 1, 2), (2, 3, 3)],
)
def test_fewest_nodes(plain: int, inverted: int, nodes: int) -> None:
    assert TreePlanner(2).nodes(plain, inverted) == nodes


def test_a_tree_needs_no_more_nodes_for_fewer_inputs() -> None:
    planner = TreePlanner(2)
    assert all(planner.nodes(n, 0) + 1 >= planner.nodes(n + 1, 0) for n in range(30))
    assert all(a <= b for a, b in pairwise([planner.nodes(n, 0) for n in range(30)]))


def test_inputs_with_long_ways_behind_them_stay_near() -> None:
    direct = TreePlanner(2).plan([Branch(0, False, 9), Branch(1, False, 0), Branch(2, False, 0)])
    assert [branch.ref for branch in direct if branch.inner is None] == [0]


def test_without_a_limit_only_inverters_are_made() -> None:
    direct = TreePlanner(None).plan([Branch(ref, ref == 3, 0) for ref in range(9)])
    assert len(direct) == 9
    assert sorted(leaves(direct)) == [(ref, ref == 3) for ref in range(9)]
