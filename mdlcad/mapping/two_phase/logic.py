"""From a netlist to gates of the library, by ABC and the library's Liberty view.

ABC counts masses but neither fan-out nor that an inverter can serve as a buffer. So it makes several versions, and the
one is taken that needs the fewest masses once its trees are there.
"""

from __future__ import annotations

import re
import subprocess
import tempfile
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from mdlcad.errors import UsageError
from mdlcad.mapping.two_phase.cell_library import COPY_TABLE, NOT_TABLE, TwoPhaseLibrary
from mdlcad.mapping.two_phase.liberty import liberty
from mdlcad.mapping.two_phase.trees import TreePlanner
from mdlcad.synthesis.netlist import GateKind, Netlist

_TIMEOUT_SECONDS = 300

_REWRITE = "balance; rewrite; refactor; balance; rewrite; rewrite -z; balance; refactor -z; rewrite -z; balance;"
_RESUB = (
    "balance; resub -K 6; rewrite; resub -K 6 -N 2; refactor; resub -K 8; balance; resub -K 8 -N 2; rewrite;"
    "resub -K 10; rewrite -z; resub -K 10 -N 2; balance; resub -K 12; refactor -z; resub -K 12 -N 2; rewrite -z;"
    "balance;"
)
# Collapsing starts afresh from the outputs' functions; where they are too large for that it fails, and is passed over.
# Bounds are in nodes and cubes, not in time, so that the same versions are made everywhere.
_SCRIPTS = (
    "dc2; dc2;",
    _RESUB,
    "collapse -B 20000; muxes; strash; dc2;",
    f"collapse -B 20000; sop -C 500; fx; strash; {_REWRITE}",
    "collapse -B 20000; bdd; strash; dc2;",
)
_COVERS = {
    GateKind.NOT: ("0 1",),
    GateKind.AND: ("11 1",),
    GateKind.OR: ("1- 1", "-1 1"),
    GateKind.XOR: ("10 1", "01 1"),
    GateKind.MUX: ("1-0 1", "-11 1"),
}


@dataclass(frozen=True, slots=True)
class Literal:
    """A net or its inverse."""

    net: str
    inverted: bool = False

    def flipped(self, when: bool = True) -> Literal:
        """The inverse."""
        return Literal(self.net, self.inverted != when)


@dataclass(frozen=True, slots=True)
class Node:
    """A gate of the library; its inputs are literals in the order of the cell's pins, inverters being left out."""

    net: str
    cell: str
    inputs: tuple[Literal, ...]


@dataclass(frozen=True, slots=True)
class Logic:
    """The netlist's combinational part. Nets are inputs, register bits, "0", or nodes.

    Attributes:
        nodes: in topological order.
        outputs: one for each of the netlist's outputs.
        data: what each of the netlist's registers takes at a tick.
    """

    nodes: tuple[Node, ...]
    outputs: tuple[Literal, ...]
    data: tuple[Literal, ...]


def lower(netlist: Netlist, library: TwoPhaseLibrary) -> Logic:
    """Gates of ``library`` for the logic of ``netlist``; of several versions the one with the fewest masses.

    Raises:
        UsageError: ABC could not map it.
    """
    text, nets = _blif(netlist)
    planner = TreePlanner(library.fan_out if library.options.branching else None)
    versions = []
    with tempfile.TemporaryDirectory(prefix="mdlcad-") as name:
        folder = Path(name)
        (folder / "cells.lib").write_text(liberty(library), encoding="ascii")
        (folder / "logic.blif").write_text(text, encoding="ascii")
        for script in _SCRIPTS:
            for mapped in _run_abc(folder, script):
                versions.append(_read(mapped, nets, netlist, library))
    if not versions:
        raise UsageError("logic synthesis made nothing of the behaviour for this cell library; make its logic smaller")
    return min(versions, key=lambda logic: _masses(logic, netlist, library, planner))


def _masses(logic: Logic, netlist: Netlist, library: TwoPhaseLibrary, planner: TreePlanner) -> int:
    """Masses of the gates and of the trees between them."""
    gated = library.options.io_gates
    wanted: dict[str, list[int]] = {}
    # an actuator's gate, and a sensor's, may invert at no cost
    shown = [Literal(literal.net) if gated else literal for literal in logic.outputs]
    for literal in [*(literal for node in logic.nodes for literal in node.inputs), *shown, *logic.data]:
        wanted.setdefault(literal.net, [0, 0])[literal.inverted] += 1
    nodes = 0
    for net, (plain, inverted) in wanted.items():
        free = gated and net in netlist.inputs
        either = planner.nodes(inverted, plain) if free else planner.nodes(plain, inverted)
        nodes += min(planner.nodes(plain, inverted), either)
    area = {cell.name: len(cell.masses) for cell in library.cells}
    return sum(area[node.cell] for node in logic.nodes) + nodes * area[library.options.buffer]


def _blif(netlist: Netlist) -> tuple[str, dict[str, str]]:
    """The combinational part as BLIF under plain names, and the netlist's name of every input in it."""
    plain: dict[str, str] = {}

    def name(net: str) -> str:
        return plain.setdefault(net, f"n{len(plain)}")

    sources = [*netlist.inputs, *(register.bit for register in netlist.registers)]
    inputs = [name(net) for net in sources]
    lines = [f".names {name('0')}", f".names {name('1')}", "1"]
    for gate in netlist.gates:
        lines.append(f".names {' '.join(name(net) for net in gate.inputs)} {name(gate.net)}")
        lines += _COVERS[gate.kind]
    roots = [f"o{index}" for index in range(len(netlist.outputs))]
    for root, output in zip(roots, netlist.outputs, strict=True):
        lines += [f".names {name(output.net)} {root}", "1 1"]
    for index, register in enumerate(netlist.registers):
        roots.append(f"d{index}")
        if register.enable is None:
            lines += [f".names {name(register.data)} d{index}", "1 1"]
        else:
            lines.append(f".names {name(register.bit)} {name(register.data)} {name(register.enable)} d{index}")
            lines += _COVERS[GateKind.MUX]
    head = [".model logic", ".inputs " + " ".join(inputs), ".outputs " + " ".join(roots)]
    return "\n".join([*head, *lines, ".end", ""]), {plain[net]: net for net in sources}


def _run_abc(folder: Path, script: str) -> list[str]:
    """The mapped BLIF of ``script``, mapped as it is and mapped with structural choices."""
    spec = find_spec("pyosys")
    if spec is None or not spec.submodule_search_locations:
        raise ValueError("pyosys is not installed")
    outputs = [folder / "plain.blif", folder / "choices.blif"]
    for output in outputs:
        output.unlink(missing_ok=True)
    commands = (
        f"read_lib -w cells.lib; read_blif logic.blif; strash; {script} strash; write_blif start.blif;"
        "map -a; topo; write_blif plain.blif;"
        "read_blif start.blif; strash; dch; dch; map -a; topo; write_blif choices.blif"
    )
    try:
        subprocess.run(
            [str(Path(spec.submodule_search_locations[0]) / "yosys-abc"), "-q", commands],
            cwd=folder,
            capture_output=True,
            timeout=_TIMEOUT_SECONDS,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return []
    return [output.read_text(encoding="ascii") for output in outputs if output.exists()]


def _read(text: str, nets: dict[str, str], netlist: Netlist, library: TwoPhaseLibrary) -> Logic:
    """A mapped BLIF; only what the outputs and registers need, without buffers and inverters."""
    gates: dict[str, tuple[str, dict[str, str]]] = {}
    for line in text.replace("\\\n", " ").splitlines():
        words = line.split()
        if words[:1] == [".gate"]:
            pins = dict(word.split("=") for word in words[2:])
            output = pins.pop(library.cell(words[1]).output) if not words[1].startswith("_") else words[2].split("=")[1]
            gates[output] = (words[1], pins)
        elif words[:1] == [".names"]:
            raise ValueError(f"ABC left '{line}' unmapped")
    cells = {cell.name: cell for cell in library.cells}
    known: dict[str, Literal] = {}
    nodes: list[Node] = []

    def literal(start: str) -> Literal:
        stack = [start]
        while stack:
            net = stack[-1]
            if net in known:
                stack.pop()
                continue
            if net in nets:
                known[net] = Literal(nets[net])
                continue
            kind, pins = gates[net]
            if re.fullmatch(r"_const[01]_", kind):
                known[net] = Literal("0", kind == "_const1_")
                continue
            missing = [pin for pin in pins.values() if pin not in known]
            if missing:
                stack += reversed(missing)
                continue
            cell = cells[kind]
            inputs = tuple(known[pins[pin]] for pin in cell.inputs)
            if not inputs:
                known[net] = Literal("0", cell.function == 1)
            elif len(inputs) == 1 and cell.function in (NOT_TABLE, COPY_TABLE):
                known[net] = inputs[0].flipped(cell.function == NOT_TABLE)
            else:
                nodes.append(Node(f"\\{len(nodes)}", kind, inputs))
                known[net] = Literal(nodes[-1].net)
        return known[start]

    outputs = tuple(literal(f"o{index}") for index in range(len(netlist.outputs)))
    data = tuple(literal(f"d{index}") for index in range(len(netlist.registers)))
    return Logic(tuple(nodes), outputs, data)
