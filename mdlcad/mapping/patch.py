"""Mends an earlier network where an edited program asks for something else, and leaves all other masses as they are.

A small edit changes the next value of a register, or an output, in a few of all cases. Often one mass is enough to make
that right, if it gets other inputs, or one of them from a new mass. So every mass of the logic is tried in turn: what
it must be follows from what comes out with it at 0 and at 1; then gates that are so are looked for, of what is there
and of up to two new ones. If one mass cannot do it for all goals, they are mended one by one.

Where masses stand is known, so among such patches those are preferred whose couplings reach from column to column.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import islice, product
from statistics import median
from typing import NamedTuple

from mdlcad.mapping.cell_library import Library
from mdlcad.mapping.circuit import LOGIC, REACH, Circuit, Limits, without_idle
from mdlcad.mapping.gatefind import Gate, GateFinder, Need
from mdlcad.mapping.wired import Wire, Wires, tables_of, value
from mdlcad.network.model import MassKind

PHASES = 3
MOST_NEW = 2
"""New masses of one patch at most."""
EFFORT = 200_000
"""Shapes of gates to try for all masses that might be patched, and a quarter of that for one."""
MOST_FOUND, MOST_RANKED, MOST_TRIED = 10_000, 1000, 100
"""Patches of a mass that are noted, of all masses that are compared, and that are held to the circuit's limits."""
COUPLING, ROCKER = 4, 2
"""What a new coupling, and one with a rocker, counts as in rows of carrier."""
POSTS = 2
"""Rockers and bias leaf that a mass has room for."""


@dataclass(frozen=True, slots=True)
class Goal:
    """What the table of ``mass`` must be, as computed from its sources even if it holds a bit itself."""

    mass: str
    table: int


@dataclass(frozen=True, slots=True)
class Patch:
    """``mass`` gets other inputs.

    Attributes:
        gates: the mass's own gate; and new ones, each of which makes the last input of the one before it.
    """

    mass: str
    gates: tuple[Gate, ...]


class _Rank(NamedTuple):
    """What speaks against a patch, the worst first: posts too many (which no layout can hold), couplings out of reach,
    masses without room, whether its mass leaves its column, length in rows, weights."""

    posts: int
    far: int
    full: int
    leaves: int
    length: int
    weights: int


def find_patches(circuit: Circuit, goals: tuple[Goal, ...], library: Library) -> Circuit | None:
    """``circuit`` with every goal met, or None if no few patches were found that do it."""
    for _ in range(len(goals) + 1):
        wrong = _wrong(circuit, goals)
        if not wrong:
            return without_idle(circuit)
        better = _mended(circuit, goals, wrong, library)
        if better is None:
            return None
        circuit = better
    return None


def _made(circuit: Circuit, goal: Goal, tables: Mapping[str, int]) -> int:
    """What a goal's mass computes; of one that takes a register's value, what it takes next."""
    if goal.mass not in circuit.known:
        return tables[goal.mass]
    wire = circuit.wires[goal.mass]
    return value(circuit.full, wire.function, [tables[source] for source in wire.sources])


def _wrong(circuit: Circuit, goals: tuple[Goal, ...]) -> tuple[Goal, ...]:
    tables = tables_of(circuit.wires, circuit.known, circuit.full)
    return tuple(goal for goal in goals if _made(circuit, goal, tables) != goal.table)


def _mended(circuit: Circuit, goals: tuple[Goal, ...], wrong: tuple[Goal, ...], library: Library) -> Circuit | None:
    """``circuit`` with one patch by which all ``wrong`` goals are met, or one of them, and no other gets worse.

    The fewer new masses the better; then the more goals; then none that needs a twin for what has too many targets.
    """
    limits = Limits(circuit, library)
    aims = [wrong] if len(wrong) == 1 else [wrong, *((goal,) for goal in wrong)]
    for new in range(MOST_NEW + 1):
        ranked = [_ranked(circuit, goals, some, library, new) for some in aims]
        for patches in ranked:
            for patch in patches:
                better = _applied(circuit, patch)
                if limits.hold(better):
                    return better
        for patches in ranked:
            for patch in patches:
                relieved = limits.relieved(_applied(circuit, patch))
                if relieved is not None:
                    return relieved
    return None


def _ranked(
    circuit: Circuit, goals: tuple[Goal, ...], aims: tuple[Goal, ...], library: Library, new: int
) -> list[Patch]:
    """The best patches of ``new`` new masses by which ``aims`` are met, and no other goal gets worse; best first."""
    tables = tables_of(circuit.wires, circuit.known, circuit.full)
    finder = GateFinder(tables, circuit.full, library.gates.weight_limit)
    patches: list[Patch] = []
    left = EFFORT
    for mass in sorted(circuit.wires):
        need = _need(circuit, goals, aims, mass, tables) if _is_free(circuit, mass) else None
        if need is not None:
            finder.effort = min(left, EFFORT // 4)
            left -= finder.effort
            patches += islice(_patches(circuit, finder, mass, need, new), MOST_FOUND)
            left += max(0, finder.effort)
    light = sorted(patches, key=lambda patch: (_weight(circuit, patch), str(patch)))[:MOST_RANKED]
    ranked = sorted(((_rank(circuit, patch), patch) for patch in light), key=lambda item: (item[0], str(item[1])))
    return [patch for rank, patch in ranked if rank.posts == 0][:MOST_TRIED]


def _weight(circuit: Circuit, patch: Patch) -> int:
    """What a patch adds, as far as it is seen at once: its inputs, those that are new more so."""
    new = set(patch.gates[0].sources) - set(circuit.wires[patch.mass].sources)
    count = len(new) + sum(len(gate.sources) for gate in patch.gates[1:])
    return 2 * count + sum(gate.function.inputs for gate in patch.gates)


def _is_free(circuit: Circuit, mass: str) -> bool:
    """Whether what a mass computes is a matter of the logic: not what holds a bit, or keeps time."""
    wire = circuit.wires[mass]
    if mass in circuit.known or mass in circuit.holds or circuit.holds & set(wire.sources):
        return False
    return wire.kind in LOGIC or (wire.kind is MassKind.REGISTER and len(_ticks(circuit, mass)) == 1)


def _ticks(circuit: Circuit, mass: str) -> tuple[str, ...]:
    """The tick among a mass's inputs, which it keeps."""
    return tuple(source for source in _sources(circuit, mass) if circuit.wires[source].kind is MassKind.TICK)


def _need(
    circuit: Circuit, goals: tuple[Goal, ...], aims: tuple[Goal, ...], mass: str, tables: Mapping[str, int]
) -> Need | None:
    """What ``mass`` must be for ``aims`` to be met; None if that is not in its hands."""
    allowed = []
    for constant in (0, circuit.full):
        tried = tables_of(circuit.wires, {**circuit.known, mass: constant}, circuit.full)
        good = circuit.full
        for goal in goals:
            same = ~(_made(circuit, goal, tried) ^ goal.table)
            if goal not in aims:
                # what is still wrong may stay so for now
                same |= ~(_made(circuit, goal, tried) ^ _made(circuit, goal, tables))
            good &= same
        allowed.append(good)
    if allowed[0] | allowed[1] != circuit.full:
        return None
    return Need(allowed[1] & ~allowed[0], allowed[0] & ~allowed[1])


def _patches(circuit: Circuit, finder: GateFinder, mass: str, need: Need, new: int) -> Iterator[Patch]:
    """All patches of ``mass`` with as many new gates."""
    fed, phase = _fed(circuit, mass), circuit.wires[mass].phase
    signals = [_signals(circuit, (phase - back) % PHASES, fed) for back in range(1, new + 2)]
    known: dict[tuple[Need, int], list[tuple[Gate, ...]]] = {}

    def chains(wanted: Need, step: int) -> list[tuple[Gate, ...]]:
        if (wanted, step) not in known:
            if step == new:
                found: list[tuple[Gate, ...]] = [(gate,) for gate in finder.gates(wanted, signals[step])]
            else:
                halves = finder.halves(wanted, signals[step])
                found = [(gate, *rest) for gate, left in halves for rest in chains(left, step + 1)]
            known[wanted, step] = found
        return known[wanted, step]

    for gates in chains(need, 0):
        if not circuit.gated(mass) or gates[0].function.gated().total <= finder.limit:
            yield Patch(mass, gates)


def _fed(circuit: Circuit, mass: str) -> set[str]:
    """``mass`` and what depends on it within a decision."""
    found = {mass}
    while True:
        more = {
            name
            for name, wire in circuit.wires.items()
            if name not in found and name not in circuit.known and found & set(wire.sources)
        }
        if not more:
            return found
        found |= more


def _signals(circuit: Circuit, phase: int, fed: set[str]) -> tuple[str, ...]:
    """Masses of ``phase`` that logic may read."""
    return tuple(
        sorted(
            name
            for name, wire in circuit.wires.items()
            if wire.phase == phase
            and name not in fed
            and wire.kind is not MassKind.TICK
            and name not in circuit.holds
            and not circuit.gated(name)
            and not circuit.holds & (set(wire.sources) if name not in circuit.known else set())
        )
    )


def _rank(circuit: Circuit, patch: Patch) -> _Rank:
    """What speaks against a patch, the worst first."""
    made = _made_by(circuit, patch)
    far, full, leaves = _seating(circuit, made, patch.mass)
    over, rockers = min(_parts(circuit, made, signs) for signs in _signs(made))
    weights = sum(wire.function.inputs for wire in made.values())
    return _Rank(over, far, full, leaves, _length(circuit, made, patch.mass) + ROCKER * rockers, weights)


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
            sources, function = (*_ticks(circuit, name), *sources), function.gated()
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


def _applied(circuit: Circuit, patch: Patch) -> Circuit:
    """``circuit`` with the patch in it."""
    made = _made_by(circuit, patch)
    signs = min(_signs(made), key=lambda signs: _parts(circuit, made, signs))
    new = dict(zip(list(made)[1:], signs, strict=True))
    return replace(circuit, wires={**circuit.wires, **made}, polarity={**circuit.polarity, **new})
