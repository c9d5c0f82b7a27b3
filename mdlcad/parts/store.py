"""parts.json: every body of a device as it is kept in a build folder, and read back.

A ring is one line of text, ``x,y x,y ...`` in mm with Python's shortest exact decimals, without the closing point: the
coordinates come back bit for bit, and a person or a text comparison sees one ring a line.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import msgspec
from shapely import Polygon
from shapely.errors import ShapelyError

from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.stiffness import CarrierStiffness


@dataclass(frozen=True, slots=True)
class PartRecord:
    """A ``Body`` in plain types; ``section``, ``assembled`` and ``envelope`` are rings, the outer one first."""

    name: str
    kind: BodyKind
    plate: str
    z: float
    thickness: float
    throw: tuple[float, float]
    moves_with: tuple[str, ...]
    colour: str
    section: tuple[str, ...]
    assembled: tuple[str, ...] | None = None
    envelope: tuple[str, ...] | None = None


@dataclass(frozen=True, slots=True)
class Parts:
    """What parts.json holds: the bodies, and how stiff the carriers among them are."""

    bodies: tuple[PartRecord, ...]
    carriers: tuple[CarrierStiffness, ...]


def records_of(bodies: Sequence[Body]) -> tuple[PartRecord, ...]:
    """The bodies as they are stored."""
    return tuple(
        PartRecord(
            name=body.name,
            kind=body.kind,
            plate=body.plate,
            z=body.z,
            thickness=body.thickness,
            throw=body.throw,
            moves_with=body.moves_with,
            colour=body.colour,
            section=_rings(body.section),
            assembled=_rings(body.assembled) if body.assembled is not None else None,
            envelope=_rings(body.envelope) if body.envelope is not None else None,
        )
        for body in bodies
    )


def bodies_of(records: Sequence[PartRecord]) -> tuple[Body, ...]:
    """The bodies that were stored.

    Raises:
        msgspec.ValidationError: a ring is not one; the message names the body.
    """
    return tuple(
        Body(
            name=record.name,
            kind=record.kind,
            plate=record.plate,
            z=record.z,
            thickness=record.thickness,
            section=_polygon(record.name, record.section),
            throw=record.throw,
            moves_with=record.moves_with,
            colour=record.colour,
            assembled=_polygon(record.name, record.assembled) if record.assembled is not None else None,
            envelope=_polygon(record.name, record.envelope) if record.envelope is not None else None,
        )
        for record in records
    )


def _rings(shape: Polygon) -> tuple[str, ...]:
    return tuple(" ".join(f"{x!r},{y!r}" for x, y in ring.coords[:-1]) for ring in (shape.exterior, *shape.interiors))


def _polygon(name: str, rings: Sequence[str]) -> Polygon:
    try:
        outer, *holes = [[_point(pair) for pair in ring.split(" ")] for ring in rings]
        shape = Polygon(outer, holes)
    except (ValueError, ShapelyError) as problem:
        raise msgspec.ValidationError(f"body {name}: a ring is not a list of points: {problem}") from problem
    if not shape.is_valid:
        raise msgspec.ValidationError(f"body {name}: its rings cross or touch themselves")
    return shape


def _point(pair: str) -> tuple[float, float]:
    x, y = pair.split(",")
    return float(x), float(y)
