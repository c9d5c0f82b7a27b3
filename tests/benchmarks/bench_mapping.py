"""What each mapping technique gains, in masses: every one is switched off in turn and the examples are mapped again.

    python tests/benchmarks/bench_mapping.py [EXAMPLE...]

Nothing of this is an option of the compiler: the script takes single functions of the mapper out, or bars options of
its graph, in this process alone. Prints a table for docs/cells.md. Takes some minutes.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

from mdlcad.language import read_device
from mdlcad.mapping import cover, greedy, mapper, selection, subject
from mdlcad.mapping.build import with_ring
from mdlcad.mapping.cell_library import Library, load_library
from mdlcad.mapping.mapper import Effort
from mdlcad.mapping.options import Option, OptionGraph
from mdlcad.mapping.plan import Key, PlannedMass, Role
from mdlcad.mapping.registers import structural_choices
from mdlcad.mapping.relieve import relieve
from mdlcad.mapping.selection import MASS_COST, Selection, selection_cost
from mdlcad.mapping.threshold import COPY
from mdlcad.mapping.tickring import RingPlan
from mdlcad.synthesis import Netlist, synthesise

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
DESIGNS = ("mazerobot", "lock", "traffic_light", "turnstile")

Allowed = Callable[[Key, Option], bool]

USUAL = Effort()


def masses_of(netlist: Netlist, library: Library, effort: Effort = USUAL) -> tuple[PlannedMass, ...]:
    """All masses that the mapper plans, ring and twins included."""
    graph, nets = mapper._make_subject(netlist)
    plan = mapper._make_plan(netlist, library, graph, nets, effort, None)
    return relieve(with_ring(plan)[0], library.gates.load_limit, library.gates.echo_limit)


@contextmanager
def barred(allowed: Allowed) -> Iterator[None]:
    """The option graph without the options that are not ``allowed``; copies always are."""

    class Barred(OptionGraph):
        def _add(self, key, sources, function, guard=None):  # type: ignore[no-untyped-def]
            if len(sources) < 2 or allowed(key, Option(sources, function, guard)):
                super()._add(key, sources, function, guard)
            else:
                self._know(key)

    with patch.object(mapper, "OptionGraph", Barred):
        yield


@contextmanager
def one_hot_ring() -> Iterator[None]:
    """A tick ring of three masses a cycle, with one 1 in it."""

    def plan(cycles: int) -> RingPlan:
        return RingPlan(cycles, cycles, False, False)

    with ExitStack() as stack:
        for module in (cover, selection):
            stack.enter_context(patch.object(module, "plan_ring", plan))
        yield


@contextmanager
def phases_afterwards() -> Iterator[None]:
    """Gates are chosen as if buffers cost nothing, and phases for those gates alone."""

    def copies(graph: OptionGraph, chosen: Selection) -> int:
        return sum(
            key.role is Role.LOGIC and option.function == COPY and option.sources[0].of == key.of
            for key in chosen.chosen
            if (option := chosen.option(graph, key)).sources
        )

    def without_buffers(graph: OptionGraph, chosen: Selection) -> int:
        return selection_cost(graph, chosen) - MASS_COST * copies(graph, chosen)

    def nodes(option: Option) -> tuple[object, ...]:
        return (tuple((s.of, s.role in (Role.STORE, Role.FOLLOW)) for s in option.sources), option.function)

    def cover_of_those(graph: OptionGraph, start: Selection, time: float, seed: int) -> Selection:
        used = {(key.of, nodes(start.option(graph, key))) for key in start.chosen if key.role is Role.LOGIC}
        kept: dict[Key, list[Option]] = {}
        moved = replace(start, chosen=dict(start.chosen))
        for key, options in graph.options.items():
            numbers = [
                number
                for number, option in enumerate(options)
                if key.role is not Role.LOGIC or len(option.sources) < 2 or (key.of, nodes(option)) in used
            ]
            kept[key] = [options[number] for number in numbers]
            if key in moved.chosen:
                moved.chosen[key] = numbers.index(moved.chosen[key])
        whole, graph.options = graph.options, kept
        found = cover.best_cover(graph, moved, time, seed)
        graph.options = whole
        for key, number in found.chosen.items():
            found.chosen[key] = whole[key].index(kept[key][number])
        return found

    def keep_second(graph: OptionGraph, chosen: Selection) -> int:
        return 0 if chosen is latest[-1] else 1

    latest: list[Selection] = []

    def cover_and_note(graph: OptionGraph, start: Selection, time: float, seed: int) -> Selection:
        latest.append(cover_of_those(graph, start, time, seed))
        return latest[-1]

    with (
        patch.object(greedy, "selection_cost", without_buffers),
        patch.object(mapper, "best_cover", cover_and_note),
        patch.object(mapper, "selection_cost", keep_second),
    ):
        yield


@contextmanager
def plain_registers() -> Iterator[None]:
    """All of a register's logic in its set term, or loading under its enable; nothing in between."""
    with patch.object(mapper, "exact_choices", lambda subject, candidates, wanted: structural_choices(wanted)):
        yield


@contextmanager
def no_other_structures() -> Iterator[None]:
    """The logic as synthesis left it."""
    with patch.object(mapper, "restructure", lambda subject, roots: []):
        yield


@contextmanager
def no_truth_tables() -> Iterator[None]:
    """Equal functions are one node only if they are built alike."""
    with patch.object(subject, "MOST_EXACT_INPUTS", -1):
        yield


def two_inputs(key: Key, option: Option) -> bool:
    return option.function.inputs <= 2 or key.role is Role.STORE


def no_majority(key: Key, option: Option) -> bool:
    return option.function.bias != 0


def no_weights(key: Key, option: Option) -> bool:
    return all(abs(weight) == 1 for weight in option.function.weights)


def no_absorption(key: Key, option: Option) -> bool:
    return key.role not in (Role.TERM, Role.HOLD, Role.LOAD) or len(option.sources) <= 2


TECHNIQUES: tuple[tuple[str, Callable[[], object]], ...] = (
    ("threshold gates of more than two inputs (and, or of two only)", lambda: barred(two_inputs)),
    ("majority (gates without a bias)", lambda: barred(no_majority)),
    ("weights of two and more (one stiffness for all springs)", lambda: barred(no_weights)),
    ("set and hold terms take in the last gate of their logic", lambda: barred(no_absorption)),
    ("smaller registers: logic shared between setting and releasing", plain_registers),
    ("smaller tick: a ring that counts, instead of three masses a cycle", one_hot_ring),
    ("phases chosen together with the gates, instead of after them", phases_afterwards),
    ("several structures of the same logic, by ABC", no_other_structures),
    ("equal functions are one node, by truth table", no_truth_tables),
)


def inverters(masses: tuple[PlannedMass, ...]) -> int:
    """The least number of inverters if inversion were not free: one for every mass that somebody wants inverted, once
    every mass carries the polarity that most want."""
    uses: dict[Key, list[bool]] = {}
    for mass in masses:
        for source, weight in zip(mass.sources, mass.function.weights, strict=True):
            uses.setdefault(source, []).append(weight < 0)
    # a mass that all want inverted can carry the inverse itself
    return sum(any(wanted) and not all(wanted) for wanted in uses.values())


def chains(masses: tuple[PlannedMass, ...]) -> int:
    """Buffers more if every user of a delayed signal had a chain of its own."""
    delay: dict[Key, int] = {}
    by_key = {mass.key: mass for mass in masses}

    def depth(key: Key) -> int:
        mass = by_key[key]
        if key.role is not Role.LOGIC or len(mass.sources) != 1:
            return 0
        return 1 + depth(mass.sources[0])

    for mass in masses:
        delay[mass.key] = depth(mass.key)
    buffers = sum(found > 0 for found in delay.values())
    return sum(delay[s] for mass in masses if not delay[mass.key] for s in mass.sources) - buffers


def main(designs: tuple[str, ...]) -> int:
    """Print the table."""
    library = load_library("parametron")
    netlists = [synthesise(read_device(EXAMPLES / f"{name}.mdl")) for name in designs]
    whole = [masses_of(netlist, library) for netlist in netlists]

    def row(words: str, counts: list[str]) -> None:
        print(f"| {words} | {' | '.join(counts)} |", flush=True)

    row("switched off", list(designs))
    row("---", ["---"] * len(designs))
    row("nothing: all techniques", [str(len(masses)) for masses in whole])
    for words, off in TECHNIQUES:
        counts = []
        for netlist, masses in zip(netlists, whole, strict=True):
            with off():  # type: ignore[attr-defined]
                counts.append(f"{len(masses_of(netlist, library)) - len(masses):+d}")
        row(words, counts)
    row("inversion for free (at least)", [f"{inverters(masses):+d}" for masses in whole])
    row("buffer chains shared by their users", [f"{chains(masses):+d}" for masses in whole])
    annealed = Effort(deterministic_time=0.0)
    counts = [
        f"{len(masses_of(netlist, library, annealed)) - len(masses):+d}"
        for netlist, masses in zip(netlists, whole, strict=True)
    ]
    row("the exact search (annealing only)", counts)
    return 0


if __name__ == "__main__":
    sys.exit(main(tuple(sys.argv[1:]) or DESIGNS))
