"""A body: one rigid or flexing piece of one plate, as a prism over a polygon in the x-y plane."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from shapely import Polygon


class BodyKind(StrEnum):
    """What a body is for."""

    FRAME = "frame"
    BASE = "base"
    COVER = "cover"
    CLOCK = "clock"
    GUIDE = "guide"
    UNIT = "unit"
    TRUNK = "trunk"
    RUNG = "rung"
    TAB = "tab"
    COUPLER = "coupler"
    ROCKER = "rocker"
    BIAS = "bias"
    PIN = "pin"
    POST = "post"
    SCREW = "screw"
    SPACER = "spacer"


@dataclass(frozen=True, slots=True)
class Body:
    """One named, coloured solid.

    Attributes:
        name: unique in the device; readable ("unit.heading[0]", "rung.heading[0].3").
        plate: the plate it is cut from; pins and posts have their own ("pins").
        z: bottom face, mm; thickness: mm.
        section: the polygon as cut (unstrained), mm, in its place in the device.
        assembled: the polygon in the assembled device where assembly strains it, else None (same as ``section``).
        throw: half amplitudes (x, y) of its motion, mm; flexures sweep at most this.
        moves_with: names of the bodies of reference it is attached to: "mass:NAME" (moves in y), "clock:K" (moves in
            x), "frame". A rigid body has one, a flexure has the two or three that it joins. Bodies that share one
            are not checked against each other's motion, only against overlap.
        colour: "#rrggbb".
        envelope: the region that a flexure covers over its motion, where that is less than its section swept by
            ``throw`` (its anchors stand still); None for rigid bodies, whose swept section is exact.
    """

    name: str
    kind: BodyKind
    plate: str
    z: float
    thickness: float
    section: Polygon
    throw: tuple[float, float]
    moves_with: tuple[str, ...]
    colour: str
    assembled: Polygon | None = None
    envelope: Polygon | None = None
