"""A network for an edited program that is an earlier one but for a few masses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from mdlcad.mapping.build import coupling_of, discrete, power_up
from mdlcad.mapping.cell_library import Library
from mdlcad.mapping.circuit import Circuit
from mdlcad.mapping.patch import Goal, find_patches
from mdlcad.mapping.subject import Subject
from mdlcad.mapping.wired import known_tables, ring_of, takers, wires_of
from mdlcad.network.model import Mass, MassKind, Network, PortBit, Register
from mdlcad.synthesis.netlist import Netlist


@dataclass(frozen=True, slots=True)
class Before:
    """An earlier network to be like.

    Attributes:
        seats: where its masses stand (column, row), if that is known. slots: all places that there are.
    """

    network: Network
    seats: Mapping[str, tuple[int, int]] = field(default_factory=dict)
    slots: tuple[tuple[int, int], ...] = ()

    def room(self) -> dict[int, int]:
        """Free places by column."""
        taken = set(self.seats.values())
        columns = sorted({column for column, _ in self.slots})
        return {column: sum(slot[0] == column and slot not in taken for slot in self.slots) for column in columns}


def mended(
    netlist: Netlist,
    library: Library,
    subject: Subject,
    nets: Mapping[str, int],
    before: Before,
) -> Network | None:
    """The earlier network with what ``netlist`` asks of it, or None if that takes more than a few masses.

    Args:
        subject, nets: the netlist's logic: a literal for every net.
    """
    earlier = before.network
    ports = {bit.bit: bit.mass for bit in (*earlier.sensors, *earlier.actuators)}
    bits = {register.bit for register in earlier.registers}
    if (
        not subject.exact
        or earlier.tick_drive is not None
        or {*netlist.inputs, *(output.bit for output in netlist.outputs)} != set(ports)
        or {register.bit for register in netlist.registers} != bits
    ):
        return None
    wires = wires_of(earlier, library)
    holds = {f"{bit}.hold": bit for bit in sorted(bits)}
    if not set(holds) <= set(wires):
        return None
    circuit = Circuit(
        wires,
        known_tables(wires, earlier, subject, holds),
        subject.full,
        frozenset(holds),
        {mass.name: mass.polarity for mass in earlier.masses},
        before.seats,
        before.room(),
        frozenset(ports.values()),
    )
    goals = _goals(netlist, subject, nets, earlier, circuit, holds)
    found = None if goals is None else find_patches(circuit, goals, library)
    return None if found is None else _network(netlist, library, earlier, found, holds)


def _goals(
    netlist: Netlist,
    subject: Subject,
    nets: Mapping[str, int],
    earlier: Network,
    circuit: Circuit,
    holds: Mapping[str, str],
) -> tuple[Goal, ...] | None:
    """What registers are to take and actuators to show; None if an actuator would have to be made in another way."""
    following = {}
    for register in netlist.registers:
        taken = nets[register.data]
        if register.enable is not None:
            taken = subject.choose(nets[register.bit], taken, nets[register.enable])
        following[register.bit] = subject.table(taken)
    shows = takers(circuit.wires, holds)
    goals = [
        Goal(mass, following[bit] ^ (subject.full if inverted else 0))
        for mass, (bit, inverted) in sorted(shows.items())
    ]
    wanted = {output.bit: nets[output.net] for output in netlist.outputs}
    for actuator in earlier.actuators:
        literal = wanted[actuator.bit]
        if actuator.mass in shows:
            bit, inverted = shows[actuator.mass]
            if literal != nets[bit] ^ inverted:
                return None
        else:
            goals.append(Goal(actuator.mass, subject.table(literal)))
    return tuple(goals)


def _network(
    netlist: Netlist, library: Library, earlier: Network, circuit: Circuit, holds: Mapping[str, str]
) -> Network:
    """The mended circuit as a network, at rest in the state of power-up."""
    ring = ring_of(circuit.wires)
    old = {mass.name: mass for mass in earlier.masses}
    sensors = [bit.mass for bit in earlier.sensors]
    ordered = [*sensors, *sorted(name for name in circuit.wires if name not in ring and name not in sensors)]
    ordered += [mass.name for mass in earlier.masses if mass.name in ring]
    couplings = tuple(
        coupling_of(library, source, name, weight * circuit.polarity[source] * circuit.polarity[name])
        for name in ordered
        for source, weight in sorted(
            zip(circuit.wires[name].sources, circuit.wires[name].function.weights, strict=True)
        )
    )
    load = dict.fromkeys(ordered, 0.0)
    for coupling in couplings:
        load[coupling.source] += coupling.self_stiffness
        load[coupling.target] += coupling.self_stiffness
    masses = []
    for name in ordered:
        wire, sign = circuit.wires[name], circuit.polarity[name]
        mass = Mass(
            name=name,
            kind=wire.kind,
            phase=wire.phase,
            k0=library.mass.k0,
            k1=library.mass.k1,
            compensation=-load[name] if library.coupling.compensated else 0.0,
            bias=-wire.function.bias * sign * library.bias.force if wire.function.bias else 0.0,
            initial=0.0,
            polarity=sign,
            port=old[name].port if name in old else None,
        )
        masses.append(mass)
    initial = {register.bit: register.initial for register in netlist.registers}
    network = replace(
        earlier,
        design=netlist.design,
        masses=tuple(masses),
        couplings=couplings,
        sensors=tuple(PortBit(bit, bit) for bit in netlist.inputs),
        actuators=tuple(
            replace(item) for output in netlist.outputs for item in earlier.actuators if item.bit == output.bit
        ),
        registers=tuple(Register(item.bit, item.mass, initial[item.bit]) for item in earlier.registers),
    )
    held = {mass: initial[bit] != inverted for mass, (bit, inverted) in takers(circuit.wires, holds).items()}
    return power_up(network, library, _tick_cycle(earlier, library), held)


def _tick_cycle(network: Network, library: Library) -> int:
    """The cycle of every decision in which the tick shows, counted from power-up."""
    if network.tick is None:
        return 0
    logic = discrete(network, library)
    row = logic.index[network.tick]
    upright = network.masses[row].polarity
    state = np.array([[1 if mass.initial > 0 else -1] for mass in network.masses], np.int8)
    for mass in network.masses:
        if mass.kind is MassKind.SENSOR:
            state[logic.index[mass.name]] = -1
    for cycle in range(network.cycles_per_tick):
        state = logic.cycle(state)
        if state[row, 0] * upright > 0:
            return cycle
    raise ValueError("the tick does not show")
