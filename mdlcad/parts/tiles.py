"""Plates larger than the machine's bed, cut into tiles that fit it and join by dovetails.

A plate falls into pieces; those that fit the bed stay as they are. A larger one is cut by straight seams through what
is rigid and stands still or is one sheet (rims, ribs, base, cover, clock plates), never through a unit, a flexure or a
carrier. Every crossing of a seam has a dovetail: its tongue is on the tile to the left of (or below) the seam, its
socket is wider by the clearance, and tiles are put together from above. A rib is too narrow for that: it is crossed
in the middle of a rib post alone, whose square then stands in a notch of either end and holds both. Seams of
neighbouring plates are looked for from opposite sides, so that the screws through the stack tie each seam to a plate
that has none there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import shapely
from shapely import Geometry, MultiPolygon, Polygon
from shapely.affinity import affine_transform

from mdlcad.mechanics.process import Process
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.shapes import GRID, box, pieces

DIVISIBLE = (BodyKind.FRAME, BodyKind.BASE, BodyKind.COVER, BodyKind.CLOCK, BodyKind.SPACER)
"""What a seam may cross. All else bends, or has to be as stiff as one piece."""

_STEP_MM = 0.5
_APART_MM = 5.0
# holes smaller than this are for pins, posts and screws; a larger opening is the inside of a rim
_HOLE_MM2 = 400.0


@dataclass(frozen=True, slots=True)
class Joint:
    """Dimensions of a dovetail, mm.

    Attributes:
        neck, head, depth: of the tongue, at its root, at its end and from one to the other.
        wall: what has to be left around it. clearance: by which the socket is wider, all around.
        pitch: dovetails along a seam are about this far apart.
    """

    neck: float
    head: float
    depth: float
    wall: float
    clearance: float
    pitch: float


@dataclass(frozen=True, slots=True)
class Tile:
    """What is made in one go: bodies of one plate, cut ones numbered; moved only if they fit no tile in their place."""

    name: str
    plate: str
    bodies: tuple[Body, ...]


@dataclass(frozen=True, slots=True)
class Untiled:
    """A piece that is larger than the bed and has no legal seam: its bodies, where it is, its larger side in mm."""

    bodies: tuple[str, ...]
    x: float
    y: float
    size: float
    reason: str


@dataclass(frozen=True, slots=True)
class Tiling:
    """The tiles of a plate, and what could not be made to fit (it is then in no tile)."""

    tiles: tuple[Tile, ...]
    untiled: tuple[Untiled, ...]


def joint_of(process: Process) -> Joint:
    """The dovetail of a process, from the wall that it leaves around a press-fit pin.

    The neck is two and a half such walls, the head four and a half (with a wall on either side it fits every shipped
    rim) and the tongue two deep, so its flanks lean 1 in 2. The clearance is twice the repeatability, since each of two
    edges may be off by one; along the joint that is a play of sqrt(5) clearances, until the screws hold the stack.
    """
    wall = process.pin.wall
    return Joint(2.5 * wall, 4.5 * wall, 2.0 * wall, wall, 2.0 * process.machine.repeatability, 30.0 * wall)


def fits(shape: Geometry, bed: tuple[float, float]) -> bool:
    """Whether a shape fits the bed, either way round."""
    width, height = _extent(shape)
    return (width <= bed[0] and height <= bed[1]) or (width <= bed[1] and height <= bed[0])


def tiles_of(plate: str, bodies: Sequence[Body], process: Process) -> Tiling:
    """The tiles of one plate's bodies; one tile with all of them if the plate fits the bed."""
    bed = process.machine.bed
    if fits(_together(bodies), bed):
        return Tiling((Tile(plate, plate, tuple(bodies)),), ())
    whole = shapely.union_all([body.section for body in bodies], grid_size=GRID)
    levels = [item.name for item in process.stack.plates]
    backwards = plate in levels and levels.index(plate) % 2 == 1
    joint = joint_of(process)
    cut: list[list[Body]] = []
    loose: list[list[Body]] = []
    untiled: list[Untiled] = []
    for piece in pieces(whole):
        members = [body for body in bodies if _inside(body.section, piece)]
        if fits(piece, bed):
            loose.append(members)
            continue
        fixed = [body.section for body in members if body.kind not in DIVISIBLE]
        studs = _studs(members, process.pin.side)
        keep_out = _keep_out(piece, fixed, studs, joint)
        ways = [_cut(piece, keep_out, studs, joint, way, backwards) for way in (bed, bed[::-1])]
        found = [parts for parts in ways if isinstance(parts, list)]
        if found:
            for part in min(found, key=len):
                cut.append(list(_bodies_in(members, part, len(cut) + 1)))
        else:
            size, middle = max(_extent(piece)), piece.representative_point()
            names = tuple(sorted({body.name for body in members if body.kind not in DIVISIBLE}))
            reason = str(ways[0])
            untiled.append(Untiled(names or (members[0].name,), middle.x, middle.y, size, reason))
    groups: list[list[Body]] = []
    for part in cut:
        groups += _placed(groups, [part], bed, 2.0 * joint.clearance)
    groups += _packed(_placed(groups, loose, bed, 2.0 * joint.clearance), bed)
    tiles = [Tile(f"{plate}-{number}", plate, tuple(group)) for number, group in enumerate(groups, start=1)]
    return Tiling(tuple(tiles), tuple(untiled))


def _extent(shape: Geometry) -> tuple[float, float]:
    x0, y0, x1, y1 = shape.bounds
    return x1 - x0, y1 - y0


def _inside(section: Polygon, piece: Polygon) -> bool:
    return bool(shapely.dwithin(piece, section.representative_point(), GRID))


def _studs(members: Sequence[Body], side: float) -> MultiPolygon:
    """The holes of rib posts: the square ones in what stands still."""
    holes = [Polygon(ring) for body in members if body.kind is BodyKind.FRAME for ring in body.section.interiors]
    return MultiPolygon([hole for hole in holes if len(hole.exterior.coords) == 5 and _is_square(hole, side)])


def _is_square(hole: Polygon, side: float) -> bool:
    return all(abs(length - side) < 2.0 * GRID for length in _extent(hole))


def _keep_out(piece: Polygon, fixed: Sequence[Polygon], studs: MultiPolygon, joint: Joint) -> Geometry:
    """Where no seam may be: at what must stay whole, and within a wall of holes but those of rib posts."""
    holes = [Polygon(ring) for ring in piece.interiors]
    small = [hole for hole in holes if hole.area < _HOLE_MM2 and not shapely.intersects(studs, hole)]
    return shapely.union_all([*fixed, *(hole.buffer(joint.wall, join_style="mitre") for hole in small)])


def _cut(
    piece: Polygon, keep_out: Geometry, studs: MultiPolygon, joint: Joint, bed: tuple[float, float], backwards: bool
) -> list[Polygon] | str:
    """Parts of ``piece`` that fit the bed, cut for a bed that lies as given; why there are none, in words."""
    if fits(piece, bed):
        return [piece]
    for axis in (0, 1):
        size = _extent(piece)[axis]
        if size <= bed[axis]:
            continue
        turned = (_swapped(piece), _swapped(keep_out), _swapped(studs)) if axis else (piece, keep_out, studs)
        sides = _split(turned[0], turned[1], turned[2], joint, bed[axis], backwards)
        if sides is None:
            low, high = piece.bounds[axis], piece.bounds[axis + 2]
            return (
                f"{size:.1f} mm in {'xy'[axis]}, the bed {bed[axis]:g}; no straight seam between {low:.1f} and "
                f"{high:.1f} has room for its dovetails and crosses neither a flexure, a carrier nor a hole"
            )
        parts: list[Polygon] = []
        for side in sides:
            for part in pieces(_swapped(side) if axis else side):
                found = _cut(part, keep_out, studs, joint, bed, backwards)
                if isinstance(found, str):
                    return found
                parts += found
        return parts
    return [piece]


def _swapped(shape: Geometry) -> Geometry:
    """``shape`` with x and y exchanged."""
    return affine_transform(shape, [0.0, 1.0, 1.0, 0.0, 0.0, 0.0])


def _split(
    piece: Polygon, keep_out: Geometry, studs: MultiPolygon, joint: Joint, most: float, backwards: bool
) -> tuple[Geometry, Geometry] | None:
    """Both sides of the best seam x = c of which at least one is no wider than ``most``; None if there is none."""
    shapely.prepare(piece)
    shapely.prepare(keep_out)
    x0, y0, x1, y1 = piece.bounds
    for c in _candidates((x0, x1), studs, joint, most, backwards):
        tongues = _tongues(piece, keep_out, studs, joint, c)
        if tongues:
            left = shapely.union_all([box(x0 - 1.0, y0 - 1.0, c, y1 + 1.0), *tongues], grid_size=GRID)
            socket = left.buffer(joint.clearance, join_style="mitre")
            return (
                shapely.intersection(piece, left, grid_size=GRID),
                shapely.difference(piece, socket, grid_size=GRID),
            )
    return None


def _candidates(
    extent: tuple[float, float], studs: MultiPolygon, joint: Joint, most: float, backwards: bool
) -> list[float]:
    """Seams to try: from the farthest one that the first tile reaches, back towards the start."""
    x0, x1 = extent
    low, high = (x1 - most, x1 - 2.0 * joint.depth) if backwards else (x0 + 2.0 * joint.depth, x0 + most - joint.depth)
    start = low if backwards else high
    found = [float(x) for x in np.arange(low, high, _STEP_MM)]
    # a rib can be crossed at its posts alone
    found += [stud.centroid.x for stud in studs.geoms if low <= stud.centroid.x <= high]
    return sorted({round(c, 4) for c in (*found, high)}, key=lambda c: abs(c - start))


def _tongues(piece: Polygon, keep_out: Geometry, studs: MultiPolygon, joint: Joint, c: float) -> list[Polygon]:
    """The tongues of the seam x = c, one a crossing or more but for those at rib posts; none if it is not legal."""
    _, y0, _, y1 = piece.bounds
    line = shapely.LineString([(c, y0 - 1.0), (c, y1 + 1.0)])
    near = [stud for stud in studs.geoms if shapely.dwithin(stud, line, joint.wall)]
    if shapely.intersects(keep_out, line) or any(abs(stud.centroid.x - c) > 2.0 * GRID for stud in near):
        return []
    crossing = shapely.intersection(piece, line)
    found: list[Polygon] = []
    for part in getattr(crossing, "geoms", [crossing]):
        low, high = part.bounds[1], part.bounds[3]
        if shapely.dwithin(part, keep_out, joint.wall):
            return []
        if high - low < joint.head and any(shapely.dwithin(part, stud, GRID) for stud in near):
            continue
        count = max(1, int((high - low) / joint.pitch))
        own = [_tongue(piece, keep_out, joint, c, a, b) for a, b in pairwise(np.linspace(low, high, count + 1))]
        made = [tongue for tongue in own if tongue is not None]
        if not made:
            return []
        found += made
    return found


def _tongue(piece: Polygon, keep_out: Geometry, joint: Joint, c: float, low: float, high: float) -> Polygon | None:
    """A tongue on x = c between two heights, as near to their middle as it can be."""
    half, middle = joint.head / 2.0 + joint.clearance, (low + high) / 2.0
    room = (high - low) / 2.0 - half
    for away in np.arange(0.0, max(room, 0.0) + _STEP_MM / 2.0, _STEP_MM):
        for y in (middle + away, middle - away):
            around = joint.wall + half
            zone = box(c - joint.wall, y - around, c + joint.depth + joint.clearance + joint.wall, y + around)
            if shapely.covers(piece, zone) and not shapely.intersects(keep_out, zone):
                neck, head, end = joint.neck / 2.0, joint.head / 2.0, c + joint.depth
                # it begins inside its tile, so that tile and tongue are one
                return Polygon(
                    [
                        (c - joint.wall / 2.0, y - neck),
                        (c, y - neck),
                        (end, y - head),
                        (end, y + head),
                        (c, y + neck),
                        (c - joint.wall / 2.0, y + neck),
                    ]
                )
    return None


def _bodies_in(members: Sequence[Body], part: Polygon, number: int) -> Iterator[Body]:
    for body in members:
        if body.kind not in DIVISIBLE:
            if _inside(body.section, part):
                yield body
            continue
        for index, piece in enumerate(pieces(shapely.intersection(body.section, part, grid_size=GRID))):
            name = f"{body.name}/{number}" if index == 0 else f"{body.name}/{number}.{index}"
            yield replace(body, name=name, section=piece)


def _placed(
    groups: Sequence[list[Body]], loose: Sequence[list[Body]], bed: tuple[float, float], apart: float
) -> list[list[Body]]:
    """Add pieces, in their places, to the tiles that have room for them and no part so near; those that are left."""
    left = []
    for piece in loose:
        alone = _together(piece)
        for group in groups:
            there = _together(group)
            if fits(shapely.GeometryCollection([there, alone]), bed) and shapely.distance(there, alone) > apart:
                group += piece
                break
        else:
            left.append(piece)
    return left


def _together(bodies: Sequence[Body]) -> Geometry:
    return shapely.GeometryCollection([body.section for body in bodies])


def _packed(loose: Sequence[list[Body]], bed: tuple[float, float]) -> list[list[Body]]:
    """Loose pieces on beds of their own: side by side on shelves, the highest first."""
    sheets: list[list[Body]] = []
    x = y = shelf = 0.0
    extents = {id(piece): _together(piece).bounds for piece in loose}
    for piece in sorted(loose, key=lambda piece: extents[id(piece)][1] - extents[id(piece)][3]):
        x0, y0, x1, y1 = extents[id(piece)]
        width, height = x1 - x0, y1 - y0
        turned = width > bed[0] or height > bed[1]
        if turned:
            width, height = height, width
        if x + width > bed[0]:
            x, y, shelf = 0.0, y + shelf + _APART_MM, 0.0
        if not sheets or y + height > bed[1]:
            sheets.append([])
            x = y = shelf = 0.0
        # a quarter turn anticlockwise about the origin takes (x, y) to (-y, x)
        turn = [0.0, -1.0, 1.0, 0.0, x + y1, y - x0] if turned else [1.0, 0.0, 0.0, 1.0, x - x0, y - y0]
        sheets[-1] += [replace(body, section=affine_transform(body.section, turn)) for body in piece]
        x, shelf = x + width + _APART_MM, max(shelf, height)
    return sheets
