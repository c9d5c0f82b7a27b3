"""Check the boundary: a closed, simple polygon with whole coordinates, listed clockwise."""

from __future__ import annotations

import re
from collections.abc import Iterator

from mdlcad.errors import Diagnostic
from mdlcad.language.declarations import Word, WrittenBoundary, WrittenLine
from mdlcad.language.device import Line
from mdlcad.language.explain import shown
from mdlcad.language.source import Source

Point = tuple[int, int]

LARGEST_COORDINATE = 1_000_000
# keeps the search for crossings, which looks at every pair of lines, well under a second
MOST_LINES = 1000
_WHOLE = re.compile(r"[+-]?[0-9]{1,12}")


def read_lines(boundary: WrittenBoundary) -> tuple[Line, ...] | None:
    """The lines with their coordinates as numbers, or None if one of them is not a whole number in range."""
    words = [word for line in boundary.lines for word in (*line.start, *line.end)]
    if any(_coordinate_trouble(word) for word in words):
        return None
    return tuple(
        Line(
            line.name.text,
            (int(line.start[0].text), int(line.start[1].text)),
            (int(line.end[0].text), int(line.end[1].text)),
            line.name.where,
        )
        for line in boundary.lines
    )


def check_boundary(source: Source, boundary: WrittenBoundary) -> Iterator[Diagnostic]:
    """Findings about one boundary: names, numbers, and then, if those can be used, the polygon."""
    yield from _check_names(source, boundary.lines)
    for written in boundary.lines:
        for word in (*written.start, *written.end):
            trouble = _coordinate_trouble(word)
            if trouble:
                yield source.error(word.where, *trouble)
    if len(boundary.lines) < 3:
        count = "no line" if not boundary.lines else f"only {len(boundary.lines)} of the lines it needs"
        yield source.error(boundary.where, f"the boundary has {count}", "a closed outline takes at least 3 lines")
        return
    if len(boundary.lines) > MOST_LINES:
        where = boundary.lines[MOST_LINES].name.where
        yield source.error(where, f"the boundary has more than {MOST_LINES} lines", "use fewer, longer lines")
        return
    lines = read_lines(boundary)
    if lines:
        yield from _check_polygon(source, boundary.lines, lines)


def _check_names(source: Source, lines: tuple[WrittenLine, ...]) -> Iterator[Diagnostic]:
    first: dict[str, WrittenLine] = {}
    for line in lines:
        earlier = first.setdefault(line.name.text, line)
        if earlier is not line:
            message = f"a second line is called '{shown(line.name.text)}'"
            hint = f"the first is in line {earlier.name.where.line} of the file; give every line a name of its own"
            yield source.error(line.name.where, message, hint)


def _coordinate_trouble(word: Word) -> tuple[str, str] | None:
    if not _WHOLE.fullmatch(word.text):
        return f"the coordinate '{shown(word.text)}' is not a whole number", "boundary points are whole grid units"
    if abs(int(word.text)) > LARGEST_COORDINATE:
        return f"the coordinate '{shown(word.text)}' is too large", f"stay within {LARGEST_COORDINATE} grid units"
    return None


def _check_polygon(source: Source, written: tuple[WrittenLine, ...], lines: tuple[Line, ...]) -> Iterator[Diagnostic]:
    sound = True
    for line in lines:
        if line.start == line.end:
            sound = False
            yield source.error(line.where, f"the line '{line.name}' has no length", "give it two different points")
    for index, line in enumerate(lines):
        before = lines[index - 1]
        if line.start == before.end:
            continue
        sound = False
        message = f"the boundary is open: '{before.name}' ends at {before.end}, '{line.name}' starts at {line.start}"
        if index:
            yield source.error(written[index].start_where, message, "start every line where the one before it ends")
        else:
            yield source.error(written[-1].end_where, message, "end the last line where the first one starts")
    if not sound:
        return
    crossings = list(_crossings(source, lines))
    yield from crossings
    twice_area = sum(line.start[0] * line.end[1] - line.end[0] * line.start[1] for line in lines)
    if not crossings and twice_area > 0:
        hint = "list the lines in the other order and swap the two points of each"
        yield source.error(lines[0].where, "the boundary runs anticlockwise", hint)


def _crossings(source: Source, lines: tuple[Line, ...]) -> Iterator[Diagnostic]:
    """One finding for each line that meets an earlier one in more than the corner they share."""
    hint = "the outline must not cross, touch or overlap itself"
    for late, line in enumerate(lines):
        for early in range(late):
            other = lines[early]
            if early == late - 1:
                meets = _folds_back(other, line)
            elif early == 0 and late == len(lines) - 1:
                meets = _folds_back(line, other)
            else:
                meets = _meet(line, other)
            if meets:
                yield source.error(line.where, f"the line '{line.name}' runs into the line '{other.name}'", hint)
                break


def _turn(a: Point, b: Point, c: Point) -> int:
    """Twice the signed area of the triangle: positive if a, b, c turn left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _folds_back(line: Line, following: Line) -> bool:
    """Whether ``following``, which starts where ``line`` ends, returns along it."""
    ahead = (line.end[0] - line.start[0]) * (following.end[0] - following.start[0])
    ahead += (line.end[1] - line.start[1]) * (following.end[1] - following.start[1])
    return ahead < 0 and _turn(line.start, line.end, following.end) == 0


def _meet(one: Line, two: Line) -> bool:
    """Whether two lines have a point in common."""
    if not all(
        max(one.start[axis], one.end[axis]) >= min(two.start[axis], two.end[axis])
        and max(two.start[axis], two.end[axis]) >= min(one.start[axis], one.end[axis])
        for axis in (0, 1)
    ):
        return False

    def parted(line: Line, other: Line) -> bool:
        first = _turn(line.start, line.end, other.start)
        second = _turn(line.start, line.end, other.end)
        return (first > 0 and second > 0) or (first < 0 and second < 0)

    return not parted(one, two) and not parted(two, one)
