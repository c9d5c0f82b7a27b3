"""Covers made in one pass, by taste: fast enough to make thousands and keep the best.

A pass starts from what is needed whatever happens and makes each mass by the option that looks cheapest, adding a
buffer of what is already there in another phase rather than a second gate. What looks cheapest is a matter of taste:
a price for every node, an order, and a choice for every register and output.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from random import Random

from mdlcad.mapping.options import HOLD_PHASE, PHASES, STORE_PHASE, Guard, Of, Option, OptionGraph
from mdlcad.mapping.plan import Key, Role
from mdlcad.mapping.registers import Term
from mdlcad.mapping.selection import MASS_COST, Selection, selection_cost, time_selection
from mdlcad.mapping.subject import TRUE

# In units of cost, of which a mass has 16.
_HEAT = 18.0
# Masses a unit of charge: more than any gate saves.
_LOYAL = 10.0
_RESTARTS = 3
# A small device has few tastes; more passes find nothing new.
_MOST_ROUNDS = 1500
# Options in a graph above which a node is made from older ones alone: looking for loops of logic takes time with the
# square of the device's size.
_MOST_LOOPING = 40_000


@dataclass(frozen=True, slots=True)
class Taste:
    """What steers a pass.

    Attributes:
        registers: for every register the numbers of its set choice and its release.
        carriers: for every output the number of its carrier.
        favour: factor on the price of a node (1 if it is not listed).
        order: the required masses and the carriers are made in the order of these numbers.
        loyalty: how much the charge for being strange counts, in masses a unit of charge.
    """

    registers: tuple[tuple[int, int], ...]
    carriers: tuple[int, ...]
    favour: dict[int, float] = field(default_factory=dict)
    order: tuple[float, ...] = ()
    loyalty: float = 1.0 / MASS_COST


class Pass:
    """Makes selections of one option graph."""

    def __init__(self, graph: OptionGraph) -> None:
        self._graph = graph
        self._flow = _area_flow(graph)
        # without truth tables nodes are only ever built from older ones, so there can be no loop
        self.falling = not graph.subject.exact or graph.size > _MOST_LOOPING

    def select(self, taste: Taste, *, falling: bool = False) -> Selection | None:
        """The selection of that taste, or None if it leads into a loop of logic.

        ``falling``: make every node from older ones alone, by which there can be no loop.
        """
        graph = self._graph
        selection = Selection(
            sets=[choice for choice, _ in taste.registers],
            releases=[release for _, release in taste.registers],
            carriers=[ways[number] for ways, number in zip(graph.carriers, taste.carriers, strict=True)],
        )
        if len({carrier.key for carrier in selection.carriers}) < len(selection.carriers):
            return None
        guards = {Guard(Of.SET, index, number) for index, number in enumerate(selection.sets)}
        guards |= {Guard(Of.RELEASE, index, number) for index, number in enumerate(selection.releases)}
        roots = [*graph.required, *(carrier.key for carrier in selection.carriers)]
        ranks = taste.order or (0.0,) * len(roots)
        for _, root in sorted(zip(ranks, roots, strict=True)):
            if not self._make(root, selection, guards, taste, falling):
                return None
        for keys in graph.sensors:
            if not any(key in selection.chosen for key in keys):
                selection.chosen[keys[1]] = _own_option(graph.options[keys[1]])
        time_selection(graph, selection)
        return selection

    def _make(self, root: Key, selection: Selection, guards: set[Guard], taste: Taste, falling: bool) -> bool:
        stack = [root]
        while stack:
            key = stack.pop()
            if key.role is Role.TICK or key in selection.chosen:
                continue
            gate = self._gate_before(key, selection) if taste.loyalty == _LOYAL else None
            if gate is not None:
                stack += [key, gate]
                continue
            number = self._pick(key, selection, guards, taste, falling)
            if number is None:
                return False
            selection.chosen[key] = number
            stack += self._graph.options[key][number].sources
        return True

    def _gate_before(self, key: Key, selection: Selection) -> Key | None:
        """The phase in which the earlier network had the gate of ``key``'s node, if it was another phase."""
        phases = [key._replace(phase=phase) for phase in range(PHASES)] if key.role is Role.LOGIC else []
        if not phases or self._graph.subject.is_input(key.of[0]) or any(twin in selection.chosen for twin in phases):
            return None
        had = [twin for twin in phases if 0 in self._graph.strange.get(twin, ())[1:]]
        return had[0] if had and key not in had else None

    def _pick(self, key: Key, selection: Selection, guards: set[Guard], taste: Taste, falling: bool) -> int | None:
        options = self._graph.options[key]
        if key.role is Role.LOGIC:
            if any(Key(Role.LOGIC, key.of, phase) in selection.chosen for phase in range(PHASES)):
                return _buffer_option(options)
            if self._graph.subject.is_input(key.of[0]):
                return _own_option(options)
        priced = [
            (self._price(option, selection, taste.favour) + taste.loyalty * self._graph.charge(key, number), number)
            for number, option in enumerate(options)
            if (option.guard is None or option.guard in guards) and not (key.role is Role.LOGIC and number == 0)
        ]
        for _, number in sorted(priced):
            if key.role is not Role.LOGIC:
                return number
            if falling:
                if all(s.of < key.of for s in options[number].sources if s.role is Role.LOGIC):
                    return number
            elif not self._loops(key.of, options[number], selection):
                return number
        return None

    def _price(self, option: Option, selection: Selection, favour: dict[int, float]) -> float:
        total = 0.1 * len(option.sources)
        for source in option.sources:
            if source in selection.chosen or source.role is Role.TICK:
                continue
            if source.role is Role.LOGIC:
                total += self._flow.get(source.of[0], 0.0) * favour.get(source.of[0], 1.0)
            elif source.role is Role.LOAD or source.role is Role.TERM:
                total += 1.0
        return total

    def _loops(self, node: tuple[int, ...], option: Option, selection: Selection) -> bool:
        """Whether a source of ``option`` is already made from ``node``."""
        stack = [source for source in option.sources if source.role is Role.LOGIC]
        seen: set[Key] = set()
        while stack:
            key = stack.pop()
            if key.of == node:
                return True
            for phase in range(PHASES):
                twin = Key(Role.LOGIC, key.of, phase)
                if twin in selection.chosen and twin not in seen:
                    seen.add(twin)
                    stack += [
                        s
                        for s in selection.option(self._graph, twin).sources
                        if s.role is Role.LOGIC and s.of != key.of
                    ]
        return False


def plain_taste(graph: OptionGraph, followings: list[int]) -> Taste:
    """Registers loaded under their enable if they have one, else with all logic in one set term; outputs of their own.

    Args:
        followings: for every register the literal of its next value in full.
    """
    registers = tuple(_plain_register(graph, index, following) for index, following in enumerate(followings))
    carriers = tuple(next(n for n, way in enumerate(ways) if not way.shared) for ways in graph.carriers)
    return Taste(registers, carriers)


def loyal_taste(graph: OptionGraph, plain: Taste) -> Taste:
    """Registers, outputs and gates as an earlier network had them, wherever it had them; else as ``plain``."""
    registers = []
    for index, (usual, release) in enumerate(plain.registers):
        choices = graph.registers[index]
        store, hold = Key(Role.STORE, (index,), STORE_PHASE), Key(Role.HOLD, (index,), HOLD_PHASE)
        number = _least_strange(graph, store, tuple(range(len(choices.sets))), usual)
        registers.append((number, _least_strange(graph, hold, choices.fits[number], release)))
    carriers = []
    for ways, usual in zip(graph.carriers, plain.carriers, strict=True):
        charges = [min(graph.strange.get(way.key, (0,))) for way in ways]
        ranked = [(charge, number != usual, number) for number, charge in enumerate(charges)]
        carriers.append(min(ranked)[2])
    return replace(plain, registers=tuple(registers), carriers=tuple(carriers), loyalty=_LOYAL)


def _least_strange(graph: OptionGraph, key: Key, numbers: tuple[int, ...], usual: int) -> int:
    """Of a register's choices the one by which ``key`` is least strange; ``usual`` if that does not decide."""
    charges: dict[int, int] = {}
    for place, option in enumerate(graph.options[key]):
        if option.guard is not None and option.guard.number in numbers:
            known = charges.get(option.guard.number)
            charge = graph.charge(key, place)
            charges[option.guard.number] = charge if known is None else min(known, charge)
    return min((charge, number != usual, number) for number, charge in charges.items())[2]


def search(graph: OptionGraph, start: Taste, effort: int, seed: int) -> Selection:
    """The cheapest selection that annealing finds from ``start``.

    Args:
        effort: masses made in all; the number of passes follows from the size of the device.
    """
    make = Pass(graph)
    best = make.select(start, falling=True)
    if best is None:
        raise ValueError("a node cannot be made from the ones before it")
    rounds = min(_MOST_ROUNDS, effort // (_RESTARTS * max(1, len(best.chosen))))
    plain, starts = best, [(start, best)] * _RESTARTS
    if graph.strange:
        loyal = loyal_taste(graph, start)
        kept = make.select(loyal, falling=make.falling)
        if kept is not None:
            best = min(best, kept, key=lambda selection: selection_cost(graph, selection))
            starts = [(loyal, kept), (loyal, kept), (start, plain)]
    for restart, (taste, first) in enumerate(starts):
        found = _anneal(graph, make, taste, first, rounds, Random(seed * _RESTARTS + restart))
        if selection_cost(graph, found) < selection_cost(graph, best):
            best = found
    return best


def _anneal(graph: OptionGraph, make: Pass, taste: Taste, best: Selection, rounds: int, random: Random) -> Selection:
    """The best of ``best`` and ``rounds`` passes, each with something changed in the taste."""
    nodes = sorted({key.of[0] for key in graph.options if key.role is Role.LOGIC})
    roots = len(graph.required) + len(graph.carriers)
    if not nodes:
        return best
    cost = best_cost = selection_cost(graph, best)
    for turn in range(rounds):
        changed = _change(graph, taste, nodes, roots, random)
        selection = make.select(changed, falling=make.falling)
        if selection is None:
            continue
        new = selection_cost(graph, selection)
        # a step back is the rarer the larger it is and the later it comes
        heat = _HEAT * (1.0 - turn / rounds)
        if new <= cost or random.random() < math.exp((cost - new) / heat):
            taste, cost = changed, new
        if new < best_cost:
            best, best_cost = selection, new
    return best


def _change(graph: OptionGraph, taste: Taste, nodes: list[int], roots: int, random: Random) -> Taste:
    kind = random.randrange(8)
    if kind < 2 and graph.registers:
        registers = list(taste.registers)
        index = random.randrange(len(registers))
        number = random.randrange(len(graph.registers[index].sets))
        registers[index] = (number, random.choice(graph.registers[index].fits[number]))
        return replace(taste, registers=tuple(registers))
    if kind == 2:
        return replace(taste, order=tuple(random.random() for _ in range(roots)))
    if kind == 3 and any(len(ways) > 1 for ways in graph.carriers):
        carriers = list(taste.carriers)
        index = random.randrange(len(carriers))
        carriers[index] = random.randrange(len(graph.carriers[index]))
        return replace(taste, carriers=tuple(carriers))
    favour = dict(taste.favour)
    for _ in range(random.randrange(1, 4)):
        favour[random.choice(nodes)] = random.choice((0.1, 0.5, 1.0, 2.0, 10.0))
    return replace(taste, favour=favour)


def _plain_register(graph: OptionGraph, index: int, following: int) -> tuple[int, int]:
    choices = graph.registers[index]
    for number, choice in enumerate(choices.sets):
        if len(choice.terms) == 1 and choice.terms[0].load is not None:
            return number, choices.fits[number][0]
    for number, choice in enumerate(choices.sets):
        if choice.terms == (Term(following),) or (not choice.terms and following == 0):
            for release in choices.fits[number]:
                if choices.releases[release] == TRUE:
                    return number, release
    raise ValueError(f"register {choices.bit} lacks its plain structure")


def _own_option(options: list[Option]) -> int:
    """The option without sources (a sensor itself), or the buffer that a register's masses allow."""
    return next((number for number, option in enumerate(options) if not option.sources), _buffer_option(options))


def _buffer_option(options: list[Option]) -> int:
    """The copy of the mass that carries the same one phase earlier."""
    return next(number for number, option in enumerate(options) if len(option.sources) == 1)


def _area_flow(graph: OptionGraph) -> dict[int, float]:
    """Masses that a node costs, shared evenly among the structures that use it."""
    users: dict[int, int] = {}
    for ways in graph.subject.ways:
        for node in sorted({lit >> 1 for a, b, _ in ways[:1] for lit in (a, b)}):
            users[node] = users.get(node, 0) + 1
    gates = {key.of[0]: graph.options[key][1:] for key in sorted(graph.options) if key.role is Role.LOGIC}
    flow = {node: 0.0 for node in gates if graph.subject.is_input(node)}
    # prices only fall from one pass to the next, and depend on cheaper ones
    for _ in range(len(gates)):
        before = dict(flow)
        for node, options in gates.items():
            if graph.subject.is_input(node):
                continue
            prices = [
                1.0 + sum(flow[s.of[0]] for s in option.sources if s.role is Role.LOGIC)
                for option in options
                if all(s.of[0] in flow for s in option.sources if s.role is Role.LOGIC)
            ]
            if prices:
                flow[node] = min(prices) / max(1, users.get(node, 1))
        if flow == before:
            break
    return flow
