"""From the circuit to the network: every cell's masses and springs, and the state at power-up."""

from __future__ import annotations

from mdlcad.mapping.two_phase.cell_library import CellMass, TwoPhaseLibrary
from mdlcad.mapping.two_phase.circuit import Circuit, Instance
from mdlcad.mapping.two_phase.clock import TICK, Clock, loop_net, tap_delay
from mdlcad.mapping.two_phase.timing import Schedule
from mdlcad.network.model import Coupling, Mass, MassKind, Network, PortBit, Register
from mdlcad.synthesis.netlist import Netlist

# Displacement at t = 0 of a mass that holds a bit: the paper's.
_HELD = 1.0


def build_network(
    netlist: Netlist, library: TwoPhaseLibrary, circuit: Circuit, clock: Clock | None, schedule: Schedule
) -> Network:
    """The network of ``circuit``, at rest in the state of power-up."""
    held = _held_bits(netlist, library, circuit, clock, schedule)
    ports = {net: output.bit for output, net in zip(netlist.outputs, circuit.outputs, strict=True)}
    lone = library.cell(library.options.buffer)
    (free,) = (mass for mass in lone.masses if mass.name == lone.output)

    masses = [_mass(bit, free, MassKind.SENSOR, -_HELD, bit) for bit in circuit.sensors]
    couplings: list[Coupling] = []
    named = sorted((*circuit.gates, *circuit.latches), key=lambda item: (item.kind is MassKind.TICK, item.net))
    if circuit.ticking and not circuit.loops:
        masses.append(_mass(TICK, free, MassKind.TICK, -_HELD, None))
    for item in (*named, *circuit.loops):
        for mass in item.cell.masses:
            # at t = 0 the inner masses hold their bits and the outputs are about to take them; p_0 = p_1 then, so an
            # output at rest in the middle would be drawn as much by the next cells as by its own
            displacement = _HELD if held[item.net] else -_HELD
            port = ports.get(item.net) if mass.name == item.cell.output else None
            masses.append(_mass(_name(item, mass.name), mass, item.kind, displacement, port))
        for spring in item.cell.couplings:
            couplings.append(
                Coupling(
                    source=_name(item, spring.source),
                    target=_name(item, spring.target),
                    strength=spring.strength,
                    self_stiffness=0.0,
                    kind=spring.kind,
                    d0=0.0,
                    d1=1.0,
                )
            )
    return Network(
        design=netlist.design,
        cells=library.name,
        dynamics=library.dynamics,
        masses=tuple(masses),
        couplings=tuple(couplings),
        sensors=tuple(PortBit(bit, bit) for bit in netlist.inputs),
        actuators=tuple(PortBit(out.bit, net) for out, net in zip(netlist.outputs, circuit.outputs, strict=True)),
        registers=tuple(Register(register.bit, register.bit, register.initial) for register in netlist.registers),
        tick=_tick_mass(circuit),
        cycles_per_tick=schedule.cycles,
        tick_drive=schedule.tick_cycle if circuit.ticking and not circuit.loops else None,
    )


def _tick_mass(circuit: Circuit) -> str | None:
    """The mass that tells the tick: the inner one of the cell that makes it, half a cycle before its output.

    The output itself is drawn towards 0 by the latches that it opens, with the paper's numbers to less than a third of
    its well.
    """
    makers = [item for item in circuit.loops if item.net == TICK]
    if not makers:
        return TICK if circuit.ticking else None
    return _name(makers[0], makers[0].cell.inner[-1].name)


def _name(item: Instance, part: str) -> str:
    """The name of a cell's mass, or of the mass at its pin."""
    if part == item.cell.output:
        return item.net
    if part in item.cell.inputs:
        return item.sources[item.cell.inputs.index(part)]
    return f"{item.net}.{part.lower()}"


def _mass(name: str, mass: CellMass, kind: MassKind, displacement: float, port: str | None) -> Mass:
    return Mass(
        name=name,
        kind=kind,
        phase=mass.phase,
        k0=mass.k0,
        k1=mass.k1,
        compensation=0.0,
        bias=mass.bias,
        initial=displacement,
        port=port,
    )


def _held_bits(
    netlist: Netlist, library: TwoPhaseLibrary, circuit: Circuit, clock: Clock | None, schedule: Schedule
) -> dict[str, bool]:
    """What every cell is about to show in cycle 0: registers their initial values, the logic settled to them with all
    sensors at 0, no tick on its way, and in each loop one 1 where it makes the tick come in its cycle."""
    bits = dict.fromkeys((*circuit.sensors, TICK, *(item.net for item in circuit.loops)), False)
    bits |= {register.bit: register.initial for register in netlist.registers}
    for gate in circuit.gates:
        minterm = sum(bits[source] << index for index, source in enumerate(gate.sources))
        bits[gate.net] = bool((gate.cell.function or 0) >> minterm & 1)
    if clock and circuit.loops:
        for loop, length in enumerate(clock.loops):
            # a 1 shown at place s in cycle 0 passes the tap in the cycles that are -s modulo the length
            bits[loop_net(loop, (tap_delay(clock, library) - schedule.tick_cycle) % length)] = True
        for item in circuit.loops:
            if item.net != TICK and item.cell.name == library.roles.inverter:
                bits[item.net] = not bits[item.sources[0]]
    return bits
