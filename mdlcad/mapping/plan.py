"""The mapped logic before it has names and forces: masses by key, each a threshold gate of other masses."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

from mdlcad.mapping.threshold import Threshold
from mdlcad.mapping.tickring import RingPlan


class Role(StrEnum):
    """What a planned mass is.

    LOGIC is a node of the subject graph in some phase (a gate, or a buffer of itself one phase earlier); SENSOR is a
    sensor itself; TERM, HOLD, STORE and FOLLOW are a register's set terms, hold, r and q; LOAD a gated tick; PORT an
    actuator's own mass; STAGE and TICK belong to the tick ring.
    """

    SENSOR = "sensor"
    LOGIC = "logic"
    LOAD = "load"
    TERM = "term"
    HOLD = "hold"
    STORE = "store"
    FOLLOW = "follow"
    PORT = "port"
    STAGE = "stage"
    TICK = "tick"


class Key(NamedTuple):
    """A planned mass: its role, what it is of, and its phase. A tuple, as the search hashes millions of them.

    ``of`` is (node,) for SENSOR and LOGIC, (literal,) for LOAD, (load or -1, literal) for TERM, (register index,) for
    HOLD, STORE and FOLLOW, (output index,) for PORT, (stage,) for STAGE and () for TICK. ``twin`` counts the masses
    that compute the same because one alone has too many targets.
    """

    role: Role
    of: tuple[int, ...]
    phase: int
    twin: int = 0


@dataclass(frozen=True, slots=True)
class PlannedMass:
    """A mass that computes ``function`` of ``sources``; a SENSOR and a constant PORT have none."""

    key: Key
    sources: tuple[Key, ...]
    function: Threshold


@dataclass(frozen=True, slots=True)
class Plan:
    """All masses of a device.

    Attributes:
        ring: the tick ring, None for a device without state.
        tick_cycle: the cycle of every decision (0 .. ring.cycles - 1) in which the set terms see the tick.
        cycles: power-clock cycles a decision.
        carriers: for every output the mass that shows it, not inverted.
    """

    masses: tuple[PlannedMass, ...]
    ring: RingPlan | None
    tick_cycle: int
    cycles: int
    carriers: tuple[Key, ...]
