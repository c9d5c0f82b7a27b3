"""When things happen, in power-clock cycles; a cell takes one.

A decision begins with cycle 0, in which the sensors change; they are taken to have changed by cycle 1. The tick is in
cycle A of it, latch i sees it s_i cycles later and shows its new bit one cycle after that. So

* a sensor's change must reach a latch's data by the cycle in which the latch looks, A + s_i;
* what a latch shows must not come round to another before that one has looked;
* everything that the latches change must have settled by the next decision's A + s_i, and at the actuators by the last
  cycle of the decision, N - 1;
* no latch may look after the decision has ended.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from mdlcad.errors import UsageError
from mdlcad.mapping.two_phase.circuit import Circuit
from mdlcad.mapping.two_phase.clock import TICK

# the cycle of a decision by which sensors have changed
_SETTLED = 1


@dataclass(frozen=True, slots=True)
class Schedule:
    """Cycles of a decision, and the cycle in it of the tick (0 for a device without state)."""

    cycles: int
    tick_cycle: int


@dataclass(frozen=True, slots=True)
class Ways:
    """Cycles that things take.

    Attributes:
        skew: s_i of every latch.
        sensors_to_data: longest way from a sensor to each latch's data (-1: none).
        latches_to_data: longest and shortest from the tick over a latch's change to each latch's data (-1: none).
        sensors_to_outputs, latches_to_outputs: longest of all, the latter from the tick.
    """

    skew: tuple[int, ...]
    sensors_to_data: tuple[int, ...]
    latches_to_data: tuple[int, ...]
    soonest_to_data: tuple[int, ...]
    sensors_to_outputs: int
    latches_to_outputs: int

    @property
    def races(self) -> bool:
        """Some latch's data change before it has looked."""
        return any(0 <= soonest <= s for soonest, s in zip(self.soonest_to_data, self.skew, strict=True))


def find_ways(circuit: Circuit) -> Ways:
    """Follow all ways through ``circuit``."""
    ticks = _distances(circuit, {TICK: 0}, max)
    skew = tuple(ticks[latch.sources[latch.cell.inputs.index("C")]] for latch in circuit.latches)
    shows = {latch.net: s + 1 for latch, s in zip(circuit.latches, skew, strict=True)}
    data = [latch.sources[latch.cell.inputs.index("D")] for latch in circuit.latches]
    from_sensors = _distances(circuit, dict.fromkeys(circuit.sensors, 0), max)
    latest, soonest = _distances(circuit, shows, max), _distances(circuit, shows, min)
    return Ways(
        skew=skew,
        sensors_to_data=tuple(from_sensors.get(net, -1) for net in data),
        latches_to_data=tuple(latest.get(net, -1) for net in data),
        soonest_to_data=tuple(soonest.get(net, -1) for net in data),
        sensors_to_outputs=max((from_sensors.get(net, -1) for net in circuit.outputs), default=-1),
        latches_to_outputs=max((latest.get(net, -1) for net in circuit.outputs), default=-1),
    )


def _distances(circuit: Circuit, starts: dict[str, int], pick: Callable[[list[int]], int]) -> dict[str, int]:
    found = dict(starts)
    for gate in circuit.gates:
        ways = [found[source] for source in gate.sources if source in found]
        if ways:
            found[gate.net] = 1 + pick(ways)
    return found


def schedule(ways: Ways, clock_length: int) -> Schedule:
    """The tick's cycle: halfway between the earliest and the latest that do.

    Raises:
        UsageError: ``clock_length`` cycles are too few; says how many it takes.
    """
    if not ways.skew:
        return Schedule(_SETTLED + max(ways.sensors_to_outputs, 0) + 1, 0)
    pairs = list(zip(ways.sensors_to_data, ways.skew, strict=True))
    earliest = max(0, *(_SETTLED + way - s for way, s in pairs if way >= 0), 0)
    after = max(ways.latches_to_outputs, max(ways.skew) + 1)
    round_trip = max(way - s for way, s in zip(ways.latches_to_data, ways.skew, strict=True))
    needed = max(earliest + after + 1, round_trip, _SETTLED + ways.sensors_to_outputs + 1)
    if clock_length < needed:
        raise UsageError(
            f"a clock of {clock_length} cycles is too short for this device: with --clock-length, make it at least "
            f"{needed}"
        )
    return Schedule(clock_length, (earliest + clock_length - 1 - after) // 2)
