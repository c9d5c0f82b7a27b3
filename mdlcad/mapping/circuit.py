"""The logic of a finished network while it is being mended: gates, what they hold, and the limits that it keeps to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from mdlcad.mapping.cell_library import Library
from mdlcad.mapping.wired import Wires, arrivals, ring_of
from mdlcad.network.model import MassKind

LOGIC = (MassKind.GATE, MassKind.BUFFER)
PHASES = 3
REACH = 1
"""Columns that a coupling spans at most."""


@dataclass(frozen=True, slots=True)
class Circuit:
    """Masses as gates, and what is known of them.

    Attributes:
        known: tables of masses that hold a bit or the tick. full: the table of 1.
        holds: the masses that keep a register's value, which no logic reads.
        polarity: -1 for a mass that is used upside down.
        seats: where each mass stands (column, row), if that is known. room: free places by column.
        ports: masses that are sensors or actuators.
    """

    wires: Wires
    known: Mapping[str, int]
    full: int
    holds: frozenset[str]
    polarity: Mapping[str, int]
    seats: Mapping[str, tuple[int, int]]
    room: Mapping[int, int]
    ports: frozenset[str]

    def gated(self, name: str) -> bool:
        """Whether a mass has the tick among its inputs."""
        return any(self.wires[source].kind is MassKind.TICK for source in self.wires[name].sources)


def without_idle(circuit: Circuit) -> Circuit:
    """``circuit`` without the gates that nobody reads any more."""
    wires = dict(circuit.wires)
    while True:
        read = {source for wire in wires.values() for source in wire.sources} | circuit.ports
        idle = [name for name, wire in wires.items() if wire.kind in LOGIC and name not in read]
        if not idle:
            return replace(circuit, wires=wires)
        for name in idle:
            del wires[name]


class Limits:
    """What a patched circuit must keep to: the library's loads and echoes, and the times by which all has settled.

    A circuit that was beyond a limit before may stay so, but no further.
    """

    def __init__(self, circuit: Circuit, library: Library) -> None:
        self._library = library
        self._loads, self._echoes = _pulls(circuit)
        self._times = _times(circuit)

    def hold(self, circuit: Circuit) -> bool:
        """Whether ``circuit`` keeps to them."""
        return not self._beyond(circuit) and self._in_time(circuit)

    def relieved(self, circuit: Circuit) -> Circuit | None:
        """``circuit`` with a twin that takes over one target of the one mass that is beyond a limit; None if that does
        not help."""
        beyond = self._beyond(circuit)
        if len(beyond) != 1 or beyond[0] in circuit.known or not self._in_time(circuit):
            return None
        (name,) = beyond
        wire = circuit.wires[name]
        count = 1
        while f"{name}.twin{count}" in circuit.wires:
            count += 1
        twin = f"{name}.twin{count}"
        found = []
        for target, other in sorted(circuit.wires.items()):
            if name in other.sources:
                sources = tuple(twin if source == name else source for source in other.sources)
                wires = {**circuit.wires, twin: wire, target: replace(other, sources=sources)}
                tried = replace(circuit, wires=wires, polarity={**circuit.polarity, twin: circuit.polarity[name]})
                if self.hold(tried):
                    near = [circuit.seats[mass] for mass in (*wire.sources, target) if mass in circuit.seats]
                    columns, rows = [column for column, _ in near] or [0], [row for _, row in near] or [0]
                    apart = max(columns) - min(columns) > 2 * REACH, max(rows) - min(rows)
                    found.append((apart, target, tried))
        return min(found, key=lambda item: item[:2])[2] if found else None

    def _beyond(self, circuit: Circuit) -> list[str]:
        """The masses of too much load or echo."""
        gates = self._library.gates
        limits = ((gates.load_limit, self._loads), (gates.echo_limit, self._echoes))
        pulls = zip(_pulls(circuit), limits, strict=True)
        return sorted({name for now, (most, then) in pulls for name in now if now[name] > max(most, then.get(name, 0))})

    def _in_time(self, circuit: Circuit) -> bool:
        return all(now <= then for now, then in zip(_times(circuit), self._times, strict=True))


def _pulls(circuit: Circuit) -> tuple[dict[str, int], dict[str, int]]:
    """Load and echo (see ``relieve``) of every mass but the sensors."""
    loads = dict.fromkeys(circuit.wires, 0)
    for wire in circuit.wires.values():
        for source, weight in zip(wire.sources, wire.function.weights, strict=True):
            loads[source] += abs(weight)
    echoes = dict.fromkeys(circuit.wires, 0)
    for name, wire in circuit.wires.items():
        for source, weight in zip(wire.sources, wire.function.weights, strict=True):
            echoes[source] += abs(weight) * (loads[name] + wire.function.inputs - abs(weight))
    for name, wire in circuit.wires.items():
        if wire.kind is MassKind.SENSOR:
            del loads[name], echoes[name]
    return loads, echoes


def _times(circuit: Circuit) -> tuple[int, ...]:
    """The last cycles in which what registers take, and what actuators show, can change: after the sensors did, and
    after the registers did."""
    wires = circuit.wires
    ring = ring_of(wires)
    sensors = [name for name, wire in wires.items() if wire.kind is MassKind.SENSOR]
    stores = [name for name in circuit.known if name not in ring and wires[name].kind is not MassKind.SENSOR]
    found = []
    for changed, fixed in ((sensors, stores), (stores, sensors)):
        reached = arrivals(wires, changed, [*fixed, *sorted(ring)])
        taken = [reached[s] for name in wires if name not in ring and circuit.gated(name) for s in wires[name].sources]
        shown = [reached[name] for name in circuit.ports if name in wires and wires[name].kind in LOGIC]
        found += [max(taken, default=0), max(shown, default=0)]
    return tuple(found)
