"""A selection of options, how long it takes, and the plan it makes."""

from __future__ import annotations

from dataclasses import dataclass, field

from mdlcad.mapping.options import TICK0, TICK2, Carrier, Option, OptionGraph
from mdlcad.mapping.plan import Key, Plan, PlannedMass, Role
from mdlcad.mapping.threshold import Threshold
from mdlcad.mapping.tickring import LEAST_CYCLES, plan_ring

_NEVER = -(10**6)
_TIMED = frozenset({Role.LOGIC, Role.PORT, Role.STORE, Role.FOLLOW})
"""Masses that change when sensors or registers do."""


@dataclass(slots=True)
class Selection:
    """What was decided.

    Attributes:
        chosen: the number of the option of every mass that is made.
        sets, releases: for every register the number of its set choice and of its release.
        carriers: for every output the mass that shows it.
        cycles, tick_cycle: N and A (see ``cover``).
    """

    chosen: dict[Key, int] = field(default_factory=dict)
    sets: list[int] = field(default_factory=list)
    releases: list[int] = field(default_factory=list)
    carriers: list[Carrier] = field(default_factory=list)
    cycles: int = 1
    tick_cycle: int = 0

    def option(self, graph: OptionGraph, key: Key) -> Option:
        """The option by which ``key`` is made."""
        return graph.options[key][self.chosen[key]]


def arrivals(graph: OptionGraph, selection: Selection, register_cycle: int, sensor_cycle: int = 0) -> dict[Key, int]:
    """The last cycle in which each made mass can change, if the sensors change in ``sensor_cycle`` and the registers in
    ``register_cycle``. Masses of the registers other than STORE and FOLLOW, and the tick, are left out."""
    found: dict[Key, int] = {}
    stack = list(selection.chosen)
    while stack:
        key = stack[-1]
        if key in found or key.role not in _TIMED:
            stack.pop()
            continue
        if key.role is Role.STORE:
            found[stack.pop()] = register_cycle
            continue
        option = selection.option(graph, key)
        if not option.sources:
            found[stack.pop()] = sensor_cycle if key.role is Role.LOGIC else _NEVER
            continue
        relevant = [source for source in option.sources if source.role in _TIMED]
        missing = [source for source in relevant if source not in found]
        if missing:
            stack += missing
        else:
            late = 1 if key.phase == 0 else 0
            found[stack.pop()] = max([found[source] for source in relevant]) + late if relevant else register_cycle
    return found


def time_selection(graph: OptionGraph, selection: Selection) -> None:
    """Set the least ``cycles`` and ``tick_cycle`` that the selection allows."""
    shown = [carrier.key for carrier in selection.carriers if carrier.key.role is not Role.STORE]
    if not graph.registers:
        settled = arrivals(graph, selection, _NEVER)
        selection.cycles = 1 + max([0, *(settled[key] for key in shown)])
        return
    from_sensors = arrivals(graph, selection, _NEVER)
    from_registers = arrivals(graph, selection, 0, _NEVER)
    tick_cycle, delay = 0, 0
    for key in selection.chosen:
        if key.role in (Role.TERM, Role.HOLD, Role.LOAD):
            late = 1 if key.role is Role.LOAD else 0
            for source in selection.option(graph, key).sources:
                if source in from_sensors:
                    tick_cycle = max(tick_cycle, from_sensors[source] + late)
                    delay = max(delay, from_registers[source] + late)
    # the registers change in cycle A - N; the outputs settle after their change in cycle A
    after = max([0, *(from_registers[key] for key in shown if key.role is not Role.PORT or key in from_registers)])
    direct = max([0, *(from_sensors[key] for key in shown)])
    selection.tick_cycle = tick_cycle
    selection.cycles = max(LEAST_CYCLES, delay, tick_cycle + 1 + after, direct + 1)


def make_plan(graph: OptionGraph, selection: Selection) -> Plan:
    """The selection as planned masses."""
    # a sensor's own mass is the option without sources
    own = {
        key: Key(Role.SENSOR, key.of, key.phase)
        for key in sorted(selection.chosen)
        if key.role is Role.LOGIC and not selection.option(graph, key).sources
    }
    inverted = {
        carrier.key
        for literal, carrier in zip(graph.outputs, selection.carriers, strict=True)
        if literal & 1 and carrier.shared
    }
    masses = []
    for key in sorted(selection.chosen):
        option = selection.option(graph, key)
        weights = zip(option.sources, option.function.weights, strict=True)
        function = Threshold(tuple(-w if source in inverted else w for source, w in weights), option.function.bias)
        if key in inverted:
            function = function.negated()
        masses.append(PlannedMass(own.get(key, key), tuple(own.get(s, s) for s in option.sources), function))
    return Plan(
        masses=tuple(masses),
        ring=plan_ring(selection.cycles) if graph.registers else None,
        tick_cycle=selection.tick_cycle,
        cycles=selection.cycles,
        carriers=tuple(own.get(carrier.key, carrier.key) for carrier in selection.carriers),
    )


# A mass is a unit with its plates' area, an input weight a leaf in it.
MASS_COST = 16
COUPLING_COST = 1
CYCLE_COST = 2


def selection_cost(graph: OptionGraph, selection: Selection) -> int:
    """What the search minimises: masses, the ring's and about as many twins as will be needed included, then couplings
    and cycles, and what is strange."""
    cost = CYCLE_COST * selection.cycles + MASS_COST * len(selection.chosen)
    targets: dict[Key, list[tuple[Key, int]]] = {}
    inputs: dict[Key, int] = {}
    for key in selection.chosen:
        option = selection.option(graph, key)
        for source, weight in zip(option.sources, option.function.weights, strict=True):
            targets.setdefault(source, []).append((key, abs(weight)))
        inputs[key] = option.function.inputs
        cost += COUPLING_COST * inputs[key] + graph.charge(key, selection.chosen[key])
    if graph.registers:
        cost += MASS_COST * plan_ring(selection.cycles).masses(TICK0 in targets and TICK2 in targets)
    load = {key: sum(weight for _, weight in found) for key, found in targets.items()}
    for key, found in targets.items():
        if key.role is Role.LOGIC and not selection.option(graph, key).sources:
            continue  # a sensor
        echo = sum(weight * (load.get(target, 0) + inputs[target] - weight) for target, weight in found)
        cost += MASS_COST * max((load[key] - 1) // graph.load_limit, (echo - 1) // graph.echo_limit, 0)
    return cost
