"""Check the declarations for sense, as far as one file alone can tell."""

from __future__ import annotations

import re
from collections.abc import Iterator

from mdlcad.errors import Diagnostic
from mdlcad.language.declarations import Program, Word, WrittenPlace, WrittenPort, WrittenValue
from mdlcad.language.explain import nearest, shown
from mdlcad.language.outline import check_boundary, read_lines
from mdlcad.language.sections import Sections
from mdlcad.language.source import Source
from mdlcad.language.verilog_keywords import VERILOG_KEYWORDS

# names become parts of file names
LONGEST_NAME = 64
_KEY = re.compile(r"0[bB]([01]+)")
_DECIMAL = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")


def check_program(source: Source, program: Program, sections: Sections) -> Iterator[Diagnostic]:
    """Findings about a program's declarations."""
    yield from _check_parts(source, program, sections)
    for boundary in program.boundaries:
        yield from check_boundary(source, boundary)
    yield from _check_names(source, program)
    for port in program.ports:
        yield from _check_fields(source, port)
        for _, values in port.values:
            yield from _check_values(source, port, values)
    yield from _check_places(source, program)


def read_position(word: Word) -> float | None:
    """The fraction of a line, or None if ``word`` is not a decimal number from 0 to 1."""
    if not _DECIMAL.fullmatch(word.text):
        return None
    # adding 0.0 makes -0.0 a plain zero
    position = float(word.text) + 0.0
    return position if 0.0 <= position <= 1.0 else None


def read_key(word: Word) -> str | None:
    """The binary digits of a key such as "0b01", or None if it is not one."""
    match = _KEY.fullmatch(word.text)
    return match.group(1) if match else None


def _check_parts(source: Source, program: Program, sections: Sections) -> Iterator[Diagnostic]:
    for again in program.names[1:]:
        yield source.error(again.where, "a second 'mechanicalmodule'", "a file holds one mechanical module")
    for boundary in program.boundaries[1:]:
        hint = f"the first is in line {program.boundaries[0].where.line} of the file; put all lines into one"
        yield source.error(boundary.where, "a second boundary", hint)
    if program.broken or not sections.complete:
        return
    end = source.where(sections.declarations_end) if sections.verilog else source.end()
    if not program.boundaries:
        yield source.error(end, "the device has no boundary", "add: boundary { line NAME {(x, y), (x, y)}, ... };")
    if not any(port.kind == "actuator" for port in program.ports):
        hint = "add an actuator; without one the device can do nothing"
        yield source.error(end, "the device has no actuator", hint)
    if not sections.verilog:
        hint = "write the behaviour as 'module NAME(...); ... endmodule' before 'endmechanicalmodule'"
        yield source.error(source.where(sections.verilog_end), "the program has no Verilog module", hint)


def _check_names(source: Source, program: Program) -> Iterator[Diagnostic]:
    lines = [line.name for boundary in program.boundaries for line in boundary.lines]
    for name in (*program.names, *lines, *(port.name for port in program.ports)):
        if len(name.text) > LONGEST_NAME:
            message = f"the name '{shown(name.text)}' is longer than {LONGEST_NAME} characters"
            yield source.error(name.where, message, "choose a shorter name")
    first: dict[str, WrittenPort] = {}
    for port in program.ports:
        name = port.name
        if name.text == "clk":
            message = f"the {port.kind} is called 'clk', which is the clock of the device"
            yield source.error(name.where, message, "choose another name; the clock needs no declaration")
        elif name.text in VERILOG_KEYWORDS:
            message = f"the {port.kind} is called '{name.text}', which is a word of Verilog"
            yield source.error(name.where, message, "choose another name; it must be able to be a Verilog port")
        earlier = first.setdefault(name.text, port)
        if earlier is not port:
            message = f"a second sensor or actuator is called '{shown(name.text)}'"
            hint = f"the first is the {earlier.kind} in line {earlier.name.where.line} of the file; choose another name"
            yield source.error(name.where, message, hint)


def _check_fields(source: Source, port: WrittenPort) -> Iterator[Diagnostic]:
    for field, entries in (("type", port.types), ("location", port.locations), ("values", port.values)):
        for where, _ in entries[1:]:
            message = f"a second '{field}' in the {port.kind} '{shown(port.name.text)}'"
            yield source.error(where, message, f"give one '{field}', with all its entries")
    if not any(places for _, places in port.locations):
        where = port.locations[0][0] if port.locations else port.name.where
        message = f"the {port.kind} '{shown(port.name.text)}' has no place on the boundary"
        yield source.error(where, message, "add: location = {(LINE, POSITION), ...}, one place for each bit")
    for _, text in port.types:
        yield from _check_text(source, text)


def _check_values(source: Source, port: WrittenPort, values: tuple[WrittenValue, ...]) -> Iterator[Diagnostic]:
    places = len(port.locations[0][1]) if port.locations else 0
    first: dict[str, Word] = {}
    widths: list[int] = []
    for value in values:
        yield from _check_text(source, value.label)
        bits = read_key(value.key)
        if bits is None:
            message = f'the key "{shown(value.key.text)}" is not a binary number'
            yield source.error(value.key.where, message, 'write "0b" and one digit 0 or 1 for each place')
            continue
        earlier = first.setdefault(bits, value.key)
        if earlier is not value.key:
            message = f'the key "{shown(value.key.text)}" is given twice'
            hint = f"the first is in line {earlier.where.line} of the file; label every value once"
            yield source.error(value.key.where, message, hint)
        widths.append(len(bits))
        # keys of one digit label the two states of every bit alone, as in a row of equal switches
        single = places > 1 and widths[0] == 1
        if places and len(bits) != (1 if single else places):
            digits = "1 digit" if len(bits) == 1 else f"{len(bits)} digits"
            count = "1 place" if places == 1 else f"{places} places"
            against = "the keys before it have 1" if single else f"the {port.kind} has {count}"
            hint = "give every key one digit for each place"
            if places > 1:
                hint += ", or all keys a single digit that labels each bit on its own"
            yield source.error(value.key.where, f'the key "{shown(value.key.text)}" has {digits}, but {against}', hint)


def _check_text(source: Source, text: Word) -> Iterator[Diagnostic]:
    if not text.text.isprintable():
        yield source.error(text.where, "this text holds a control character", "use plain letters, digits and signs")


def _check_places(source: Source, program: Program) -> Iterator[Diagnostic]:
    """Unknown lines, positions off the line, two bits on one spot (a corner is one spot, whichever line names it)."""
    boundary = program.boundaries[0] if program.boundaries else None
    known = [line.name.text for line in boundary.lines] if boundary else []
    numbers = {name: index for index, name in reversed(list(enumerate(known)))}
    corners = len(known) if boundary and read_lines(boundary) else 0
    taken: dict[tuple[int, float], str] = {}
    for port in program.ports:
        places = [place for _, location in port.locations for place in location]
        for bit, place in enumerate(places):
            position = read_position(place.position)
            if position is None:
                message = f"the position '{shown(place.position.text)}' is not a number from 0 to 1"
                hint = "0 is the first point of the line, 1 its second, 0.5 the middle"
                yield source.error(place.position.where, message, hint)
            index = numbers.get(place.line.text)
            if index is None:
                if known and not program.broken:
                    yield _unknown_line(source, place, known)
                continue
            if position is None:
                continue
            spot = (index, position)
            if position == 1.0 and corners:
                spot = ((index + 1) % corners, 0.0)
            owner = f"{port.name.text}[{bit}]"
            earlier = taken.setdefault(spot, owner)
            if earlier is not owner:
                corner = " (the corner of two lines)" if position in (0.0, 1.0) else ""
                message = f"this spot{corner} is already taken by {shown(earlier)}"
                yield source.error(place.where, message, "give every bit of every sensor and actuator its own place")


def _unknown_line(source: Source, place: WrittenPlace, known: list[str]) -> Diagnostic:
    listed = ", ".join(known[:8]) + (", ..." if len(known) > 8 else "")
    hint = nearest(place.line.text, known, f"the lines are {listed}")
    return source.error(place.line.where, f"the boundary has no line '{shown(place.line.text)}'", hint)
