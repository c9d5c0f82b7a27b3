"""Right devices are proved; every seeded fault is caught."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest

from mdlcad.artefact import from_json, to_json
from mdlcad.errors import UsageError
from mdlcad.network.model import Coupling, Mass, Network
from mdlcad.proof.outcome import Proof
from mdlcad.proof.prove import prove
from tests.proof.devices import Draft, Machine, toggle, vote, walker


@pytest.mark.parametrize(("device", "total"), [(toggle, 4), (walker, 16), (vote, 8)])
def test_a_right_device_is_proved(device: Callable[[], tuple[Network, Machine]], total: int) -> None:
    network, machine = device()
    proof = prove(network, machine)
    assert proof.first_mismatches == ()
    assert proof.holds and proof.exhaustive
    assert (proof.transitions_total, proof.transitions_checked, proof.transitions_unreachable) == (total, total, 0)
    assert proof.margin > 1.0 and proof.margin_mass in {mass.name for mass in network.masses}
    assert sorted(proof.peaks) == sorted(mass.name for mass in network.masses)
    assert all(1.0 < peak < 2.5 for peak in proof.peaks.values())


def test_the_artefact_is_the_same_for_any_number_of_workers_and_survives_json() -> None:
    network, machine = walker()
    data = to_json(prove(network, machine, workers=1))
    assert data == to_json(prove(network, machine, workers=2))
    assert to_json(from_json(data, Proof)) == data


def edit_mass(network: Network, name: str, **changes: object) -> Network:
    assert any(mass.name == name for mass in network.masses)
    masses = tuple(dataclasses.replace(m, **changes) if m.name == name else m for m in network.masses)
    return dataclasses.replace(network, masses=masses)


def edit_coupling(network: Network, name: str, edit: Callable[[Coupling], Coupling | None]) -> Network:
    assert any(coupling.name == name for coupling in network.couplings)
    edited = [edit(c) if c.name == name else c for c in network.couplings]
    return dataclasses.replace(network, couplings=tuple(c for c in edited if c is not None))


def flipped(c: Coupling) -> Coupling:
    return dataclasses.replace(c, strength=-c.strength)


def swapped_sensors(network: Network) -> Network:
    a, b = network.sensors
    return dataclasses.replace(
        network, sensors=(dataclasses.replace(a, mass=b.mass), dataclasses.replace(b, mass=a.mass))
    )


FAULTS: dict[str, Callable[[Network], Network]] = {
    "flipped sign into a register": lambda n: edit_coupling(n, "x2->A[0] load", flipped),
    "flipped sign in the output logic": lambda n: edit_coupling(n, "in Y[0]->xy", flipped),
    "flipped sign in the tick ring": lambda n: edit_coupling(n, "ring4->ring5", flipped),
    "missing spring in the logic": lambda n: edit_coupling(n, "a0->b1", lambda c: None),
    "missing spring to the output": lambda n: edit_coupling(n, "ab->w", lambda c: None),
    "missing spring in a register": lambda n: edit_coupling(n, "A[0] keep->A[0] r", lambda c: None),
    "missing spring in the tick ring": lambda n: edit_coupling(n, "ring4->ring5", lambda c: None),
    "spring that pulls nothing": lambda n: edit_coupling(
        n, "A[0] r->q A[0]", lambda c: dataclasses.replace(c, strength=0.0)
    ),
    "wrong phase of a gate": lambda n: edit_mass(n, "b1", phase=2),
    "wrong phase of a register": lambda n: edit_mass(n, "q A[0]", phase=0),
    "wrong bias: or made of and": lambda n: edit_mass(n, "xy", bias=-0.5),
    "no bias": lambda n: edit_mass(n, "A[0] load", bias=0.0),
    "wrong polarity": lambda n: edit_mass(n, "w", polarity=-1),
    "wrong power-up state": lambda n: edit_mass(n, "q B[0]", initial=-1.6),
    "no token": lambda n: edit_mass(n, "ring5", initial=-1.6),
    "two tokens": lambda n: edit_mass(n, "ring8", initial=1.6),
    "swapped sensors": swapped_sensors,
    "tick of one register a cycle too early": lambda n: edit_coupling(
        n, "ring11->B[0] load", lambda c: dataclasses.replace(c, source="ring8")
    ),
    "stuck: no wells": lambda n: edit_mass(n, "a0", k1=0.0),
    "wrong cycles": lambda n: dataclasses.replace(n, cycles_per_tick=5),
}


@pytest.mark.parametrize("fault", FAULTS, ids=list(FAULTS))
def test_a_seeded_fault_is_caught(fault: str) -> None:
    network, machine = walker()
    proof = prove(FAULTS[fault](network), machine)
    assert proof.mismatches > 0
    assert not proof.holds
    assert proof.first_mismatches and all(m.expected != m.got for m in proof.first_mismatches)
    assert len(proof.first_mismatches) == min(proof.mismatches, 10)


def test_a_wrong_reference_is_caught_too() -> None:
    """One transition of sixteen differs; the mismatch names it."""
    network, machine = walker()

    def rule(states: np.ndarray, inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        after, outputs = machine.rule(states, inputs)
        odd = (states == [1, 1]).all(axis=1) & (inputs == [0, 1]).all(axis=1)
        after[:, 0] ^= odd
        return after, outputs

    proof = prove(network, dataclasses.replace(machine, rule=rule))
    assert not proof.holds
    assert {(m.state, m.inputs, m.expected, m.got) for m in proof.first_mismatches} == {
        ("A[0]=1 B[0]=1", "X[0]=0 Y[0]=1", "next A[0]=1", "next A[0]=0")
    }


def test_an_output_that_remembers_the_last_input_is_caught() -> None:
    """A latch in a device that should have none: YES keeps its value on a tie of two inputs."""
    draft = Draft("sticky", 3)
    a, b = draft.sensor("A[0]"), draft.sensor("B[0]")
    # Majority of A, B and its own last value is not A and B, nor any function of them.
    draft.gate("m", 1, a, b, "back")
    draft.gate("out", 2, "m", value=False)
    draft.gate("back", 0, "out")
    draft.actuator("Y[0]", "out")

    def rule(states: np.ndarray, inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return states, inputs[:, :1] & inputs[:, 1:]

    machine = Machine(("A[0]", "B[0]"), ("Y[0]",), (), np.zeros(0, np.uint8), rule)
    proof = prove(draft.network(), machine)
    assert proof.mismatches > 0 and not proof.holds


def test_a_diverging_network_is_no_proof() -> None:
    network, machine = toggle()
    wild = dataclasses.replace(network, dynamics=dataclasses.replace(network.dynamics, inertia=1e-7))
    proof = prove(wild, machine, steps_per_period=400)
    assert not proof.holds
    assert to_json(from_json(to_json(proof), Proof)) == to_json(proof)


def test_checking_nothing_is_no_proof() -> None:
    network, machine = toggle()
    proof = prove(network, machine)
    nothing = dataclasses.replace(proof, transitions_checked=0)
    assert not nothing.holds
    assert not dataclasses.replace(nothing, exhaustive=False).holds
    assert not dataclasses.replace(nothing, transitions_total=0).holds
    assert not dataclasses.replace(proof, transitions_checked=3).holds


def test_a_lane_ends_at_its_first_mistake() -> None:
    """With the tick dead nothing is checked; with a register stuck, only what came before."""
    network, machine = walker()
    dead = prove(edit_mass(network, "ring5", initial=-1.6), machine)
    assert (dead.transitions_checked, dead.mismatches) == (0, 1)
    assert "once every 4 cycles" in dead.first_mismatches[0].got
    stuck = prove(edit_coupling(network, "x2->A[0] load", lambda c: None), machine)
    assert 0 < stuck.transitions_checked < stuck.transitions_total


def counter(bits: int, width: int) -> tuple[Network, Machine]:
    """``bits`` registers that each take a sensor; more sensors than the exhaustive check allows."""
    draft = Draft("wide", 2)
    ins = [draft.sensor(f"D[{i}]", phase=2) for i in range(width)]
    draft.clock()
    for i in range(bits):
        draft.actuator(f"Q[{i}]", draft.register(f"R[{i}]", ins[i]))

    def rule(states: np.ndarray, inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return inputs[:, :bits].copy(), states.copy()

    names = tuple(f"D[{i}]" for i in range(width))
    outputs = tuple(f"Q[{i}]" for i in range(bits))
    state = tuple(f"R[{i}]" for i in range(bits))
    return draft.network(), Machine(names, outputs, state, np.zeros(bits, np.uint8), rule)


def test_a_wide_device_is_sampled_and_says_so() -> None:
    network, machine = counter(3, 10)
    proof = prove(network, machine, decisions=1000)
    assert proof.first_mismatches == ()
    assert proof.holds and not proof.exhaustive
    assert proof.decisions >= 1000
    assert proof.states_visited == proof.reachable_states == 8
    assert 900 < proof.transitions_checked < proof.transitions_total == 2**13
    broken = edit_coupling(network, "in D[2]->R[2] load", flipped)
    assert not prove(broken, machine, decisions=1000).holds


def test_a_tick_may_come_in_cycle_0() -> None:
    """The token one cycle ahead, named where it is in phase 0: before decision 0 the register cannot yet be read."""
    network, machine = walker()
    early = edit_mass(edit_mass(network, "ring5", initial=-1.6), "ring8", initial=1.6)
    proof = prove(dataclasses.replace(early, tick="ring9"), machine)
    assert proof.tick_cycle == 0
    assert proof.holds


def test_bits_must_agree() -> None:
    network, machine = walker()
    for wrong in (
        dataclasses.replace(machine, inputs=("X[0]", "Z[0]")),
        dataclasses.replace(machine, outputs=("V[0]",)),
        dataclasses.replace(machine, states=("A[0]", "C[0]")),
        dataclasses.replace(machine, inputs=("X[0]", "Y[0]", "Z[0]")),
    ):
        with pytest.raises(UsageError):
            prove(network, wrong)
    with pytest.raises(UsageError, match="no tick"):
        prove(dataclasses.replace(network, tick=None), machine)


def test_an_upside_down_mass_reads_the_right_way() -> None:
    """Polarity: x -> -x of one mass with all its couplings and its bias changes nothing that is read."""
    network, machine = walker()
    masses: list[Mass] = [
        dataclasses.replace(m, polarity=-1, bias=-m.bias, initial=-m.initial) if m.name in ("q A[0]", "in X[0]") else m
        for m in network.masses
    ]
    turned = {"q A[0]", "in X[0]"}
    couplings = tuple(flipped(c) if (c.source in turned) != (c.target in turned) else c for c in network.couplings)
    assert prove(dataclasses.replace(network, masses=tuple(masses), couplings=couplings), machine).holds
