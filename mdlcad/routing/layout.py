"""The layout artefact: every carrier, coupler, bias leaf and tab, as axis-parallel pieces in millimetres.

A net (one source mass and all its couplings) is one rigid *carrier*: trunks on the plate V, rungs on the plates
H0, H1, ..., joined by square pins, pinned to the source's shuttle and moving in y with it. At each target the carrier
ends where the coupler's flexure begins; the coupler ends in a block pinned to the target's shuttle.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from msgspec import UNSET, UnsetType

from mdlcad.mechanics.decks import Deck


class Side(StrEnum):
    """Side of a hub. The left side of a hub looks at lower x."""

    LEFT = "left"
    RIGHT = "right"


class EndKind(StrEnum):
    """How an end of a rung is held.

    HUB: rigidly pinned to the shuttle of the net's own source mass.
    VIA: pinned to the net's trunk on plate V.
    COUPLER: continues as the flexure of one coupling of the net, to the target's hub.
    TAB: continues as a tab through the rim to a sensor or actuator place.
    """

    HUB = "hub"
    VIA = "via"
    COUPLER = "coupler"
    TAB = "tab"


@dataclass(frozen=True, slots=True)
class RungEnd:
    """An end of a rung.

    Attributes:
        x: where the bar ends, mm: hub centre for HUB, trunk centre for VIA, start of the flexure for COUPLER, the
            place's x (or the bend's x for a tab in y) for TAB.
        ref: mass name (HUB), coupling name (COUPLER), port bit (TAB), trunk name (VIA).
    """

    kind: EndKind
    x: float
    ref: str


@dataclass(frozen=True, slots=True)
class Rung:
    """A horizontal bar of a carrier at height y on a rung plate; ``left.x < right.x``."""

    name: str
    net: str
    plate: str
    y: float
    left: RungEnd
    right: RungEnd


@dataclass(frozen=True, slots=True)
class Trunk:
    """A vertical bar of a carrier on plate V, from y_low to y_high (centres of its extreme rungs).

    Attributes:
        deck: whose plate V; left out of the file of a device with one unit plate.
    """

    name: str
    net: str
    x: float
    y_low: float
    y_high: float
    deck: Deck | UnsetType = UNSET


@dataclass(frozen=True, slots=True)
class BiasLeaf:
    """The preloaded leaf of a biased mass: from its hub's block to a fixed post, on a rung plate."""

    mass: str
    plate: str
    side: Side
    post_x: float
    post_y: float


@dataclass(frozen=True, slots=True)
class CouplerLeaf:
    """The flexure of one coupling: from the carrier's bar at start_x to the target's hub, on the rung's plate.

    post_x is the fixed pivot of a rocker (a negative coupling), else None.
    """

    coupling: str
    plate: str
    side: Side
    start_x: float
    y: float
    post_x: float | None


@dataclass(frozen=True, slots=True)
class Tab:
    """The outer piece of a port: on ``plate`` from the rung's end through the rim to the place on the boundary.

    path: centre line, mm; the last point is the place on the boundary plus the tab's overhang along the normal.
    """

    bit: str
    net: str
    plate: str
    path: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class Layout:
    """All routed pieces. ``unrealised``: couplings that could not be given a part, by name, with the reason."""

    rungs: tuple[Rung, ...]
    trunks: tuple[Trunk, ...]
    couplers: tuple[CouplerLeaf, ...]
    biases: tuple[BiasLeaf, ...]
    tabs: tuple[Tab, ...]
    unrealised: tuple[tuple[str, str], ...]
    seed: int
