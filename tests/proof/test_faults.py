"""Every seeded fault that changes the behaviour is caught; logic alone, without dynamics, says what changes it.

A fault of which the logic says that it changes nothing, or that hangs on a tie (two pulls that cancel, a mass that
nothing pulls), may be right in the dynamics: then it must be right on other walks too.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest

from mdlcad.language import read_device
from mdlcad.mapping import map_netlist
from mdlcad.mapping.cell_library import Library, load_library
from mdlcad.mapping.mapper import Effort
from mdlcad.network.model import Network
from mdlcad.proof.behaviour import Behaviour
from mdlcad.proof.itinerary import make_itinerary
from mdlcad.proof.reference import build_reference
from mdlcad.synthesis import synthesise
from tests.proof.devices import toggle, walker
from tests.proof.faults import all_faults, caught
from tests.proof.ideal import Verdict, classify
from tests.scenario.builds import QUICKLY

EXAMPLES = Path(__file__).parents[2] / "examples"
KINDS = {
    "flipped sign",
    "missing spring",
    "wrong phase",
    "flipped bias",
    "missing bias",
    "swapped biases",
    "swapped sensors",
}

Counts = Counter[tuple[str, Verdict, bool]]


def by_hand() -> Library:
    """The numbers of the networks in ``tests.proof.devices``."""
    library = load_library("parametron")
    return replace(library, coupling=replace(library.coupling, strength=0.3), bias=replace(library.bias, force=0.5))


def seed_faults(network: Network, library: Library, reference: Behaviour, stride: int = 1) -> Counts:
    """How many faults of which kind, what they do by logic, and whether the proof catches them; every ``stride``-th."""
    proof, judge, other = (make_itinerary(reference, 20_000, seed) for seed in (0, 7, 5))
    assert classify(network, library, reference, judge) is Verdict.SAME
    assert not caught(network, reference, proof)
    counts: Counts = Counter()
    for kind, where, faulty in list(all_faults(network))[::stride]:
        verdict, found = classify(faulty, library, reference, judge), caught(faulty, reference, proof)
        counts[kind, verdict, found] += 1
        if not found:
            assert verdict is not Verdict.CHANGED, f"{kind} {where} changes the behaviour and is not caught"
            assert not caught(faulty, reference, other), f"{kind} {where} is wrong on another walk"
    return counts


@pytest.mark.parametrize("stride", [pytest.param(5, id="a fifth"), pytest.param(1, id="all", marks=pytest.mark.long)])
def test_faults_of_a_small_device_that_change_its_behaviour_are_caught(stride: int) -> None:
    network, machine = walker()
    counts = seed_faults(network, by_hand(), machine, stride)
    assert {kind for kind, _, _ in counts} >= KINDS - {"swapped sensors"}  # there is one pair
    changed = sum(count for (_, verdict, _), count in counts.items() if verdict is Verdict.CHANGED)
    assert changed > 40 / stride
    flipped = sum(count for (kind, _, _), count in counts.items() if kind == "flipped sign")
    assert counts["flipped sign", Verdict.CHANGED, True] == flipped > 0


def test_the_oracle_knows_a_fault_that_changes_nothing() -> None:
    """A spring that only a stuck input feeds: the toggle's ring may lose a weight that is never the one that counts."""
    network, machine = toggle()
    judge = make_itinerary(machine, 100, 7)
    heavier = tuple(
        replace(c, strength=3 * c.strength) if c.target.startswith("ring") else c for c in network.couplings
    )
    assert classify(replace(network, couplings=heavier), by_hand(), machine, judge) is Verdict.SAME
    lighter = tuple(c for c in network.couplings if c.target != "ring3")
    assert classify(replace(network, couplings=lighter), by_hand(), machine, judge) is not Verdict.SAME


def example(name: str, effort: Effort | None = None) -> tuple[Network, Library, Behaviour]:
    device, library = read_device(EXAMPLES / f"{name}.mdl"), load_library("parametron")
    return map_netlist(synthesise(device), library, effort), library, build_reference(device)


def test_a_sample_of_the_maze_robots_faults() -> None:
    counts = seed_faults(*example("mazerobot", QUICKLY), stride=29)
    assert sum(count for (_, verdict, found), count in counts.items() if verdict is Verdict.CHANGED and found) >= 2


@pytest.mark.long
@pytest.mark.parametrize("name", ["mazerobot", "lock", "turnstile"])
def test_every_fault_that_changes_the_behaviour_is_caught(name: str) -> None:
    counts = seed_faults(*example(name))
    for (kind, verdict, found), count in sorted(counts.items(), key=lambda item: (item[0][0], item[0][1].value)):
        print(f"{name}: {kind}: {verdict.value}: {count} {'caught' if found else 'right in the dynamics'}")
    assert {kind for kind, _, _ in counts} == KINDS
    assert counts["flipped sign", Verdict.CHANGED, True] > 40
