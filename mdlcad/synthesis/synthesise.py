"""From a device's Verilog to its netlist."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from graphlib import TopologicalSorter

from mdlcad.language.device import Device
from mdlcad.synthesis.cells import Bit, GateDesign, parse_gates
from mdlcad.synthesis.check import check_design
from mdlcad.synthesis.netlist import CONSTANTS, Gate, Netlist, OutputBit, StateBit
from mdlcad.synthesis.yosys import run_yosys

_NAME_DIGITS = 4


def synthesise(device: Device) -> Netlist:
    """The netlist of ``device``.

    Registers that reach no output are left out. An unknown or unassigned value is 0, and so is the initial value of a
    register that declares none.

    Raises:
        InputError: the Verilog is wrong, or is something a device cannot do.
    """
    run = run_yosys(device)
    check_design(device, run)
    return build_netlist(device, parse_gates(run.netlist))


def port_bits(name: str, width: int) -> Iterator[str]:
    """The bits of a port, the least significant first."""
    return (f"{name}[{index}]" for index in range(width))


def build_netlist(device: Device, design: GateDesign) -> Netlist:
    """The netlist of a gate-level design whose ports are those of ``device``."""
    logic = {cell.output: cell for cell in design.logic}
    registers = {cell.output: cell for cell in design.registers}
    inputs: dict[Bit, str] = {}
    for sensor in device.sensors:
        inputs |= dict(zip(design.ports[sensor.name], port_bits(sensor.name, len(sensor.places)), strict=True))
    outputs = [
        (name, bit)
        for actuator in device.actuators
        for name, bit in zip(port_bits(actuator.name, len(actuator.places)), design.ports[actuator.name], strict=True)
    ]

    roots = [(name, bit) for name, bit in outputs]
    live: dict[Bit, None] = {}
    owner: dict[Bit, str] = {}
    pending = list(roots)
    while pending:
        root, start = pending.pop(0)
        stack = [start]
        while stack:
            bit = stack.pop()
            if bit in live or bit in CONSTANTS:
                continue
            live[bit] = None
            if bit in registers:
                cell = registers[bit]
                pending += [(cell.name, b) for b in (cell.data, cell.enable) if b is not None]
            elif bit in logic:
                owner[bit] = root
                stack += reversed(logic[bit].inputs)

    names: dict[Bit, str] = {"0": "0", "1": "1"} | inputs | {bit: cell.name for bit, cell in registers.items()}
    digests: dict[Bit, str] = dict(names)
    graph = {
        bit: sorted(set(logic[bit].inputs) - set(CONSTANTS), key=str) for bit in sorted(owner, key=str) if bit in logic
    }
    order = [bit for bit in TopologicalSorter(graph).static_order() if bit in graph]
    taken = set(names.values())
    for bit in order:
        gate = logic[bit]
        digests[bit] = hashlib.sha256("|".join([gate.kind, *(digests[b] for b in gate.inputs)]).encode()).hexdigest()
        name = design.names.get(bit)
        if name is None or name in taken:
            name = _fresh(f"{owner[bit]}.{gate.kind}_", digests[bit], taken)
        names[bit] = name
        taken.add(name)

    gates = [Gate(names[bit], logic[bit].kind, tuple(names[b] for b in logic[bit].inputs)) for bit in order]
    return Netlist(
        design=device.name,
        inputs=tuple(inputs.values()),
        outputs=tuple(OutputBit(name, names[bit]) for name, bit in outputs),
        registers=tuple(
            StateBit(cell.name, names[cell.data], None if cell.enable is None else names[cell.enable], cell.initial)
            for cell in design.registers
            if cell.output in live
        ),
        gates=_canonical(gates),
    )


def _fresh(stem: str, digest: str, taken: set[str]) -> str:
    digits = _NAME_DIGITS
    while stem + digest[:digits] in taken:
        digits += 1
    return stem + digest[:digits]


def _canonical(gates: list[Gate]) -> tuple[Gate, ...]:
    """Topological order in which only depth and name decide, so that Yosys' own numbering leaves no trace."""
    depth: dict[str, int] = {}
    for gate in gates:
        depth[gate.net] = 1 + max(depth.get(net, 0) for net in gate.inputs)
    return tuple(sorted(gates, key=lambda gate: (depth[gate.net], gate.net)))
