"""The clock: which loops, and that they tick when they should."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from mdlcad.mapping.two_phase import map_two_phase
from mdlcad.mapping.two_phase.clock import plan_clock
from mdlcad.network.model import MassKind, Network
from mdlcad.simulation.decode import decode, instants
from mdlcad.simulation.run import Watch, simulate, undriven
from mdlcad.simulation.system import system_of
from mdlcad.synthesis import synthesise
from tests.mapping.two_phase.programs import library, small

TOGGLE = "module v(input clk, input [1:0] s, output reg [1:0] t); always @(posedge clk) t <= t + s; endmodule"


def ticks(network: Network, cycles: int) -> list[int]:
    """The cycles in which the tick mass is 1; asserts that it is 0 in all others."""
    system = system_of(network)
    masses = np.array([system.index(network.tick or "")])
    watch = Watch(masses, instants(system, masses, 400))
    bits = decode(system, masses, simulate(system, undriven(), cycles * 400, watch=watch).readings)[:, 0, 0]
    assert set(bits.tolist()) <= {0, 1}
    return [int(cycle) for cycle in np.flatnonzero(bits)]


@pytest.mark.parametrize(
    ("length", "loops"),
    [(60, (5, 12)), (20, (4, 5)), (30, (5, 6)), (7, (7,)), (6, (6,)), (64, (64,)), (126, (9, 14)), (2, (2,))],
)
def test_loops(length: int, loops: tuple[int, ...]) -> None:
    clock = plan_clock(length, 2)
    assert clock.loops == loops
    assert clock.length == length


@pytest.mark.parametrize("parameters", ["robust", "literal"])
def test_five_by_twelve_ticks_every_sixty_cycles(parameters: str) -> None:
    network = map_two_phase(synthesise(small(TOGGLE)), library(parameters))
    found = ticks(network, 400)
    assert np.diff(found).tolist() == [60] * (len(found) - 1)
    assert len(found) >= 6
    kinds = Counter(mass.kind for mass in network.masses)
    assert kinds[MassKind.TICK] == 2 * (5 + 12) + 2 * 3


@pytest.mark.parametrize("length", [17, 16, 24])
def test_a_single_loop_and_odd_lengths_tick_too(length: int) -> None:
    network = map_two_phase(synthesise(small(TOGGLE)), library(clock_length=length))
    found = ticks(network, 6 * length)
    assert np.diff(found).tolist() == [length] * (len(found) - 1)
    assert len(found) == 6


def test_a_loop_without_its_token_is_caught() -> None:
    from dataclasses import replace

    from mdlcad.proof.timing import NoTick, find_timing

    network = map_two_phase(synthesise(small(TOGGLE)), library())
    tokens = [m.name for m in network.masses if m.name.startswith("tick.b") and m.initial > 0 and "not" not in m.name]
    assert len(tokens) == 2
    still = replace(network, masses=tuple(replace(m, initial=-1.0) if m.name in tokens else m for m in network.masses))
    with pytest.raises(NoTick):
        find_timing(still, system_of(still), 400)
