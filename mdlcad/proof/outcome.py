"""The artefact of a proof."""

from __future__ import annotations

from dataclasses import dataclass

from msgspec import UNSET, UnsetType


@dataclass(frozen=True, slots=True)
class Mismatch:
    """The first wrong decision of one lane, in words.

    Attributes:
        lane, decision: where it was seen; decision 0 is the first after power-up.
        state, inputs: the reference's state before the decision and the inputs during it, as "A[0]=1 B[0]=0".
        expected, got: the bits that differ, in the same form; a mass that is neither 0 nor 1 reads "?".
    """

    lane: int
    decision: int
    state: str
    inputs: str
    expected: str
    got: str

    def __str__(self) -> str:
        return (
            f"decision {self.decision} of lane {self.lane}: in state ({self.state}) with inputs ({self.inputs}) "
            f"expected {self.expected}, got {self.got}"
        )


@dataclass(frozen=True, slots=True)
class Proof:
    """What time simulation of the network showed about the program's behaviour.

    A transition is a (state, inputs) pair; for a device without state, an input vector.

    Attributes:
        transitions_total: transitions from reachable states; if not every reachable state is known, an upper bound.
        transitions_checked: distinct transitions whose outputs and next state were compared.
        transitions_unreachable: transitions from states that cannot be reached from power-up (0 if not all known).
        mismatches: lanes that went wrong; a lane stops at its first wrong decision.
        exhaustive: every transition from every reachable state was planned to be checked.
        first_mismatches: the first few.
        reachable_states, states_visited: states of the reference that can be reached (those known), that were met.
        decisions, lanes: decisions simulated (all lanes together), independent runs from power-up.
        tick_cycle: clock cycle within each decision in which the tick comes, found by simulation (-1: there is none).
        cycles_per_tick, steps_per_period, sensor_force, seed: how it was done.
        margin, margin_mass: smallest |x| at any read-out, and of which mass.
        peaks: largest |x| over all lanes and all time, by mass.
        method: the same in words.
        tilts: largest angle about x of every shuttle, rad, if nothing stopped it; where they are not held from tilting.
    """

    design: str
    cells: str
    transitions_total: int
    transitions_checked: int
    transitions_unreachable: int
    mismatches: int
    exhaustive: bool
    first_mismatches: tuple[Mismatch, ...]
    reachable_states: int
    states_visited: int
    decisions: int
    lanes: int
    tick_cycle: int
    cycles_per_tick: int
    steps_per_period: int
    sensor_force: float
    seed: int
    margin: float
    margin_mass: str
    peaks: dict[str, float]
    method: str
    tilts: dict[str, float] | UnsetType = UNSET

    @property
    def holds(self) -> bool:
        """Nothing was wrong, something was checked, and all of it if the proof says exhaustive."""
        complete = not self.exhaustive or self.transitions_checked == self.transitions_total
        return self.mismatches == 0 and self.transitions_checked > 0 and complete
