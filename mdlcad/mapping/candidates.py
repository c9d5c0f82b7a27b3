"""Which nodes of the subject graph one mass can compute, and from which other nodes."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

from mdlcad.mapping.subject import Subject
from mdlcad.mapping.threshold import Threshold, match

MOST_LEAVES = 4
_MOST_CUTS = 40
# of all nodes together; a larger graph gets fewer a node, but never fewer than the least
_ALL_CUTS = 40_000
_LEAST_CUTS = 10
_PASSES = 2

Cut = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Candidate:
    """A threshold gate: ``function`` of the ``leaves`` (nodes, ascending)."""

    leaves: tuple[int, ...]
    function: Threshold

    def negated(self) -> Candidate:
        """The gate of the inverse function."""
        return Candidate(self.leaves, self.function.negated())


def find_candidates(subject: Subject, weight_limit: int) -> list[tuple[Candidate, ...]]:
    """For every node the gates that compute it (not inverted); none for inputs and the constant.

    Equal leaves appear once, with the lightest function; a leaf is never the node itself.
    """
    cuts = _cuts(subject)
    found = []
    for node, ways in enumerate(subject.ways):
        gates = []
        for cut in cuts[node] if ways else ():
            if cut == (node,):
                continue
            on, off = _local_function(subject, node, cut)
            function = match(on, off, len(cut), weight_limit)
            if function is not None:
                gates.append(Candidate(cut, function))
        found.append(tuple(gates))
    return found


def _cuts(subject: Subject) -> list[list[Cut]]:
    cuts: list[list[Cut]] = [[(node,)] for node in range(len(subject.ways))]
    most = max(_LEAST_CUTS, min(_MOST_CUTS, _ALL_CUTS // len(cuts)))
    for _ in range(_PASSES if subject.exact else 1):
        for node, ways in enumerate(subject.ways):
            if not ways:
                continue
            found: set[Cut] = set(cuts[node])
            for a, b, _ in ways:
                for left, right in product(cuts[a >> 1], cuts[b >> 1]):
                    merged = tuple(sorted({*left, *right}))
                    if len(merged) <= MOST_LEAVES and node not in merged:
                        found.add(merged)
            cuts[node] = sorted(found, key=lambda cut: (cut != (node,), len(cut), cut))[:most]
    return cuts


def _local_function(subject: Subject, node: int, cut: Cut) -> tuple[int, int]:
    """Minterms of the leaves for which the node is 1, and those for which it is 0; the others never occur."""
    if not subject.exact:
        table = _cone_table(subject, node, cut)
        return table, table ^ ((1 << (1 << len(cut))) - 1)
    value = subject.table(2 * node)
    regions = [subject.full]
    for leaf in reversed(cut):
        table = subject.table(2 * leaf)
        regions = [half for region in regions for half in (region & ~table, region & table)]
    on = off = 0
    for minterm, region in enumerate(regions):
        if region & value:
            on |= 1 << minterm
        if region & ~value:
            off |= 1 << minterm
    return on, off


def _cone_table(subject: Subject, node: int, cut: Cut) -> int:
    minterms = 1 << len(cut)
    full = (1 << minterms) - 1
    tables = {0: 0}
    for index, leaf in enumerate(cut):
        tables[leaf] = sum(1 << m for m in range(minterms) if m >> index & 1)
    stack = [node]
    while stack:
        top = stack[-1]
        if top in tables:
            stack.pop()
            continue
        a, b, _ = subject.ways[top][0]
        missing = [lit >> 1 for lit in (b, a) if lit >> 1 not in tables]
        if missing:
            stack += missing
        else:
            left = tables[a >> 1] ^ (full if a & 1 else 0)
            right = tables[b >> 1] ^ (full if b & 1 else 0)
            tables[stack.pop()] = left & right
    return tables[node]
