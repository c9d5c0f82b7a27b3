"""Programs and networks for the tests."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from mdlcad.language import Device, parse_device, read_device
from mdlcad.mapping.request import MappingRequest
from mdlcad.mapping.two_phase import TwoPhaseLibrary, load_two_phase
from mdlcad.mapping.two_phase.build import build_network
from mdlcad.mapping.two_phase.cell_library import Cell
from mdlcad.mapping.two_phase.circuit import Circuit, Instance
from mdlcad.mapping.two_phase.timing import Schedule
from mdlcad.network.model import MassKind, Network
from mdlcad.synthesis.netlist import Netlist, OutputBit

ROOT = Path(__file__).resolve().parents[3]
PAPER = ROOT.parent / "shared" / "paper"

BODY = """\
mechanicalmodule small();
boundary {{ line a {{(0,0), (0,9)}}, line b {{(0,9), (9,9)}}, line c {{(9,9), (9,0)}}, line d {{(9,0), (0,0)}} }};
sensor s {{ location = {{(a, 0.3), (a, 0.7)}}, values = {{"0b00": "none"}} }};
actuator t {{ location = {{(c, 0.2), (c, 0.8)}}, values = {{"0b00": "none"}} }};
{module}
endmechanicalmodule
"""

# a shift register from t[1] through q to t[0]
RACE = """\
module v(input clk, input [1:0] s, output [1:0] t);
  reg [{last}:0] q; reg first;
  always @(posedge clk) begin first <= s[0]; q <= {{first, q[{last}:1]}}; end
  assign t = {{first, q[0]}};
endmodule"""


def small(module: str) -> Device:
    """A device with sensor s[1:0] and actuator t[1:0]."""
    return parse_device(BODY.format(module=module), "small.mdl")


def example(name: str) -> Device:
    return read_device(ROOT / "examples" / f"{name}.mdl")


def listing(name: str) -> Device:
    """A program of the paper; skips where its listings are not at hand."""
    path = PAPER / f"{name}.mdl"
    if not path.exists():
        pytest.skip(f"THE PAPER'S LISTING {name}.mdl IS NOT HERE: expected in {PAPER.parent.name}/{PAPER.name}")
    return read_device(path)


def library(parameters: str | None = None, **options: object) -> TwoPhaseLibrary:
    """The library with other options."""
    found = load_two_phase("two_phase", MappingRequest(parameters=parameters))
    return replace(found, options=replace(found.options, **options))


def with_period(network: Network, period: float) -> Network:
    return replace(network, dynamics=replace(network.dynamics, period=period))


def lone_cell(cells: TwoPhaseLibrary, cell: Cell) -> Network:
    """One cell between sensors called like its pins, each with its gate as in a device, and the actuator "OUT"."""
    netlist = Netlist("cell", cell.inputs, (OutputBit("OUT", "gate"),), (), ())
    buffer = cells.cell(cells.options.buffer)
    gates = tuple(Instance(f"{pin}.in", buffer, (pin,), MassKind.BUFFER) for pin in cell.inputs)
    instance = Instance("gate", cell, tuple(gate.net for gate in gates), MassKind.GATE)
    circuit = Circuit(cell.inputs, (*gates, instance), (), (), False, ("gate",))
    return build_network(netlist, cells, circuit, None, Schedule(2, 0))
