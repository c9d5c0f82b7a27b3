"""Which lines end at a node, as compressed rows."""

from __future__ import annotations

import numpy as np

from mdlcad.placement.sites.problem import Ints, SiteProblem


def incidence(problem: SiteProblem) -> tuple[Ints, Ints]:
    """(N + 1,) start of every node's entries and (2 L,) indices of lines, for all N nodes with the pins."""
    ends = problem.lines.reshape(-1)
    order = np.argsort(ends, kind="stable")
    start = np.searchsorted(ends[order], np.arange(problem.nodes + len(problem.pins) + 1))
    return start.astype(np.int64), (order // 2).astype(np.int64)
