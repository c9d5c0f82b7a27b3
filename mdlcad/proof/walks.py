"""Input walks from power-up that together make given moves of a graph.

Lanes start at power-up and run side by side. The shortest lane always goes next: it takes the shortest way to a move
that no lane has claimed, and claims it. So lanes end about equally long, and no state is ever forced.
"""

from __future__ import annotations

import heapq

import numpy as np
from numpy.typing import NDArray

from mdlcad.proof.machine import Graph, Ints


def plan(graph: Graph, wanted: NDArray[np.bool_], lanes: int, seed: int) -> list[list[int]]:
    """Walks (vector indices, one list a lane) that make every wanted move (bool[n, k]) of ``graph``.

    A state's wanted moves are taken in a seeded random order, so that each is met after various histories. Lanes that
    can reach no unclaimed move end early; further lanes are opened as long as moves are left.

    Raises:
        ValueError: a wanted move cannot be reached from power-up.
    """
    rng = np.random.default_rng([seed, 1])
    open_moves: list[list[int]] = []
    for row in wanted:
        moves = np.flatnonzero(row)
        open_moves.append([int(v) for v in rng.permutation(moves)])
    left = np.array([len(moves) for moves in open_moves])

    walks: list[list[int]] = []
    heap: list[tuple[int, int, int]] = []  # length, lane, state
    remaining = int(left.sum())
    before = remaining + 1
    while remaining:
        if not heap:
            before = remaining
            for _ in range(lanes):
                heap.append((0, len(walks), 0))
                walks.append([])
        _, lane, state = heapq.heappop(heap)
        way = _way_to_open(graph, left, state)
        if way is None:
            if not heap and remaining == before:
                raise ValueError("some wanted moves cannot be reached from power-up")
            continue
        for vector in way:
            walks[lane].append(vector)
            state = int(graph.following[state, vector])
        vector = open_moves[state].pop()
        left[state] -= 1
        remaining -= 1
        walks[lane].append(vector)
        state = int(graph.following[state, vector])
        if state >= 0:
            heapq.heappush(heap, (len(walks[lane]), lane, state))
    return walks


def _way_to_open(graph: Graph, left: Ints, start: int) -> list[int] | None:
    """Fewest moves from ``start`` to a state with open moves (ties: lowest state number); None if there is none."""
    if left[start]:
        return []
    n, k = graph.following.shape
    parent = np.full(n, -1, dtype=np.int64)
    move = np.full(n, -1, dtype=np.int64)
    seen = np.zeros(n, dtype=bool)
    seen[start] = True
    frontier = np.array([start])
    while len(frontier):
        reached, index = np.unique(graph.following[frontier].ravel(), return_index=True)
        fresh = (reached >= 0) & ~seen[reached]
        reached, index = reached[fresh], index[fresh]
        seen[reached] = True
        parent[reached] = frontier[index // k]
        move[reached] = index % k
        goals = reached[left[reached] > 0]
        if len(goals):
            way = []
            state = int(goals[0])
            while state != start:
                way.append(int(move[state]))
                state = int(parent[state])
            return way[::-1]
        frontier = reached
    return None
