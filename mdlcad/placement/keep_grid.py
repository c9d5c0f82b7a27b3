"""Place on the program's grid like an earlier build: who is still there stays, and only who is new is placed."""

from __future__ import annotations

import numpy as np

from mdlcad.network.matching import renamed_masses
from mdlcad.network.model import Network
from mdlcad.placement.placers import Placer
from mdlcad.placement.ports import PortPlace
from mdlcad.placement.sites import Sited, SiteProblem, measure
from mdlcad.placement.sites.problem import lines_between
from mdlcad.placement.unit_grid import GridPlacement, GridProblem, Seating, grid_placement, grid_problem

_NEAR = 1e-6


def place_on_grid_like(
    network: Network,
    boundary: tuple[tuple[int, int], ...],
    ports: tuple[PortPlace, ...],
    placer: Placer,
    seating: Seating,
    seed: int,
    before: Network,
    earlier: GridPlacement,
) -> GridPlacement:
    """Place ``network`` with every mass on the site that it had in ``earlier``, the placement of ``before``.

    A mass whose site is no site any more (a smaller boundary, a finer grid) is placed like a new one.

    Raises:
        UsageError: a port of the network has no place.
    """
    problem = grid_problem(network, boundary, ports, seating)
    names = renamed_masses(before, network)
    places = {names.get(item.mass, item.mass): (item.x, item.y) for item in earlier.masses}
    sites = {_rounded(x, y): index for index, (x, y) in enumerate((problem.sites.sites * problem.scale).tolist())}
    site_of = np.full(problem.sites.nodes, -1, np.int64)
    taken: set[int] = set()
    for node, name in enumerate(problem.order[: problem.sites.nodes]):
        site = sites.get(_rounded(*places[name]), -1) if name in places else -1
        if site not in taken and site >= 0:
            site_of[node] = site
            taken.add(site)
    return grid_placement(network, boundary, problem, _completed(problem, site_of, placer, seed), placer.name, seed)


def _completed(problem: GridProblem, site_of: np.ndarray, placer: Placer, seed: int) -> Sited:
    """``site_of`` with the nodes that have none (-1) placed on the free sites, all others held as pins."""
    whole = problem.sites
    new, held = np.flatnonzero(site_of < 0), np.flatnonzero(site_of >= 0)
    if len(new):
        free = np.setdiff1d(np.arange(len(whole.sites)), site_of[held])
        place = np.empty(whole.nodes + len(whole.pins), np.int64)
        place[np.concatenate([new, held])] = np.arange(whole.nodes)
        place[whole.nodes :] = np.arange(whole.nodes, len(place))
        part = SiteProblem(
            nodes=len(new),
            sites=whole.sites[free],
            pins=np.concatenate([whole.sites[site_of[held]], whole.pins]),
            lines=lines_between([(int(place[a]), int(place[b])) for a, b in whole.lines.tolist()]),
        )
        site_of = site_of.copy()
        site_of[new] = free[placer.on_sites(part, seed).site_of]
    return measure(whole, site_of)


def _rounded(x: float, y: float) -> tuple[int, int]:
    return round(x / _NEAR), round(y / _NEAR)
