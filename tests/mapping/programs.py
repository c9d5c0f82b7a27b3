"""Random small programs, and the ideal logic of a network run beside the program's reference."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from random import Random

import numpy as np
from numpy.typing import NDArray

from mdlcad.language.device import Device
from mdlcad.mapping import Effort, Library, load_library, map_netlist
from mdlcad.mapping.build import discrete
from mdlcad.network.model import Network
from mdlcad.proof.reference import Reference
from mdlcad.synthesis import synthesise
from tests.synthesis.verilog_device import device_of

QUICK = Effort(masses_made=4000, deterministic_time=0.0)


@lru_cache
def library() -> Library:
    return load_library("parametron")


def quick_network(device: Device) -> Network:
    return map_netlist(synthesise(device), library(), QUICK)


@dataclass(frozen=True)
class Program:
    verilog: str
    sensors: dict[str, int]
    actuators: dict[str, int]

    def device(self) -> Device:
        return device_of(self.verilog, self.sensors, self.actuators)


def random_program(seed: int) -> Program:
    """Registers with and without enables, resets and initial values, and outputs of every kind."""
    random = Random(seed)
    inputs = [f"a[{i}]" for i in range(random.randint(1, 4))]
    bits = random.randint(0, 4)
    registers = [f"r{i}" for i in range(bits)]

    def expression(depth: int) -> str:
        if depth == 0 or random.random() < 0.15:
            return random.choice([*inputs, *registers, *(f"~{n}" for n in inputs)])
        kind = random.choice(("&", "|", "^", "?", "maj", "&", "|"))
        a, b, c = (expression(depth - 1) for _ in range(3))
        if kind == "?":
            return f"({a} ? {b} : {c})"
        if kind == "maj":
            return f"(({a} & {b}) | ({c} & ({a} | {b})))"
        return f"({a} {kind} {b})"

    lines = [f"module m({'input clk, ' if bits else ''}input [{len(inputs) - 1}:0] a, output [3:0] y);"]
    for name in registers:
        initial = random.choice(("", " = 1'b0", " = 1'b1"))
        lines.append(f"reg {name}{initial};")
        style = random.randrange(3)
        if style == 0:
            lines.append(f"always @(posedge clk) {name} <= {expression(2)};")
        elif style == 1:
            lines.append(f"always @(posedge clk) if ({expression(1)}) {name} <= {expression(2)};")
        else:
            lines.append(
                f"always @(posedge clk) if ({expression(1)}) {name} <= {random.randrange(2)};"
                f" else if ({expression(1)}) {name} <= {expression(1)};"
            )
    for bit in range(4):
        outputs = [expression(2), random.choice(inputs), f"1'b{random.randrange(2)}"]
        outputs += registers * 2 + [f"~{name}" for name in registers]
        lines.append(f"assign y[{bit}] = {random.choice(outputs)};")
    return Program("\n".join([*lines, "endmodule", ""]), {"a": len(inputs)}, {"y": 4})


def mismatches(network: Network, reference: Reference, decisions: int, lanes: int = 16, seed: int = 0) -> int:
    """Decisions after which the network's ideal logic shows other outputs or states than the reference."""
    random = np.random.default_rng(seed)
    logic = discrete(network, library())
    upright = np.array([[mass.polarity] for mass in network.masses])
    initial = np.array([mass.initial for mass in network.masses])
    state: NDArray[np.int8] = np.repeat(np.where(initial > 0, 1, -1).astype(np.int8)[:, None], lanes, axis=1)
    sensors = [logic.index[port.mass] for port in network.sensors]
    watched = [logic.index[port.mass] for port in network.actuators]
    registers = {register.bit: logic.index[register.mass] for register in network.registers}
    watched += [registers[bit] for bit in reference.states]
    expected = np.repeat(reference.initial[None], lanes, axis=0)
    wrong = 0
    for _ in range(decisions):
        inputs = random.integers(0, 2, (lanes, len(sensors))).astype(np.uint8)
        state[sensors] = 2 * inputs.T.astype(np.int8) - 1
        for _ in range(network.cycles_per_tick):
            state = logic.cycle(state)
        expected, outputs = reference.step(expected, inputs)
        seen = (state * upright > 0)[watched].T
        wrong += int(np.any(seen != np.concatenate([outputs, expected], axis=1), axis=1).sum())
    return wrong
