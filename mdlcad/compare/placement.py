"""The placement: who moved, how far, over how many slots; the outline in mm and the lattice."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from math import hypot

from mdlcad.compare.change import Change, FieldChange, Sort, Spot
from mdlcad.compare.fields import counted, keyed_changes, largest_first, same_number
from mdlcad.compare.folders import Build, NotComparable, read
from mdlcad.compare.pair import Findings, Pair
from mdlcad.errors import UsageError
from mdlcad.mechanics.decks import Deck
from mdlcad.placement.placement import PlacedMass, Placement
from mdlcad.placement.unit_grid import GridPlacement

# half the side of the box that shows a unit or port whose own extent the placement does not say
_AROUND_MM = 6.0


def placement_changes(pair: Pair) -> Findings:
    """Changes of the placement, largest first, and remarks."""
    on_grid = [build.label for build in (pair.a, pair.b) if _on_grid(build)]
    if len(on_grid) == 2:
        return _grid_changes(pair)
    if on_grid and pair.a.has("placement.json") and pair.b.has("placement.json"):
        words = f"the masses of {on_grid[0]} stand on the program's grid, those of the other in mm"
        raise NotComparable(words, "placement.json")
    a, b = pair.both("placement.json", Placement)
    units_a = {pair.mass(unit.mass): unit for unit in a.masses}
    units_b = {unit.mass: unit for unit in b.masses}
    changes = [
        Change("unit", name, Sort.REMOVED, _slot(unit), spots=(_around(unit.x, unit.y),))
        for name, unit in units_a.items()
        if name not in units_b
    ]
    changes += [
        Change("unit", name, Sort.ADDED, _slot(unit), spots=(_around(unit.x, unit.y),))
        for name, unit in units_b.items()
        if name not in units_a
    ]
    moves = []
    for name, before in units_a.items():
        after = units_b.get(name)
        if after is not None:
            move = _move("unit", name, (before.x, before.y), (after.x, after.y), pair.tolerance_mm)
            slots = (after.column - before.column, after.row - before.row)
            if move is not None or slots != (0, 0) or _deck(before) is not _deck(after):
                moves.append(_with_slots(move, name, before, after, slots))
    changes += moves
    ports_a, ports_b = {port.bit: port for port in a.ports}, {port.bit: port for port in b.ports}
    for bit, old in ports_a.items():
        if bit in ports_b:
            new = ports_b[bit]
            move = _move("port", bit, (old.x, old.y), (new.x, new.y), pair.tolerance_mm)
            if move is not None:
                changes.append(move)
            fields = tuple(
                FieldChange(label, one, other)
                for label, one, other in (
                    ("mass", pair.mass(old.mass), new.mass),
                    ("line", old.line, new.line),
                    ("normal", str(old.normal), str(new.normal)),
                )
                if one != other
            )
            if fields:
                words = ", ".join(f"{item.name} {item.before} -> {item.after}" for item in fields)
                changes.append(Change("port", bit, Sort.CHANGED, words, fields))
    # a port that comes or goes is told at the program's level too; here it has a place
    changes += [
        Change("port", bit, Sort.REMOVED, spots=(_around(p.x, p.y),))
        for bit, p in ports_a.items()
        if bit not in ports_b
    ]
    changes += [
        Change("port", bit, Sort.ADDED, spots=(_around(p.x, p.y),)) for bit, p in ports_b.items() if bit not in ports_a
    ]
    changes += _lattice(pair, a, b)
    notes = [f"seed {a.seed} -> {b.seed}"] if a.seed != b.seed else []
    common = _common(moves)
    if common is not None and len(moves) > 1:
        dx, dy, count = common
        notes.append(f"{count} units moved by the same ({dx:+.3f}, {dy:+.3f}) mm")
    return Findings(largest_first(changes), notes)


def _on_grid(build: Build) -> bool:
    """The build's library has no parts, and its masses stand on the program's grid."""
    try:
        read(build, "placement.json", GridPlacement)
    except (NotComparable, UsageError):
        return False
    return True


def _grid_changes(pair: Pair) -> Findings:
    a, b = pair.both("placement.json", GridPlacement)
    masses_a = {pair.mass(unit.mass): replace(unit, mass=pair.mass(unit.mass)) for unit in a.masses}
    changes = keyed_changes("mass", masses_a, {unit.mass: unit for unit in b.masses})
    changes += keyed_changes("port", {port.bit: port for port in a.ports}, {port.bit: port for port in b.ports})
    skip = frozenset({"masses", "ports"})
    changes += keyed_changes("placement", {"on the grid": a}, {"on the grid": b}, skip=skip)
    return Findings(largest_first(changes), ["masses stand on the program's grid: lengths are grid units"])


def _lattice(pair: Pair, a: Placement, b: Placement) -> list[Change]:
    changes = keyed_changes(
        "lattice",
        {"columns": len(a.column_x), "rows": len(a.row_y), "usable slots": len(a.slots)},
        {"columns": len(b.column_x), "rows": len(b.row_y), "usable slots": len(b.slots)},
    )
    changes += keyed_changes("lattice", {"mm per grid unit": a.mm_per_grid}, {"mm per grid unit": b.mm_per_grid})
    if len(a.slots) == len(b.slots):
        changes += keyed_changes("lattice", {"slots": sorted(a.slots)}, {"slots": sorted(b.slots)})
    for what, one, other in (("x of columns", a.column_x, b.column_x), ("y of rows", a.row_y, b.row_y)):
        if len(one) == len(other):
            changes += keyed_changes("lattice", {what: one}, {what: other}, tolerance=pair.tolerance_mm)
    if not _same_points(a.boundary, b.boundary, pair.tolerance_mm):
        width, height = _extent(a.boundary)
        wider, higher = _extent(b.boundary)
        words = f"{width:.3f} x {height:.3f} mm -> {wider:.3f} x {higher:.3f} mm"
        size = max(abs(wider - width), abs(higher - height))
        changes.append(Change("boundary", "outline", Sort.CHANGED, words, size=size, unit="mm"))
    return changes


def _move(
    what: str, name: str, before: tuple[float, float], after: tuple[float, float], tolerance: float
) -> Change | None:
    dx, dy = after[0] - before[0], after[1] - before[1]
    distance = hypot(dx, dy)
    if same_number(distance, 0.0, tolerance):
        return None
    fields = tuple(
        FieldChange(axis, old, new) for axis, old, new in zip("xy", before, after, strict=True) if old != new
    )
    words = f"by {distance:.3f} mm ({dx:+.3f}, {dy:+.3f})"
    spots = (_around(*after), _around(*before))
    return Change(what, name, Sort.MOVED, words, fields, distance, "mm", spots)


def _with_slots(
    move: Change | None, name: str, before: PlacedMass, after: PlacedMass, slots: tuple[int, int]
) -> Change:
    same = _deck(before) is _deck(after)
    if slots == (0, 0) and move is not None and same:
        return Change("unit", name, Sort.MOVED, f"{move.words}, in its slot", move.fields, move.size, "mm", move.spots)
    across, along = slots
    steps = [counted(abs(n), word) for n, word in ((across, "column"), (along, "row")) if n]
    over = " and ".join([*steps, *([] if same else [f"to the {_deck(after)} deck"])])
    fields = (
        *(move.fields if move is not None else ()),
        FieldChange("column", before.column, after.column),
        FieldChange("row", before.row, after.row),
    )
    words = f"{move.words + ', ' if move is not None else ''}{over}: {_slot(before)} -> {_slot(after)}"
    spots = (_around(after.x, after.y), _around(before.x, before.y))
    return Change("unit", name, Sort.MOVED, words, fields, move.size if move is not None else 0.0, "mm", spots)


def _common(moves: Sequence[Change]) -> tuple[float, float, int] | None:
    """The shift that more than half of the moved units share."""
    shifts = Counter()  # type: Counter[tuple[float, float]]
    for move in moves:
        by_axis = {item.name: item for item in move.fields}
        shift = [
            round(float(item.after) - float(item.before), 3)
            if (item := by_axis.get(axis)) is not None
            and isinstance(item.after, float)
            and isinstance(item.before, float)
            else 0.0
            for axis in "xy"
        ]
        shifts[shift[0], shift[1]] += 1
    if not shifts:
        return None
    (dx, dy), count = shifts.most_common(1)[0]
    return (dx, dy, count) if 2 * count > len(moves) else None


def _deck(unit: PlacedMass) -> Deck:
    """Where the unit is; a device with one unit plate has the lower deck alone."""
    return Deck.UPPER if unit.deck is Deck.UPPER else Deck.LOWER


def _slot(unit: PlacedMass) -> str:
    return f"column {unit.column}, row {unit.row}"


def _around(x: float, y: float) -> Spot:
    return Spot("", (x - _AROUND_MM, y - _AROUND_MM, x + _AROUND_MM, y + _AROUND_MM))


def _same_points(a: Sequence[tuple[float, float]], b: Sequence[tuple[float, float]], tolerance: float) -> bool:
    return len(a) == len(b) and all(
        same_number(p, q, tolerance) for one, other in zip(a, b, strict=True) for p, q in zip(one, other, strict=True)
    )


def _extent(points: Sequence[tuple[float, float]]) -> tuple[float, float]:
    xs, ys = [x for x, _ in points], [y for _, y in points]
    return (max(xs) - min(xs), max(ys) - min(ys)) if points else (0.0, 0.0)
