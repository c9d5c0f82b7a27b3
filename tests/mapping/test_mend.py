"""An earlier network is mended for an edited program: it does what the edited program says, and little else changes."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from random import Random

import pytest

from mdlcad.language.device import Device
from mdlcad.mapping import Before, map_netlist
from mdlcad.mapping.gatefind import GateFinder, Need
from mdlcad.mapping.mapper import _make_subject
from mdlcad.mapping.mend import mended
from mdlcad.mapping.wired import value
from mdlcad.network.matching import changed_masses
from mdlcad.network.model import Network
from mdlcad.proof.prove import prove
from mdlcad.proof.reference import build_reference
from mdlcad.synthesis import synthesise
from tests.mapping.programs import QUICK, Program, library, mismatches, quick_network, random_program
from tests.synthesis.verilog_device import device_of

COUNTER = (
    "module m(input clk, input up, input hold, output reg [1:0] n = 0, output full);\n"
    "always @(posedge clk) if (!hold) n <= up ? n + 1 : n - 1; assign full = n == 3; endmodule\n"
)


def counter(text: str = COUNTER) -> Device:
    return device_of(text, {"up": 1, "hold": 1}, {"n": 2, "full": 1})


@lru_cache
def first_network() -> Network:
    return quick_network(counter())


def mend(device: Device, before: Before) -> Network | None:
    netlist = synthesise(device)
    subject, nets = _make_subject(netlist)
    return mended(netlist, library(), subject, nets, before)


def edited(program: Program, seed: int) -> Program:
    """The program with one operator another."""
    text = program.verilog
    places = [i for i, sign in enumerate(text) if sign in "&|^" and text[i - 1] == " "]
    at = Random(seed).choice(places)
    return replace(program, verilog=text[:at] + ("&" if text[at] != "&" else "|") + text[at + 1 :])


def test_a_program_that_does_the_same_has_the_same_network() -> None:
    first = first_network()
    other = COUNTER.replace("up ? n + 1 : n - 1", "n + {!up, 1'b1}").replace("n == 3", "&n")
    assert other != COUNTER and synthesise(counter(other)) != synthesise(counter())
    assert map_netlist(synthesise(counter(other)), library(), QUICK, Before(first)) == first


def test_another_start_changes_displacements_alone() -> None:
    first = first_network()
    device = counter(COUNTER.replace("n = 0", "n = 2"))
    after = mend(device, Before(first))
    assert after is not None and after != first
    assert mismatches(after, build_reference(device), 60) == 0
    assert replace(after, masses=(), registers=()) == replace(first, masses=(), registers=())
    assert [replace(mass, initial=0.0) for mass in after.masses] == [
        replace(mass, initial=0.0) for mass in first.masses
    ]


@pytest.mark.parametrize(("old", "new"), [("up ?", "up | n[1] ?"), ("n == 3", "n == 2")])
def test_a_changed_condition_changes_few_masses(old: str, new: str) -> None:
    first = first_network()
    device = counter(COUNTER.replace(old, new))
    assert mismatches(first, build_reference(device), 60) > 0
    after = mend(device, Before(first))
    assert after is not None
    assert mismatches(after, build_reference(device), 200) == 0
    assert prove(after, build_reference(device), seed=1).holds
    names = {mass.name for mass in first.masses}
    new_ones = [mass for mass in after.masses if mass.name not in names]
    assert len(new_ones) <= 4 and len(changed_masses(first, after)) <= 4
    assert all(mass.port is None for mass in new_ones)


def test_no_mass_gets_more_posts_than_it_has_room_for() -> None:
    """As a gate of its own, ``full`` would have two rockers and a bias leaf, and an actuator is not turned over."""
    after = mend(counter(COUNTER.replace("n == 3", "n != 3")), Before(first_network()))
    for mass in after.masses if after is not None else ():
        posts = sum(item.target == mass.name and item.strength < 0 for item in after.couplings) + (mass.bias != 0)
        assert posts <= 2, mass.name


@pytest.mark.parametrize("seed", (1, 2, 9, *(pytest.param(seed, marks=pytest.mark.long) for seed in (4, 10))))
def test_mended_random_programs_do_what_they_say(seed: int) -> None:
    """(About half of all such edits can be mended; the rest are mapped anew.)"""
    program = random_program(seed)
    change = edited(program, seed).device()
    after = mend(change, Before(quick_network(program.device())))
    assert after is not None
    assert mismatches(after, build_reference(change), 60) == 0, program.verilog


def test_other_sensors_are_not_mended() -> None:
    first = first_network()
    text = COUNTER.replace("input hold", "input stop").replace("!hold", "!stop")
    assert mend(device_of(text, {"up": 1, "stop": 1}, {"n": 2, "full": 1}), Before(first)) is None


def test_gates_are_found_for_what_is_needed_and_no_others() -> None:
    tables = {"a": 0b11110000, "b": 0b11001100, "c": 0b10101010}
    finder = GateFinder(tables, 0xFF, 5)
    finder.effort = 10_000
    majority = Need(0b11101000, 0b00010111)
    found = list(finder.gates(majority, ("a", "b", "c")))
    assert [gate.sources for gate in found] == [("a", "b", "c")]
    finder.effort = 0
    assert not list(finder.gates(majority, ("a", "b", "c")))
    finder.effort = 10_000
    odd = Need(0b10010110, 0b01101001)
    assert not list(finder.gates(odd, ("a", "b", "c")))
    for need in (majority, odd):
        for gate, rest in finder.halves(need, ("a", "b", "c")):
            # whatever meets the rest makes the gate right: the least and the greatest such table do
            for last in (rest.on, 0xFF & ~rest.off):
                made = value(0xFF, gate.function, [*(tables[source] for source in gate.sources), last])
                assert made & need.on == need.on and not made & need.off
