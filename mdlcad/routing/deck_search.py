"""The smallest device with two unit plates that a network can be routed in.

At every scale: which deck each unit is in, a column for every mass in both decks at once, then one deck is annealed
freely and the other around the slots that nets crossing between them have taken; then each is routed by itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from mdlcad.errors import Picture, SignoffError
from mdlcad.mechanics.decks import Deck
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.costs import HARD
from mdlcad.placement.deck_columns import choose_deck_columns
from mdlcad.placement.deck_seats import Slot, place_deck
from mdlcad.placement.decks import Lean, Units, choose_decks, crossing, network_in, rules_in
from mdlcad.placement.lattice import Lattice, bare_placement, lattices, make_lattice
from mdlcad.placement.placement import Placement
from mdlcad.placement.placer import MOVES_PER_MASS, PlaceResult
from mdlcad.placement.ports import PortPlace
from mdlcad.routing.ahead import Ahead
from mdlcad.routing.decks import EMPTY, joined_layout, joined_placement
from mdlcad.routing.driver import (
    FAR,
    HOPELESS,
    QUICK,
    SCREEN,
    SLACK,
    SMALLEST,
    TOO_SOFT,
    Effort,
    Size,
    least_scale,
    smallest,
)
from mdlcad.routing.jam import Jam, JamError, draw_jam
from mdlcad.routing.judge import Judge, Objection, no_objection
from mdlcad.routing.layout import Layout
from mdlcad.routing.router import route

HELD = 1e6
"""What it costs to leave a slot that the other deck has settled."""
TURNS = 4
"""Times that both decks are annealed from one start, each time the other one first."""
WANTED = HARD / 2
"""What it costs to leave a slot that the other deck would like."""
SHAPES, SEEDS = 3, 4
"""How many lattices of a scale are tried, and with how many choices of decks and columns each."""
THOROUGH = 4
"""Times as many moves where the scale is the last chance, or one of those below the first that worked."""


@dataclass(frozen=True, slots=True)
class _Start:
    """Where a placement starts from: decks, their lattices, a column for every mass; ``cost`` after a short anneal."""

    units: Units
    decks: Mapping[Deck, Lattice]
    columns: Mapping[str, int]
    seed: int
    cost: float


@dataclass(frozen=True, slots=True)
class _Outcome:
    """What came of a start: both decks, or what was in the way; ``judged`` as in the search."""

    found: tuple[Placement, Layout] | None
    reason: str = ""
    jam: Jam | None = None
    judged: int = 0


def place_and_route_decks(
    network: Network,
    boundary: tuple[tuple[int, int], ...],
    ports: tuple[PortPlace, ...],
    rules: LayoutRules,
    seed: int,
    leans: Mapping[str, Lean],
    progress: Callable[[str], None] | None = None,
    judge: Judge = no_objection,
    size: Size = SMALLEST,
    workers: int = 1,
) -> tuple[Placement, Layout]:
    """Place and route on two unit plates, at the smallest scale that works. Same arguments, same result.

    Args:
        boundary, ports, progress, size, workers: as for ``place_and_route``.
        leans: how much every coupling tilts its source's shuttle.
        judge: is shown the placement of the whole device and what is routed of it so far.

    Raises:
        SignoffError: no scale that ``size`` allows works; it says what was in the way, and has a picture of that.
    """
    least = least_scale(network, boundary, rules) / math.sqrt(2.0)
    with Ahead(workers) as ahead:
        search = _Search(network, boundary, ports, rules, seed, leans, progress or (lambda line: None), judge, ahead)
        found = smallest(search.attempt, least, boundary, size, lambda: search.judged >= TOO_SOFT)
    if found is None:
        where = size.words()
        words = f"could not place and route {network.design} on two unit plates{where and ' '}{where}: {search.reason}"
        raise SignoffError(words, Picture("jam.svg", draw_jam(network, search.jam, rules, words)))
    return found


class _Search:
    """One network on two decks in one boundary at varying scale.

    Attributes:
        reason: what was in the way at the last scale; jam: where. judged: legal layouts that the judge objected to.
    """

    def __init__(
        self,
        network: Network,
        boundary: tuple[tuple[int, int], ...],
        ports: tuple[PortPlace, ...],
        rules: LayoutRules,
        seed: int,
        leans: Mapping[str, Lean],
        progress: Callable[[str], None],
        judge: Judge,
        ahead: Ahead,
    ) -> None:
        self.network, self.boundary, self.ports, self.rules = network, boundary, ports, rules
        self.seed, self.leans, self.progress, self.judge, self.ahead = seed, leans, progress, judge, ahead
        self.reason, self.judged = "", 0
        self.jam = Jam(Placement((), 0.0, (), (), (), (), (), seed))
        self._choices: dict[tuple[int, int], dict[str, Deck] | None] = {}

    def attempt(self, scale: float, effort: Effort) -> tuple[Placement, Layout] | None:
        """Both decks at ``scale``, or None."""
        scale = math.floor(scale * 1e4 + 1e-6) / 1e4
        empty = bare_placement(self.network, self.boundary, self.ports, scale, self.seed)
        self.jam = Jam(empty)
        need = math.ceil(SLACK * len(self.network.masses) / 2)
        choices = lattices(self.boundary, empty.ports, self.rules, scale, need)
        if not choices:
            self.reason = f"no lattice of {need} slots a unit plate fits the boundary: a larger size would help"
            return None
        self.reason = "no column for every mass: a larger size would help"
        seeds = range(self.seed, self.seed + SEEDS)
        turns = [(lattice, units) for lattice in choices[:SHAPES] for units in self._all_units(lattice, seeds)]
        tried = [start for _, start in self.ahead.each(turns, self._start) if start is not None]
        starts = sorted(tried, key=lambda start: start.cost)[: effort.lattices * effort.seeds]
        worth = [start for i, start in enumerate(starts) if i == 0 or starts[i - 1].cost <= HOPELESS]
        moves = MOVES_PER_MASS if effort == QUICK else THOROUGH * MOVES_PER_MASS
        for _, outcome in self.ahead.each(worth, lambda start: self._from(start, moves)):
            if outcome.found is not None:
                self.progress(f"{scale:.3f} mm per grid unit: routed on two unit plates")
                return outcome.found
            self.judged += outcome.judged
            self.reason, self.jam = outcome.reason or self.reason, outcome.jam or self.jam
        self.progress(f"{scale:.3f} mm per grid unit: {self.reason}")
        return None

    def _all_units(self, lattice: Lattice, seeds: range) -> list[tuple[int, dict[str, Deck]]]:
        """Which unit goes to which deck, for every seed with which that can be had."""
        found = [(seed, self._units(len(lattice.slots), seed)) for seed in seeds]
        if any(units is None for _, units in found):
            self.reason = f"two unit plates of {len(lattice.slots)} slots do not hold its units and crossing nets"
        return [(seed, units) for seed, units in found if units is not None]

    def _units(self, slots: int, seed: int) -> dict[str, Deck] | None:
        key = (slots, seed)
        if key not in self._choices:
            self._choices[key] = choose_decks(self.network, slots, self.leans, seed)
        return self._choices[key]

    def _start(self, turn: tuple[Lattice, tuple[int, dict[str, Deck]]]) -> _Start | None:
        """Columns for a lattice and a choice of decks, and what a short anneal makes of them."""
        lattice, (seed, units) = turn
        decks = {deck: self._lattice(lattice, units, deck) for deck in Deck}
        columns = choose_deck_columns(self.network, units, decks, self.rules, seed)
        if columns is None:
            return None
        start = _Start(units, decks, columns, seed, math.inf)
        pair = self._pair(start, Deck.LOWER, {}, seed, SCREEN)
        return None if pair is None else replace(start, cost=sum(result.cost for result in pair.values()))

    def _lattice(self, lattice: Lattice, units: Units, deck: Deck) -> Lattice:
        """The lattice with the tabs of one deck only."""
        ports = tuple(port for port in lattice.ports if units[port.mass] is deck)
        return make_lattice(
            lattice.boundary,
            lattice.mm_per_grid,
            lattice.inner,
            lattice.column_x,
            lattice.row_y,
            ports,
            self.rules,
        )

    def _from(self, start: _Start, moves: int) -> _Outcome:
        """Both decks annealed without a broken rule, crossing nets in one slot, and routed; or what is in the way.

        Args:
            moves: a mass, of each anneal.
        """
        wanted: dict[str, Slot] = {}
        last, best, judged = _Outcome(None), math.inf, 0
        for turn in range(TURNS):
            first = (Deck.LOWER, Deck.UPPER)[turn % 2]
            pair = self._pair(start, first, wanted, start.seed + turn, moves)
            if pair is None:
                break
            cost = sum(result.cost for result in pair.values())
            if cost == 0:
                last = self._routed(start, {deck: result.placement for deck, result in pair.items()})
                judged += last.judged
                if last.found is not None:
                    return last
                best, wanted = 0.0, {}
                continue
            if cost < best:
                best = cost
                words = f"the best placement of both decks: about {max(1, round(best / HARD))} conflicts left"
                last = replace(last, reason=words)
            if cost > FAR:
                break
            # next turn the deck that had to give way goes first, and finds the other's slots dear to leave
            wanted = self._crossing_slots(start, pair[first].placement)
        return replace(last, judged=judged)

    def _pair(
        self, start: _Start, first: Deck, wanted: Mapping[str, Slot], seed: int, moves: int
    ) -> dict[Deck, PlaceResult] | None:
        """The deck ``first``, where leaving a wanted slot has its price, and the other around what crosses from it."""
        free = self._annealed(start, first, wanted, HELD if not wanted else WANTED, seed, moves)
        if free is None:
            return None
        other = self._annealed(start, first.other, self._crossing_slots(start, free.placement), HELD, seed, moves)
        return None if other is None else {first: free, first.other: other}

    def _crossing_slots(self, start: _Start, placement: Placement) -> dict[str, Slot]:
        across = crossing(self.network, start.units)
        return {unit.mass: (unit.column, unit.row) for unit in placement.masses if unit.mass in across}

    def _annealed(
        self, start: _Start, deck: Deck, wanted: Mapping[str, Slot], price: float, seed: int, moves: int
    ) -> PlaceResult | None:
        network, rules = (
            network_in(self.network, start.units, deck),
            rules_in(self.rules, self.network, start.units, deck),
        )
        across = crossing(self.network, start.units)
        return place_deck(network, start.decks[deck], rules, start.columns, across, wanted, price, seed, moves)

    def _routed(self, start: _Start, placed: Mapping[Deck, Placement]) -> _Outcome:
        units, seed = start.units, start.seed
        placement = joined_placement(self.network, units, placed)
        done = dict.fromkeys(Deck, EMPTY)
        for deck in Deck:
            network, rules = network_in(self.network, units, deck), rules_in(self.rules, self.network, units, deck)
            own = {coupling.name for coupling in network.couplings}

            def judge(_: Placement, layout: Layout, deck: Deck = deck, own: set[str] = own) -> tuple[Objection, ...]:
                whole = joined_layout(self.network, units, {**done, deck: layout})
                return tuple(item for item in self.judge(placement, whole) if item.coupling in own)

            try:
                done[deck] = route(network, _marked(placed[deck], units), rules, seed, judge)
            except JamError as error:
                return _Outcome(None, f"{deck} deck: {error}", error.jam, error.judged)
        return _Outcome((placement, joined_layout(self.network, units, done)))


def _marked(placement: Placement, units: Units) -> Placement:
    """The placement of a deck, in which every mass knows where its unit is."""
    return replace(placement, masses=tuple(replace(unit, deck=units[unit.mass]) for unit in placement.masses))
