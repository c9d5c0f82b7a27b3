"""Verilog to a netlist of plain gates and registers, by Yosys."""

from mdlcad.synthesis.netlist import Gate, GateKind, Netlist, OutputBit, StateBit
from mdlcad.synthesis.synthesise import synthesise

__all__ = ["Gate", "GateKind", "Netlist", "OutputBit", "StateBit", "synthesise"]
