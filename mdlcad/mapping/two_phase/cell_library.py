"""What a two-phase library is once its data are read: cells of masses and couplings, in numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from mdlcad.mapping.characterisation import Characterisation
from mdlcad.network.model import CouplingKind, Dynamics

# truth tables of one input and of two
NOT_TABLE, COPY_TABLE = 0b01, 0b10
AND_TABLE, NOR_TABLE = 0b1000, 0b0001


@dataclass(frozen=True, slots=True)
class Options:
    """The options of the paper's synthesis process.

    Attributes:
        clock_length: power-clock cycles from tick to tick.
        clock: make the clock; without it the mass "tick" has no source and is to be driven from outside.
        branching: buffer trees, so that no output drives more inputs than the library's fan-out allows.
        io_gates: a buffer of its own for every sensor and every actuator.
        buffer: the cell that is used as a buffer.
    """

    clock_length: int
    clock: bool
    branching: bool
    io_gates: bool
    buffer: str


@dataclass(frozen=True, slots=True)
class Roles:
    """Names of the cells that the compiler asks for, besides the buffer."""

    inverter: str
    latch: str
    join: str
    zero: str
    one: str


@dataclass(frozen=True, slots=True)
class CellMass:
    """A mass of a cell: phase 0 or 1, stiffness k0 + k1 p_phase, bias q."""

    name: str
    phase: int
    k0: float
    k1: float
    bias: float


@dataclass(frozen=True, slots=True)
class CellCoupling:
    """A spring of strength c p_source between two masses of a cell, or from one of its input pins."""

    source: str
    target: str
    strength: float
    kind: CouplingKind


@dataclass(frozen=True, slots=True)
class Cell:
    """A gate or latch, one power-clock cycle from its inputs to its output.

    Attributes:
        inputs: pins; each is the output mass of the cell that drives it.
        output: the mass that gives the result, of phase 0.
        function: truth table, bit m the value where input i is bit i of m; None for a latch.
        text: the function as the data give it; "" for a latch.
        state: the mass that holds a latch's bit; None for a gate.
    """

    name: str
    inputs: tuple[str, ...]
    output: str
    function: int | None
    text: str
    state: str | None
    masses: tuple[CellMass, ...]
    couplings: tuple[CellCoupling, ...]

    @property
    def inner(self) -> tuple[CellMass, ...]:
        """All masses but the output."""
        return tuple(mass for mass in self.masses if mass.name != self.output)


@dataclass(frozen=True, slots=True)
class TwoPhaseLibrary:
    """One library with one of its parameter sets. All quantities are dimensionless.

    Attributes:
        parameters: name of the parameter set in use, one of ``parameter_sets``.
        fan_out: most inputs that one output may drive.
        cells: in the order of the file.
        characterisation: where the file's default parameter set was measured to work; None if it does not say.
    """

    name: str
    title: str
    parameters: str
    parameter_sets: tuple[str, ...]
    options: Options
    dynamics: Dynamics
    fan_out: int
    roles: Roles
    cells: tuple[Cell, ...]
    kind: Literal["two_phase"] = "two_phase"
    characterisation: Characterisation | None = None

    def cell(self, name: str) -> Cell:
        """The cell called ``name``; KeyError if there is none."""
        for cell in self.cells:
            if cell.name == name:
                return cell
        raise KeyError(name)
