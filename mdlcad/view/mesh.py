"""Bodies as merged triangle meshes, one a plate and kind of body, that can be moved, taken apart and coloured."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import manifold3d
import numpy as np

from mdlcad.parts.arcs import rings
from mdlcad.parts.body import Body, BodyKind
from mdlcad.view.built import Built
from mdlcad.view.motion import Floats, Follow, Follower, Ints

# The longest edge of a flexure's outline, mm: short enough that a bent beam looks bent.
_EDGE = 1.6

# Taken wholly apart, the gap between two plates is this share of the device's larger side: one sees between them.
_APART = 0.2

LOOSE = ("shims", "pins")
"""What is not cut from a plate, but lies or stands between plates."""

_FLEXURES = (BodyKind.UNIT, BodyKind.COUPLER, BodyKind.ROCKER, BodyKind.BIAS, BodyKind.GUIDE)


@dataclass(frozen=True, slots=True, eq=False)
class Outline:
    """A body as a prism: everything about it but its height is plane.

    Attributes:
        points: float[n, 2], the rings, one after the other, mm.
        ends: the number of points up to the end of each ring.
        caps: int[m, 3], triangles of the section.
        low, high: bottom and top face, mm; low_level, high_level: by how many gaps each is lifted in an exploded view.
        follow: how the points follow the references.
    """

    points: Floats
    ends: tuple[int, ...]
    caps: Ints
    low: float
    high: float
    low_level: int
    high_level: int
    follow: Follow


@dataclass(frozen=True, slots=True, eq=False)
class Merged:
    """All bodies of one plate and kind.

    Attributes:
        members: numbers of its bodies.
        points: float[n, 3], as assembled, mm; level: float[n], gaps by which each is lifted.
        first, second, share: how each follows the references (``motion.Follow``).
        faces: int[m, 3]; body: int[m], the number of the body that a face is of.
    """

    plate: str
    kind: BodyKind
    members: tuple[int, ...]
    points: Floats
    level: Floats
    first: Ints
    second: Ints
    share: Floats
    faces: Ints
    body: Ints

    def placed(self, gap: float, displacements: Floats | None) -> Floats:
        """float[n, 3], mm: the points with the plates ``gap`` mm further apart and the references displaced."""
        points = self.points.copy()
        points[:, 2] += gap * self.level
        if displacements is not None:
            share = self.share[:, None]
            points[:, :2] += (1.0 - share) * displacements[self.first] + share * displacements[self.second]
        return points


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """A device ready to be looked at.

    Attributes:
        plates: names of the plates, bottom to top, then "shims" and "pins" if there are any.
        outlines: one a body, in the order of the build's bodies.
        apart: largest gap between plates, mm.
    """

    built: Built
    plates: tuple[str, ...]
    outlines: tuple[Outline, ...]
    groups: tuple[Merged, ...]
    apart: float


def make_model(built: Built) -> Model:
    """The meshes of a build."""
    bodies = built.bodies
    bottoms = _bottoms(bodies)
    follower = Follower(built)
    outlines = tuple(_outline(body, bottoms, follower) for body in bodies)
    keys: dict[tuple[str, BodyKind], list[int]] = {}
    for number, body in enumerate(bodies):
        keys.setdefault((body.plate, body.kind), []).append(number)
    groups = tuple(_merge(plate, kind, members, outlines) for (plate, kind), members in keys.items())
    bounds = np.array([body.section.bounds for body in bodies])
    side = float((bounds[:, 2:].max(axis=0) - bounds[:, :2].min(axis=0)).max())
    loose = [plate for plate in LOOSE if any(body.plate == plate for body in bodies)]
    return Model(built, (*bottoms, *loose), outlines, groups, _APART * side)


def _bottoms(bodies: Sequence[Body]) -> dict[str, float]:
    """Bottom face of every plate, mm, from the lowest plate up."""
    bottoms: dict[str, float] = {}
    for body in bodies:
        if body.plate not in LOOSE:
            bottoms[body.plate] = min(bottoms.get(body.plate, body.z), body.z)
    return dict(sorted(bottoms.items(), key=lambda item: item[1]))


def _outline(body: Body, bottoms: dict[str, float], follower: Follower) -> Outline:
    """The outline of a body as it stands in the assembled device."""
    section = body.section if body.assembled is None else body.assembled
    parts = [_divided(ring) if body.kind in _FLEXURES else ring for ring in rings(section)]
    caps = np.asarray(manifold3d.triangulate(parts), dtype=np.int64)
    ends = tuple(int(end) for end in np.cumsum([len(part) for part in parts]))
    points, top = np.concatenate(parts), body.z + body.thickness
    follow = follower.follow(body, points)
    if body.plate in bottoms:
        low = high = list(bottoms).index(body.plate)
    else:
        # pins and posts are drawn out between the plates that they join
        low, high = _level(body.z, bottoms), _level(top - 1e-3, bottoms)
    return Outline(points, ends, caps, body.z, top, low, high, follow)


def _level(z: float, bottoms: dict[str, float]) -> int:
    """Number of the plate at or below a height."""
    return max(sum(bottom <= z + 1e-6 for bottom in bottoms.values()) - 1, 0)


def _divided(ring: Floats) -> Floats:
    """A ring with points put into its long edges."""
    parts = []
    for start, end in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        count = max(1, math.ceil(float(np.hypot(*(end - start))) / _EDGE))
        parts.append(start + (end - start) * (np.arange(count) / count)[:, None])
    return np.concatenate(parts)


def _merge(plate: str, kind: BodyKind, members: Sequence[int], outlines: Sequence[Outline]) -> Merged:
    points, levels, follows, faces, owners = [], [], [], [], []
    start = 0
    for number in members:
        outline = outlines[number]
        n = len(outline.points)
        for z, level in ((outline.low, outline.low_level), (outline.high, outline.high_level)):
            points.append(np.column_stack([outline.points, np.full(n, z)]))
            levels.append(np.full(n, float(level)))
            follows.append(outline.follow)
        found = start + np.concatenate([outline.caps[:, ::-1], outline.caps + n, _walls(outline)])
        faces.append(found)
        owners.append(np.full(len(found), number, dtype=np.int64))
        start += 2 * n
    return Merged(
        plate,
        kind,
        tuple(members),
        np.concatenate(points),
        np.concatenate(levels),
        np.concatenate([follow.first for follow in follows]),
        np.concatenate([follow.second for follow in follows]),
        np.concatenate([follow.share for follow in follows]),
        np.concatenate(faces),
        np.concatenate(owners),
    )


def _walls(outline: Outline) -> Ints:
    """int[2 n, 3], the triangles between the bottom points 0..n-1 and the top points n..2n-1, facing outwards."""
    n = len(outline.points)
    here = np.arange(n, dtype=np.int64)
    after = here + 1
    begin = 0
    for end in outline.ends:
        after[end - 1] = begin
        begin = end
    return np.concatenate([np.column_stack([here, after, after + n]), np.column_stack([here, after + n, here + n])])
