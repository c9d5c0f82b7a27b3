"""The circuit of cells: what the compiler puts between sensors, gates, latches, clock and actuators."""

from __future__ import annotations

from dataclasses import dataclass
from graphlib import TopologicalSorter

from mdlcad.mapping.two_phase.cell_library import Cell, TwoPhaseLibrary
from mdlcad.mapping.two_phase.clock import TICK, Clock, clock_cells
from mdlcad.mapping.two_phase.logic import Literal, Logic
from mdlcad.mapping.two_phase.names import Names, name_nodes
from mdlcad.mapping.two_phase.strain import Pin, Wiring, relieve
from mdlcad.mapping.two_phase.trees import Branch, TreePlanner
from mdlcad.network.model import MassKind
from mdlcad.synthesis.netlist import Netlist


@dataclass(frozen=True, slots=True)
class Instance:
    """A cell in its place. ``net`` is its name and that of its output mass; ``sources`` in the order of its pins."""

    net: str
    cell: Cell
    sources: tuple[str, ...]
    kind: MassKind


@dataclass(frozen=True, slots=True)
class Circuit:
    """All cells of a device.

    Attributes:
        sensors: the netlist's inputs, masses without a cell.
        gates: gates and the nodes of trees, every one after what it reads.
        latches: in the netlist's order of registers; a latch's net is its bit.
        loops: the cells of the clock, from loops to tick; empty if none is made.
        ticking: there is a net ``TICK``.
        outputs: the net that shows each of the netlist's outputs.
    """

    sensors: tuple[str, ...]
    gates: tuple[Instance, ...]
    latches: tuple[Instance, ...]
    loops: tuple[Instance, ...]
    ticking: bool
    outputs: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class _Sink:
    """A pin that wants a net or its inverse, with ``depth`` cycles still to go from there."""

    instance: str
    pin: int
    inverted: bool
    depth: int


class CircuitBuilder:
    """Puts in cells from the actuators back to the sensors, so that a tree knows how long the ways behind it are."""

    def __init__(self, netlist: Netlist, logic: Logic, library: TwoPhaseLibrary, *, level_ticks: bool) -> None:
        self._netlist = netlist
        self._library = library
        self._logic = logic
        self._level_ticks = level_ticks
        self._buffer = library.cell(library.options.buffer)
        self._inverter = library.cell(library.roles.inverter)
        self._planner = TreePlanner(library.fan_out if library.options.branching else None)
        bits = [register.bit for register in netlist.registers]
        self._zero, self._one = "zero", "one"
        self._names = Names([*netlist.inputs, *bits, TICK, self._zero, self._one])
        self._nets = name_nodes(netlist, logic, self._names)
        self._cells: dict[str, tuple[Cell, MassKind]] = {}
        self._sinks: dict[str, list[_Sink]] = {}
        self._wires: dict[Pin, str] = {}
        self._peers: dict[Pin, tuple[str, bool]] = {}

    def build(self, clock: Clock | None) -> Circuit:
        """The circuit; with ``clock`` None the tick has no source."""
        netlist, latch = self._netlist, self._library.cell(self._library.roles.latch)
        for register, literal in zip(netlist.registers, self._logic.data, strict=True):
            self._cells[register.bit] = (latch, MassKind.REGISTER)
            self._ask(literal, register.bit, latch.inputs.index("D"), 0)
        outputs = self._add_outputs()
        for node in reversed(self._logic.nodes):
            net = self._nets[node.net]
            self._cells[net] = (self._library.cell(node.cell), MassKind.GATE)
            depth = 1 + self._grow(net, MassKind.BUFFER)
            for pin, literal in enumerate(node.inputs):
                self._ask(literal, net, pin, depth)
        for register in netlist.registers:
            self._grow(register.bit, MassKind.BUFFER)
        for net, role in ((self._zero, self._library.roles.zero), (self._one, self._library.roles.one)):
            if net in self._sinks or net in outputs:
                self._cells[net] = (self._library.cell(role), MassKind.GATE)
                self._grow(net, MassKind.BUFFER)
        for bit in netlist.inputs:
            self._add_sensor(bit)
        for register in netlist.registers:
            self._ask(Literal(TICK), register.bit, latch.inputs.index("C"), 0)
        self._grow_ticks()
        if self._library.options.branching:
            self._relieve()

        instances = {net: self._instance(net) for net in self._cells}
        latches = tuple(instances[register.bit] for register in netlist.registers)
        gates = {net: item for net, item in instances.items() if item.cell.state is None}
        graph = {net: [s for s in item.sources if s in gates] for net, item in sorted(gates.items())}
        return Circuit(
            sensors=netlist.inputs,
            gates=tuple(gates[net] for net in TopologicalSorter(graph).static_order()),
            latches=latches,
            loops=tuple(
                Instance(cell.net, self._library.cell(cell.cell), cell.sources, MassKind.TICK)
                for cell in (clock_cells(clock, self._library) if clock and latches else ())
            ),
            ticking=bool(latches),
            outputs=outputs,
        )

    def _instance(self, net: str) -> Instance:
        cell, kind = self._cells[net]
        return Instance(net, cell, tuple(self._wires[net, pin] for pin in range(len(cell.inputs))), kind)

    def _relieve(self) -> None:
        def add_buffer(net: str, pin: Pin) -> str:
            name = self._names.digested(f"{net}.{self._buffer.name.lower()}", f"{pin[0]}/{pin[1]}")
            self._cells[name] = (self._buffer, MassKind.BUFFER)
            return name

        biased = {
            net: len(cell.inputs) for net, (cell, _) in self._cells.items() if any(mass.bias for mass in cell.inner)
        }
        relieve(Wiring(self._wires, self._peers, biased), add_buffer)

    def _ask(self, literal: Literal, instance: str, pin: int, depth: int) -> None:
        if literal.net == "0":
            literal = Literal(self._one if literal.inverted else self._zero)
        net = self._nets.get(literal.net, literal.net)
        self._sinks.setdefault(net, []).append(_Sink(instance, pin, literal.inverted, depth))

    def _add_outputs(self) -> tuple[str, ...]:
        """A gate for every actuator; without such gates, only for one whose bit has no mass of its own."""
        shown: list[str] = []
        for output, literal in zip(self._netlist.outputs, self._logic.outputs, strict=True):
            net = self._nets.get(literal.net, literal.net)
            own = not literal.inverted and net not in (*self._netlist.inputs, *shown, "0")
            if own and not self._library.options.io_gates:
                shown.append(net)
                continue
            gate = self._names.plain(f"{output.bit}.out")
            # where the logic has the inverse, the actuator's gate inverts
            flips = literal.inverted and literal.net != "0"
            self._cells[gate] = (self._inverter if flips else self._buffer, MassKind.BUFFER)
            self._ask(literal.flipped(flips), gate, 0, 1)
            shown.append(gate)
        return tuple(shown)

    def _add_sensor(self, bit: str) -> None:
        """The gate of a sensor: a buffer, or an inverter where that makes the tree behind it smaller."""
        sinks = self._sinks.pop(bit, [])
        if not sinks:
            return
        if not self._library.options.io_gates:
            self._sinks[bit] = sinks
            self._grow(bit, MassKind.BUFFER)
            return
        inverted = sum(sink.inverted for sink in sinks)
        plain = len(sinks) - inverted
        flips = self._planner.nodes(inverted, plain) < self._planner.nodes(plain, inverted)
        gate = self._names.plain(f"{bit}.in")
        self._cells[gate] = (self._inverter if flips else self._buffer, MassKind.BUFFER)
        for sink in sinks:
            self._ask(Literal(gate, sink.inverted != flips), sink.instance, sink.pin, sink.depth)
        self._grow(gate, MassKind.BUFFER)
        self._wires[gate, 0] = bit

    def _grow(self, net: str, kind: MassKind) -> int:
        """Make the tree of ``net``; the most cycles from ``net`` to the end of the ways behind it."""
        sinks = sorted(self._sinks.pop(net, []), key=lambda sink: (sink.instance, sink.pin))
        branches = [Branch(index, sink.inverted, sink.depth) for index, sink in enumerate(sinks)]
        direct = self._planner.plan(branches)
        self._wire(net, direct, sinks, net, kind)
        return max((branch.depth for branch in direct), default=0)

    def _grow_ticks(self) -> None:
        """The tree of the tick; level if all latches must see it in the same cycle."""
        sinks = sorted(self._sinks.get(TICK, []), key=lambda sink: sink.instance)
        limit = self._library.fan_out
        if not (self._level_ticks and self._library.options.branching):
            self._grow(TICK, MassKind.TICK)
            return
        branches = [Branch(index, False, 0) for index in range(len(sinks))]
        while len(branches) > limit:
            branches = self._planner.gather(branches)
        self._wire(TICK, tuple(branches), sinks, TICK, MassKind.TICK)

    def _wire(self, net: str, direct: tuple[Branch, ...], sinks: list[_Sink], root: str, kind: MassKind) -> None:
        for branch in direct:
            if branch.inner is None:
                sink = sinks[branch.ref]
                self._wires[sink.instance, sink.pin] = net
                self._peers[sink.instance, sink.pin] = (root, sink.inverted)
                continue
            cell = self._inverter if branch.inner.flips else self._buffer
            ends = [f"{sinks[ref].instance}/{sinks[ref].pin}" for ref in branch.ends()]
            node = self._names.digested(f"{root}.{cell.name.lower()}", "|".join(ends))
            self._cells[node] = (cell, kind)
            self._wires[node, 0] = net
            self._wire(node, branch.inner.branches, sinks, root, kind)
