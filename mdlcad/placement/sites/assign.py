"""From places anywhere to sites of their own."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment

from mdlcad.placement.sites.problem import Floats, Ints, SiteProblem


def assign(points: Floats, problem: SiteProblem) -> Ints:
    """(n,) a site for every movable node, for the least sum of squared distances from ``points`` (at least n rows)."""
    offsets = points[: problem.nodes, None, :] - problem.sites[None, :, :]
    _, columns = linear_sum_assignment((offsets**2).sum(axis=2))
    return np.asarray(columns, np.int64)
