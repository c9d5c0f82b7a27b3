"""The smallest device that a network can be routed in: scales upwards, lattices and seeds at each."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import TypeVar

from shapely import Polygon

from mdlcad.errors import Picture, SignoffError
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.columns import Answers
from mdlcad.placement.costs import HARD
from mdlcad.placement.lattice import bare_placement, lattices
from mdlcad.placement.placement import Placement
from mdlcad.placement.placer import MOVES_PER_MASS, PlaceResult
from mdlcad.placement.placers import ANNEAL, Placer
from mdlcad.placement.ports import PortPlace
from mdlcad.placement.room import Lack, lack_of_room
from mdlcad.routing.ahead import Ahead
from mdlcad.routing.jam import Jam, JamError, draw_jam
from mdlcad.routing.judge import Judge, no_objection
from mdlcad.routing.layout import Layout
from mdlcad.routing.router import route

STEP = 1.03
"""Ratio of one scale to the next while looking for a first that works."""
ROUND = 5.0
"""Between the last scale that failed and the first that worked, one in the middle is tried, and those at which the
longest side of the boundary is a multiple of this, mm: sizes that people ask for."""
MOST_STEPS = 52
SLACK = 1.05
"""Slots a mass: with fewer, annealing has hardly room to move in."""
SCREEN = 1500
"""Moves a mass of the short anneal that ranks the lattices of a scale."""
HOPELESS = 9 * HARD
"""A short anneal that leaves more than this is not worth a full one."""
TOO_SOFT = 8
"""After so many legal layouts with carriers that miss a limit, larger ones are not tried: carriers only grow longer."""
FAR = 3 * HARD
"""A full anneal that leaves more than this is not worth another seed."""


class UnitPlates(StrEnum):
    """How many unit plates a device may have; AUTO: a second one where one cannot do it."""

    ONE = "1"
    TWO = "2"
    AUTO = "auto"


@dataclass(frozen=True, slots=True)
class Size:
    """How large the device may be.

    Attributes:
        pitch: mm per grid unit, exactly; None for as small as it can be routed.
        fit: largest width and height of the boundary, mm, either way round; None for any.
        unit_plates: how many there may be.
    """

    pitch: float | None = None
    fit: tuple[float, float] | None = None
    unit_plates: UnitPlates = UnitPlates.AUTO

    def most(self, boundary: tuple[tuple[int, int], ...]) -> float:
        """The largest scale, mm per grid unit, that it allows."""
        if self.fit is None:
            return math.inf
        xs, ys = [x for x, _ in boundary], [y for _, y in boundary]
        short, long = sorted((max(xs) - min(xs), max(ys) - min(ys)))
        return min(min(self.fit) / short, max(self.fit) / long)

    def words(self) -> str:
        """The limit in words, to follow that something could not be placed; nothing if there is none."""
        if self.pitch is not None:
            return f"at {self.pitch:g} mm per grid unit"
        return "" if self.fit is None else f"within {self.fit[0]:g} x {self.fit[1]:g} mm"


SMALLEST = Size()


@dataclass(frozen=True, slots=True)
class Effort:
    """How many of a scale's lattices are annealed in full, and with how many seeds each."""

    lattices: int
    seeds: int


QUICK, PATIENT = Effort(2, 2), Effort(2, 3)


def place_and_route(
    network: Network,
    boundary: tuple[tuple[int, int], ...],
    ports: tuple[PortPlace, ...],
    rules: LayoutRules,
    seed: int,
    progress: Callable[[str], None] | None = None,
    judge: Judge = no_objection,
    size: Size = SMALLEST,
    placer: Placer = ANNEAL,
    workers: int = 1,
) -> tuple[Placement, Layout]:
    """Place and route at the smallest scale (mm per grid unit) that works. Same arguments, same result.

    Scales rise in steps of ``STEP`` until one works; then those just below it are tried again, more patiently.

    Args:
        boundary: vertices on the grid, clockwise. ports: places in grid units.
        progress: called with one line for every scale tried.
        judge: what a layout is held to besides its clearances.
        placer: decides who sits where.
        workers: how many lattices are annealed, or channels routed, at once; the result is the same for any number.

    Raises:
        SignoffError: no scale that ``size`` allows, up to ``STEP ** MOST_STEPS`` times the least one, works; it says
            what was in the way, and has a picture of that.
    """
    least = least_scale(network, boundary, rules)
    with Ahead(workers) as ahead:
        search = _Search(network, boundary, ports, rules, seed, progress or (lambda line: None), judge, placer, ahead)
        found = smallest(search.attempt, least, boundary, size, lambda: search.judged >= TOO_SOFT)
    return found if found is not None else search.give_up(size.words())


T = TypeVar("T")


def smallest(
    attempt: Callable[[float, Effort], T | None],
    least: float,
    boundary: tuple[tuple[int, int], ...],
    size: Size,
    hopeless: Callable[[], bool],
) -> T | None:
    """What ``attempt`` makes at the smallest scale that works, from ``least`` on; None if none does or ``hopeless``."""
    if size.pitch is not None:
        return attempt(size.pitch, PATIENT)
    scale, most = least, size.most(boundary)
    for _ in range(MOST_STEPS):
        last = scale >= most
        found = attempt(min(scale, most), PATIENT if last else QUICK)
        if found is not None:
            for finer in _between(min(scale, most), boundary):
                better = attempt(finer, PATIENT)
                if better is not None:
                    return better
            return found
        if last or hopeless():
            break
        scale *= STEP
    return None


def _between(scale: float, boundary: tuple[tuple[int, int], ...]) -> list[float]:
    """Scales worth a try less than a step below ``scale``, smallest first."""
    xs, ys = [x for x, _ in boundary], [y for _, y in boundary]
    side = max(max(xs) - min(xs), max(ys) - min(ys))
    first, last = math.ceil(scale / STEP * side / ROUND), math.ceil(scale * side / ROUND - 1e-9)
    return sorted({scale / math.sqrt(STEP), *(count * ROUND / side for count in range(first, last))})


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
    """One network in one boundary at varying scale.

    Attributes:
        closest: the placement with the fewest conflicts so far.
        empty: the boundary and ports at the last scale, nobody placed.
        reason: what was in the way at the last scale.
        judged: legal layouts that the judge objected to.
    """

    def __init__(
        self,
        network: Network,
        boundary: tuple[tuple[int, int], ...],
        ports: tuple[PortPlace, ...],
        rules: LayoutRules,
        seed: int,
        progress: Callable[[str], None],
        judge: Judge,
        placer: Placer,
        ahead: Ahead,
    ) -> None:
        self.network, self.boundary, self.ports, self.judge = network, boundary, ports, judge
        self.placer, self.ahead = placer, ahead
        self.rules, self.seed, self.progress = rules, seed, progress
        self.closest: PlaceResult | None = None
        self.reason = ""
        self.judged = 0
        self.empty = Placement((), 0.0, (), (), (), (), (), seed)
        self._columns = Answers()

    def attempt(self, scale: float, effort: Effort) -> tuple[Placement, Layout] | None:
        """A placement and its layout at ``scale``, or None."""
        scale = math.floor(scale * 1e4 + 1e-6) / 1e4
        self.empty = bare_placement(self.network, self.boundary, self.ports, scale, self.seed)
        need = math.ceil(SLACK * len(self.network.masses))
        choices = lattices(self.boundary, self.empty.ports, self.rules, scale, need)
        if not choices:
            self.reason = f"no lattice of {need} slots fits the boundary: a larger size would help"
            return None

        def place(what: tuple[int, int, int]) -> PlaceResult:
            index, offset, moves_per_mass = what
            lattice, seed = choices[index], self.seed + offset
            return self.placer.on_lattice(self.network, lattice, self.rules, seed, moves_per_mass, self._columns)

        short = self.ahead.each([(index, 0, SCREEN) for index in range(len(choices))], place)
        screened = sorted(((index, result) for (index, _, _), result in short), key=lambda item: item[1].cost)
        self._remember(screened[0][1])
        best = screened[0][1].cost
        hopeful = {index for index, result in screened[: effort.lattices] if result.cost <= HOPELESS}
        turns = [
            (index, offset, MOVES_PER_MASS)
            for offset in range(effort.seeds)
            for index, _ in screened[: effort.lattices]
        ]
        for (index, offset, _), result in self.ahead.each(turns, place, lambda turn: turn[0] in hopeful):
            best = min(best, result.cost)
            self._remember(result)
            if result.cost > FAR:
                hopeful.remove(index)
            if result.cost > 0:
                continue
            try:
                layout = route(
                    self.network,
                    result.placement,
                    self.rules,
                    self.seed + offset,
                    self.judge,
                    sides=result.sides,
                    workers=self.ahead.workers,
                )
            except JamError as error:
                self.reason = str(error)
                self.judged += error.judged
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

    def _remember(self, result: PlaceResult) -> None:
        if self.closest is None or result.cost < self.closest.cost:
            self.closest = result

    def give_up(self, where: str) -> tuple[Placement, Layout]:
        """Route the best placement that was found, conflicts and all, to name what is in its way.

        Raises:
            SignoffError: unless that works after all.
        """
        jam = Jam(self.empty)
        if self.closest is not None:
            placement = self.closest.placement
            try:
                return placement, route(self.network, placement, self.rules, placement.seed, self.judge)
            except JamError as error:
                self.reason, jam = str(error), error.jam
        words = f"could not place and route {self.network.design}{where and ' '}{where}: {self.reason}"
        raise SignoffError(words, Picture("jam.svg", draw_jam(self.network, jam, self.rules, words)))
