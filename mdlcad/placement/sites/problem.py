"""Sites, pins and lines as arrays, and what a solution is worth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from mdlcad.placement.sites.kernels import count_crossings

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class SiteProblem:
    """Nodes 0..n-1 can move and take one site each; nodes n..n+P-1 are pins that stay.

    Attributes:
        nodes: n.
        sites: (S, 2) places, in footprints; S >= n.
        pins: (P, 2) places of the pins, in footprints.
        lines: (L, 2) pairs of nodes that are coupled, each pair once, the lower first, in order.
    """

    nodes: int
    sites: Floats
    pins: Floats
    lines: Ints

    def __post_init__(self) -> None:
        if len(self.sites) < self.nodes:
            raise ValueError(f"{self.nodes} masses do not fit {len(self.sites)} sites")

    def points(self, site_of: Ints) -> Floats:
        """(n + P, 2) places of all nodes when node i sits on site ``site_of[i]``."""
        return np.concatenate([self.sites[site_of], self.pins])


@dataclass(frozen=True, slots=True, eq=False)
class Sited:
    """A solution.

    Attributes:
        site_of: (n,) site of every node.
        crossings: pairs of lines without a common node that meet.
        length: sum of the straight lengths of all lines, in footprints.
    """

    site_of: Ints
    crossings: int
    length: float


def lines_between(pairs: list[tuple[int, int]]) -> Ints:
    """The distinct unordered pairs, in order."""
    unique = sorted({(min(a, b), max(a, b)) for a, b in pairs if a != b})
    return np.array(unique, np.int64).reshape(-1, 2)


def measure(problem: SiteProblem, site_of: Ints) -> Sited:
    """What a solution is worth."""
    points = problem.points(site_of)
    spans = points[problem.lines[:, 0]] - points[problem.lines[:, 1]]
    return Sited(site_of, int(count_crossings(points, problem.lines)), float(np.hypot(spans[:, 0], spans[:, 1]).sum()))
