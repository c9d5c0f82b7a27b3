"""The least set of couplings that must stay negative, as an exact covering problem.

A choice of polarity exists that leaves only the couplings of a set F negative, if and only if every cycle with an odd
number of negative couplings has one in F (Harary's balance theorem). There are too many cycles to list: they are found
as they are violated, by shortest paths in the signed double cover (every mass twice, a negative coupling changes
sides; a path from a mass to its twin is an odd cycle), first for the linear relaxation, then for whole solutions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
import numpy.typing as npt
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

Floats = npt.NDArray[np.float64]

_ROUNDS = 200
"""Most times that violated cycles are looked for; a hundred couplings take five, a thousand fifty."""
_NODES = 20_000
"""Most nodes of the solver's search; the relaxation is nearly tight, so a few hundred are many."""
_NEARLY_ONE = 1.0 - 1e-6
_TIE = 1e-6
"""Length added to every coupling, so that of equal cycles the shorter is found."""


@dataclass(frozen=True, slots=True)
class SignedGraph:
    """Nodes 0..n-1 and couplings between them, each negative or not.

    Attributes:
        ends: two nodes a coupling; both may be the same.
        groups: couplings (indices) of which no more than a number should be negative, with that number.
    """

    nodes: int
    ends: tuple[tuple[int, int], ...]
    negative: tuple[bool, ...]
    groups: tuple[tuple[tuple[int, ...], int], ...] = ()


@dataclass(frozen=True, slots=True)
class Frustration:
    """Couplings to leave negative: one entry each.

    Attributes:
        crowded: couplings beyond the numbers of their groups, in all.
        proven: no choice has fewer crowded couplings, and none with as few has fewer negative ones.
    """

    negative: tuple[bool, ...]
    crowded: int
    proven: bool


def least_frustration(graph: SignedGraph) -> Frustration:
    """The fewest couplings beyond their groups' numbers, and of such choices the fewest negative couplings."""
    cycles: dict[tuple[int, ...], None] = {}
    for i, (a, b) in enumerate(graph.ends):
        if a == b and graph.negative[i]:
            cycles[(i,)] = None
    for _ in range(_ROUNDS):
        if not _add(cycles, violated(graph, _solve(graph, list(cycles), Kind.RELAXED)[0])):
            break
    for _ in range(_ROUNDS):
        weights, proven = _solve(graph, list(cycles), Kind.WHOLE)
        if not _add(cycles, violated(graph, weights)):
            break
    else:
        proven = False
    chosen = weights > 0.5
    crowded = sum(max(0, int(chosen[list(group)].sum()) - room) for group, room in graph.groups)
    return Frustration(tuple(bool(item) for item in chosen), crowded, proven)


def _add(cycles: dict[tuple[int, ...], None], found: Sequence[tuple[int, ...]]) -> int:
    before = len(cycles)
    cycles.update(dict.fromkeys(found))
    return len(cycles) - before


class Kind(Enum):
    """RELAXED: fractions of couplings are allowed. WHOLE: they are not."""

    RELAXED = 0
    WHOLE = 1


def _solve(graph: SignedGraph, cycles: list[tuple[int, ...]], kind: Kind) -> tuple[Floats, bool]:
    """Weights float[couplings] that cover ``cycles`` at the least cost, and whether that is proven (HiGHS).

    Behind the couplings the problem has one variable for each group: how many it holds too many.
    """
    count, spare = len(graph.ends), len(graph.groups)
    rows = [(cycle, 1.0) for cycle in cycles]
    rows += [((*group, count + g), -1.0) for g, (group, _) in enumerate(graph.groups)]
    if not rows:
        return np.zeros(count), True
    lengths = [len(members) for members, _ in rows]
    column = np.concatenate([np.array(members, np.int64) for members, _ in rows])
    data = np.repeat([sign for _, sign in rows], lengths)
    start = np.concatenate([[0], np.cumsum(lengths)])
    # a group's row: -(sum of its couplings) + too many >= -room
    data[start[1 + len(cycles) :] - 1] = 1.0
    least = [1.0] * len(cycles) + [-float(room) for _, room in graph.groups]
    found = milp(
        np.concatenate([np.ones(count), np.full(spare, count + 1.0)]),
        constraints=LinearConstraint(
            csr_array((data, column, start), shape=(len(rows), count + spare)), np.array(least), np.inf
        ),
        integrality=np.full(count + spare, kind.value),
        bounds=Bounds(0.0, np.concatenate([np.ones(count), np.full(spare, np.inf)])),
        options={"node_limit": _NODES, "mip_rel_gap": 0.0},
    )
    if found.x is None:
        # every coupling negative covers all cycles
        return np.ones(count), False
    weights = np.asarray(found.x[:count], np.float64)
    return (np.round(weights) if kind is Kind.WHOLE else weights), found.status == 0


def violated(graph: SignedGraph, weights: Floats) -> list[tuple[int, ...]]:
    """Odd cycles (sorted couplings) of total weight below 1, at most one through every node.

    A path from a node to its twin is the mirror image of the way back, so each is looked for as two paths from that
    node, of at most half the length, that meet in a coupling.
    """
    n = graph.nodes
    best: dict[tuple[int, int], tuple[float, int]] = {}
    for i, ((a, b), negative) in enumerate(zip(graph.ends, graph.negative, strict=True)):
        if a == b:
            continue
        step = float(weights[i]) + _TIE
        for side in (0, 1):
            other = side ^ negative
            for u, v in ((a + side * n, b + other * n), (b + other * n, a + side * n)):
                if (u, v) not in best or step < best[u, v][0]:
                    best[u, v] = (step, i)
    if not best:
        return []
    keys = np.array(list(best), np.int64)
    steps = np.array([step for step, _ in best.values()])
    cover = csr_array((steps, (keys[:, 0], keys[:, 1])), shape=(2 * n, 2 * n))
    through = _ends_of_few(graph)
    if not through:
        return []
    distance, before = dijkstra(cover, indices=np.array(through), limit=0.5, return_predecessors=True)
    # a step of the cover and its mirror image close the same cycles
    once = keys[:, 0] < (keys[:, 1] + n) % (2 * n)
    tail, mirrored, steps = keys[once, 0], (keys[once, 1] + n) % (2 * n), steps[once]
    found: dict[tuple[int, ...], None] = {}
    for node, away, back_from in zip(through, distance, before, strict=True):
        closed = away[tail] + steps + away[mirrored]
        pick = int(np.argmin(closed))
        if not closed[pick] < _NEARLY_ONE:
            continue
        there, back = int(tail[pick]), int(mirrored[pick])
        walk = [(at % n, previous % n, best[previous, at][1]) for previous, at in _steps(back_from, node, back)]
        walk.reverse()
        walk.append((there % n, back % n, best[there, (back + n) % (2 * n)][1]))
        walk += [(previous % n, at % n, best[previous, at][1]) for previous, at in _steps(back_from, node, there)]
        cycle = _odd_cycle(walk, graph.negative)
        if sum(float(weights[i]) for i in cycle) < _NEARLY_ONE:
            found[cycle] = None
    return list(found)


def _ends_of_few(graph: SignedGraph) -> list[int]:
    """Nodes that every odd cycle has one of: the ends of the couplings that are negative after turning nodes round.

    Turning a node changes the sign of all its couplings, and no cycle's number of negative ones from odd to even. As
    long as a node with more negative couplings than positive ones is turned, they become fewer.
    """
    beside: list[list[int]] = [[] for _ in range(graph.nodes)]
    for i, (a, b) in enumerate(graph.ends):
        if a != b:
            beside[a].append(i)
            beside[b].append(i)
    minus = list(graph.negative)
    waiting = list(range(graph.nodes))
    while waiting:
        node = waiting.pop()
        if 2 * sum(minus[i] for i in beside[node]) <= len(beside[node]):
            continue
        for i in beside[node]:
            minus[i] = not minus[i]
            waiting += graph.ends[i]
    return sorted({node for ends, left in zip(graph.ends, minus, strict=True) if left for node in ends})


def _steps(before: npt.NDArray[np.int32], start: int, end: int) -> list[tuple[int, int]]:
    """The shortest path's steps (from, to), the last first."""
    steps = []
    while end != start:
        steps.append((int(before[end]), end))
        end = steps[-1][0]
    return steps


def _odd_cycle(path: list[tuple[int, int, int]], negative: Sequence[bool]) -> tuple[int, ...]:
    """An odd cycle without repeated nodes in a closed walk of (node, next node, coupling), walked backwards."""
    visited: list[int] = [path[0][1]]
    taken: list[int] = []
    for previous, _, coupling in path:
        taken.append(coupling)
        if previous in visited:
            at = visited.index(previous)
            loop = taken[at:]
            if sum(negative[i] for i in loop) % 2:
                return tuple(sorted(loop))
            # an even loop is left out: the rest of the walk is odd
            del taken[at:], visited[at + 1 :]
        else:
            visited.append(previous)
    raise AssertionError("a path from a mass to its twin has an odd cycle")
