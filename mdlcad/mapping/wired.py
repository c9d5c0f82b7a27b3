"""A finished network read back as threshold gates with truth tables, as the mapper thinks of it.

All is as if every mass were upright. Tables are those of a tick: the ring's masses count as 1.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

from mdlcad.mapping.cell_library import Library
from mdlcad.mapping.subject import Subject
from mdlcad.mapping.threshold import Threshold
from mdlcad.network.model import MassKind, Network

NEVER = -(10**6)


@dataclass(frozen=True, slots=True)
class Wire:
    """A mass as a gate: ``function`` of ``sources``, of which a sensor has none."""

    phase: int
    kind: MassKind
    sources: tuple[str, ...]
    function: Threshold


Wires = dict[str, Wire]


def wires_of(network: Network, library: Library) -> Wires:
    """Every mass of ``network`` as a gate, in the network's order."""
    polarity = {mass.name: mass.polarity for mass in network.masses}
    inputs: dict[str, list[tuple[str, int]]] = {name: [] for name in polarity}
    for item in network.couplings:
        weight = round(item.strength / library.coupling.strength) * polarity[item.source] * polarity[item.target]
        inputs[item.target].append((item.source, weight))
    return {
        mass.name: Wire(
            mass.phase,
            mass.kind,
            tuple(source for source, _ in inputs[mass.name]),
            Threshold(
                tuple(weight for _, weight in inputs[mass.name]),
                -round(mass.bias / library.bias.force) * mass.polarity,
            ),
        )
        for mass in network.masses
    }


def ring_of(wires: Wires) -> frozenset[str]:
    """The masses of the tick that depend on nothing but the tick."""
    ring = {name for name, wire in wires.items() if wire.kind is MassKind.TICK}
    while True:
        led = {name for name in ring if any(source not in ring for source in wires[name].sources)}
        if not led:
            return frozenset(ring)
        ring -= led


def value(full: int, function: Threshold, tables: Sequence[int]) -> int:
    """Truth table of ``function`` of inputs with those truth tables; ``full`` is that of 1."""
    found = 0
    for minterm in range(1 << len(tables)):
        total = function.bias + sum(w if minterm >> i & 1 else -w for i, w in enumerate(function.weights))
        if total > 0:
            term = full
            for i, table in enumerate(tables):
                term &= table if minterm >> i & 1 else table ^ full
            found |= term
    return found


def tables_of(wires: Wires, known: Mapping[str, int], full: int) -> dict[str, int]:
    """Truth table of every mass, from the ``known`` ones."""
    tables = dict(known)

    def made(wire: Wire) -> int:
        return value(full, wire.function, [tables[source] for source in wire.sources])

    _complete(wires, tables, made)
    return tables


def _complete(wires: Wires, found: dict[str, int], made: Callable[[Wire], int]) -> None:
    """Make what ``found`` lacks, every mass after its sources."""
    for start in wires:
        stack = [start]
        while stack:
            top = stack[-1]
            missing = [] if top in found else [source for source in wires[top].sources if source not in found]
            if missing:
                stack += missing
                continue
            stack.pop()
            if top not in found:
                found[top] = made(wires[top])


def takers(wires: Wires, holds: Mapping[str, str]) -> dict[str, tuple[str, bool]]:
    """The register bit that a mass takes at a tick, and whether inverted: by mass, of those that a hold feeds.

    Args:
        holds: the register of every mass that holds one's value.
    """
    return {
        name: (holds[source], weight < 0)
        for name, wire in wires.items()
        for source, weight in zip(wire.sources, wire.function.weights, strict=True)
        if source in holds
    }


def known_tables(wires: Wires, network: Network, subject: Subject, holds: Mapping[str, str]) -> dict[str, int]:
    """Tables of what needs no gate: sensors, what takes a register's value, and the ring at its tick."""
    known = {bit.mass: subject.table(subject.input(bit.bit)) for bit in network.sensors}
    for name, (bit, inverted) in takers(wires, holds).items():
        known[name] = subject.table(subject.input(bit)) ^ (subject.full if inverted else 0)
    return known | dict.fromkeys(sorted(ring_of(wires)), subject.full)


def arrivals(wires: Wires, changed: Iterable[str], fixed: Iterable[str]) -> dict[str, int]:
    """The last cycle in which each mass can still change after ``changed`` ones did in cycle 0, while ``fixed`` ones
    stay as they are; ``NEVER`` for those that do not depend on them."""
    found = dict.fromkeys(fixed, NEVER) | dict.fromkeys(changed, 0)

    def latest(wire: Wire) -> int:
        late = 1 if wire.phase == 0 else 0
        return max((found[source] + late for source in wire.sources), default=NEVER)

    _complete(wires, found, latest)
    return found
