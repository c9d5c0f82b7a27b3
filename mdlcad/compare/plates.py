"""The plates: for each, the area in which A and B differ and where; as drawn in parts.json and as written to files."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mdlcad.compare.change import Change, FieldChange, Sort, Spot
from mdlcad.compare.drawings import KINDS, read_drawing
from mdlcad.compare.fields import counted, largest_first
from mdlcad.compare.folders import NotComparable
from mdlcad.compare.pair import Findings, Pair
from mdlcad.compare.sections import GRID_MM, Difference, difference
from mdlcad.errors import UsageError
from mdlcad.parts.body import Body
from mdlcad.parts.plates import plates_of

DRAWN = "parts.json"
# A plate lists no more places than this; the words tell how many there are.
MOST_SPOTS = 200


@dataclass(frozen=True, slots=True)
class _Found:
    """A difference of one plate and the sources ("parts.json", "dxf", ...) that show it."""

    difference: Difference
    sources: tuple[str, ...]


def plate_changes(pair: Pair) -> Findings:
    """Changes of the plates, largest first, and remarks; trouble: a file that differs cannot be read, or the two
    engines disagree.

    Raises:
        NotComparable: one side has no plates at all.
    """
    notes: list[str] = []
    troubles: list[str] = []
    unread: list[str] = []
    try:
        a, b = pair.drawn()
        drawn_a, drawn_b = plates_of(a), plates_of(b)
    except (NotComparable, UsageError) as problem:  # the second is told at the level of parts
        drawn_a, drawn_b = {}, {}
        notes.append(f"{problem}; the plates' files are compared instead")
    names_a, names_b = _names(pair.a.hashes, drawn_a), _names(pair.b.hashes, drawn_b)
    for names, build in ((names_a, pair.a), (names_b, pair.b)):
        if not names:
            raise NotComparable(f"{build.label} has no plates", "plates/")
    changes = [Change("plate", name, Sort.REMOVED) for name in names_a if name not in names_b]
    changes += [Change("plate", name, Sort.ADDED) for name in names_b if name not in names_a]
    for name in names_a:
        if name in names_b:
            found = _differences(pair, name, drawn_a.get(name), drawn_b.get(name), unread, troubles)
            changes += [_change(name, item, (*drawn_a.get(name, ()), *drawn_b.get(name, ()))) for item in found]
    if unread:
        notes.append(f"{counted(len(unread), 'STEP file')} of plates differ too and were not read: {', '.join(unread)}")
    return Findings(largest_first(changes), notes, troubles)


def _names(files: Iterable[str], drawn: Mapping[str, object]) -> list[str]:
    """Plates that are drawn (bottom first), then those that only files know."""
    written = [name.split("/", 1)[1].rpartition(".")[0] for name in files if name.startswith("plates/")]
    return list(dict.fromkeys((*drawn, *sorted(written))))


def _differences(
    pair: Pair,
    plate: str,
    a: Sequence[Body] | None,
    b: Sequence[Body] | None,
    unread: list[str],
    troubles: list[str],
) -> list[_Found]:
    found: list[_Found] = []

    def note(source: str, name: str, one: Callable[[], BaseGeometry], other: Callable[[], BaseGeometry]) -> None:
        try:
            _note(found, difference(name, one(), other(), pair.tolerance_mm), source)
        except UsageError as problem:
            troubles.append(str(problem))

    if a is not None and b is not None and not _same_sections(a, b):
        note(DRAWN, f"plate {plate}", partial(_union, a), partial(_union, b))
    for kind in KINDS:
        name = f"plates/{plate}.{kind}"
        if name not in pair.a.hashes or name not in pair.b.hashes or pair.a.hashes[name] == pair.b.hashes[name]:
            continue
        if kind == "step" and found:
            # slow to read, and the other files already show what changed
            unread.append(name)
            continue
        note(kind, name, partial(read_drawing, pair.a.folder / name), partial(read_drawing, pair.b.folder / name))
    return [item for item in found if item.difference.area > 0.0]


def _note(found: list[_Found], new: Difference, source: str) -> None:
    """Add a difference, to the sources of one already found if it is the same."""
    for index, item in enumerate(found):
        if _same(item.difference, new):
            found[index] = replace(item, sources=(*item.sources, source))
            return
    found.append(_Found(new, (source,)))


def _same(a: Difference, b: Difference) -> bool:
    """Of the same area, side by side and at the same extremes, but for the rounding of file formats."""
    slack = 0.01 * max(a.area, b.area) + 1e-3
    return (
        abs(a.only_a - b.only_a) <= slack and abs(a.only_b - b.only_b) <= slack and bool(a.patches) == bool(b.patches)
    )


def _same_sections(a: Sequence[Body], b: Sequence[Body]) -> bool:
    by_name = {body.name: body.section for body in a}
    return len(a) == len(b) and all(
        body.name in by_name and shapely.equals_exact(by_name[body.name], body.section, tolerance=0.0) for body in b
    )


def _union(bodies: Sequence[Body]) -> BaseGeometry:
    return shapely.union_all([body.section for body in bodies], grid_size=GRID_MM)


def _change(plate: str, found: _Found, bodies: Sequence[Body]) -> Change:
    result = found.difference
    spots = tuple(
        Spot(plate, patch.box, patch.area, _bodies_at(patch.box, bodies, DRAWN in found.sources))
        for patch in result.patches[:MOST_SPOTS]
    )
    where = spots[0]
    centre = ((where.box[0] + where.box[2]) / 2, (where.box[1] + where.box[3]) / 2)
    there = f" ({', '.join(where.bodies[:3])})" if where.bodies else ""
    words = (
        f"{result.area:.4g} mm2 differ ({result.only_a:.4g} gone, {result.only_b:.4g} new) at "
        f"{counted(len(result.patches), 'place')}, the largest, {where.area_mm2:.4g} mm2, at "
        f"({centre[0]:.2f}, {centre[1]:.2f}) mm{there}; seen in {', '.join(found.sources)}"
    )
    fields = (
        FieldChange("only in A, mm2", round(result.only_a, 6), None),
        FieldChange("only in B, mm2", None, round(result.only_b, 6)),
        FieldChange("all of it by KLayout and by Shapely, mm2", round(result.raw, 6), round(result.checked, 6)),
    )
    return Change("plate", plate, Sort.CHANGED, words, fields, round(result.area, 6), "mm2", spots)


def _bodies_at(box: tuple[float, float, float, float], bodies: Sequence[Body], drawn: bool) -> tuple[str, ...]:
    """Bodies that reach into a box, if the difference is ``drawn`` only those that differ; those with the least extent
    first, for they are the ones meant."""
    place = shapely.box(*box)
    sections: dict[str, list[Polygon]] = {}
    for body in bodies:
        sections.setdefault(body.name, []).append(body.section)
    named = []
    for name, shapes in sections.items():
        changed = len(shapes) != 2 or not shapely.equals_exact(shapes[0], shapes[1], tolerance=0.0)
        if (changed or not drawn) and any(shapely.intersects(shape, place) for shape in shapes):
            named.append((shapes[0].envelope.area, name))
    return tuple(name for _, name in sorted(named)[:8])
