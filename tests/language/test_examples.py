"""The examples do what their headers say: every state, every input, against a few lines of Python.

Yosys turns each program's Verilog into AND, NOT and flip-flop cells, which are evaluated here one by one.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from itertools import product
from pathlib import Path

import pytest

from mdlcad.language import Device, read_device

EXAMPLES = Path(__file__).parents[2] / "examples"
YOSYS = """
import sys
from pyosys import libyosys
design = libyosys.Design()
for command in sys.argv[1:]:
    libyosys.run_pass(command, design)
"""

Bits = dict[str, int]
Ports = dict[str, int]


class Machine:
    """The gates of a device: from its sensors and its state to its actuators and its next state."""

    def __init__(self, device: Device, folder: Path) -> None:
        (folder / "behaviour.v").write_text(device.verilog)
        commands = [
            "read_verilog -nodpi behaviour.v",
            "synth -flatten -auto-top",
            "dffunmap",
            "abc -g AND",
            "opt_clean",
            "write_json gates.json",
        ]
        subprocess.run(
            [sys.executable, "-c", YOSYS, *commands], cwd=folder, check=True, capture_output=True, timeout=120
        )
        modules = json.loads((folder / "gates.json").read_text())["modules"]
        (self.module,) = [module for module in modules.values() if module["attributes"].get("top")]
        cells = self.module["cells"].values()
        self.flops = {
            str(cell["connections"]["Q"][0]): str(cell["connections"]["D"][0])
            for cell in cells
            if "DFF" in cell["type"]
        }
        self.gates = {
            str(cell["connections"]["Y"][0]): [
                str(cell["connections"][pin][0]) for pin in "AB" if pin in cell["connections"]
            ]
            for cell in cells
            if cell["type"] in ("$_AND_", "$_NOT_")
        }
        assert len(self.flops) + len(self.gates) == len([cell for cell in cells if cell["type"] != "$scopeinfo"])
        self.start = {
            str(bit): int(value)
            for net in self.module["netnames"].values()
            for bit, value in zip(net["bits"], reversed(net["attributes"].get("init", "")), strict=False)
            if value in "01"
        }

    def port(self, name: str) -> list[str]:
        return [str(bit) for bit in self.module["ports"][name]["bits"]]

    def evaluate(self, known: Bits, bit: str) -> int:
        if bit not in known:
            values = [self.evaluate(known, source) for source in self.gates[bit]]
            known[bit] = min(values) if len(values) == 2 else 1 - values[0]
        return known[bit]

    def step(self, state: Bits, inputs: Ports) -> tuple[Ports, Bits]:
        known = {"0": 0, "1": 1} | state
        for name, value in inputs.items():
            known |= {bit: value >> index & 1 for index, bit in enumerate(self.port(name))}
        outputs = {
            name: sum(self.evaluate(known, bit) << index for index, bit in enumerate(self.port(name)))
            for name, port in self.module["ports"].items()
            if port["direction"] == "output"
        }
        return outputs, {q: self.evaluate(known, d) for q, d in self.flops.items()}


def all_inputs(device: Device) -> Iterator[Ports]:
    names = [sensor.name for sensor in device.sensors]
    for values in product(*(range(1 << len(sensor.places)) for sensor in device.sensors)):
        yield dict(zip(names, values, strict=True))


def maze(state: tuple[int, ...], read: Ports) -> tuple[int, ...]:
    walls = [read["wall_left"], read["wall_front"], read["wall_right"], read["wall_back"]]
    (heading,) = state
    ways = [(heading + turn) % 4 for turn in (3, 0, 1, 2)]
    return (next((way for way in ways if not walls[way]), ways[3]),)


def lock(state: tuple[int, ...], read: Ports) -> tuple[int, ...]:
    closed, kept = state
    if read["action"] and read["key"] and not closed:
        return 1, read["code"]
    if read["action"] and not read["key"] and closed and read["code"] == kept:
        return 0, kept
    return closed, kept


def turnstile(state: tuple[int, ...], read: Ports) -> tuple[int, ...]:
    return (0 if read["clear"] else (state[0] + read["arm"]) % 6,)


def traffic_light(state: tuple[int, ...], read: Ports) -> tuple[int, ...]:
    round_trip = [0b001, 0b010, 0b100, 0b110]
    now = round_trip.index(state[0])
    return (round_trip[0 if now == 0 and not read["walker"] else (now + 1) % 4],)


def voter(state: tuple[int, ...], read: Ports) -> tuple[int, ...]:
    return ()


CASES: dict[str, tuple[Callable[[tuple[int, ...], Ports], tuple[int, ...]], tuple[int, ...], int, int]] = {
    # the rule, its first state, how many states can be reached, and state bits
    "mazerobot": (maze, (0,), 4, 2),
    "lock": (lock, (0, 0), 32, 5),
    "turnstile": (turnstile, (0,), 6, 3),
    "traffic_light": (traffic_light, (0b001,), 4, 2),
    "voter": (voter, (), 1, 0),
}


def test_every_example_has_a_case() -> None:
    assert sorted(CASES) == sorted(path.stem for path in EXAMPLES.glob("*.mdl"))


@pytest.mark.parametrize("name", CASES)
def test_every_transition(name: str, tmp_path: Path) -> None:
    rule, first, states, state_bits = CASES[name]
    device = read_device(EXAMPLES / f"{name}.mdl")
    machine = Machine(device, tmp_path)
    (actuator,) = device.actuators
    assert len(machine.flops) == state_bits
    assert machine.start.keys() >= machine.flops.keys(), "every state bit has a first value"
    # walk both side by side; the rule's first number is what the actuator must show
    bits_of = {first: {bit: machine.start[bit] for bit in machine.flops}}
    waiting = [first]
    while waiting:
        state = waiting.pop()
        for read in all_inputs(device):
            shown, next_bits = machine.step(bits_of[state], read)
            assert shown[actuator.name] == (state[0] if state else int(sum(read.values()) >= 2))
            following = rule(state, read)
            if following not in bits_of:
                bits_of[following] = next_bits
                waiting.append(following)
            assert bits_of[following] == next_bits, "a state is held in the same bits however it was reached"
    assert len(bits_of) == states
