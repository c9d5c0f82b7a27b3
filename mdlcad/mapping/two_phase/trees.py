"""Fan-out trees: one output, many inputs, some of which want its inverse.

A tree's nodes are buffers and inverters. An inverter is a buffer that also inverts, so where both polarities are
wanted the tree mixes the two, and needs no more nodes than one that only copies.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

# Up to this many inputs the fewest nodes are found; more are first gathered under buffers.
_EXACT = 16

Counts = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Move:
    """Put ``count`` inputs that want polarity ``inverted`` under one node; ``flips`` if that node is an inverter."""

    inverted: bool
    count: int
    flips: bool

    def after(self, counts: Counts) -> Counts:
        """How many (plain, inverted) inputs remain, the node itself being one of them."""
        left = [counts[0], counts[1]]
        left[self.inverted] -= self.count
        left[self.inverted != self.flips] += 1
        return (left[0], left[1])


@dataclass(frozen=True, slots=True)
class Branch:
    """Something to drive: ``ref`` is a number of the caller's; ``depth`` the cycles that follow after it.

    ``inner`` is None for the caller's own, else what the branch drives in turn.
    """

    ref: int
    inverted: bool
    depth: int
    inner: TreeNode | None = None

    def ends(self) -> list[int]:
        """The caller's numbers of all that the branch drives in the end."""
        if self.inner is None:
            return [self.ref]
        return sorted(ref for branch in self.inner.branches for ref in branch.ends())


@dataclass(frozen=True, slots=True)
class TreeNode:
    """A buffer, or an inverter if ``flips``."""

    flips: bool
    branches: tuple[Branch, ...]


class TreePlanner:
    """Plans trees for outputs that may drive at most ``limit`` inputs (None: any number, and only inverters
    are made)."""

    def __init__(self, limit: int | None) -> None:
        self._limit = limit
        self._plans: dict[Counts, tuple[Move, ...]] = {}

    def nodes(self, plain: int, inverted: int) -> int:
        """How many nodes the tree for so many inputs has."""
        return len(self._moves((plain, inverted)))

    def plan(self, branches: list[Branch]) -> tuple[Branch, ...]:
        """What the output drives directly. Inputs with the fewest cycles after them go deepest into the tree."""
        pools: list[list[Branch]] = [[b for b in branches if b.inverted == side] for side in (False, True)]
        for pool in pools:
            pool.sort(key=lambda b: (b.depth, b.ref))
        for move in self._moves((len(pools[0]), len(pools[1]))):
            pool = pools[move.inverted]
            taken = tuple(pool[: move.count])
            del pool[: move.count]
            side = move.inverted != move.flips
            node = Branch(
                ref=min(b.ref for b in taken),
                inverted=side,
                depth=1 + max(b.depth for b in taken),
                inner=TreeNode(move.flips, taken),
            )
            pools[side].append(node)
            pools[side].sort(key=lambda b: (b.depth, b.ref))
        return tuple(pools[0])

    def gather(self, branches: list[Branch]) -> list[Branch]:
        """All of ``branches``, which want the same polarity, under as few buffers as hold them."""
        limit = self._limit or len(branches)
        groups = [tuple(branches[at : at + limit]) for at in range(0, len(branches), limit)]
        return [
            Branch(group[0].ref, group[0].inverted, 1 + max(b.depth for b in group), TreeNode(False, group))
            for group in groups
        ]

    def _moves(self, counts: Counts) -> tuple[Move, ...]:
        if counts not in self._plans:
            self._plans[counts] = self._search(counts)
        return self._plans[counts]

    def _search(self, counts: Counts) -> tuple[Move, ...]:
        if self._limit is None:
            return (Move(True, counts[1], True),) if counts[1] else ()
        gathered: list[Move] = []
        while sum(counts) > _EXACT:
            move = Move(counts[1] > counts[0], self._limit, False)
            gathered.append(move)
            counts = move.after(counts)
        ways: dict[Counts, tuple[Move, ...]] = {counts: ()}
        queue = deque([counts])
        while True:
            here = queue.popleft()
            if here[1] == 0 and here[0] <= self._limit:
                return (*gathered, *ways[here])
            for move in self._possible(here, self._limit):
                there = move.after(here)
                if there not in ways:
                    ways[there] = (*ways[here], move)
                    queue.append(there)

    @staticmethod
    def _possible(counts: Counts, limit: int) -> list[Move]:
        """Buffers before inverters, full nodes before others, so that ties fall to the plainest tree."""
        return [
            Move(side, count, flips)
            for flips in (False, True)
            for count in range(limit, 0, -1)
            for side in (False, True)
            if count <= counts[side] and (flips or count > 1)
        ]
