"""The netlist artefact: what the program does, as plain gates and registers over single-bit nets."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

CONSTANTS = ("0", "1")


class GateKind(StrEnum):
    """A gate's function. The inputs of MUX are (if 0, if 1, select)."""

    NOT = "not"
    AND = "and"
    OR = "or"
    XOR = "xor"
    MUX = "mux"


@dataclass(frozen=True, slots=True)
class Gate:
    """One gate; ``net`` is its output. Inputs are nets or constants."""

    net: str
    kind: GateKind
    inputs: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class StateBit:
    """One register of one bit; ``bit`` is both its name and the net of its output.

    Attributes:
        data: net (or "0", "1") that it takes at a tick.
        enable: net without which it keeps its value at a tick; None if it always takes ``data``.
        initial: value at power-up.
    """

    bit: str
    data: str
    enable: str | None
    initial: bool


@dataclass(frozen=True, slots=True)
class OutputBit:
    """One actuator bit "NAME[i]" and the net (or "0", "1") that it shows."""

    bit: str
    net: str


@dataclass(frozen=True, slots=True)
class Netlist:
    """The synthesised program.

    Net names: an input bit and a register bit are nets of their own name ("NAME[i]", i = 0 the least significant);
    a gate's net has the program's name if it has one, else the name of an output or register that it feeds, its kind
    and four digits that depend on the function from named nets alone, so that they outlive edits elsewhere.

    Attributes:
        inputs: every sensor bit, used or not, in the order of the device.
        outputs: every actuator bit, in the order of the device.
        registers: sorted by name.
        gates: in topological order, ties by name.
    """

    design: str
    inputs: tuple[str, ...]
    outputs: tuple[OutputBit, ...]
    registers: tuple[StateBit, ...]
    gates: tuple[Gate, ...]
