"""One patch of a network: what it changes, what speaks against it, and the circuit with it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from statistics import median
from typing import NamedTuple

from mdlcad.mapping.circuit import PHASES, REACH, Circuit
from mdlcad.mapping.gatefind import Gate
from mdlcad.mapping.wired import Wire, Wires
from mdlcad.network.model import MassKind

COUPLING, ROCKER = 4, 2
"""What a new coupling, and one with a rocker, counts as in rows of carrier."""
POSTS = 2
"""Rockers and bias leaf that a mass has room for."""


@dataclass(frozen=True, slots=True)
class Patch:
    """``mass`` gets other inputs.

    Attributes:
        gates: the mass's own gate; and new ones, each of which makes the last input of the one before it.
    """

    mass: str
    gates: tuple[Gate, ...]


class Rank(NamedTuple):
    """What speaks against a patch, the worst first: posts too many (which no layout can hold), couplings out of reach,
    masses without room, whether its mass leaves its column, length in rows, weights."""

    posts: int
    far: int
    full: int
    leaves: int
    length: int
    weights: int


def ticks(circuit: Circuit, mass: str) -> tuple[str, ...]:
    """The tick among a mass's inputs, which it keeps."""
    return tuple(source for source in _sources(circuit, mass) if circuit.wires[source].kind is MassKind.TICK)


def rank(circuit: Circuit, patch: Patch) -> Rank:
    """What speaks against a patch, the worst first."""
    made = _made_by(circuit, patch)
    far, full, leaves = _seating(circuit, made, patch.mass)
    over, rockers = min(_parts(circuit, made, signs) for signs in _signs(made))
    weights = sum(wire.function.inputs for wire in made.values())
    return Rank(over, far, full, leaves, _length(circuit, made, patch.mass) + ROCKER * rockers, weights)


def _sources(circuit: Circuit, mass: str) -> tuple[str, ...]:
    return circuit.wires[mass].sources if mass in circuit.wires else ()


def _made_by(circuit: Circuit, patch: Patch) -> Wires:
    """What a patch changes: its mass first, then its new ones."""
    names = [patch.mass]
    while len(names) < len(patch.gates):
        names.append(_new_name(circuit, patch.mass, len(names)))
    made: Wires = {}
    for number, (name, gate) in enumerate(zip(names, patch.gates, strict=True)):
        sources, function = (*gate.sources, *names[number + 1 : number + 2]), gate.function
        phase, kind = (circuit.wires[patch.mass].phase - number) % PHASES, MassKind.GATE
        if len(sources) == 1:
            kind = MassKind.BUFFER
        if number == 0 and (circuit.gated(name) or name in circuit.ports):
            kind = circuit.wires[name].kind
        if number == 0 and circuit.gated(name):
            sources, function = (*ticks(circuit, name), *sources), function.gated()
        made[name] = Wire(phase, kind, sources, function)
    return made


def _new_name(circuit: Circuit, mass: str, number: int) -> str:
    """The name of a new mass, after the one that it serves; ``number`` tells a patch's new masses apart."""
    count = 0
    while number:
        count += 1
        number -= f"{mass}.patch{count}" not in circuit.wires
    return f"{mass}.patch{count}"


def _signs(made: Wires) -> Iterator[tuple[int, ...]]:
    """The ways up that a patch's new masses can be used."""
    return product((1, -1), repeat=len(made) - 1)


def _parts(circuit: Circuit, made: Wires, signs: tuple[int, ...]) -> tuple[int, int]:
    """Posts too many and negative couplings, with the new masses that way up."""
    new = list(made)[1:]
    polarity = {**circuit.polarity, **dict(zip(new, signs, strict=True))}
    over = rockers = 0
    for name, wire in made.items():
        signed = zip(wire.sources, wire.function.weights, strict=True)
        turned = sum(weight * polarity[source] * polarity[name] < 0 for source, weight in signed)
        over += max(0, turned + (wire.function.bias != 0) - POSTS)
        rockers += turned
    return over, rockers


def _seating(circuit: Circuit, made: Wires, mass: str) -> tuple[int, int, int]:
    """How many couplings of a patch reach too far if it alone moves, how many of its masses then stand in columns that
    have no room left, and whether its mass leaves its column."""
    if mass not in circuit.seats:
        return 0, 0, 0
    columns = {name: column for name, (column, _) in circuit.seats.items()}
    targets = [columns[name] for name, wire in circuit.wires.items() if mass in wire.sources and name in columns]
    best: tuple[int, int, int] | None = None
    for chosen in product(sorted(circuit.room), repeat=len(made)):
        at = {**columns, **dict(zip(made, chosen, strict=True))}
        far = sum(abs(at[mass] - column) > REACH for column in targets)
        for name, wire in made.items():
            far += sum(abs(at[name] - at[source]) > REACH for source in wire.sources if source in at)
        entered = Counter(at[name] for name in made if columns.get(name) != at[name])
        full = sum(max(0, count - circuit.room[column]) for column, count in entered.items())
        found = far, full, int(at[mass] != columns[mass])
        best = found if best is None else min(best, found)
    assert best is not None
    return best


def _length(circuit: Circuit, made: Wires, mass: str) -> int:
    """How much a patch adds to carriers, in rows: a new mass stands in the middle of those that it is coupled to."""
    rows = {name: row for name, (_, row) in circuit.seats.items()}
    total = 0
    for name, wire in reversed(made.items()):
        sources = [source for source in wire.sources if source in rows]
        if name not in rows:
            rows[name] = round(median([*(rows[source] for source in sources), rows.get(mass, 0)]))
        new = [source for source in sources if source not in _sources(circuit, name)]
        total += sum(COUPLING + abs(rows[source] - rows[name]) for source in new)
    return total


def applied(circuit: Circuit, patch: Patch) -> Circuit:
    """``circuit`` with the patch in it."""
    made = _made_by(circuit, patch)
    signs = min(_signs(made), key=lambda signs: _parts(circuit, made, signs))
    new = dict(zip(list(made)[1:], signs, strict=True))
    return replace(circuit, wires={**circuit.wires, **made}, polarity={**circuit.polarity, **new})
