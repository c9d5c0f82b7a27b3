"""The placers behind one interface: each places on the sites of a grid and on the slots of a device's lattice."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.columns import Answers
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.names import PlacerName
from mdlcad.placement.placer import PlaceResult, choose_sides, place, placement_of
from mdlcad.placement.sites import (
    PaperOptions,
    Sited,
    SiteProblem,
    StraightOptions,
    place_like_the_paper,
    place_straight,
)
from mdlcad.placement.sites.problem import lines_between


class Placer(Protocol):
    """A way to decide who sits where. Same arguments, same result."""

    @property
    def name(self) -> PlacerName:
        """What ``--placer`` calls it."""

    def on_sites(self, problem: SiteProblem, seed: int) -> Sited:
        """Place points on the sites of a grid."""

    def on_lattice(
        self, network: Network, lattice: Lattice, rules: LayoutRules, seed: int, moves_per_mass: int, columns: Answers
    ) -> PlaceResult:
        """Place units on the slots of ``lattice``, which has one for every mass; ``moves_per_mass`` is how hard to try,
        for a placer that can try harder, and ``columns`` are those chosen so far, for one that chooses them."""


@dataclass(frozen=True, slots=True)
class AnnealPlacer:
    """Ours: simulated annealing, on a lattice with the rules of channels, hubs and tabs in its cost."""

    options: StraightOptions = field(default_factory=StraightOptions)

    @property
    def name(self) -> PlacerName:
        """What ``--placer`` calls it."""
        return PlacerName.ANNEAL

    def on_sites(self, problem: SiteProblem, seed: int) -> Sited:
        """Place points on the sites of a grid."""
        return place_straight(problem, seed, self.options)

    def on_lattice(
        self, network: Network, lattice: Lattice, rules: LayoutRules, seed: int, moves_per_mass: int, columns: Answers
    ) -> PlaceResult:
        """Place units on the slots of ``lattice``."""
        return place(network, lattice, rules, seed, moves_per_mass, columns)


@dataclass(frozen=True, slots=True)
class PaperPlacer:
    """The paper's. It sees straight lines between slots and nothing of channels, so what it places may not route."""

    options: PaperOptions = field(default_factory=PaperOptions)

    @property
    def name(self) -> PlacerName:
        """What ``--placer`` calls it."""
        return PlacerName.PAPER

    def on_sites(self, problem: SiteProblem, seed: int) -> Sited:
        """Place points on the sites of a grid."""
        return place_like_the_paper(problem, seed, self.options)

    def on_lattice(
        self, network: Network, lattice: Lattice, rules: LayoutRules, seed: int, moves_per_mass: int, columns: Answers
    ) -> PlaceResult:
        """Place units on the slots of ``lattice``; the cost is that of the rules which the best sides still break."""
        found = self.on_sites(slot_problem(network, lattice, rules), seed)
        placement = placement_of(network, lattice, found.site_of.astype(np.int32), seed)
        return PlaceResult(placement, choose_sides(network, placement, lattice, rules, seed).cost)


ANNEAL = AnnealPlacer()


def slot_problem(network: Network, lattice: Lattice, rules: LayoutRules) -> SiteProblem:
    """The slots of a lattice as sites, in footprints of a unit; the ports are pins, each with a line to its mass."""
    unit = np.array([rules.column_pitch, rules.row_pitch])
    node = {mass.name: index for index, mass in enumerate(network.masses)}
    pairs = [(node[item.source], node[item.target]) for item in network.couplings]
    pairs += [(node[port.mass], len(node) + index) for index, port in enumerate(lattice.ports)]
    return SiteProblem(
        nodes=len(node),
        sites=np.array([(lattice.column_x[c], lattice.row_y[r]) for c, r in lattice.slots]) / unit,
        pins=np.array([(port.x, port.y) for port in lattice.ports]).reshape(-1, 2) / unit,
        lines=lines_between(pairs),
    )
