"""The ways to build a register: what sets it at a tick, and what releases the value it held.

A register is a ring of three masses: r (phase 2) = OR of its set terms and its hold; q (phase 0) = r; hold (phase 1)
= q AND NOT (tick AND release). A set term (phase 1) is tick AND s, or load AND s where load (phase 0) = tick AND
release. So at a tick the register becomes OR(s) OR (q AND NOT release), and keeps its value otherwise.
"""

from __future__ import annotations

from dataclasses import dataclass

from mdlcad.mapping.candidates import Candidate
from mdlcad.mapping.subject import FALSE, TRUE, Subject
from mdlcad.synthesis.netlist import StateBit

_MOST_LITERALS = 8


@dataclass(frozen=True, slots=True)
class Term:
    """A set term: tick AND ``literal``, or (tick AND ``load``) AND ``literal`` if there is a load."""

    literal: int
    load: int | None = None


@dataclass(frozen=True, slots=True)
class SetChoice:
    """One way to set a register: the OR of ``terms`` (at most two)."""

    terms: tuple[Term, ...]


@dataclass(frozen=True, slots=True)
class RegisterChoices:
    """All ways to build one register; ``fits[i]`` are the indices of the releases that go with ``sets[i]``.

    Attributes:
        output: literal of the register's own bit.
        releases: literals; TRUE releases at every tick, FALSE never.
    """

    bit: str
    output: int
    sets: tuple[SetChoice, ...]
    releases: tuple[int, ...]
    fits: tuple[tuple[int, ...], ...]


@dataclass(frozen=True, slots=True)
class Wanted:
    """Literals of one register: next value in full, and data and enable as synthesis has them."""

    register: StateBit
    output: int
    following: int
    data: int
    enable: int | None


def structural_choices(wanted: Wanted) -> RegisterChoices:
    """The two ways that need no truth tables: all logic in the set term, or loading under the enable."""
    sets = [_set_choice(wanted.following)]
    releases = [TRUE]
    fits = [(0,)]
    if wanted.enable is not None:
        sets.append(_set_choice(wanted.data, wanted.enable))
        releases.append(wanted.enable)
        fits.append((1,))
    return RegisterChoices(wanted.register.bit, wanted.output, tuple(sets), tuple(releases), tuple(fits))


def exact_choices(subject: Subject, candidates: list[tuple[Candidate, ...]], wanted: Wanted) -> RegisterChoices:
    """Every way that the nodes of an exact graph offer."""
    q = subject.table(wanted.output)
    target = subject.table(wanted.following)
    literals = [FALSE, TRUE]
    literals += [2 * node + sign for node in range(1, len(subject.ways)) for sign in (0, 1)]
    tables = {literal: subject.table(literal) for literal in literals}

    # set: right where the register was 0, never where it must become 0
    setting = [lit for lit in literals if tables[lit] & ~q == target & ~q and not tables[lit] & ~target]
    # release: wherever the register was 1 and must become 0
    releasing = [lit for lit in literals if not q & ~target & ~tables[lit]]
    setting = _nearest(setting, wanted.following)
    releasing = _nearest(releasing, wanted.following)
    if wanted.enable is not None and wanted.enable not in releasing:
        releasing.append(wanted.enable)

    options: list[tuple[SetChoice, int]] = []
    for literal in setting:
        options.append((_set_choice(literal), tables[literal]))
        for a, b in _halves(candidates, literal):
            options.append((SetChoice((Term(a), Term(b))), tables[literal]))
    if wanted.enable is not None:
        made = subject.table(wanted.enable) & subject.table(wanted.data)
        options.append((_set_choice(wanted.data, wanted.enable), made))

    sets, fits = [], []
    for option, table in options:
        loads = {term.load for term in option.terms if term.load is not None}
        fit = tuple(
            index
            for index, release in enumerate(releasing)
            if table | (q & ~tables[release]) == target and loads <= {release}
        )
        if fit:
            sets.append(option)
            fits.append(fit)
    return RegisterChoices(wanted.register.bit, wanted.output, tuple(sets), tuple(releasing), tuple(fits))


def _set_choice(literal: int, load: int | None = None) -> SetChoice:
    """Set by one term; what is never set needs none."""
    return SetChoice(() if literal == FALSE else (Term(literal, load),))


def _nearest(literals: list[int], always: int) -> list[int]:
    """The constants, the given literal and the oldest others: early nodes are the program's own."""
    keep = [lit for lit in literals if lit in (FALSE, TRUE, always)]
    return keep + [lit for lit in literals if lit not in keep][:_MOST_LITERALS]


def _halves(candidates: list[tuple[Candidate, ...]], literal: int) -> list[tuple[int, int]]:
    """Pairs of literals whose OR is ``literal``, from the two-input gates of its node."""
    found = []
    for gate in candidates[literal >> 1]:
        function = gate.function.negated() if literal & 1 else gate.function
        if len(gate.leaves) == 2 and function.bias == 1:
            a, b = (2 * leaf + (weight < 0) for leaf, weight in zip(gate.leaves, function.weights, strict=True))
            found.append((a, b))
    return found
