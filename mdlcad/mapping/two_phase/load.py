"""Reads a two-phase library from its TOML file, and says what is wrong with one that cannot be used."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from typing import Any

import msgspec

from mdlcad.datafolder import find_data, refuse_non_numbers
from mdlcad.errors import UsageError
from mdlcad.mapping.characterisation import Characterisation
from mdlcad.mapping.request import AS_WRITTEN, MappingRequest
from mdlcad.mapping.two_phase.cell_library import (
    AND_TABLE,
    COPY_TABLE,
    NOR_TABLE,
    NOT_TABLE,
    Cell,
    CellCoupling,
    CellMass,
    Options,
    Roles,
    TwoPhaseLibrary,
)
from mdlcad.mapping.two_phase.function import truth_table
from mdlcad.network.model import CouplingKind, Dynamics

_PHASES = 2
_WORD = re.compile(r"[A-Za-z_]\w*\Z")
# names of the paper's Appendix: a0 and a1 of a mass of either phase
_CLOCKING = {"in": (0, 0.0, 1.0), "out": (1, 2.0, -1.0)}

Number = float | str
"""A number, or the name of a parameter with or without a minus."""


class MassData(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A mass as the file has it."""

    name: str
    clocking: str = "in"
    bias: Number = 0.0
    a0: Number | None = None
    a1: Number | None = None


class CouplingData(msgspec.Struct, frozen=True, forbid_unknown_fields=True, rename={"source": "from", "target": "to"}):
    """A coupling as the file has it."""

    source: str
    target: str
    strength: Number
    kind: CouplingKind = CouplingKind.LINEAR


class CellData(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A cell as the file has it."""

    name: str
    inputs: list[str]
    output: str
    masses: list[MassData]
    couplings: list[CouplingData]
    function: str | None = None
    state: str | None = None


class GatesData(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Table ``gates``."""

    fan_out: int


class LibraryData(msgspec.Struct, frozen=True, forbid_unknown_fields=True, rename={"sets": "parameters"}):
    """The whole file, but for the name of the parameter set in use."""

    kind: str
    name: str
    title: str
    default: str
    options: Options
    roles: Roles
    gates: GatesData
    cell: list[CellData]
    sets: dict[str, dict[str, float]]
    characterisation: Characterisation | None = None


def load_two_phase(name_or_path: str, request: MappingRequest = AS_WRITTEN) -> TwoPhaseLibrary:
    """The two-phase library of that name in ``cells/``, or the one in the folder or TOML file at that path.

    Args:
        request: what is wanted otherwise than the file has it.

    Raises:
        UsageError: no such library or parameter set, the file is not a valid library, or what is requested does not
            fit it; names the file and the key.
    """
    found = find_data("cells", name_or_path, "")
    path = found / "library.toml" if found.is_dir() else found
    label = f"{path.parent.name}/{path.name}"
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
        refuse_non_numbers(label, table)
        data = msgspec.convert(table, LibraryData)
        return _library(data, request)
    except OSError as trouble:
        raise UsageError(f"{label}: cannot be read: {trouble.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as trouble:
        raise UsageError(f"{label}: not TOML: {trouble}") from None
    except (msgspec.ValidationError, ValueError) as trouble:
        raise UsageError(f"{label}: {trouble}") from None


def _library(data: LibraryData, request: MappingRequest) -> TwoPhaseLibrary:
    chosen = request.parameters or data.default
    if data.kind != "two_phase":
        raise ValueError(f"kind is '{data.kind}', not 'two_phase'")
    if chosen not in data.sets:
        raise ValueError(f"no parameter set '{chosen}'; there are {', '.join(sorted(data.sets))}")
    numbers = _Numbers(chosen, data.sets[chosen])
    dynamics = Dynamics(
        inertia=numbers.positive("inertia"),
        damping=numbers.positive("damping"),
        quartic=numbers.positive("quartic"),
        period=numbers.positive("period"),
        phases=_PHASES,
    )
    cells = tuple(_cell(cell, numbers) for cell in data.cell)
    library = TwoPhaseLibrary(
        name=data.name,
        title=data.title,
        parameters=chosen,
        parameter_sets=tuple(data.sets),
        options=_options(data.options, request),
        dynamics=dynamics,
        fan_out=data.gates.fan_out,
        roles=data.roles,
        cells=cells,
        characterisation=data.characterisation,
    )
    check_library(library)
    return library


def _options(options: Options, request: MappingRequest) -> Options:
    """``options`` of the file, with what is requested otherwise."""
    return Options(
        clock_length=options.clock_length if request.clock_length is None else request.clock_length,
        clock=options.clock if request.clock is None else request.clock,
        branching=options.branching if request.branching is None else request.branching,
        io_gates=options.io_gates if request.io_gates is None else request.io_gates,
        buffer=options.buffer if request.buffer is None else request.buffer,
    )


def check_library(library: TwoPhaseLibrary) -> None:
    """Raise ValueError unless the cells, roles and options of ``library`` fit each other."""
    names = [cell.name for cell in library.cells]
    if len(set(names)) != len(names):
        raise ValueError("two cells share a name")
    if library.fan_out < 2:
        raise ValueError("gates.fan_out must be at least 2")
    if library.options.clock_length < 2:
        raise ValueError(f"options.clock_length (--clock-length) is {library.options.clock_length}; make it 2 or more")
    roles = library.roles
    wanted = (
        ("options.buffer", library.options.buffer, 1, (COPY_TABLE,), "a buffer, of function A"),
        ("roles.inverter", roles.inverter, 1, (NOT_TABLE,), "an inverter, of function !A"),
        ("roles.join", roles.join, 2, (AND_TABLE, NOR_TABLE), "an AND or a NOR of two inputs"),
        ("roles.zero", roles.zero, 0, (0,), "the constant 0"),
        ("roles.one", roles.one, 0, (1,), "the constant 1"),
    )
    for key, name, inputs, tables, words in wanted:
        if name not in names:
            hint = "; name the buffer there or with --buffer" if key == "options.buffer" else ""
            raise ValueError(f"{key} is '{name}', but the cells are {', '.join(names)}{hint}")
        cell = library.cell(name)
        if len(cell.inputs) != inputs or cell.function not in tables:
            raise ValueError(f"{key}: cell '{name}' is not {words}")
    if roles.latch not in names or library.cell(roles.latch).state is None:
        raise ValueError(f"roles.latch is '{roles.latch}', which is not a cell with a state")
    if set(library.cell(roles.latch).inputs) != {"C", "D"}:
        raise ValueError(f"roles.latch: cell '{roles.latch}' must have the inputs C and D")


class _Numbers:
    """A parameter set; numbers in cells are looked up in it."""

    def __init__(self, name: str, table: Mapping[str, float]) -> None:
        self._name = name
        self._table = table

    def of(self, number: Number) -> float:
        """A number as given, or the parameter of that name, negated behind a minus."""
        if not isinstance(number, str):
            return number
        name = number.removeprefix("-")
        if name not in self._table:
            raise ValueError(f"parameter set '{self._name}' has no '{name}'")
        return -self._table[name] if number.startswith("-") else self._table[name]

    def positive(self, name: str) -> float:
        """The parameter ``name``, which must be positive."""
        value = self.of(name)
        if not value > 0:
            raise ValueError(f"parameters.{self._name}.{name} must be positive")
        return value


def _cell(data: CellData, numbers: _Numbers) -> Cell:
    try:
        cell = Cell(
            name=data.name,
            inputs=tuple(data.inputs),
            output=data.output,
            function=None if data.function is None else truth_table(data.function, tuple(data.inputs)),
            text=data.function or "",
            state=data.state,
            masses=tuple(_mass(mass, numbers) for mass in data.masses),
            couplings=tuple(
                CellCoupling(item.source, item.target, numbers.of(item.strength), item.kind) for item in data.couplings
            ),
        )
        _check_cell(cell)
    except ValueError as trouble:
        raise ValueError(f"cell '{data.name}': {trouble}") from None
    return cell


def _mass(data: MassData, numbers: _Numbers) -> CellMass:
    """k = k_l + gamma (a0 + a1 x_p), with x_p = p_0 = 2 - p_1."""
    if data.clocking not in _CLOCKING:
        raise ValueError(f"clocking '{data.clocking}' is neither 'in' nor 'out'")
    phase, a0, a1 = _CLOCKING[data.clocking]
    a0 = a0 if data.a0 is None else numbers.of(data.a0)
    a1 = a1 if data.a1 is None else numbers.of(data.a1)
    if phase:
        a0, a1 = a0 + 2.0 * a1, -a1
    linear, quadratic = numbers.of("linear"), numbers.of("quadratic")
    return CellMass(data.name, phase, linear + quadratic * a0, quadratic * a1, numbers.of(data.bias))


def _check_cell(cell: Cell) -> None:
    phases: dict[str, int] = {mass.name: mass.phase for mass in cell.masses}
    pins = [*phases, *cell.inputs]
    if len(set(pins)) != len(pins):
        raise ValueError("two of its masses and pins share a name")
    for name in (cell.name, *pins):
        if not _WORD.match(name):
            raise ValueError(f"'{name}' is not a name of letters, digits and '_'")
    if phases.get(cell.output) != 0:
        raise ValueError(f"its output '{cell.output}' must be one of its masses, clocked 'in'")
    if (cell.function is None) == (cell.state is None):
        raise ValueError("it needs either a function or a state")
    if cell.state is not None and phases.get(cell.state) != 1:
        raise ValueError(f"its state '{cell.state}' must be one of its masses, clocked 'out'")
    if any(phase == 0 for name, phase in phases.items() if name != cell.output):
        raise ValueError("only its output may be clocked 'in', so that it takes one cycle")
    phases |= dict.fromkeys(cell.inputs, 0)
    for item in cell.couplings:
        for end in (item.source, item.target):
            if end not in phases:
                raise ValueError(f"a coupling ends at '{end}', which it has not")
        if item.target in cell.inputs or phases[item.source] == phases[item.target]:
            raise ValueError(f"the coupling {item.source} to {item.target} must go from a phase to the other")
    unused = [pin for pin in cell.inputs if all(item.source != pin for item in cell.couplings)]
    if unused:
        raise ValueError(f"nothing is coupled to its input '{unused[0]}'")


def library_kind(path_or_name: str) -> str | None:
    """The ``kind`` that a library's file states, None if it states none or cannot be read as TOML.

    Raises:
        UsageError: no such library.
    """
    found = find_data("cells", path_or_name, "")
    path = found / "library.toml" if found.is_dir() else found
    try:
        table: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError):
        return None
    kind = table.get("kind")
    return kind if isinstance(kind, str) else None
