"""Screws through the rim of the whole stack: at its corners and between them, clear of what leaves the rim."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import shapely
from shapely import Polygon

from mdlcad.parts import palette
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.shapes import disc, pieces
from mdlcad.parts.stack import FRAME_REF, Stack

_STEP_MM = 1.0


def screw_bodies(stack: Stack, boundary: Polygon, notches: Sequence[Polygon]) -> list[Body]:
    """The screws, from the bottom of the stack to its top.

    One stands at every corner of the rim's middle line and others between, at most the process's pitch apart; where a
    notch or an edge is in the way, it stands at the nearest free place on the line, within half a pitch.
    """
    frame, wall = stack.process.frame, stack.process.pin.wall
    reach = frame.screw_hole / 2.0 + wall
    away = shapely.union_all([notch.buffer(reach) for notch in notches])
    free = shapely.difference(boundary.buffer(-reach), away)
    shapely.prepare(free)
    bodies: list[Body] = []
    for line in pieces(boundary.buffer(-frame.width / 2.0, join_style="mitre")):
        ring = line.exterior
        taken: list[shapely.Point] = []
        for along in _stations(ring, frame.screw_pitch):
            place = _nearest(ring, along, free, frame.screw_pitch / 2.0)
            if place is None or any(shapely.distance(place, other) < 4.0 * reach for other in taken):
                continue
            taken.append(place)
            x, y = round(place.x, 4), round(place.y, 4)
            name, section = f"screw.{len(bodies)}", disc(x, y, frame.screw / 2.0)
            ends = (stack.process.stack.plates[0].name, stack.process.stack.plates[-1].name)
            bodies.append(stack.upright(name, BodyKind.SCREW, *ends, section, (0.0, 0.0), FRAME_REF, palette.SCREW))
    return bodies


def screw_hole(stack: Stack, screw: Body) -> Polygon:
    """The clearance hole of a screw."""
    centre = screw.section.centroid
    return disc(round(centre.x, 4), round(centre.y, 4), stack.process.frame.screw_hole / 2.0)


def _stations(ring: shapely.LinearRing, pitch: float) -> list[float]:
    """Distances along the ring: every corner, and evenly between corners that are more than ``pitch`` apart."""
    found: list[float] = []
    start = 0.0
    for (x0, y0), (x1, y1) in pairwise(ring.coords):
        length = math.hypot(x1 - x0, y1 - y0)
        count = max(1, math.ceil(length / pitch))
        found += [start + length * index / count for index in range(count)]
        start += length
    return found


def _nearest(ring: shapely.LinearRing, along: float, free: Polygon, most: float) -> shapely.Point | None:
    for step in range(int(most / _STEP_MM)):
        for sign in (1.0, -1.0):
            place = ring.interpolate((along + sign * step * _STEP_MM) % ring.length)
            if shapely.contains(free, place):
                return place
    return None
