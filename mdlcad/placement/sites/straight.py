"""Our placer on sites: annealing of length and crossings together, from where the lines alone would pull the masses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csc_array
from scipy.sparse.linalg import spsolve

from mdlcad.placement.sites.assign import assign
from mdlcad.placement.sites.incidence import incidence
from mdlcad.placement.sites.kernels import anneal_straight
from mdlcad.placement.sites.problem import Floats, Sited, SiteProblem, measure


@dataclass(frozen=True, slots=True)
class StraightOptions:
    """How hard to try.

    Attributes:
        moves_per_mass: annealing moves for every mass.
        price: what a crossing costs, in footprints of length.
        hot, cold: first and last temperature, in footprints of length.
    """

    moves_per_mass: int = 1000
    price: float = 1.5
    hot: float = 3.0
    cold: float = 0.15


def place_straight(problem: SiteProblem, seed: int, options: StraightOptions | None = None) -> Sited:
    """Anneal from the spring equilibrium. Same arguments, same result."""
    options = options or StraightOptions()
    if problem.nodes == 0:
        return measure(problem, np.zeros(0, np.int64))
    random = np.random.Generator(np.random.PCG64(seed))
    site_of = assign(_equilibrium(problem), problem)
    source = random.integers(1, 2**63, size=1, dtype=np.uint64)
    start, lines = incidence(problem)
    anneal_straight(
        problem.points(site_of),
        problem.sites,
        problem.lines,
        start,
        lines,
        site_of,
        options.moves_per_mass * problem.nodes,
        options.hot,
        options.cold,
        options.price,
        source,
    )
    return measure(problem, site_of)


def _equilibrium(problem: SiteProblem) -> Floats:
    """(n, 2) where the movable nodes rest if every line is the same linear spring and the pins hold.

    The least sum of squared lengths (Hall 1970). A weak spring to the middle of the sites holds nodes that no line
    joins to a pin.
    """
    count = problem.nodes + len(problem.pins)
    a, b = problem.lines[:, 0], problem.lines[:, 1]
    weak = 1e-3
    ones = np.ones(len(a))
    rows, columns = np.concatenate([a, b, a, b]), np.concatenate([b, a, a, b])
    pull = csc_array(coo_array((np.concatenate([-ones, -ones, ones, ones]), (rows, columns)), shape=(count, count)))
    free = pull[: problem.nodes, : problem.nodes] + weak * csc_array(np.eye(problem.nodes))
    held = pull[: problem.nodes, problem.nodes :] @ problem.pins
    middle = problem.sites.mean(axis=0)
    return np.stack([spsolve(free, weak * middle[k] - held[:, k]) for k in (0, 1)], axis=1)
