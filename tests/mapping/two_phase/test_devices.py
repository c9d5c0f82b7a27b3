"""Whole devices, proved against their programs by simulation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mdlcad.language import Device
from mdlcad.mapping.two_phase import map_two_phase
from mdlcad.network.model import CouplingKind, Network
from mdlcad.proof.compare import compare
from mdlcad.proof.itinerary import make_itinerary
from mdlcad.proof.outcome import Proof
from mdlcad.proof.prove import SENSOR_FORCE, prove
from mdlcad.proof.reference import build_reference
from mdlcad.proof.timing import find_timing
from mdlcad.simulation.decode import decode, instants
from mdlcad.simulation.run import Stimulus, Watch, simulate
from mdlcad.simulation.system import system_of
from mdlcad.synthesis import synthesise
from tests.mapping.two_phase.programs import RACE, example, library, listing, small, with_period

# Loops of 4 and 5 instead of 5 and 12: as many decisions in a third of the time.
SHORT = 20


def mapped(device: Device, parameters: str | None = None, **options: object) -> Network:
    return map_two_phase(synthesise(device), library(parameters, **options))


def proved(device: Device, network: Network) -> Proof:
    proof = prove(network, build_reference(device), decisions=300)
    assert proof.holds, [str(item) for item in proof.first_mismatches[:3]]
    assert proof.exhaustive
    return proof


def decisions_right(device: Device, network: Network, wanted: int, lanes: int = 16) -> int:
    """Decisions of random walks from power-up, all of them right."""
    reference, system = build_reference(device), system_of(network)
    itinerary = make_itinerary(reference, wanted, 3, exhaustive=False, lanes=lanes)
    found = compare(
        network,
        reference,
        system,
        itinerary,
        find_timing(network, system, 400),
        sensor_force=SENSOR_FORCE,
        steps_per_period=400,
        workers=2,
    )
    decisions, walks, _ = itinerary.inputs.shape
    assert (found.wrong == decisions).all()
    return decisions * walks


def test_every_transition_of_the_maze() -> None:
    device = example("mazerobot")
    assert proved(device, mapped(device, clock_length=SHORT)).transitions_checked == 64


def test_every_transition_of_the_maze_with_the_papers_numbers() -> None:
    device = example("mazerobot")
    assert proved(device, mapped(device, "literal", clock_length=SHORT)).transitions_checked == 64


@pytest.mark.long
@pytest.mark.parametrize("period", [0.9, 1.0, 1.1])
@pytest.mark.parametrize("name", ["mazerobot", "maze_solver_robot"])
def test_the_papers_numbers_hold_in_their_window(name: str, period: float) -> None:
    device = listing(name)
    network = mapped(device, "literal", clock_length=SHORT)
    assert proved(device, with_period(network, period)).transitions_checked == proved(device, network).transitions_total


@pytest.mark.long
@pytest.mark.parametrize("parameters", ["robust", "literal"])
@pytest.mark.parametrize("name", ["mazerobot", "maze_solver_robot"])
def test_the_papers_mazes_at_sixty_cycles(name: str, parameters: str) -> None:
    device = listing(name)
    proved(device, mapped(device, parameters))


def test_three_hundred_decisions_of_the_lock() -> None:
    device = example("lock")
    assert decisions_right(device, mapped(device, clock_length=SHORT), 320) >= 300


@pytest.mark.long
@pytest.mark.parametrize("parameters", ["robust", "literal"])
@pytest.mark.parametrize("name", ["lock", "house_lock"])
def test_every_transition_of_the_papers_locks(name: str, parameters: str) -> None:
    device = listing(name)
    assert proved(device, mapped(device, parameters)).transitions_checked == 2048


@pytest.mark.long
@pytest.mark.parametrize("name", ["turnstile", "traffic_light"])
def test_other_examples(name: str) -> None:
    device = example(name)
    proved(device, mapped(device, clock_length=SHORT))


def test_a_device_without_state() -> None:
    device = example("voter")
    assert proved(device, mapped(device)).transitions_checked == 8


def test_options_leave_the_behaviour() -> None:
    module = (
        "module v(input clk, input [1:0] s, output reg [1:0] t);"
        "initial t = 2; always @(posedge clk) if (s[1]) t <= t + s[0]; else t <= ~t; endmodule"
    )
    device = small(module)
    for options in ({"io_gates": False}, {"clock_length": 17}):
        assert decisions_right(device, mapped(device, **{"clock_length": SHORT, **options}), 96, lanes=4) >= 96


def test_a_shift_register_does_not_race() -> None:
    device = small(RACE.format(last=1))
    assert decisions_right(device, mapped(device, clock_length=SHORT), 96, lanes=4) >= 96


def test_without_a_clock_the_tick_comes_from_outside() -> None:
    device = small("module v(input clk, input [1:0] s, output reg [1:0] t); always @(posedge clk) t <= s; endmodule")
    network = mapped(device, clock=False)
    system = system_of(network)
    driven = np.array([system.index(name) for name in ("s[0]", "s[1]", "tick")])
    # spans of five cycles; the tick is there in the first half of every fourth
    data = np.random.default_rng(2).integers(0, 2, (24, 2))
    tick = (np.arange(24) % 4 == 3).astype(float)[:, None]
    data = np.repeat(data[::4], 4, axis=0)
    force = 2.0 * np.concatenate([data, tick], axis=1)[:, :, None] - 1.0
    shown = np.array([system.index(register.mass) for register in network.registers])
    run = simulate(
        system, Stimulus(driven, force, 2000, 2000), 24 * 2000, watch=Watch(shown, instants(system, shown, 400))
    )
    bits = decode(system, shown, run.readings)[4::5, :, 0]
    expected = np.zeros((24, 2), dtype=int)
    for span in range(24):
        expected[span] = data[span] if tick[span, 0] else (expected[span - 1] if span else 0)
    assert (bits == expected).all()


def test_without_a_clock_every_transition_is_right_with_a_tick_from_outside() -> None:
    device = example("mazerobot")
    network = mapped(device, clock=False, clock_length=SHORT)
    assert network.tick_drive is not None
    assert proved(device, network).transitions_checked == 64


def test_a_tick_from_outside_in_a_wrong_cycle_is_caught() -> None:
    device = small(RACE.format(last=1))
    network = mapped(device, clock=False, clock_length=SHORT)
    reference = build_reference(device)
    assert prove(network, reference, decisions=300).holds
    assert not prove(replace(network, tick_drive=SHORT - 1), reference, decisions=300).holds


def test_a_wrong_network_is_caught() -> None:
    device = example("voter")
    network = mapped(device)
    nor = next(c for c in network.couplings if ".nor_" in c.target and c.kind is CouplingKind.LINEAR)
    for strength in (-nor.strength, 0.0):
        spoilt = replace(nor, strength=strength)
        wrong = replace(network, couplings=tuple(spoilt if c is nor else c for c in network.couplings))
        assert not prove(wrong, build_reference(device), decisions=300).holds
