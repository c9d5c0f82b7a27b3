"""The bodies of both builds, read once for all levels that look at them."""

from __future__ import annotations

import msgspec

from mdlcad.compare.drawings import MOST_MM
from mdlcad.compare.folders import Build, NotComparable, read
from mdlcad.errors import UsageError
from mdlcad.parts.body import Body
from mdlcad.parts.store import Parts, bodies_of

Bodies = tuple[Body, ...]


def bodies_of_both(a: Build, b: Build) -> tuple[Bodies, Bodies] | NotComparable | UsageError:
    """The bodies of two builds, or why they cannot be had."""
    try:
        return read_bodies(a), read_bodies(b)
    except (NotComparable, UsageError) as problem:
        return problem


def read_bodies(build: Build) -> Bodies:
    """The bodies of a build.

    Raises:
        NotComparable: it has none, or another version wrote them.
        UsageError: they cannot be read, have one name twice, or sizes that no device has.
    """
    path = build.folder / "parts.json"
    try:
        bodies = bodies_of(read(build, "parts.json", Parts).bodies)
    except msgspec.ValidationError as problem:
        raise UsageError(f"{path}: {problem}; build it again") from None
    names = set()
    for body in bodies:
        if body.name in names:
            raise UsageError(f"{path}: has two bodies of the name {body.name}; build it again")
        names.add(body.name)
        if max(map(abs, (*body.section.bounds, body.z, body.thickness))) > MOST_MM:
            raise UsageError(f"{path}: body {body.name} is larger than {MOST_MM / 1000:g} m; it is damaged")
    return bodies
