"""The smallest device that a network can be routed in: scales upwards, lattices and seeds at each."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from shapely import Polygon

from mdlcad.errors import SignoffError
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.anneal import HARD
from mdlcad.placement.lattice import lattices, place_ports
from mdlcad.placement.placement import Placement
from mdlcad.placement.placer import place
from mdlcad.placement.ports import PortPlace
from mdlcad.placement.room import Lack, lack_of_room
from mdlcad.routing.layout import Layout
from mdlcad.routing.router import route

STEP = 1.06
"""Ratio of one scale to the next while looking for a first that works."""
FINE = 4
"""Of this many parts of a step, those between the last scale that failed and the first that worked are tried too."""
MOST_STEPS = 26
SLACK = 1.1
"""Slots a mass: with fewer, annealing has hardly room to move in."""
SCREEN = 1500
"""Moves a mass of the short anneal that ranks the lattices of a scale."""
HOPELESS = 5 * HARD
"""A short anneal that leaves more than this is not worth a full one."""
FAR = 2 * HARD
"""A full anneal that leaves more than this is not worth another seed."""


@dataclass(frozen=True, slots=True)
class _Effort:
    """How many of a scale's lattices are annealed in full, and with how many seeds each."""

    lattices: int
    seeds: int


QUICK, PATIENT = _Effort(1, 1), _Effort(2, 2)


def place_and_route(
    network: Network,
    boundary: tuple[tuple[int, int], ...],
    ports: tuple[PortPlace, ...],
    rules: LayoutRules,
    seed: int,
    progress: Callable[[str], None] | None = None,
) -> tuple[Placement, Layout]:
    """Place and route at the smallest scale (mm per grid unit) that works. Same arguments, same result.

    Scales rise in steps of ``STEP`` until one works; then those just below it are tried again, more patiently.

    Args:
        boundary: vertices on the grid, clockwise. ports: places in grid units.
        progress: called with one line for every scale tried.

    Raises:
        SignoffError: no scale up to ``STEP ** MOST_STEPS`` times the least one works; says what was in the way.
    """
    search = _Search(network, boundary, ports, rules, seed, progress or (lambda line: None))
    scale = least_scale(network, boundary, rules)
    for _ in range(MOST_STEPS):
        found = search.attempt(scale, QUICK)
        if found is not None:
            for k in range(1 - FINE, 0):
                better = search.attempt(scale * STEP ** (k / FINE), PATIENT)
                if better is not None:
                    return better
            return found
        scale *= STEP
    raise SignoffError(f"could not place and route {network.design}: {search.reason}")


def least_scale(network: Network, boundary: tuple[tuple[int, int], ...], rules: LayoutRules) -> float:
    """mm per grid unit at which the units' footprints alone would fill the boundary."""
    need = len(network.masses) * (rules.unit_left + rules.unit_right) * rules.row_pitch
    return math.sqrt(need / Polygon(boundary).area)


def find_lack(
    network: Network, boundary: tuple[tuple[int, int], ...], ports: tuple[PortPlace, ...], rules: LayoutRules
) -> Lack | None:
    """What no scale that ``place_and_route`` would try has room for, or None."""
    largest = least_scale(network, boundary, rules) * STEP ** (MOST_STEPS - 1)
    return lack_of_room(network, boundary, ports, rules, len(network.masses), largest)


class _Search:
    """One network in one boundary at varying scale. ``reason``: what was in the way at the last scale."""

    def __init__(
        self,
        network: Network,
        boundary: tuple[tuple[int, int], ...],
        ports: tuple[PortPlace, ...],
        rules: LayoutRules,
        seed: int,
        progress: Callable[[str], None],
    ) -> None:
        self.network, self.boundary, self.ports = network, boundary, ports
        self.rules, self.seed, self.progress = rules, seed, progress
        self.reason = "no lattice with enough slots fits the boundary"

    def attempt(self, scale: float, effort: _Effort) -> tuple[Placement, Layout] | None:
        """A placement and its layout at ``scale``, or None."""
        scale = round(scale, 4)
        placed = place_ports(self.network, self.ports, scale)
        need = math.ceil(SLACK * len(self.network.masses))
        choices = lattices(self.boundary, placed, self.rules, scale, need)
        if not choices:
            return None
        screened = sorted(
            (place(self.network, lattice, self.rules, self.seed, SCREEN).cost, index)
            for index, lattice in enumerate(choices)
        )
        best = screened[0][0]
        for cost, index in screened[: effort.lattices]:
            for offset in range(effort.seeds if cost <= HOPELESS else 0):
                result = place(self.network, choices[index], self.rules, self.seed + offset)
                best = min(best, result.cost)
                if result.cost > FAR:
                    break
                if result.cost > 0:
                    continue
                try:
                    layout = route(self.network, result.placement, self.rules, self.seed + offset)
                except SignoffError as error:
                    self.reason = str(error)
                    continue
                self.progress(f"{scale:.3f} mm per grid unit: routed")
                return result.placement, layout
        if best > 0:
            words = f"{scale:.3f} mm per grid unit: about {max(1, round(best / HARD))} conflicts left"
            self.reason = f"the best placement at {words}"
            self.progress(words)
        else:
            self.progress(f"{scale:.3f} mm per grid unit: {self.reason}")
        return None
