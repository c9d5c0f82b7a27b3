"""Netlist to two-phase network: the library's one entry."""

from __future__ import annotations

from mdlcad.mapping.two_phase.build import build_network
from mdlcad.mapping.two_phase.cell_library import TwoPhaseLibrary
from mdlcad.mapping.two_phase.circuit import CircuitBuilder
from mdlcad.mapping.two_phase.clock import join_cells, plan_clock
from mdlcad.mapping.two_phase.logic import lower
from mdlcad.mapping.two_phase.timing import find_ways, schedule
from mdlcad.network.model import Network
from mdlcad.synthesis.netlist import Netlist


def map_two_phase(netlist: Netlist, library: TwoPhaseLibrary) -> Network:
    """Map ``netlist`` to masses and springs of ``library``, with its options.

    The result is a function of the two arguments alone.

    Raises:
        UsageError: the clock is too short for the device; says how long it must be.
    """
    options = library.options
    clock = plan_clock(options.clock_length, join_cells(library)) if options.clock else None
    logic = lower(netlist, library)
    circuit = CircuitBuilder(netlist, logic, library, level_ticks=False).build(clock)
    ways = find_ways(circuit)
    if ways.races:
        circuit = CircuitBuilder(netlist, logic, library, level_ticks=True).build(clock)
        ways = find_ways(circuit)
    return build_network(netlist, library, circuit, clock, schedule(ways, options.clock_length))
