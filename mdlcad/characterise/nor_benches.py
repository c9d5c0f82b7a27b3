"""Benches of a library of kind ``two_phase``: every gate at every fan-out, the latch, the clock, the reference circuit.

A gate stands behind buffers, one at each input, and drives as many NORs (the join of the clock, the heaviest cell) as
its fan-out says. A decision takes six cycles: two for the sensor to turn, buffer, gate, load, and one to spare.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from mdlcad.characterise.bench import Bench, Gates, make_bench
from mdlcad.characterise.circuits import REFERENCE, reference_device, register_device
from mdlcad.language import Device
from mdlcad.mapping.two_phase import TwoPhaseLibrary, map_two_phase
from mdlcad.mapping.two_phase.build import build_network
from mdlcad.mapping.two_phase.cell_library import Cell
from mdlcad.mapping.two_phase.circuit import Circuit, Instance
from mdlcad.mapping.two_phase.timing import Schedule
from mdlcad.network.model import MassKind
from mdlcad.proof.behaviour import Bits
from mdlcad.proof.reference import build_reference
from mdlcad.synthesis import synthesise
from mdlcad.synthesis.netlist import Netlist, OutputBit

_CYCLES = 6

# cycles from tick to tick: the least that the circuits need, and for the clock a product of two loops
_LATCH_CYCLES = 12
_CLOCK_CYCLES = 12
_REFERENCE_CYCLES = 20


def gate_bench(library: TwoPhaseLibrary, cell: Cell, fan_out: int, seed: int) -> Bench:
    """``cell`` behind buffers, driving ``fan_out`` joins whose other inputs are sensors."""
    join, buffer = library.cell(library.roles.join), library.cell(library.options.buffer)
    sides = tuple(f"side{i}" for i in range(fan_out))
    sensors = (*cell.inputs, *sides)
    fronts = [Instance(f"{pin}.in", buffer, (pin,), MassKind.BUFFER) for pin in sensors]
    gate = Instance("gate", cell, tuple(f"{pin}.in" for pin in cell.inputs), MassKind.GATE)
    loads = [Instance(f"load{i}", join, ("gate", f"{side}.in"), MassKind.GATE) for i, side in enumerate(sides)]
    watched = ("gate", *(load.net for load in loads))
    netlist = Netlist("cell", sensors, tuple(OutputBit(name, name) for name in watched), (), ())
    circuit = Circuit(sensors, (*fronts, gate, *loads), (), (), False, watched)
    network = build_network(netlist, library, circuit, None, Schedule(_CYCLES, 0))

    def rule(inputs: Bits) -> Bits:
        pins = len(cell.inputs)
        out = _look_up(cell, [inputs[:, i] for i in range(pins)], len(inputs))
        read = [out, *(_look_up(join, [out, inputs[:, pins + i]], len(inputs)) for i in range(fan_out))]
        return np.stack(read, axis=1)

    return make_bench(f"{cell.name}, fan-out {fan_out}", network, Gates(sensors, watched, rule), seed)


def _look_up(cell: Cell, pins: list[Bits], rows: int) -> Bits:
    minterm = np.zeros(rows, np.int64)
    for index, pin in enumerate(pins):
        minterm += pin.astype(np.int64) << index
    bits: Bits = ((cell.function or 0) >> minterm & 1).astype(np.uint8)
    return bits


def cell_benches(library: TwoPhaseLibrary, seed: int) -> Iterator[Bench]:
    """Gates, latch, and clock."""
    for cell in library.cells:
        if cell.state is None:
            for fan_out in range(1, library.fan_out + 1):
                yield gate_bench(library, cell, fan_out, seed)
    yield _mapped(library, library.roles.latch, register_device(), seed, _LATCH_CYCLES, clock=False)
    yield _mapped(library, "clock of two loops", register_device(), seed, _CLOCK_CYCLES)


def reference_bench(library: TwoPhaseLibrary, seed: int) -> Bench:
    """The reference circuit, with a clock that is as short as it may be."""
    return _mapped(library, REFERENCE, reference_device(), seed, _REFERENCE_CYCLES)


def _mapped(
    library: TwoPhaseLibrary, cell: str, device: Device, seed: int, clock_length: int, clock: bool = True
) -> Bench:
    changed = replace(library, options=replace(library.options, clock=clock, clock_length=clock_length))
    return make_bench(cell, map_two_phase(synthesise(device), changed), build_reference(device), seed)
