"""The paper's placer: a force-directed layout onto sites, again with the pins held, then swaps that uncross.

The steps are those of the paper's appendix on placement. Its solver for the assignment (CP-SAT) is replaced by the
exact algorithm for that problem, which gives an optimum of the same cost in a fraction of the time. Its limit on time
is a limit on pairs tested here, so that the same seed gives the same result on any machine.
"""

from __future__ import annotations

from dataclasses import dataclass

import networkx as nx
import numpy as np

from mdlcad.placement.sites.assign import assign
from mdlcad.placement.sites.incidence import incidence
from mdlcad.placement.sites.kernels import swap_greedily
from mdlcad.placement.sites.problem import Floats, Sited, SiteProblem, measure


@dataclass(frozen=True, slots=True)
class PaperOptions:
    """What the paper lets its user set.

    Attributes:
        iterations: of the first layout. iterations_pinned: of the second, with the pins held.
        sweeps: most scans of the crossing removal; 0 leaves it out.
        radius: how far apart swapped masses may be, in footprints.
        tests: most pairs tested in all.
    """

    iterations: int = 100
    iterations_pinned: int = 100
    sweeps: int = 30
    radius: float = 3.0
    tests: int = 1_000_000


def place_like_the_paper(problem: SiteProblem, seed: int, options: PaperOptions | None = None) -> Sited:
    """One run of the paper's method. Same arguments, same result."""
    options = options or PaperOptions()
    if problem.nodes == 0:
        return measure(problem, np.zeros(0, np.int64))
    free = _fit(_spring(problem, None, options.iterations, seed), problem)
    first = assign(free, problem)
    held = _spring(problem, problem.points(first), options.iterations_pinned, seed)
    site_of = assign(held, problem)
    start, lines = incidence(problem)
    swap_greedily(
        problem.points(site_of), problem.lines, start, lines, site_of, options.radius, options.sweeps, options.tests
    )
    return measure(problem, site_of)


def _spring(problem: SiteProblem, start: Floats | None, iterations: int, seed: int) -> Floats:
    """(N, 2) the Fruchterman-Reingold layout; from ``start``, with the pins held there, if given."""
    count = problem.nodes + len(problem.pins)
    graph = nx.Graph()
    graph.add_nodes_from(range(count))
    graph.add_edges_from(problem.lines.tolist())
    pins = list(range(problem.nodes, count))
    found = nx.spring_layout(
        graph,
        pos=None if start is None else dict(enumerate(start)),
        fixed=pins if start is not None and pins else None,
        iterations=iterations,
        method="force",
        seed=np.random.RandomState(seed),
    )
    return np.array([found[node] for node in range(count)])


def _fit(points: Floats, problem: SiteProblem) -> Floats:
    """Stretched so that the layout fills the box of the sites and pins."""
    all_places = np.concatenate([problem.sites, problem.pins])
    low, high = all_places.min(axis=0), all_places.max(axis=0)
    least, most = points.min(axis=0), points.max(axis=0)
    return np.asarray(low + (points - least) / np.maximum(most - least, 1e-12) * (high - low))
