"""Reads the gate-level JSON that Yosys writes: cells over numbered bits, and the program's names for those bits."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from mdlcad.synthesis.netlist import GateKind

Bit = int | str
"""A net of Yosys: a number, or the constant "0" or "1" (unknowns are 0)."""

GATE_TYPES = {
    "$_NOT_": (GateKind.NOT, "A"),
    "$_AND_": (GateKind.AND, "AB"),
    "$_OR_": (GateKind.OR, "AB"),
    "$_XOR_": (GateKind.XOR, "AB"),
    "$_MUX_": (GateKind.MUX, "ABS"),
}
REGISTER_TYPES = ("$_DFF_P_", "$_DFFE_PP_")


@dataclass(frozen=True, slots=True)
class LogicCell:
    """A plain gate; ``inputs`` in the order of ``GateKind``."""

    kind: GateKind
    inputs: tuple[Bit, ...]
    output: Bit


@dataclass(frozen=True, slots=True)
class RegisterCell:
    """A flip-flop of one bit; ``name`` is the program's name for it, "NAME[i]"."""

    name: str
    data: Bit
    enable: Bit | None
    output: Bit
    initial: bool


@dataclass(frozen=True, slots=True)
class GateDesign:
    """A flat module of plain gates.

    Attributes:
        ports: bits of every port, least significant first.
        names: the program's name of every bit that has one, "NAME[i]"; for a bit of several names, a port's first,
            then the shallowest, then the alphabetically first.
        aliases: for every name of a register's bit, the one that the register goes by.
    """

    ports: dict[str, tuple[Bit, ...]]
    names: dict[Bit, str]
    logic: tuple[LogicCell, ...]
    registers: tuple[RegisterCell, ...]
    aliases: dict[str, str]


def top_module(design: dict[str, Any]) -> dict[str, Any]:
    """The only module of a flattened design."""
    (module,) = design["modules"].values()
    return dict(module)


def parse_gates(design: dict[str, Any]) -> GateDesign:
    """Read a gate-level design.

    Raises:
        ValueError: a cell that is not a plain gate or flip-flop (a fault of the script, not of the program).
    """
    module = top_module(design)
    ports = {name: tuple(_bit(b) for b in port["bits"]) for name, port in module["ports"].items()}
    names, initial = _names(module, frozenset(ports))
    logic: list[LogicCell] = []
    registers: list[RegisterCell] = []
    for cell_name in sorted(module["cells"], key=_natural):
        cell = module["cells"][cell_name]
        pins = {pin: _bit(bits[0]) for pin, bits in cell["connections"].items()}
        if cell["type"] in GATE_TYPES:
            kind, order = GATE_TYPES[cell["type"]]
            logic.append(LogicCell(kind, tuple(pins[pin] for pin in order), pins["Y"]))
        elif cell["type"] in REGISTER_TYPES:
            output = pins["Q"]
            name = names.get(output) or _line_name(cell["attributes"].get("src", ""), output, names)
            names.setdefault(output, name)
            registers.append(RegisterCell(name, pins["D"], pins.get("E"), output, initial.get(output, False)))
        elif cell["type"] != "$scopeinfo":
            raise ValueError(f"cell {cell_name} of type {cell['type']} is not a plain gate")
    chosen = {register.output: register.name for register in registers}
    aliases = {
        f"{name}[{index}]": chosen[bit]
        for name, net in module["netnames"].items()
        if not net["hide_name"]
        for index, bit in enumerate(net["bits"])
        if bit in chosen
    }
    return GateDesign(ports, names, tuple(logic), tuple(sorted(registers, key=lambda r: r.name)), aliases)


def _bit(raw: Bit) -> Bit:
    return "0" if raw in ("x", "z") else raw


def _names(module: dict[str, Any], ports: frozenset[str]) -> tuple[dict[Bit, str], dict[Bit, bool]]:
    def rank(name: str) -> tuple[bool, int, str]:
        return (name not in ports, name.count("."), name)

    names: dict[Bit, str] = {}
    initial: dict[Bit, bool] = {}
    for name in sorted(module["netnames"], key=rank):
        net = module["netnames"][name]
        values = net["attributes"].get("init", "")[::-1]
        for index, bit in enumerate(net["bits"]):
            if not net["hide_name"] and isinstance(bit, int):
                names.setdefault(bit, f"{name}[{index}]")
            if index < len(values) and values[index] in "01":
                initial[bit] = values[index] == "1"
    return names, initial


def _line_name(src: str, output: Bit, names: dict[Bit, str]) -> str:
    """A name for a register that the program left without one: the line that made it, and a running number."""
    match = re.match(r"[^:|]*:(\d+)", src)
    stem = f"line{match[1] if match else 0}"
    taken = set(names.values())
    index = 0
    while f"{stem}[{index}]" in taken:
        index += 1
    return f"{stem}[{index}]"


def _natural(text: str) -> list[tuple[int, str]]:
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", text)]
