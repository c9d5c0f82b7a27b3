"""A mapped network does what its program says: as ideal logic for random programs, and as masses and springs."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mdlcad.language import read_device
from mdlcad.mapping import Effort, map_netlist
from mdlcad.mapping.build import discrete
from mdlcad.network.model import MassKind, Network
from mdlcad.proof.prove import prove
from mdlcad.proof.reference import build_reference
from mdlcad.synthesis import synthesise
from tests.mapping.programs import library, mismatches, quick_network, random_program
from tests.synthesis.verilog_device import device_of

EXAMPLES = Path(__file__).parents[2] / "examples"

TOGGLE = (
    "module m(input clk, input a, input b, output reg x = 1, output y);\n"
    "always @(posedge clk) if (a) x <= x ^ b; assign y = x & b; endmodule\n"
)


def toggle(text: str = TOGGLE) -> Network:
    return quick_network(device_of(text, {"a": 1, "b": 1}, {"x": 1, "y": 1}))


@pytest.mark.parametrize("seed", range(20))
def test_random_programs_keep_their_behaviour(seed: int) -> None:
    program = random_program(seed)
    device = program.device()
    assert mismatches(quick_network(device), build_reference(device), 40) == 0, program.verilog


@pytest.mark.long
@pytest.mark.parametrize("seed", range(100, 300))
def test_more_random_programs_keep_their_behaviour(seed: int) -> None:
    program = random_program(seed)
    device = program.device()
    network = quick_network(device)
    reference = build_reference(device)
    assert mismatches(network, reference, 40) == 0, program.verilog
    assert prove(network, reference, seed=1).holds, program.verilog


@pytest.mark.parametrize("seed", (3, 5, 8, 13))
def test_random_programs_keep_their_behaviour_in_the_dynamics(seed: int) -> None:
    program = random_program(seed)
    device = program.device()
    proof = prove(quick_network(device), build_reference(device), seed=1)
    assert proof.holds, (program.verilog, proof.first_mismatches)


def test_the_comparison_notices_a_broken_network() -> None:
    """A network with one coupling turned round, or one initial value wrong, is not right."""
    device = device_of(TOGGLE, {"a": 1, "b": 1}, {"x": 1, "y": 1})
    network, reference = quick_network(device), build_reference(device)
    assert mismatches(network, reference, 60) == 0
    for index, coupling in enumerate(network.couplings):
        couplings = list(network.couplings)
        couplings[index] = replace(coupling, strength=-coupling.strength)
        broken = replace(network, couplings=tuple(couplings))
        assert mismatches(broken, reference, 60) > 0, coupling.name
    register = network.registers[0].mass
    flipped = tuple(replace(m, initial=-m.initial) if m.name == register else m for m in network.masses)
    assert mismatches(replace(network, masses=flipped), reference, 5) > 0


def test_the_networks_structure() -> None:
    network = toggle()
    masses = {mass.name: mass for mass in network.masses}
    for coupling in network.couplings:
        assert masses[coupling.target].phase == (masses[coupling.source].phase + 1) % 3, coupling.name
        assert abs(coupling.strength) in (0.2, 0.4)
    for mass in network.masses:
        springs = [c.self_stiffness for c in network.couplings if mass.name in (c.source, c.target)]
        assert mass.compensation == pytest.approx(-sum(springs))
        assert (mass.initial != 0.0) == (mass.phase == 2)
        assert "$" not in mass.name
    for port in (*network.sensors, *network.actuators):
        assert masses[port.mass].polarity == 1 and masses[port.mass].port == port.bit
    assert [port.bit for port in network.sensors] == ["a[0]", "b[0]"]
    assert all(masses[port.mass].kind is MassKind.SENSOR for port in network.sensors)
    assert not [c for c in network.couplings if masses[c.target].kind is MassKind.SENSOR]
    assert network.tick in masses and network.registers[0].initial


def test_a_device_without_state_has_no_tick() -> None:
    device = device_of(
        "module m(input [2:0] a, output y, output z, output k);\n"
        "assign y = ^a; assign z = a[1]; assign k = 1; endmodule",
        {"a": 3},
        {"y": 1, "z": 1, "k": 1},
    )
    network = quick_network(device)
    assert network.tick is None and not network.registers
    assert not [mass for mass in network.masses if mass.kind is MassKind.TICK]
    assert prove(network, build_reference(device), seed=1).holds


def test_a_majority_is_one_mass() -> None:
    device = device_of(
        "module m(input a, input b, input c, output y); assign y = (a & b) | (c & (a | b)); endmodule",
        {"a": 1, "b": 1, "c": 1},
        {"y": 1},
    )
    network = quick_network(device)
    assert len(network.masses) == 4 and len(network.couplings) == 3


def test_more_state_than_truth_tables_can_hold() -> None:
    """Sixteen registers and a sensor: the structural way, and a tick with many targets."""
    device = device_of(
        "module m(input clk, input a, output [15:0] q); reg [15:0] s = 16'h8001;\n"
        "always @(posedge clk) if (a) s <= {s[14:0], s[15] ^ s[3]}; assign q = s; endmodule",
        {"a": 1},
        {"q": 16},
    )
    network = quick_network(device)
    reference = build_reference(device)
    assert mismatches(network, reference, 60) == 0
    assert prove(network, reference, seed=1).holds


def test_no_mass_has_more_load_or_echo_than_the_library_allows() -> None:
    device = device_of(
        "module m(input clk, input a, output [11:0] q); reg [11:0] s;\n"
        "always @(posedge clk) s <= {s[10:0], a}; assign q = s; endmodule",
        {"a": 1},
        {"q": 12},
    )
    network = quick_network(device)
    unit = library().coupling.strength
    sensors = {port.mass for port in network.sensors}
    out: dict[str, list[tuple[str, int]]] = {mass.name: [] for mass in network.masses}
    for coupling in network.couplings:
        out[coupling.source].append((coupling.target, round(abs(coupling.strength) / unit)))
    load = {name: sum(weight for _, weight in targets) for name, targets in out.items()}
    for name, targets in out.items():
        if name not in sensors:
            assert load[name] <= library().gates.load_limit
            assert sum(weight * load[target] for target, weight in targets) <= library().gates.echo_limit


TWO_CONES = """module m(input clk, input a, input b, input c, output reg x, output reg y);
  wire w = a & b;
  always @(posedge clk) begin x <= w ^ x; y <= {Y}; end
endmodule
"""


def test_names_outlive_comments_renamed_wires_and_edits_of_another_cone() -> None:
    def names(text: str) -> set[str]:
        network = quick_network(device_of(text, {"a": 1, "b": 1, "c": 1}, {"x": 1, "y": 1}))
        return {mass.name for mass in network.masses}

    first = TWO_CONES.replace("{Y}", "c")
    before = names(first)
    assert {"x[0]", "x[0].q", "x[0].hold", "y[0]", "y[0].set"} <= before
    assert names("// a remark\n" + first) == before
    assert names(first.replace("module m(", "module renamed(")) == before
    edited = names(TWO_CONES.replace("{Y}", "c & ~y"))
    assert {name for name in before if name.startswith("x[0]")} <= edited


def test_the_same_bytes_under_any_hash_seed() -> None:
    program = (
        "import sys\n"
        "from mdlcad.artefact import to_json\n"
        "from tests.mapping.test_mapper import toggle\n"
        "sys.stdout.buffer.write(to_json(toggle()))"
    )
    outputs = {
        subprocess.run(
            [sys.executable, "-c", program],
            cwd=EXAMPLES.parent,
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            check=True,
        ).stdout
        for seed in ("0", "11")
    }
    assert len(outputs) == 1


@pytest.mark.parametrize(("name", "masses", "couplings"), [("mazerobot", 35, 62), ("lock", 60, 105)])
def test_the_examples_stay_small(name: str, masses: int, couplings: int) -> None:
    """The paper needs 187 and 311 masses, the first three-phase prototype 53 and 82."""
    device = read_device(EXAMPLES / f"{name}.mdl")
    network = map_netlist(synthesise(device), library(), Effort(masses_made=30_000, deterministic_time=0.0))
    assert len(network.masses) <= masses and len(network.couplings) <= couplings
    assert mismatches(network, build_reference(device), 100) == 0


def test_cancelling_inputs_are_an_error_of_the_ideal_logic() -> None:
    network = toggle()
    inputs = [c.target for c in network.couplings if abs(c.strength) < 0.3]
    biased = next(mass for mass in network.masses if mass.bias and inputs.count(mass.name) == 2)
    broken = tuple(replace(m, bias=0.0) if m is biased else m for m in network.masses)
    logic = discrete(replace(network, masses=broken), library())
    states = np.random.default_rng(0).choice([-1, 1], (len(network.masses), 64)).astype(np.int8)
    with pytest.raises(ValueError, match="cancel"):
        logic.cycle(states)
