"""When a device decides, when its inputs may change, when it is to be read.

One decision is N = ``cycles_per_tick`` clock cycles. The tick of decision d is the clock cycle in which the tick mass
is 1 at its own instant (the peak of its clock wave); the first is found by running the network, the others follow
every N cycles. Then

* state *before* decision d and outputs *of* decision d: every mass at its last instant not later than tick d.
  Nothing that the tick causes can have happened, since its targets move only after it has;
* state *after* decision d: the same instant of tick d + 1;
* inputs change one cycle after the tick: the registers have taken their new state, and the new inputs have N - 1
  cycles to the next tick, as the new state has.

A device without state has no tick: inputs change every N cycles from t = 0, and outputs are read at their instants
within the last of the N cycles.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlcad.network.model import Network
from mdlcad.simulation.decode import decode, instants
from mdlcad.simulation.run import Stimulus, Watch, simulate
from mdlcad.simulation.system import Ints, System


class NoTick(Exception):
    """The tick mass does not tick once every N cycles, or too early; the message says what it does."""


@dataclass(frozen=True, slots=True, eq=False)
class Timing:
    """Instants of a device, in steps and clock cycles.

    Attributes:
        period: N, clock cycles of a decision.
        first_cycle: cycle of tick 0 (without a tick: of the first reading).
        tick_instant: step within the cycle of the tick mass's reading (without a tick: the last step).
        first_steps: steps of decision 0's inputs.
        interval_steps: steps of every other decision's inputs.
    """

    period: int
    first_cycle: int
    tick_instant: int
    first_steps: int
    interval_steps: int

    def reading_cycle(self, instant: Ints) -> Ints:
        """int[w]: for masses read at step ``instant`` (int[w]) of a cycle, the cycle to read for decision 0.

        Raises:
            NoTick: the first tick comes before such a mass was read once.
        """
        cycle = self.first_cycle - (instant > self.tick_instant).astype(np.int64)
        if len(cycle) and cycle.min() < 0:
            raise NoTick("the first tick is in cycle 0, before the registers and outputs can be read")
        return cycle


def find_timing(network: Network, system: System, steps_per_period: int) -> Timing:
    """Derive the timing, running the network without forces for a few decisions to find its tick.

    Raises:
        NoTick: see there.
    """
    n = network.cycles_per_tick
    if network.tick is None:
        return Timing(n, n - 1, steps_per_period - 1, n * steps_per_period, n * steps_per_period)
    tick = np.array([system.index(network.tick)])
    instant = instants(system, tick, steps_per_period)
    still = Stimulus(np.zeros(0, dtype=np.int64), np.zeros((1, 0, 1)), 0, 1)
    run = simulate(
        system, still, 4 * n * steps_per_period, watch=Watch(tick, instant), steps_per_period=steps_per_period
    )
    bits = decode(system, tick, run.readings)[:, 0, 0]
    seen = [int(cycle) for cycle in np.flatnonzero(bits == 1)]
    if len(seen) != 4 or np.any(np.diff(seen) != n) or np.any(bits > 1):
        word = "".join("01?"[bit] for bit in bits)
        raise NoTick(f"tick mass {network.tick!r} should be 1 once every {n} cycles, but reads {word}")
    first = seen[0] * steps_per_period + int(instant[0]) + steps_per_period
    return Timing(n, seen[0], int(instant[0]), first, n * steps_per_period)
