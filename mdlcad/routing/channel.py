"""Exact routing of one channel by CP-SAT: a track for every trunk and a plate for every item.

Which conflicts there are (all between different nets unless said otherwise):

* two trunks whose rows overlap stand a track pitch apart;
* two items of one plate that come near in y keep the gap in x; two items of one hub side never share a plate;
* an item's pin passes every plate below the item's, its fixed post every plate above: neither may meet other items.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ortools.sat.python import cp_model

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.placement.grid import RESOLUTION
from mdlcad.routing.pieces import Channel, Edge, Item, Role, units
from mdlcad.solver import solver_with

FIRST_LIMIT = 8.0
BEST_LIMIT = 0.4
"""CP-SAT's deterministic time for a first legal routing and for shortening its rungs."""

LEVEL = units(5.0)
"""A plate higher costs a carrier as much as so many counts of length."""

LEAF_AND_TAB = ({Role.COUPLER, Role.TAB}, {Role.COUPLER, Role.STRAIGHT_TAB}, {Role.COUPLER, Role.GUEST})
"""Pairs of one net that must not run into each other: only flexures do not move as their carrier does."""


@dataclass(frozen=True, slots=True)
class ChannelRoute:
    """x of every trunk (mm) and the plate index of every item, in the channel's order."""

    tracks: tuple[float, ...]
    plates: tuple[int, ...]


class ChannelModel:
    """Variables and constraints of one channel."""

    def __init__(self, channel: Channel, rules: LayoutRules) -> None:
        self.channel = channel
        self.rules = rules
        self.model = cp_model.CpModel()
        self.gap = units(rules.gap)
        domains = [cp_model.Domain.from_intervals([list(span) for span in t.domain]) for t in channel.trunks]
        self.x = [self.model.new_int_var_from_domain(d, f"x{i}") for i, d in enumerate(domains)]
        self.plate = [
            [self.model.new_bool_var(f"p{i}.{k}") for k in range(len(rules.link_plates))]
            for i in range(len(channel.items))
        ]
        for item, row in zip(channel.items, self.plate, strict=True):
            self.model.add_exactly_one(row)
            if item.plate is not None:
                self.model.add(row[item.plate] == 1)
            if item.ceiling is not None:
                for literal in row[item.ceiling + 1 :]:
                    self.model.add(literal == 0)
            for literal in row[: item.floor or 0]:
                self.model.add(literal == 0)
        self.known: dict[tuple[str, str], Any] = {}
        self.edges = [self._edges(item) for item in channel.items]
        self._trunks()
        for i in range(len(channel.items)):
            for j in range(i):
                self._pair(i, j)

    def _at(self, edge: Edge) -> Any:
        return edge.at if edge.trunk is None else self.x[edge.trunk] + edge.at

    def _edges(self, item: Item) -> tuple[Any, Any]:
        if item.bend is None or item.trunk is None:
            return self._at(item.left), self._at(item.right)
        bar, x = item.right.at, self.x[item.trunk]
        low = self.model.new_int_var(-(10**7), 10**7, f"low.{item.ref}")
        high = self.model.new_int_var(-(10**7), 10**7, f"high.{item.ref}")
        self.model.add_min_equality(low, [x - bar, item.bend - bar])
        self.model.add_max_equality(high, [x + bar, item.bend + bar])
        # a rung has a length: the bend is not on the trunk's own centre
        self._either(self._before(x, item.bend, units(1.0)), self._before(item.bend, x, units(1.0)))
        return low, high

    def _before(self, a: Any, b: Any, space: int) -> Any:
        """A literal that implies a + space <= b (True or False if that is known)."""
        difference = b - a
        if isinstance(difference, int):
            return difference >= space
        key = (str(a), f"{b}>{space}")
        if key not in self.known:
            literal = self.model.new_bool_var("")
            self.model.add(difference >= space).only_enforce_if(literal)
            self.known[key] = literal
        return self.known[key]

    def _either(self, *literals: Any) -> None:
        """At least one holds; plain booleans are allowed."""
        if any(literal is True for literal in literals):
            return
        self.model.add_bool_or([literal for literal in literals if literal is not False])

    def _near(self, low_a: float, high_a: float, low_b: float, high_b: float) -> bool:
        space = max(low_a, low_b) - min(high_a, high_b)
        return space < 2 * self.rules.throw + self.rules.gap - 1e-6

    def _trunks(self) -> None:
        bar, pitch = self.rules.bar_width / 2, units(self.rules.track_pitch)
        for i, a in enumerate(self.channel.trunks):
            for j, b in enumerate(self.channel.trunks[:i]):
                if self._near(a.y_low - bar, a.y_high + bar, b.y_low - bar, b.y_high + bar):
                    self._either(self._before(self.x[i], self.x[j], pitch), self._before(self.x[j], self.x[i], pitch))

    def _above(self, i: int, j: int) -> Any:
        """A literal that holds whenever item i lies on a higher plate than item j."""
        key = (f"above{i}", str(j))
        if key not in self.known:
            literal = self.model.new_bool_var("")
            for high in range(len(self.plate[i])):
                for low in range(high):
                    self.model.add_bool_or([~self.plate[i][high], ~self.plate[j][low], literal])
            self.known[key] = literal
        return self.known[key]

    def _pair(self, i: int, j: int) -> None:
        a, b = self.channel.items[i], self.channel.items[j]
        if set(a.hubs) & set(b.hubs):
            self._share(i, j, False, False)
        own = a.net == b.net and Role.BIAS not in (a.role, b.role)
        if own and {a.role, b.role} not in LEAF_AND_TAB:
            return
        for box_a in self._boxes(i):
            for box_b in self._boxes(j):
                if self._near(box_a[2], box_a[3], box_b[2], box_b[3]):
                    self._share(
                        i, j, self._before(box_a[1], box_b[0], self.gap), self._before(box_b[1], box_a[0], self.gap)
                    )
        pin, post = units(self.rules.pin / 2), units(self.rules.post_radius)
        for m, n in ((i, j), (j, i)):
            item = self.channel.items[m]
            for left, right, low, high in self._boxes(n):
                if not self._near(item.y_low, item.y_high, low, high):
                    continue
                if item.trunk is not None and not own:
                    x = self.x[item.trunk]
                    self._either(
                        ~self._above(m, n),
                        self._before(x, left, pin + self.gap),
                        self._before(right, x, pin + self.gap),
                    )
                if item.post is not None:
                    self._either(
                        ~self._above(n, m),
                        self._before(item.post, left, post + self.gap),
                        self._before(right, item.post, post + self.gap),
                    )

    def _boxes(self, i: int) -> list[tuple[Any, Any, float, float]]:
        item = self.channel.items[i]
        boxes = [(*self.edges[i], item.y_low, item.y_high)]
        if item.rises is not None:
            boxes.append(item.rises)
        return boxes

    def _share(self, i: int, j: int, before: Any, after: Any) -> None:
        """Items i and j share no plate unless one of the literals holds."""
        for mine, other in zip(self.plate[i], self.plate[j], strict=True):
            self._either(~mine, ~other, before, after)

    def length(self) -> Any:
        """What to make small: the reach of couplers (twice) and of source rungs, counts; and heights, which tilt."""
        terms = []
        for item, (left, right) in zip(self.channel.items, self.edges, strict=True):
            if item.trunk is not None:
                terms.append((2 if item.role is Role.COUPLER else 1) * (right - left))
        for item, row in zip(self.channel.items, self.plate, strict=True):
            if item.role in (Role.COUPLER, Role.STRAIGHT, Role.SOURCE):
                # the nearer to its unit the better: of a bare hub's net that is the other deck's
                nearest = row if item.floor is None else row[::-1]
                terms += [LEVEL * k * literal for k, literal in enumerate(nearest)]
        return sum(terms)


def solve(channel: Channel, rules: LayoutRules, seed: int) -> ChannelRoute | None:
    """Tracks and plates for ``channel``, or None if there are none (or none was found in the limit)."""
    if channel.trouble:
        return None
    if not channel.items:
        return ChannelRoute((), ())
    model = ChannelModel(channel, rules)
    solver = solver_with(seed, FIRST_LIMIT)
    if solver.solve(model.model) not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None
    best = read_route(model, solver)
    if channel.items:
        model.model.minimize(model.length())
        for variable, value in zip(model.x, best[0], strict=True):
            model.model.add_hint(variable, value)
        for row, plate in zip(model.plate, best[1], strict=True):
            for k, literal in enumerate(row):
                model.model.add_hint(literal, k == plate)
        solver = solver_with(seed, BEST_LIMIT)
        if solver.solve(model.model) in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            best = read_route(model, solver)
    return in_mm(best)


def in_mm(solved: tuple[list[int], list[int]]) -> ChannelRoute:
    """The route that ``read_route`` found."""
    return ChannelRoute(tuple(round(x * RESOLUTION, 6) for x in solved[0]), tuple(solved[1]))


def read_route(model: ChannelModel, solver: cp_model.CpSolver) -> tuple[list[int], list[int]]:
    """Track (counts) of every trunk and plate of every item, as solved."""
    tracks = [int(solver.value(x)) for x in model.x]
    plates = [next(k for k, literal in enumerate(row) if solver.boolean_value(literal)) for row in model.plate]
    return tracks, plates
