"""The tick: a small ring of masses that gives one pulse every N power-clock cycles.

A ring of n stages (three masses each, one cycle) whose last stage is fed back inverted runs through 2 n states (a
Johnson counter); fed back as NOR of the last two stages, through 2 n - 1. One gate finds the state in which stage 1 is
on and the last is off, once a period. With one stage the ring itself alternates and needs no such gate; two stages
with NOR are a one-hot ring, which starts itself from any state, and need none either.
"""

from __future__ import annotations

from dataclasses import dataclass

LEAST_CYCLES = 2


@dataclass(frozen=True, slots=True)
class RingPlan:
    """What a ring of ``cycles`` is made of.

    Attributes:
        stages: number of stages of three masses.
        nor: whether the feedback is NOR of the last two stages.
        decoded: whether a gate has to find the pulse; else every stage pulses itself.
    """

    cycles: int
    stages: int
    nor: bool
    decoded: bool

    def masses(self, both_phases: bool) -> int:
        """Number of masses, if the pulse is needed in phase 0 alone or also one step earlier."""
        return 3 * self.stages + (1 + both_phases if self.decoded else 0)


def plan_ring(cycles: int) -> RingPlan:
    """The smallest ring that pulses every ``cycles`` >= 2 cycles."""
    if cycles < LEAST_CYCLES:
        raise ValueError("a tick needs at least two cycles")
    stages = (cycles + 1) // 2
    nor = cycles % 2 == 1
    return RingPlan(cycles, stages, nor, decoded=cycles > 3)
