"""Faults, one at a time: every sign, spring, phase and bias of a network, and every pair of its sensors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations

import numpy as np

from mdlcad.network.model import Coupling, Mass, Network
from mdlcad.proof.behaviour import Behaviour
from mdlcad.proof.compare import compare
from mdlcad.proof.itinerary import Itinerary
from mdlcad.proof.prove import SENSOR_FORCE
from mdlcad.proof.timing import NoTick, find_timing
from mdlcad.simulation.run import steps_for
from mdlcad.simulation.system import system_of

Fault = tuple[str, str, Network]
"""Its kind, where it is, and the network that has it."""

# decisions of every lane that are tried before all of them are
_PREFIXES = (2, 8)


def all_faults(network: Network) -> Iterator[Fault]:
    """Each of them changes one thing in the network."""

    def coupling(i: int, *new: Coupling) -> Network:
        return replace(network, couplings=(*network.couplings[:i], *new, *network.couplings[i + 1 :]))

    def masses(*changes: tuple[int, Mass]) -> Network:
        made = dict(changes)
        return replace(network, masses=tuple(made.get(i, mass) for i, mass in enumerate(network.masses)))

    for i, c in enumerate(network.couplings):
        yield "flipped sign", c.name, coupling(i, replace(c, strength=-c.strength))
        yield "missing spring", c.name, coupling(i)
    place = {mass.name: i for i, mass in enumerate(network.masses)}
    for i, mass in enumerate(network.masses):
        for phase in range(3):
            if phase != mass.phase:
                yield "wrong phase", f"{mass.name} in {phase}", masses((i, replace(mass, phase=phase)))
        if mass.bias:
            yield "flipped bias", mass.name, masses((i, replace(mass, bias=-mass.bias)))
            yield "missing bias", mass.name, masses((i, replace(mass, bias=0.0)))
    for c in network.couplings:
        i, j = place[c.source], place[c.target]
        a, b = network.masses[i], network.masses[j]
        if a.bias != b.bias:
            yield "swapped biases", c.name, masses((i, replace(a, bias=b.bias)), (j, replace(b, bias=a.bias)))
    for i, j in combinations(range(len(network.sensors)), 2):
        a, b = network.sensors[i], network.sensors[j]
        swapped = list(network.sensors)
        swapped[i], swapped[j] = replace(a, mass=b.mass), replace(b, mass=a.mass)
        yield "swapped sensors", f"{a.bit}, {b.bit}", replace(network, sensors=tuple(swapped))


def caught(network: Network, reference: Behaviour, itinerary: Itinerary) -> bool:
    """Whether the proof that takes ``itinerary`` finds a mismatch.

    What a lane does does not depend on later inputs; so what shows in its first decisions is found without the rest.
    """
    system = system_of(network)
    steps = steps_for(system)
    try:
        timing = find_timing(network, system, steps)
    except NoTick:
        return True
    for decisions in (*_PREFIXES, len(itinerary.inputs)):
        part = replace(
            itinerary,
            inputs=itinerary.inputs[:decisions],
            states=itinerary.states[: decisions + 1],
            outputs=itinerary.outputs[:decisions],
        )
        found = compare(
            network, reference, system, part, timing, sensor_force=SENSOR_FORCE, steps_per_period=steps, workers=2
        )
        if np.any(found.wrong < len(part.inputs)):
            return True
    return False
