"""When a device decides, when its inputs change, when it is to be read.

Decision d is the N = ``cycles_per_tick`` clock cycles from t = d N T; its inputs are applied at that moment and held
until the next decision begins. Once in every decision the tick mass is 1 at its own instant (the peak of its clock
wave): the tick, in a cycle that is the same in every decision and is found by running the network. Then

* the state before a decision is every register's last reading not later than the decision's tick. Nothing that the
  tick causes can have happened, since its targets move only after it has;
* the state after it is the state before the next one;
* the outputs of a decision are read in its last cycle, each mass at its own instant: the registers have changed, the
  inputs are still held.

A device without state has no tick, and outputs only.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlcad.network.model import Network
from mdlcad.simulation.decode import decode, instants
from mdlcad.simulation.drive import with_tick
from mdlcad.simulation.run import Stimulus, Watch, simulate
from mdlcad.simulation.system import Ints, System


class NoTick(Exception):
    """The tick mass does not tick once every N cycles; the message says what it does."""


@dataclass(frozen=True, slots=True)
class Timing:
    """Instants of a device.

    Attributes:
        period: N, clock cycles of a decision.
        tick_cycle: cycle within a decision of its tick; -1 without one.
        tick_instant: step within that cycle at which the tick mass is read.
    """

    period: int
    tick_cycle: int
    tick_instant: int

    def state_cycle(self, instant: Ints) -> Ints:
        """int[w]: for registers read at step ``instant`` (int[w]) of a cycle, the cycle to read before decision 0.

        It is -1 for a mass whose instant comes only after a tick in cycle 0: before decision 0 it cannot be read.
        """
        cycle: Ints = self.tick_cycle - (instant > self.tick_instant).astype(np.int64)
        return cycle


def find_timing(network: Network, system: System, steps_per_period: int) -> Timing:
    """Derive the timing, running the network for four decisions, without forces on its sensors, to find its tick.

    Raises:
        NoTick: see there.
    """
    n = network.cycles_per_tick
    if network.tick is None:
        return Timing(n, -1, 0)
    tick = np.array([system.index(network.tick)])
    instant = instants(system, tick, steps_per_period)
    span = n * steps_per_period
    free = Stimulus(np.zeros(0, dtype=np.int64), np.zeros((4, 0, 1)), span, span)
    run = simulate(
        system,
        with_tick(network, system, free, steps_per_period),
        4 * span,
        watch=Watch(tick, instant),
        steps_per_period=steps_per_period,
    )
    bits = decode(system, tick, run.readings)[:, 0, 0]
    seen = [int(cycle) for cycle in np.flatnonzero(bits == 1)]
    if len(seen) != 4 or np.any(np.diff(seen) != n) or np.any(bits > 1):
        word = "".join("01?"[bit] for bit in bits)
        raise NoTick(f"tick mass {network.tick!r} should be 1 once every {n} cycles, but reads {word}")
    return Timing(n, seen[0], int(instant[0]))
