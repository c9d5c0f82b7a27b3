"""What a channel has to hold: trunks and the items that hang on them, before tracks and plates are chosen.

x positions are counted in multiples of ``RESOLUTION`` (see ``placement.grid``); an edge is either fixed or a fixed
distance from a trunk's centre. Heights (y) are known from the placement.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import StrEnum

from mdlcad.placement.grid import RESOLUTION


class Role(StrEnum):
    """What an item is: hub to trunk, trunk to target, hub to target, a bias leaf, trunk to port, hub to port,
    a passing tab."""

    SOURCE = "source"
    COUPLER = "coupler"
    STRAIGHT = "straight"
    BIAS = "bias"
    TAB = "tab"
    STRAIGHT_TAB = "straight tab"
    GUEST = "guest"


def units(length: float) -> int:
    """A length in counts, rounded up (clearances are never rounded away)."""
    return math.ceil(length / RESOLUTION - 1e-6)


@dataclass(frozen=True, slots=True)
class Edge:
    """An x position in counts: ``at``, or the centre of trunk ``trunk`` plus ``at``."""

    at: int
    trunk: int | None = None


@dataclass(frozen=True, slots=True)
class TrunkPiece:
    """A trunk to be given a track: ``domain`` are the intervals (counts) its centre may take; y in mm."""

    net: str
    domain: tuple[tuple[int, int], ...]
    y_low: float
    y_high: float


@dataclass(frozen=True, slots=True)
class Item:
    """One thing on a rung plate.

    Attributes:
        net: the mass whose carrier (or bias leaf) it is.
        ref: coupling name, port bit or mass name.
        hubs: the (mass, side) hub sides it is fixed to; no two items share one on a plate.
        y_low, y_high: its height at rest, mm.
        left, right: its reach in x; ``span`` replaces both for a tab in y, whose bend may lie on either side.
        trunk: index of the trunk whose pin it needs at that trunk's centre, or None.
        post: where its fixed post stands (counts), or None.
        plate: index of the plate it must lie on (a tab that passes hub columns lies on one in several channels).
        ceiling: index of the highest plate it may lie on, or None: higher, its pins would be too soft or tilt its hub.
        floor: of a net whose unit is in the other deck, above all of these plates: index of the lowest it may lie on.
        rises: (x_low, x_high, y_low, y_high) of a second rectangle on the same plate: a tab's vertical part.
    """

    role: Role
    net: str
    ref: str
    hubs: tuple[tuple[str, int], ...]
    y_low: float
    y_high: float
    left: Edge
    right: Edge
    trunk: int | None = None
    post: int | None = None
    bend: int | None = None
    plate: int | None = None
    ceiling: int | None = None
    floor: int | None = None
    rises: tuple[int, int, float, float] | None = None


@dataclass(slots=True)
class Channel:
    """All pieces of one channel. ``trouble`` names what can have no legal track at all."""

    index: int
    trunks: list[TrunkPiece] = field(default_factory=list)
    items: list[Item] = field(default_factory=list)
    trouble: list[str] = field(default_factory=list)
