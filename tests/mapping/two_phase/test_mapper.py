"""The mapper: numbers of masses, fan-out, options, names, and what it refuses."""

from __future__ import annotations

import os
import subprocess
import sys
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest

from mdlcad.artefact import checksum, to_json
from mdlcad.errors import UsageError
from mdlcad.language import Device
from mdlcad.mapping.two_phase import load_two_phase, map_two_phase
from mdlcad.mapping.two_phase.strain import Wiring, relieve
from mdlcad.network.model import CouplingKind, MassKind, Network
from mdlcad.synthesis import synthesise
from tests.mapping.two_phase.programs import RACE, ROOT, example, library, listing, small

# name -> the prototype's count, the paper's count
BARS = {"mazerobot": (130, 187), "lock": (216, 311)}


def fan_outs(network: Network) -> Counter[str]:
    """Inputs on each output: couplings away from every mass of phase 0."""
    outputs = {mass.name for mass in network.masses if mass.phase == 0}
    return Counter(coupling.source for coupling in network.couplings if coupling.source in outputs)


def burdened_pairs(network: Network) -> list[str]:
    """Biased inner masses all of whose several inputs drive another biased mass too."""
    biased = {mass.name for mass in network.masses if mass.phase == 1 and mass.bias}
    loads = Counter(coupling.source for coupling in network.couplings if coupling.target in biased)
    inputs: dict[str, list[str]] = {}
    for coupling in network.couplings:
        if coupling.target in biased:
            inputs.setdefault(coupling.target, []).append(coupling.source)
    return [mass for mass, nets in inputs.items() if len(nets) > 1 and all(loads[net] > 1 for net in nets)]


def check_counts(device: Device, bar: int) -> Network:
    network = map_two_phase(synthesise(device), library())
    assert len(network.masses) <= bar
    assert network.cycles_per_tick == 60
    assert max(fan_outs(network).values()) <= 2
    assert not burdened_pairs(network)
    return network


@pytest.mark.parametrize("name", sorted(BARS))
def test_the_examples_take_no_more_masses_than_the_prototype(name: str) -> None:
    check_counts(example(name), BARS[name][0])


@pytest.mark.parametrize("name", sorted(BARS))
def test_the_papers_own_listings_do_too(name: str) -> None:
    check_counts(listing(name), BARS[name][0])


def test_every_sensor_and_actuator_has_a_gate_of_its_own() -> None:
    network = map_two_phase(synthesise(example("mazerobot")), library())
    kinds = {mass.name: mass.kind for mass in network.masses}
    for port in network.sensors:
        assert kinds[port.mass] is MassKind.SENSOR
        targets = [coupling.target for coupling in network.couplings if coupling.source == port.mass]
        assert targets == [f"{port.bit}.in.m"]
    for port in network.actuators:
        assert port.mass == f"{port.bit}.out"
        assert kinds[port.mass] is MassKind.BUFFER
        assert not [coupling for coupling in network.couplings if coupling.source == port.mass]
    assert [register.mass for register in network.registers] == ["drive[0]", "drive[1]"]


def test_a_nor_is_the_papers_three_couplings_and_two_masses() -> None:
    network = map_two_phase(synthesise(example("mazerobot")), library("literal"))
    masses = {mass.name: mass for mass in network.masses}
    nors = [mass for mass in network.masses if mass.bias and mass.kind is MassKind.GATE]
    assert nors
    for inner in nors:
        inputs = [coupling for coupling in network.couplings if coupling.target == inner.name]
        outputs = [coupling for coupling in network.couplings if coupling.source == inner.name]
        assert [coupling.strength for coupling in inputs] == [-0.5, -0.5]
        assert [coupling.strength for coupling in outputs] == [0.5]
        assert inner.phase == 1
        assert {masses[c.source].phase for c in inputs} | {masses[c.target].phase for c in outputs} == {0}
    assert all((c.d0, c.d1, c.self_stiffness) == (0.0, 1.0, 0.0) for c in network.couplings)
    latches = [coupling for coupling in network.couplings if coupling.kind is CouplingKind.LATCH]
    assert [coupling.strength for coupling in latches] == [-0.5, -0.5]


def test_no_separate_gates_saves_them() -> None:
    with_gates = map_two_phase(synthesise(example("mazerobot")), library())
    without = map_two_phase(synthesise(example("mazerobot")), library(io_gates=False))
    assert len(without.masses) < len(with_gates.masses)
    assert [port.mass for port in without.actuators] == ["drive[0]", "drive[1]"]
    assert {mass.name: mass.port for mass in without.masses}["drive[1]"] == "drive[1]"
    assert not [mass for mass in without.masses if mass.name.endswith((".in", ".out"))]


def test_no_branching_leaves_one_output_to_drive_all() -> None:
    network = map_two_phase(synthesise(example("lock")), library(branching=False))
    assert max(fan_outs(network).values()) > 2
    assert not [mass for mass in network.masses if ".buf_" in mass.name]


def test_no_clock_leaves_the_tick_open() -> None:
    network = map_two_phase(synthesise(example("mazerobot")), library(clock=False))
    assert network.tick == "tick"
    ticks = [mass for mass in network.masses if mass.kind is MassKind.TICK]
    assert [mass.name for mass in ticks] == ["tick"]
    assert not [coupling for coupling in network.couplings if coupling.target == "tick"]
    latches = [coupling for coupling in network.couplings if coupling.kind is CouplingKind.LATCH]
    assert {coupling.source for coupling in latches} == {"tick"}


def test_another_library_brings_its_own_buffer(tmp_path: Path) -> None:
    text = (ROOT / "cells" / "two_phase" / "library.toml").read_text(encoding="utf-8")
    text = text.replace('name = "two_phase"', 'name = "mine"').replace('name = "BUF"', 'name = "COPY"')
    path = tmp_path / "library.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(UsageError, match=r"options\.buffer is 'BUF', but the cells are .*COPY"):
        load_two_phase(str(path))
    path.write_text(text.replace('buffer = "BUF"', 'buffer = "COPY"'), encoding="utf-8")
    cells = load_two_phase(str(path))
    network = map_two_phase(synthesise(example("lock")), cells)
    assert network.cells == "mine"
    assert len(network.masses) == len(map_two_phase(synthesise(example("lock")), library()).masses)
    assert any(".copy_" in mass.name for mass in network.masses)


def test_a_clock_that_is_too_short_is_refused_with_the_length_that_does() -> None:
    netlist = synthesise(example("mazerobot"))
    with pytest.raises(UsageError, match=r"5 cycles is too short .* at least (\d+)") as caught:
        map_two_phase(netlist, library(clock_length=5))
    least = int(str(caught.value).split()[-1])
    assert 10 <= least <= 25
    assert map_two_phase(netlist, library(clock_length=least)).cycles_per_tick == least
    with pytest.raises(UsageError):
        map_two_phase(netlist, library(clock_length=least - 1))


def test_constants_and_plain_wires() -> None:
    device = small("module v(input [1:0] s, output [1:0] t); assign t = {s[0], 1'b1}; endmodule")
    network = map_two_phase(synthesise(device), library())
    assert network.tick is None
    assert {mass.name for mass in network.masses} == {
        *("s[0]", "s[1]", "s[0].in", "s[0].in.m", "one", "t[0].out", "t[0].out.m", "t[1].out", "t[1].out.m")
    }


def test_latches_that_feed_each_other_directly_see_the_tick_in_one_cycle() -> None:
    # the tree of the tick must be level here: the latch that it would serve first is read by one that it serves last
    device = small(RACE.format(last=5))
    network = map_two_phase(synthesise(device), library())
    driver = {coupling.target: coupling.source for coupling in network.couplings}
    depths = set()
    for coupling in network.couplings:
        if coupling.kind is CouplingKind.LATCH:
            mass, depth = coupling.source, 0
            while mass != "tick":
                mass, depth = driver[driver[mass]], depth + 1
            depths.add(depth)
    assert depths == {2}


def test_strain_is_found_and_relieved() -> None:
    # x and y both drive two NORs; n1 has both as its inputs
    driver = {("n1", 0): "x", ("n1", 1): "y", ("n2", 0): "x", ("n2", 1): "p", ("n3", 0): "y", ("n3", 1): "p"}
    wiring = Wiring(dict(driver), {pin: (net, False) for pin, net in driver.items()}, {"n1": 2, "n2": 2, "n3": 2})
    assert [net for net in ("n1", "n2", "n3") if wiring.strained(net)] == ["n1", "n2", "n3"]
    made: list[str] = []

    def add_buffer(net: str, pin: tuple[str, int]) -> str:
        made.append(f"{net}.{len(made)}")
        return made[-1]

    relieve(wiring, add_buffer)
    assert not [net for net in ("n1", "n2", "n3") if wiring.strained(net)]
    assert made


def test_names_outlive_an_edit_elsewhere() -> None:
    program = (
        "module v(input clk, input [1:0] s, output reg [1:0] t);"
        "always @(posedge clk) begin t[0] <= t[0] ^ s[0]; {edit} end endmodule"
    )
    names = [
        {
            mass.name
            for mass in map_two_phase(synthesise(small(program.format(edit=edit))), library()).masses
            if mass.name.startswith(("t[0]", "s[0]", "tick"))
        }
        for edit in ("t[1] <= s[1] & ~t[1];", "t[1] <= s[1] | ~t[1];")
    ]
    assert names[0] == names[1]


def test_the_same_bytes_with_any_hash_seed() -> None:
    script = (
        "from tests.mapping.two_phase.programs import *; from mdlcad.mapping.two_phase import *;"
        "from mdlcad.artefact import *; from mdlcad.synthesis import synthesise;"
        "print(checksum(to_json(map_two_phase(synthesise(example('lock')), library()))))"
    )
    sums = {checksum(to_json(map_two_phase(synthesise(example("lock")), library())))}
    for seed in ("1", "2"):
        done = subprocess.run(
            [sys.executable, "-c", script],
            cwd=ROOT,
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
            timeout=120,
        )
        sums.add(done.stdout.strip())
    assert len(sums) == 1


def test_options_are_fields_of_the_library() -> None:
    cells = load_two_phase("two_phase")
    shorter = replace(cells, options=replace(cells.options, clock_length=20))
    assert map_two_phase(synthesise(example("mazerobot")), shorter).cycles_per_tick == 20
