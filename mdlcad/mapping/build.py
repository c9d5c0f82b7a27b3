"""From a plan to the network: names, forces, polarity, and a power-up state."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mdlcad.mapping.cell_library import Library
from mdlcad.mapping.discrete import DiscreteNetwork, Signs
from mdlcad.mapping.plan import Key, Plan, PlannedMass, Role
from mdlcad.mapping.polarity import choose_polarity
from mdlcad.mapping.threshold import Threshold
from mdlcad.mapping.tickmasses import ring_masses, tick_sources
from mdlcad.network.model import Coupling, Mass, MassKind, Network, PortBit, Register
from mdlcad.synthesis.netlist import Netlist

_KINDS = {
    Role.SENSOR: MassKind.SENSOR,
    Role.LOGIC: MassKind.GATE,
    Role.PORT: MassKind.GATE,
    Role.TERM: MassKind.REGISTER,
    Role.HOLD: MassKind.REGISTER,
    Role.STORE: MassKind.REGISTER,
    Role.FOLLOW: MassKind.REGISTER,
    Role.LOAD: MassKind.TICK,
    Role.STAGE: MassKind.TICK,
    Role.TICK: MassKind.TICK,
}


def with_ring(plan: Plan) -> tuple[tuple[PlannedMass, ...], Key | None]:
    """The plan's masses with those of its ring, and the mass that the set terms see as the tick."""
    if plan.ring is None:
        return plan.masses, None
    tick2, tick0 = Key(Role.TICK, (), 2), Key(Role.TICK, (), 0)
    early = any(tick2 in mass.sources for mass in plan.masses)
    stands_for = tick_sources(plan.ring, early)
    masses = [
        replace(mass, sources=tuple(stands_for.get(source, source) for source in mass.sources)) for mass in plan.masses
    ]
    return (*masses, *ring_masses(plan.ring, early)), stands_for[tick0]


def invert(masses: tuple[PlannedMass, ...], keys: frozenset[Key]) -> tuple[PlannedMass, ...]:
    """The same logic with the masses ``keys`` carrying the inverse of what they did."""
    made = []
    for mass in masses:
        weights = tuple(
            -w if source in keys else w for source, w in zip(mass.sources, mass.function.weights, strict=True)
        )
        function = Threshold(weights, mass.function.bias)
        made.append(replace(mass, function=function.negated() if mass.key in keys else function))
    return tuple(made)


def build_network(
    netlist: Netlist,
    library: Library,
    plan: Plan,
    masses: tuple[PlannedMass, ...],
    names: dict[Key, str],
    tick: Key | None,
) -> Network:
    """The network of the planned ``masses`` (the ring's included), at rest in the state of power-up."""
    ports = {names[key]: output.bit for output, key in zip(netlist.outputs, plan.carriers, strict=True)}
    sensors = {names[m.key]: names[m.key] for m in masses if m.key.role is Role.SENSOR}
    ordered = sorted(masses, key=lambda m: _place(m, names, netlist))
    springs = [
        (names[source], names[mass.key], weight)
        for mass in ordered
        for source, weight in sorted(zip(mass.sources, mass.function.weights, strict=True), key=lambda i: names[i[0]])
    ]
    polarity = choose_polarity(
        [names[mass.key] for mass in ordered],
        [(a, b, weight < 0) for a, b, weight in springs],
        [*sensors, *ports],
        [names[mass.key] for mass in ordered if mass.function.bias],
    )
    couplings = tuple(coupling_of(library, a, b, weight * polarity[a] * polarity[b]) for a, b, weight in springs)
    load: dict[str, float] = {}
    for coupling in couplings:
        for end in (coupling.source, coupling.target):
            load[end] = load.get(end, 0.0) + coupling.self_stiffness
    network = Network(
        design=netlist.design,
        cells=library.name,
        dynamics=library.network_dynamics(),
        masses=tuple(
            Mass(
                name=(name := names[mass.key]),
                kind=MassKind.BUFFER if _is_buffer(mass) else _KINDS[mass.key.role],
                phase=mass.key.phase,
                k0=library.mass.k0,
                k1=library.mass.k1,
                compensation=-load.get(name, 0.0) if library.coupling.compensated else 0.0,
                bias=-mass.function.bias * polarity[name] * library.bias.force if mass.function.bias else 0.0,
                initial=0.0,
                polarity=polarity[name],
                port=sensors.get(name, ports.get(name)),
            )
            for mass in ordered
        ),
        couplings=couplings,
        sensors=tuple(PortBit(bit, bit) for bit in netlist.inputs),
        actuators=tuple(
            PortBit(output.bit, names[key]) for output, key in zip(netlist.outputs, plan.carriers, strict=True)
        ),
        registers=tuple(
            Register(register.bit, names[Key(Role.STORE, (index,), 2)], register.initial)
            for index, register in enumerate(netlist.registers)
        ),
        tick=None if tick is None else names[tick],
        cycles_per_tick=plan.cycles,
    )
    return power_up(network, library, plan.tick_cycle, _held(netlist, masses, names))


def discrete(network: Network, library: Library) -> DiscreteNetwork:
    """The ideal threshold logic of a network made with ``library``."""
    return DiscreteNetwork(network, library.coupling.strength, library.bias.force)


def coupling_of(library: Library, source: str, target: str, weight: int) -> Coupling:
    """The spring of an input of that signed weight."""
    table = library.coupling
    ratio = table.self_stiffness_negative if weight < 0 else table.self_stiffness_positive
    strength = weight * table.strength
    return Coupling(source, target, strength, abs(strength) * ratio)


def _is_buffer(mass: PlannedMass) -> bool:
    return mass.key.role is Role.LOGIC and len(mass.sources) == 1


def _place(mass: PlannedMass, names: dict[Key, str], netlist: Netlist) -> tuple[int, int, str]:
    """Sensors in the order of the device, then all else by name, the ring last and in its own order."""
    name = names[mass.key]
    if mass.key.role is Role.SENSOR:
        return (0, netlist.inputs.index(name), name)
    if mass.key.role in (Role.STAGE, Role.TICK):
        return (2, mass.key.of[0] if mass.key.of else 1 << 20, name)
    return (1, 0, name)


def _held(netlist: Netlist, masses: tuple[PlannedMass, ...], names: dict[Key, str]) -> dict[str, bool]:
    """The initial logic value of every mass that takes a register's value at a tick: its store, the store's twins, and
    actuators that take it beside the store."""
    held = {}
    for mass in masses:
        for source, weight in zip(mass.sources, mass.function.weights, strict=True):
            if mass.key.role in (Role.STORE, Role.PORT) and source.role is Role.HOLD:
                held[names[mass.key]] = netlist.registers[source.of[0]].initial != (weight < 0)
    return held


def power_up(network: Network, library: Library, tick_cycle: int, registers: dict[str, bool]) -> Network:
    """Displacements at t = 0, when the masses of phase 2 hold their values and all others are about to be set anew.

    The ``registers`` hold their initial values, the logic has settled to them with all sensors at 0, and the ring is
    where the first tick falls into ``tick_cycle``.
    """
    logic = discrete(network, library)
    upright = np.array([mass.polarity for mass in network.masses])
    state: Signs = np.where(upright > 0, -1, 1).astype(np.int8)[:, None]

    def hold_registers(current: Signs) -> None:
        for name, value in registers.items():
            row = logic.index[name]
            current[row] = upright[row] * (1 if value else -1)

    # From any start the ring falls into step; the registers are held by hand while the logic around them settles.
    history = [state]
    # Once all is as it was a decision before it stays so; then the last two decisions are what is wanted.
    period = network.cycles_per_tick
    settling = len(network.masses) + 4 * period
    while len(history) <= settling:
        hold_registers(state)
        state = logic.cycle(state)
        history.append(state)
        if len(history) > 2 * period and np.array_equal(state, history[-1 - period]):
            settling = min(settling, len(history) - 1 + 2 * period)
    chosen = history[-1]
    if network.tick is not None:
        row = logic.index[network.tick]
        # the state after cycle c is the state before cycle c + 1; the tick must show in cycle c + 1 + tick_cycle
        start = next(
            c
            for c in range(settling - 2 * network.cycles_per_tick, settling)
            if history[c + 1 + tick_cycle][row, 0] * upright[row] > 0
        )
        chosen = history[start]
    chosen = chosen.copy()
    hold_registers(chosen)
    well = library.power_up.well
    return replace(
        network,
        masses=tuple(
            replace(mass, initial=well * float(chosen[row, 0]) if mass.phase == 2 else 0.0)
            for row, mass in enumerate(network.masses)
        ),
    )
