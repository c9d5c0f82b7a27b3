"""The program's own RTL as a reference: what every later form of the device is held against.

It shares with the mapped network only Yosys' reading of the Verilog and the choice of registers; the logic is evaluated
from plain gates made directly from the RTL's operators, before any logic optimisation or mapping.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from graphlib import TopologicalSorter

import numpy as np
from numpy.typing import NDArray

from mdlcad.language.device import Device
from mdlcad.synthesis.cells import Bit, GateDesign, LogicCell, RegisterCell, parse_gates
from mdlcad.synthesis.check import check_design
from mdlcad.synthesis.netlist import GateKind
from mdlcad.synthesis.synthesise import build_netlist, port_bits
from mdlcad.synthesis.yosys import run_yosys

Bits = NDArray[np.uint8]


@dataclass(frozen=True, slots=True, eq=False)
class Reference:
    """The behaviour of the program, one tick at a time, for many states at once.

    Attributes:
        inputs: sensor bits "NAME[i]", in the order of the device.
        outputs: actuator bits "NAME[i]", in the order of the device.
        states: register bits, those of the netlist and in its order.
        initial: uint8[S], their values at power-up.
    """

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    states: tuple[str, ...]
    initial: Bits
    _input_bits: tuple[Bit, ...]
    _output_bits: tuple[Bit, ...]
    _registers: tuple[RegisterCell, ...]
    _unused: tuple[RegisterCell, ...]
    _logic: tuple[LogicCell, ...]

    def step(self, states: Bits, inputs: Bits) -> tuple[Bits, Bits]:
        """One tick with the inputs held.

        Args:
            states: uint8[n, S] of 0 and 1, before the tick.
            inputs: uint8[n, I] of 0 and 1, applied before the tick and held after it.

        Returns:
            uint8[n, S], the states after the tick, and uint8[n, O], the outputs then: a function of the new state and
            of the inputs that are still held. A registered output shows its new value.
        """
        before = self._evaluate(states, inputs)
        following = np.empty((len(states), len(self.states)), dtype=np.uint8)
        for column, cell in enumerate(self._registers):
            data = before[cell.data]
            if cell.enable is not None:
                data = np.where(before[cell.enable] != 0, data, states[:, column])
            following[:, column] = data
        return following, self._outputs(following, inputs)

    def settle(self, states: Bits, inputs: Bits) -> Bits:
        """uint8[n, O], the outputs in ``states`` with ``inputs`` held, without a tick."""
        return self._outputs(states, inputs)

    def _outputs(self, states: Bits, inputs: Bits) -> Bits:
        after = self._evaluate(states, inputs)
        if not self._output_bits:
            return np.empty((len(states), 0), dtype=np.uint8)
        return np.stack([after[bit] for bit in self._output_bits], axis=1)

    def _evaluate(self, states: Bits, inputs: Bits) -> dict[Bit, Bits]:
        rows = len(states)
        if states.shape != (rows, len(self.states)) or inputs.shape != (rows, len(self.inputs)):
            raise ValueError(f"expected states[n, {len(self.states)}] and inputs[n, {len(self.inputs)}]")
        zeros, ones = np.zeros(rows, dtype=np.uint8), np.ones(rows, dtype=np.uint8)
        values: dict[Bit, Bits] = {"0": zeros, "1": ones}
        for column, bit in enumerate(self._input_bits):
            values[bit] = inputs[:, column]
        for column, cell in enumerate(self._registers):
            values[cell.output] = states[:, column]
        for cell in self._unused:
            values[cell.output] = ones if cell.initial else zeros
        for gate in self._logic:
            values[gate.output] = _apply(gate.kind, [values[bit] for bit in gate.inputs])
        return values


def build_reference(device: Device) -> Reference:
    """The reference of ``device``.

    Registers that the netlist has no use for stay at their initial values: they reach no output, or never change.

    Raises:
        InputError: the Verilog is wrong, or is something a device cannot do.
    """
    run = run_yosys(device)
    check_design(device, run)
    mapped, design = parse_gates(run.netlist), parse_gates(run.reference)
    used = {register.bit for register in build_netlist(device, mapped).registers}
    # where optimising the logic made an output of a register's plain copy, the netlist calls the register by the output
    stored = sorted(
        (replace(cell, name=mapped.aliases.get(cell.name, cell.name)) for cell in design.registers),
        key=lambda cell: cell.name,
    )
    registers = tuple(cell for cell in stored if cell.name in used)
    missing = sorted(used - {cell.name for cell in registers})
    if missing:
        raise ValueError(f"the reference lacks the registers {', '.join(missing)}")
    return Reference(
        inputs=tuple(bit for s in device.sensors for bit in port_bits(s.name, len(s.places))),
        outputs=tuple(bit for a in device.actuators for bit in port_bits(a.name, len(a.places))),
        states=tuple(cell.name for cell in registers),
        initial=np.array([cell.initial for cell in registers], dtype=np.uint8),
        _input_bits=tuple(bit for s in device.sensors for bit in design.ports[s.name]),
        _output_bits=tuple(bit for a in device.actuators for bit in design.ports[a.name]),
        _registers=registers,
        _unused=tuple(cell for cell in stored if cell.name not in used),
        _logic=_levelised(design),
    )


def _levelised(design: GateDesign) -> tuple[LogicCell, ...]:
    by_output = {cell.output: cell for cell in design.logic}
    graph = {cell.output: [bit for bit in cell.inputs if bit in by_output] for cell in design.logic}
    return tuple(by_output[bit] for bit in TopologicalSorter(graph).static_order())


def _apply(kind: GateKind, values: list[Bits]) -> Bits:
    if kind is GateKind.NOT:
        return values[0] ^ np.uint8(1)
    if kind is GateKind.AND:
        return values[0] & values[1]
    if kind is GateKind.OR:
        return values[0] | values[1]
    if kind is GateKind.XOR:
        return values[0] ^ values[1]
    return np.where(values[2] != 0, values[1], values[0])
