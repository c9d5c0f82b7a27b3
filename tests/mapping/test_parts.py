"""The pieces of the mapper, each against what it must be by definition or by brute force."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
import pytest

from mdlcad.errors import UsageError
from mdlcad.mapping.candidates import find_candidates
from mdlcad.mapping.cell_library import load_library
from mdlcad.mapping.plan import Key, PlannedMass, Role
from mdlcad.mapping.polarity import choose_polarity
from mdlcad.mapping.relieve import relieve
from mdlcad.mapping.restructure import restructure
from mdlcad.mapping.subject import FALSE, TRUE, Subject
from mdlcad.mapping.threshold import AND2, COPY, Threshold, match, threshold_functions
from mdlcad.mapping.tickmasses import ring_masses, tick_sources
from mdlcad.mapping.tickring import plan_ring


def value(function: Threshold, inputs: tuple[int, ...]) -> int:
    total = function.bias + sum(w * x for w, x in zip(function.weights, inputs, strict=True))
    assert total != 0
    return 1 if total > 0 else -1


@pytest.mark.parametrize("inputs", [1, 2, 3, 4])
def test_threshold_functions_are_what_their_tables_say(inputs: int) -> None:
    for table, function in threshold_functions(inputs, 5):
        assert function.total <= 5
        for minterm in range(1 << inputs):
            signs = tuple(1 if minterm >> i & 1 else -1 for i in range(inputs))
            assert (value(function, signs) > 0) == bool(table >> minterm & 1)


def test_one_mass_computes_and_or_majority_but_not_xor() -> None:
    full = {2: 15, 3: 255}

    def found(table: int, inputs: int) -> Threshold | None:
        return match(table, full[inputs] ^ table, inputs, 5)

    assert found(0b1000, 2) == AND2
    assert found(0b1110, 2) == Threshold((1, 1), 1)
    assert found(0b11101000, 3) == Threshold((1, 1, 1), 0)
    assert found(0b0110, 2) is None
    assert match(0b0010, 0b0001, 2, 5) is not None  # what never occurs is free


@pytest.mark.parametrize(
    "function", [COPY, AND2, Threshold((1, 1), 1), Threshold((1, 1, 1), 0), Threshold((2, 1, 1), -1)]
)
def test_gating_is_an_and_with_one_more_input(function: Threshold) -> None:
    gated = function.gated()
    for signs in product((-1, 1), repeat=len(gated.weights)):
        both = signs[0] > 0 and value(function, signs[1:]) > 0
        assert (value(gated, signs) > 0) == both


def majority_subject() -> tuple[Subject, int]:
    subject = Subject("abc")
    a, b, c = (subject.input(name) for name in "abc")
    return subject, subject.disjunction(subject.conjunction(a, b), subject.conjunction(c, subject.disjunction(a, b)))


def test_equal_functions_are_one_node_however_they_are_built() -> None:
    subject, majority = majority_subject()
    a, b, c = (subject.input(name) for name in "abc")
    other = subject.choose(subject.conjunction(b, c), subject.disjunction(b, c), a)
    assert other == majority
    assert subject.conjunction(a, a ^ 1) == FALSE and subject.disjunction(a, a ^ 1) == TRUE
    assert subject.cofactor(majority, a >> 1, True) == subject.disjunction(b, c)
    assert subject.cofactor(majority, a >> 1, False) == subject.conjunction(b, c)


def test_candidates_compute_their_node() -> None:
    subject, majority = majority_subject()
    restructure(subject, [majority])
    candidates = find_candidates(subject, 5)
    assert any(gate.function == Threshold((1, 1, 1), 0) for gate in candidates[majority >> 1]) or any(
        gate.function == Threshold((-1, -1, -1), 0) for gate in candidates[majority >> 1]
    )
    for node, gates in enumerate(candidates):
        for gate in gates:
            for minterm in range(8):
                signs = tuple(1 if subject.table(2 * leaf) >> minterm & 1 else -1 for leaf in gate.leaves)
                assert (value(gate.function, signs) > 0) == bool(subject.table(2 * node) >> minterm & 1)


def ring_pulses(cycles: int, early: bool, steps: int) -> tuple[list[int], list[int]]:
    """Cycles in which the tick shows in phase 0, and in phase 2 of the cycle before, by running the ring."""
    ring = plan_ring(cycles)
    masses = ring_masses(ring, early)
    sources = tick_sources(ring, early)
    state = {mass.key: -1 for mass in masses}
    seen: dict[int, list[int]] = {0: [], 2: []}
    for cycle in range(steps):
        for phase in range(3):
            for mass in masses:
                if mass.key.phase == phase:
                    state[mass.key] = value(mass.function, tuple(state[s] for s in mass.sources))
            for tick, key in sources.items():
                if tick.phase == phase == key.phase and state[key] > 0:
                    seen[phase].append(cycle)
    return seen[0], seen[2]


@pytest.mark.parametrize("early", [False, True])
@pytest.mark.parametrize("cycles", range(2, 12))
def test_the_ring_ticks_once_every_n_cycles(cycles: int, early: bool) -> None:
    late, before = ring_pulses(cycles, early, 8 * cycles)
    late = [cycle for cycle in late if cycle > 2 * cycles]
    assert len(late) >= 4 and set(np.diff(late)) == {cycles}
    if early:
        assert {cycle + 1 for cycle in before if cycle > 2 * cycles} >= set(late[1:])
    ring = plan_ring(cycles)
    assert len(ring_masses(ring, early)) == ring.masses(early)
    assert len(ring_masses(ring, early)) <= 3 * cycles


def test_a_ring_needs_two_cycles() -> None:
    with pytest.raises(ValueError, match="two cycles"):
        plan_ring(1)


def star(targets: int) -> tuple[PlannedMass, ...]:
    """A sensor, a gate and its targets, each with one target of its own."""
    sensor, gate = Key(Role.SENSOR, (1,), 0), Key(Role.LOGIC, (2,), 1)
    masses = [PlannedMass(sensor, (), Threshold((), 0)), PlannedMass(gate, (sensor,), COPY)]
    for index in range(targets):
        middle, end = Key(Role.LOGIC, (10 + index,), 2), Key(Role.LOGIC, (100 + index,), 0)
        masses += [PlannedMass(middle, (gate,), COPY), PlannedMass(end, (middle,), COPY)]
    return tuple(masses)


def test_twins_keep_load_and_echo_within_their_limits() -> None:
    relieved = relieve(star(9), load_limit=4, echo_limit=10)
    users: dict[Key, int] = {}
    for mass in relieved:
        for source in mass.sources:
            users[source] = users.get(source, 0) + 1
    twins = [mass.key for mass in relieved if mass.key.of == (2,)]
    assert len(twins) == 3 and all(users[key] <= 4 for key in twins)
    assert len({mass.key for mass in relieved}) == len(relieved) == len(star(9)) + 2
    assert relieve(star(4), load_limit=4, echo_limit=10) == star(4)


def test_polarity_is_the_best_there_is() -> None:
    """Fewest posts too many (two a mass), then fewest negative couplings, by trying all."""
    random = np.random.default_rng(5)
    for _ in range(6):
        names = [f"m{i}" for i in range(7)]
        pairs = sorted({tuple(sorted(random.choice(7, 2, replace=False).tolist())) for _ in range(11)})
        springs = [(names[a], names[b], bool(random.integers(2))) for a, b in pairs]

        def price(signs: dict[str, int], springs: list[tuple[str, str, bool]] = springs) -> tuple[int, int]:
            rockers = [b for a, b, inverting in springs if (signs[a] * signs[b] < 0) != inverting]
            return sum(max(0, rockers.count(name) - 2) for name in signs), len(rockers)

        best = min(price(dict(zip(names, (1, 1, *rest), strict=True))) for rest in product((1, -1), repeat=5))
        chosen = choose_polarity(names, springs, names[:2], [])
        assert chosen["m0"] == chosen["m1"] == 1
        assert price(chosen) == best


def test_the_shipped_library_loads() -> None:
    library = load_library("parametron")
    assert library.name == "parametron" and library.dynamics.phases == 3
    assert library.mass.k0 + 2 * library.mass.k1 == -2.5


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (("k0 = 3.5", "k0 = -3.5"), "mass.k0 must be positive"),
        (("k0 = 3.5", "k0 = inf"), "mass.k0: must be a number, not inf"),
        (("load_limit = 8", "load_limit = nan"), "gates.load_limit: must be a number, not nan"),
        (("k1 = -3.0", "k1 = -1.0"), "mass.k1 k0 + 2 k1 must be negative"),
        (("phases = 3", "phases = 2"), "dynamics.phases must be 3"),
        (("strength = 0.2", 'strength = "soft"'), "$.coupling.strength"),
        (("strength = 0.2", "strenght = 0.2"), "unknown key 'coupling.strenght'"),
        (("weight_limit = 5", "weight_limit = 99"), "gates.weight_limit must be 3 to 9"),
        (("[bias]", "[bias"), "not TOML"),
        (("[power_up]", "[wake_up]"), "unknown key 'wake_up'"),
    ],
)
def test_bad_libraries_are_refused_by_file_and_key(tmp_path: Path, change: tuple[str, str], expected: str) -> None:
    text = (Path(__file__).parents[2] / "cells" / "parametron" / "library.toml").read_text(encoding="utf-8")
    assert change[0] in text
    folder = tmp_path / "mine"
    folder.mkdir()
    (folder / "library.toml").write_text(text.replace(*change), encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        load_library(str(folder))
    assert str(caught.value).startswith("mine/library.toml: ") and expected in str(caught.value)
