"""Mends an earlier network where an edited program asks for something else, and leaves all other masses as they are.

A small edit changes the next value of a register, or an output, in a few of all cases. Often one mass is enough to make
that right, if it gets other inputs, or one of them from a new mass. So every mass of the logic is tried in turn: what
it must be follows from what comes out with it at 0 and at 1; then gates that are so are looked for, of what is there
and of up to two new ones. If one mass cannot do it for all goals, they are mended one by one.

Where masses stand is known, so among such patches those are preferred whose couplings reach from column to column.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice

from mdlcad.mapping.cell_library import Library
from mdlcad.mapping.circuit import LOGIC, PHASES, Circuit, Limits, without_idle
from mdlcad.mapping.gatefind import Gate, GateFinder, Need
from mdlcad.mapping.patching import Patch, applied, rank, ticks
from mdlcad.mapping.wired import tables_of, value
from mdlcad.network.model import MassKind

MOST_NEW = 2
"""New masses of one patch at most."""
EFFORT = 200_000
"""Shapes of gates to try for all masses that might be patched, and a quarter of that for one."""
MOST_FOUND, MOST_RANKED, MOST_TRIED = 10_000, 1000, 100
"""Patches of a mass that are noted, of all masses that are compared, and that are held to the circuit's limits."""


@dataclass(frozen=True, slots=True)
class Goal:
    """What the table of ``mass`` must be, as computed from its sources even if it holds a bit itself."""

    mass: str
    table: int


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
                better = applied(circuit, patch)
                if limits.hold(better):
                    return better
        for patches in ranked:
            for patch in patches:
                relieved = limits.relieved(applied(circuit, patch))
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
    ranked = sorted(((rank(circuit, patch), patch) for patch in light), key=lambda item: (item[0], str(item[1])))
    return [patch for how, patch in ranked if how.posts == 0][:MOST_TRIED]


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
    return wire.kind in LOGIC or (wire.kind is MassKind.REGISTER and len(ticks(circuit, mass)) == 1)


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
