"""The smallest device that a network can be routed in: scales upwards, lattices and seeds at each."""

from __future__ import annotations

import math
from collections.abc import Callable

from shapely import Polygon

from mdlcad.errors import SignoffError
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.anneal import HARD
from mdlcad.placement.lattice import lattices, place_ports
from mdlcad.placement.placement import Placement
from mdlcad.placement.placer import place
from mdlcad.placement.ports import PortPlace
from mdlcad.routing.layout import Layout
from mdlcad.routing.router import route

STEP = 1.03
"""Ratio of one scale to the next: finer steps spend more time than they save in size."""
MOST_STEPS = 40
SEEDS = 1
"""Seeds for every lattice of a scale: another lattice or the next scale finds a way sooner than another seed."""
SLACK = 1.2
"""Slots a mass: with fewer, annealing has no room to move in, and none of our examples was placed."""


def place_and_route(
    network: Network,
    boundary: tuple[tuple[int, int], ...],
    ports: tuple[PortPlace, ...],
    rules: LayoutRules,
    seed: int,
    progress: Callable[[str], None] | None = None,
) -> tuple[Placement, Layout]:
    """Place and route at the smallest scale (mm per grid unit) that works. Same arguments, same result.

    Args:
        boundary: vertices on the grid, clockwise. ports: places in grid units.
        progress: called with one line for every scale tried.

    Raises:
        SignoffError: no scale up to ``STEP ** MOST_STEPS`` times the least one works; says what was in the way.
    """
    scale = _least_scale(network, boundary, rules)
    reason = "no lattice with enough slots fits the boundary"
    for _ in range(MOST_STEPS):
        placed = place_ports(network, ports, scale)
        best = math.inf
        for lattice in lattices(boundary, placed, rules, scale, math.ceil(SLACK * len(network.masses))):
            for offset in range(SEEDS):
                result = place(network, lattice, rules, seed + offset)
                best = min(best, result.cost)
                if result.cost >= HARD:
                    continue
                try:
                    return result.placement, route(network, result.placement, rules, seed + offset)
                except SignoffError as error:
                    reason = str(error)
        if progress is not None:
            progress(f"{scale:.3f} mm per grid unit: {'no lattice' if best == math.inf else f'cost {best:.0f}'}")
        scale = round(scale * STEP, 4)
    raise SignoffError(f"could not place and route {network.design}: {reason}")


def _least_scale(network: Network, boundary: tuple[tuple[int, int], ...], rules: LayoutRules) -> float:
    """mm per grid unit at which the units' footprints alone would fill the boundary."""
    area = Polygon(boundary).area
    need = len(network.masses) * (rules.unit_left + rules.unit_right) * rules.row_pitch
    return round(math.sqrt(need / area), 4)
