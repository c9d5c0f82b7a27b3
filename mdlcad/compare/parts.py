"""The parts: bodies by name, the sizes they were given, and the bill of materials."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import hypot

import shapely
from shapely import Polygon, affinity

from mdlcad.compare.change import Change, FieldChange, Sort, Spot
from mdlcad.compare.fields import counted, field_changes, keyed_changes, largest_first, same_number, worded
from mdlcad.compare.folders import NotComparable, read
from mdlcad.compare.pair import Findings, Pair
from mdlcad.errors import UsageError
from mdlcad.mechanics import Process, Sizing
from mdlcad.mechanics.compensation import COMPENSATION_FILE, Compensation, compensated
from mdlcad.mechanics.decks import two_decks
from mdlcad.parts.body import Body
from mdlcad.parts.bom import bill_of_materials
from mdlcad.parts.store import Parts

# shapes are compared by themselves
_SHAPES = frozenset({"section", "assembled", "envelope", "name"})
# fields of a sizing that are lengths in mm, for which the tolerance is meant
_LENGTHS = frozenset({"preload", "amplitude", "offset", "reach", "sweep", "clearance"})


def part_changes(pair: Pair) -> Findings:
    """Changes of bodies (largest first), of their sizes, and of the bill of materials.

    Raises:
        NotComparable: neither bodies nor sizes are there to compare.
    """
    changes: list[Change] = []
    notes: list[str] = []
    troubles: list[str] = []
    apart: list[str] = []
    looks = (_bodies, _carriers, _sizes)
    for look in looks:
        try:
            changes += look(pair)
        except NotComparable as problem:
            notes.append(str(problem))
            apart.append(problem.file)
        except UsageError as problem:
            troubles.append(str(problem))
    if len(apart) == len(looks):
        raise NotComparable("; ".join(dict.fromkeys(notes)), apart[0])
    return Findings(largest_first(changes), tuple(dict.fromkeys(notes)), troubles, apart)


def _bodies(pair: Pair) -> list[Change]:
    a, b = pair.drawn()
    bodies_a = {_renamed(pair, body.name): body for body in a}
    bodies_b = {body.name: body for body in b}
    changes = [_whole(name, Sort.REMOVED, bodies_a[name]) for name in bodies_a if name not in bodies_b]
    changes += [_whole(name, Sort.ADDED, bodies_b[name]) for name in bodies_b if name not in bodies_a]
    for name, before in bodies_a.items():
        if name in bodies_b:
            holds = tuple(_held(pair, item) for item in before.moves_with)
            change = _changed(name, replace(before, moves_with=holds), bodies_b[name], pair.tolerance_mm)
            if change is not None:
                changes.append(change)
    return changes + _materials(pair, a, b)


def _renamed(pair: Pair, name: str) -> str:
    """What B would call a body of A: bodies are named after masses ("unit.MASS") and couplings."""
    kind, dot, rest = name.partition(".")
    net, number, index = rest.rpartition(".")
    if number and index.isdigit() and net in pair.renamed:
        return f"{kind}.{pair.mass(net)}.{index}"
    return kind + dot + pair.coupling(pair.mass(rest))


def _held(pair: Pair, holder: str) -> str:
    """A body's reference ("mass:NAME", "clock:K", "frame") in B's names."""
    kind, colon, name = holder.partition(":")
    return kind + colon + pair.mass(name) if kind == "mass" else holder


def _whole(name: str, sort: Sort, body: Body) -> Change:
    words = f"{body.kind} on {body.plate}, {body.section.area:.4g} mm2"
    return Change("body", name, sort, words, size=round(body.section.area, 6), unit="mm2", spots=(_spot(body),))


def _spot(body: Body) -> Spot:
    x0, y0, x1, y1 = (round(value, 4) for value in body.section.bounds)
    return Spot(body.plate, (x0, y0, x1, y1), round(body.section.area, 6), (body.name,))


def _changed(name: str, a: Body, b: Body, tolerance: float) -> Change | None:
    fields = field_changes(a, b, tolerance, _SHAPES)
    shift = _shift(a.section, b.section, tolerance)
    if shift is not None:
        distance = hypot(*shift)
        if not same_number(distance, 0.0, tolerance):
            words = f"by {distance:.3f} mm ({shift[0]:+.3f}, {shift[1]:+.3f}) on {b.plate}"
            words += f"; {worded(fields)}" if fields else ""
            moved = (FieldChange("dx", 0.0, shift[0]), FieldChange("dy", 0.0, shift[1]), *fields)
            return Change("body", name, Sort.MOVED, words, moved, distance, "mm", (_spot(b), _spot(a)))
    else:
        area = shapely.symmetric_difference(a.section, b.section, grid_size=1e-4).area
        size = FieldChange("area, mm2", round(a.section.area, 6), round(b.section.area, 6))
        words = f"its outline on {b.plate} differs by {area:.4g} mm2"
        words += f"; {worded(fields)}" if fields else ""
        return Change("body", name, Sort.CHANGED, words, (size, *fields), round(area, 6), "mm2", (_spot(b), _spot(a)))
    strained = [
        label
        for label, one, other in (("assembled", a.assembled, b.assembled), ("envelope", a.envelope, b.envelope))
        if (one is None) != (other is None)
        or (one is not None and other is not None and not _like(one, other, tolerance))
    ]
    if not fields and not strained:
        return None
    words = "; ".join(part for part in (worded(fields), f"{' and '.join(strained)} differ" if strained else "") if part)
    return Change("body", name, Sort.CHANGED, words, fields, spots=(_spot(b),))


def _shift(a: Polygon, b: Polygon, tolerance: float) -> tuple[float, float] | None:
    """(dx, dy) in mm if ``b`` is ``a`` moved; (0, 0) if they are the same; None if the shape changed."""
    if shapely.equals_exact(a, b, tolerance=0.0):
        return 0.0, 0.0
    (ax, ay, *_), (bx, by, *_) = a.bounds, b.bounds
    dx, dy = round(bx - ax, 9), round(by - ay, 9)
    return (dx, dy) if _like(affinity.translate(a, dx, dy), b, tolerance) else None


def _like(a: Polygon, b: Polygon, tolerance: float) -> bool:
    slack = max(tolerance, 1e-9)
    return bool(shapely.equals_exact(a, b, slack)) or bool(
        shapely.equals_exact(shapely.normalize(a), shapely.normalize(b), slack)
    )


def _materials(pair: Pair, a: Sequence[Body], b: Sequence[Body]) -> list[Change]:
    """The bill of materials, line against line."""
    lines_a = _bill(a, two_decks(read(pair.a, "process.json", Process)))
    lines_b = _bill(b, two_decks(read(pair.b, "process.json", Process)))
    changes = keyed_changes(
        "bill of materials", lines_a, lines_b, lambda line: counted(int(line["count"] or 0), "piece")
    )
    return [replace(change, unit="") for change in changes]


def _bill(bodies: Sequence[Body], process: Process) -> dict[str, Mapping[str, int | float | None]]:
    bill = bill_of_materials(bodies, process)
    lines: dict[str, Mapping[str, int | float | None]] = {
        f"{line.kind} of {line.thickness_mm:g} mm {line.material or 'sheet'} on {line.plate}": {
            "count": line.count,
            "mass in g": line.mass_g,
        }
        for line in bill.parts
    }
    lines |= {
        f"{line.kind} {line.profile} {line.size_mm:g} mm, {line.length_mm:g} mm long, {line.material}": {
            "count": line.count,
            "mass in g": line.mass_g,
        }
        for line in bill.stock
    }
    return lines


def _carriers(pair: Pair) -> list[Change]:
    """How stiff the carriers are, as each coupler feels it."""
    a, b = pair.both("parts.json", Parts)
    named = {item.coupling: item for item in (replace(c, coupling=pair.coupling(c.coupling)) for c in a.carriers)}
    return keyed_changes("carrier stiffness", named, {item.coupling: item for item in b.carriers})


def _sizes(pair: Pair) -> list[Change]:
    a, b = pair.both("sizing.json", Sizing)
    changes: list[Change] = []
    if pair.a.has(COMPENSATION_FILE) and pair.b.has(COMPENSATION_FILE):
        solved = pair.both(COMPENSATION_FILE, Compensation)
        a, b = compensated(a, solved[0]), compensated(b, solved[1])
        changes += _compensations(pair, *solved)
    for what, sized_a, sized_b in (
        ("size of unit", {pair.mass(u.mass): u for u in a.units}, {u.mass: u for u in b.units}),
        (
            "size of coupler",
            {pair.coupling(c.coupling): replace(c, coupling=pair.coupling(c.coupling)) for c in a.couplers},
            {c.coupling: c for c in b.couplers},
        ),
        ("size of bias leaf", {pair.mass(u.mass): u for u in a.biases}, {u.mass: u for u in b.biases}),
    ):
        changes += keyed_changes(what, sized_a, sized_b, skip=frozenset({"mass"}))
    rules = keyed_changes("layout rules", {"rules": a.rules}, {"rules": b.rules})
    law = keyed_changes("unit law", {"law": (a.law, a.series)}, {"law": (b.law, b.series)})
    kept = []
    for change in (*changes, *rules, *law):
        fields = tuple(item for item in change.fields if not _within(item, pair.tolerance_mm))
        if fields or change.sort is not Sort.CHANGED:
            words = worded(fields) if change.sort is Sort.CHANGED else change.words
            kept.append(replace(change, fields=fields, words=words))
    return kept


def _compensations(pair: Pair, a: Compensation, b: Compensation) -> list[Change]:
    """What masses and couplers were solved for and what is left; what was drawn for it is told with the sizes."""
    drawn = frozenset({"mass", "preload", "preload_sized", "size"})
    couplers = {pair.coupling(item.size.coupling): item for item in a.couplers}
    return [
        *keyed_changes(
            "compensation of unit", {pair.mass(u.mass): u for u in a.units}, {u.mass: u for u in b.units}, skip=drawn
        ),
        *keyed_changes(
            "compensation of coupler", couplers, {item.size.coupling: item for item in b.couplers}, skip=drawn
        ),
    ]


def _within(item: FieldChange, tolerance: float) -> bool:
    return (
        item.name.rpartition(".")[2] in _LENGTHS
        and isinstance(item.before, float)
        and isinstance(item.after, float)
        and same_number(item.before, item.after, tolerance)
    )
