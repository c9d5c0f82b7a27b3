"""Every program of programs.toml does what Icarus Verilog makes of it: as netlist, as reference, as network of masses.

Icarus shares nothing with the compiler: it reads the text with a parser of its own and interprets it event by event.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import tomllib
from dataclasses import dataclass
from functools import lru_cache
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from mdlcad.language.device import Device
from mdlcad.mapping import Effort, load_library, map_netlist
from mdlcad.proof.prove import prove
from mdlcad.proof.reference import Bits, Reference, build_reference
from mdlcad.synthesis import Netlist, synthesise
from mdlcad.synthesis.netlist import GateKind
from mdlcad.synthesis.yosys import YosysRun, run_yosys
from tests.synthesis.verilog_device import device_of

PROGRAMS = tomllib.loads((Path(__file__).parent / "programs.toml").read_text(encoding="utf-8"))
QUICK = Effort(masses_made=4000, deterministic_time=0.0)
# mapping and simulating every program takes minutes: the default run proves a few of different kinds
PROVED_BY_DEFAULT = ("case", "declaration_values", "enumeration", "hierarchy", "reset_and_enable", "wired_or")
IN_TWO_PHASE = ("declaration_values", "enable", "mealy_and_moore", "reduction")

needs_icarus = pytest.mark.skipif(
    shutil.which("iverilog") is None, reason="Icarus Verilog is not installed: apt-get install iverilog"
)


@dataclass(frozen=True)
class Program:
    """A module ``m`` with the widths of its ports; ``icarus`` is the same in words that Icarus knows."""

    verilog: str
    icarus: str
    inputs: dict[str, int]
    outputs: dict[str, int]
    clocked: bool

    def device(self) -> Device:
        return device_of(self.verilog, self.inputs, self.outputs)


def program(name: str) -> Program:
    entry = PROGRAMS[name]
    text = entry["verilog"]
    inputs, outputs = ports(text)
    clocked = inputs.pop("clk", 0) == 1
    return Program(
        text, entry.get("icarus", text), inputs | entry.get("inputs", {}), outputs | entry.get("outputs", {}), clocked
    )


def ports(text: str) -> tuple[dict[str, int], dict[str, int]]:
    """Widths of the inputs and outputs in the header of module ``m``, or behind it if that holds only names."""
    header = text[re.search(r"\bmodule m\s*\(", text).end() :]
    declared = header[: header.index(");")] if re.match(r"\s*(input|output)", header) else header
    found: dict[str, dict[str, int]] = {"input": {}, "output": {}}
    for item in re.finditer(
        r"\b(input|output)\b(?:\s+(?:reg|logic|wire|signed))*\s*(?:\[([^\]]*)\])?\s*"
        r"((?:[a-z]\w*(?:\s*=\s*[\w']+)?\s*,?\s*(?!\binput\b|\boutput\b))+)",
        declared,
    ):
        direction, span, names = item.groups()
        width = 1 if span is None else int(span.split(":")[0]) + 1 if span.split(":")[0].isdigit() else 0
        for name in names.split(","):
            if name.strip():
                found[direction][re.split(r"[\s=;]", name.strip())[0]] = width
    return found["input"], found["output"]


@lru_cache
def run_once(device: Device) -> YosysRun:
    return run_yosys(device)


@pytest.fixture(autouse=True)
def one_run_a_program(monkeypatch: pytest.MonkeyPatch) -> None:
    # by import_module, for the package gives the name of the first to its function
    for module in ("mdlcad.synthesis.synthesise", "mdlcad.proof.reference"):
        monkeypatch.setattr(import_module(module), "run_yosys", run_once)


def stimuli(program: Program) -> Bits:
    """Every input if there is no state and few bits, else a walk of 250 ticks."""
    width = sum(program.inputs.values())
    if not program.clocked and width <= 8:
        return ((np.arange(2**width)[:, None] >> np.arange(width)) & 1).astype(np.uint8)
    return np.random.default_rng(5).integers(0, 2, (250, width)).astype(np.uint8)


def by_icarus(program: Program, inputs: Bits, folder: Path) -> Bits:
    """Outputs before and after every tick, one row each, bit 0 of the first output first."""
    declared = "".join(f"reg [{w - 1}:0] {n}; " for n, w in program.inputs.items())
    declared += "".join(f"wire [{w - 1}:0] {n}; " for n, w in program.outputs.items())
    connected = ", ".join(
        f".{n}({n})" for n in [*program.inputs, *program.outputs, *(["clk"] if program.clocked else [])]
    )
    shown = f'$display("%b", {{{", ".join(reversed(program.outputs))}}});'
    lines = [f"module bench; reg clk = 0; {declared} m dut({connected}); initial begin #1;"]
    for row in inputs:
        at = 0
        for name, width in program.inputs.items():
            lines.append(f"{name} = {width}'b{''.join(str(bit) for bit in row[at : at + width][::-1])};")
            at += width
        lines.append(f"#1 {shown} clk = 1; #1 {shown} clk = 0; #1;")
    lines.append("$finish; end endmodule")
    (folder / "bench.v").write_text(program.icarus + "\n" + "\n".join(lines) + "\n")
    subprocess.run(["iverilog", "-g2012", "-s", "bench", "-o", "bench", "bench.v"], cwd=folder, check=True, timeout=60)
    out = subprocess.run(["vvp", "bench"], cwd=folder, check=True, timeout=60, capture_output=True, text=True).stdout
    words = [line for line in out.splitlines() if re.fullmatch("[01xz]+", line)]
    assert not any(set(word) & set("xz") for word in words), "the program leaves something unknown"
    return np.array([[int(bit) for bit in word[::-1]] for word in words], dtype=np.uint8)


def by_reference(reference: Reference, inputs: Bits) -> Bits:
    state, rows = reference.initial[None], []
    for row in inputs:
        rows.append(reference.settle(state, row[None])[0])
        state, out = reference.step(state, row[None])
        rows.append(out[0])
    return np.array(rows)


def by_netlist(netlist: Netlist, inputs: Bits) -> Bits:
    state = {register.bit: int(register.initial) for register in netlist.registers}
    rows = []

    def settle(row: Bits) -> dict[str, int]:
        nets = {"0": 0, "1": 1} | state | dict(zip(netlist.inputs, map(int, row), strict=True))
        for gate in netlist.gates:
            values = [nets[net] for net in gate.inputs]
            match gate.kind:
                case GateKind.NOT:
                    nets[gate.net] = 1 - values[0]
                case GateKind.AND:
                    nets[gate.net] = values[0] & values[1]
                case GateKind.OR:
                    nets[gate.net] = values[0] | values[1]
                case GateKind.XOR:
                    nets[gate.net] = values[0] ^ values[1]
                case GateKind.MUX:
                    nets[gate.net] = values[1] if values[2] else values[0]
        return nets

    for row in inputs:
        nets = settle(row)
        rows.append([nets[output.net] for output in netlist.outputs])
        for register in netlist.registers:
            if register.enable is None or nets[register.enable]:
                state[register.bit] = nets[register.data]
        nets = settle(row)
        rows.append([nets[output.net] for output in netlist.outputs])
    return np.array(rows, dtype=np.uint8)


@needs_icarus
@pytest.mark.parametrize("name", PROGRAMS)
def test_netlist_and_reference_agree_with_icarus(name: str, tmp_path: Path) -> None:
    one = program(name)
    inputs = stimuli(one)
    theirs = by_icarus(one, inputs, tmp_path)
    assert len({tuple(row) for row in theirs}) > 1, "a program whose outputs never change tests nothing"
    np.testing.assert_array_equal(by_netlist(synthesise(one.device()), inputs), theirs)
    np.testing.assert_array_equal(by_reference(build_reference(one.device()), inputs), theirs)


def test_the_comparison_would_notice_a_difference(tmp_path: Path) -> None:
    one = program("add_and_subtract")
    other = Program(one.verilog.replace("a - b - 1", "a - b + 1"), "", one.inputs, one.outputs, one.clocked)
    inputs = stimuli(one)
    ours = by_reference(build_reference(one.device()), inputs)
    assert not np.array_equal(by_netlist(synthesise(other.device()), inputs), ours)


def prove_network(name: str, cells: str) -> None:
    device = program(name).device()
    netlist = synthesise(device)
    library = load_library(cells)
    network = map_netlist(netlist, library, QUICK) if cells == "parametron" else map_netlist(netlist, library)
    proof = prove(network, build_reference(device))
    assert proof.holds, proof.first_mismatches
    assert proof.exhaustive
    assert proof.transitions_checked == proof.transitions_total


def small(name: str) -> bool:
    """Whether state and input bits are at most 8."""
    one = program(name)
    return sum(one.inputs.values()) + len(synthesise(one.device()).registers) <= 8


@pytest.mark.parametrize("name", PROVED_BY_DEFAULT)
def test_the_network_is_proved(name: str) -> None:
    prove_network(name, "parametron")


@pytest.mark.long
@pytest.mark.parametrize("name", [name for name in PROGRAMS if name not in PROVED_BY_DEFAULT])
def test_every_small_network_is_proved(name: str) -> None:
    if not small(name):
        pytest.skip("more than 8 bits of state and input")
    prove_network(name, "parametron")


@pytest.mark.long
@pytest.mark.parametrize("name", IN_TWO_PHASE)
def test_the_two_phase_network_is_proved(name: str) -> None:
    prove_network(name, "two_phase")


def test_there_are_at_least_forty_programs_of_our_own() -> None:
    assert len(PROGRAMS) >= 40
