"""What an earlier network made, as functions of the program's own inputs, so that a new one may prefer the same.

A small edit changes the cheapest cover of a device in many places, since many covers are about equally cheap. So
whatever the earlier network did not have in the same way is charged a little: a gate of other inputs, or a mass
of a function or phase that was not there. The charge decides between covers of about the same size; it is too small
to buy many masses.

Masses are known by their phase and by their function of sensors and registers (up to its inverse), while the tick is 1.
That takes truth tables, so in devices of more inputs than have them there is no preference.
"""

from __future__ import annotations

from mdlcad.mapping.cell_library import Library
from mdlcad.mapping.options import Option, OptionGraph
from mdlcad.mapping.plan import Key, Role
from mdlcad.mapping.subject import Subject
from mdlcad.mapping.wired import ring_of, value, wires_of
from mdlcad.network.model import MassKind, Network

NEW_MASS, NEW_INPUTS = 6, 3
"""What is charged for a mass that was not there, and for one that had other inputs; a mass costs 16."""

# phase, whether the tick is among its inputs, and its function with the tick at 1
_Sign = tuple[int, bool, int]
_TICK: _Sign = (-1, True, 0)
_Inputs = tuple[tuple[_Sign, int], ...]


def strangeness(graph: OptionGraph, earlier: Network, library: Library) -> dict[Key, tuple[int, ...]]:
    """What every option of every mass is charged; nothing in devices without truth tables."""
    if not graph.subject.exact:
        return {}
    known = _Earlier(graph.subject, earlier, library).inputs
    tables = _Tables(graph)
    charges: dict[Key, tuple[int, ...]] = {}
    for key in sorted(graph.options):
        prices = []
        for option in graph.options[key]:
            ways = known.get(tables.sign(key, option))
            if ways is None:
                prices.append(NEW_MASS)
            else:
                prices.append(0 if tables.inputs(option) in ways else NEW_INPUTS)
        charges[key] = tuple(prices)
    return charges


def _normal(subject: Subject, table: int) -> int:
    return min(table, table ^ subject.full)


class _Tables:
    """Functions of the masses that a graph could make."""

    def __init__(self, graph: OptionGraph) -> None:
        self._graph = graph
        self._done: dict[Key, int] = {}

    def table(self, key: Key) -> int:
        """The function of a mass with the tick at 1. A TERM's load is 1 whenever the term counts."""
        subject = self._graph.subject
        if key.role is Role.TICK:
            return subject.full
        if key.role in (Role.STORE, Role.FOLLOW):
            return subject.table(self._graph.registers[key.of[0]].output)
        if key.role is Role.LOGIC:
            return subject.table(2 * key.of[0])
        if key.role is Role.LOAD:
            return subject.table(key.of[0])
        if key.role is Role.TERM:
            load = subject.full if key.of[0] < 0 else subject.table(key.of[0])
            return load & subject.table(key.of[1])
        if key not in self._done:
            option = self._graph.options[key][0]
            self._done[key] = value(subject.full, option.function, [self.table(source) for source in option.sources])
        return self._done[key]

    def sign(self, key: Key, option: Option) -> _Sign:
        """What ``key`` is known by if it is made by ``option``."""
        subject = self._graph.subject
        gated = any(source.role in (Role.TICK, Role.LOAD) for source in option.sources)
        if key.role is Role.HOLD:
            table = value(subject.full, option.function, [self.table(source) for source in option.sources])
        else:
            table = self.table(key)
        return key.phase, gated, _normal(subject, table)

    def inputs(self, option: Option) -> _Inputs:
        """What an option is known by: its inputs and their weights."""
        found = []
        for source, weight in zip(option.sources, option.function.weights, strict=True):
            if source.role is Role.TICK:
                found.append((_TICK, abs(weight)))
                continue
            gated = source.role in (Role.TERM, Role.LOAD, Role.HOLD)
            if source.role is Role.HOLD:
                # which release it has is its own affair
                found.append(((source.phase, True, -1), abs(weight)))
                continue
            found.append(((source.phase, gated, _normal(self._graph.subject, self.table(source))), abs(weight)))
        return tuple(sorted(found))


class _Earlier:
    """What the earlier network made: for every mass that it is known by, the inputs that such masses had."""

    def __init__(self, subject: Subject, network: Network, library: Library) -> None:
        self._subject = subject
        self._wires = wires_of(network, library)
        self._masses = {mass.name: mass for mass in network.masses}
        self._bits = {bit.mass: bit.bit for bit in network.sensors}
        self._bits |= {register.mass: register.bit for register in network.registers}
        self._holds = {f"{register.bit}.hold": register.bit for register in network.registers}
        # a store's twin takes the register's value too
        taken = [item for item in network.couplings if item.source in self._holds]
        self._bits |= {item.target: self._holds[item.source] for item in taken}
        self._ring = ring_of(self._wires)
        self._tables: dict[str, int | None] = dict.fromkeys(sorted(self._ring), subject.full)
        self.inputs: dict[_Sign, set[_Inputs]] = {}
        for name in self._masses:
            sign = self._sign(name)
            wire = self._wires[name]
            inputs = [(self._input(o), w) for o, w in zip(wire.sources, wire.function.weights, strict=True)]
            if name not in self._ring and sign is not None and all(one is not None for one, _ in inputs):
                found = tuple(sorted((one, abs(weight)) for one, weight in inputs if one is not None))
                self.inputs.setdefault(sign, set()).add(found)

    def _table(self, name: str) -> int | None:
        """A mass's function with the tick at 1; None if it leans on an input that the program has no longer."""
        stack = [name]
        while stack:
            top = stack[-1]
            if top in self._tables:
                stack.pop()
            elif top in self._bits:
                bit = self._bits[top]
                there = bit in self._subject.inputs
                self._tables[stack.pop()] = self._subject.table(self._subject.input(bit)) if there else None
            else:
                missing = [source for source in self._wires[top].sources if source not in self._tables]
                if missing:
                    stack += missing
                else:
                    self._tables[stack.pop()] = self._evaluate(top)
        return self._tables[name]

    def _evaluate(self, name: str) -> int | None:
        wire = self._wires[name]
        tables = [self._tables[source] for source in wire.sources]
        known = [table for table in tables if table is not None]
        return value(self._subject.full, wire.function, known) if len(known) == len(tables) else None

    def _gated(self, name: str) -> bool:
        """Whether a mass has the tick, or the tick under a load, among its inputs."""
        return any(self._masses[source].kind is MassKind.TICK for source in self._wires[name].sources)

    def _sign(self, name: str) -> _Sign | None:
        table = self._table(name)
        if table is None:
            return None
        gated = name not in self._bits and self._gated(name)
        return self._masses[name].phase, gated, _normal(self._subject, table)

    def _input(self, name: str) -> _Sign | None:
        """What a mass is known by as an input of others."""
        if name in self._ring:
            return _TICK
        if name in self._holds:
            return self._masses[name].phase, True, -1
        return self._sign(name)
