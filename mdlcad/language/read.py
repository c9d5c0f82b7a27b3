"""From the text of a program to its ``Device``: parse, check everything, then build."""

from __future__ import annotations

from itertools import islice
from pathlib import Path, PurePosixPath

from mdlcad.errors import Diagnostic, InputError
from mdlcad.language.behaviour import check_verilog
from mdlcad.language.declarations import Program, WrittenPort
from mdlcad.language.device import Actuator, Device, Place, Sensor, Value
from mdlcad.language.lint import check_program, read_key, read_position
from mdlcad.language.outline import read_lines
from mdlcad.language.parse import parse_declarations
from mdlcad.language.sections import Sections, cut
from mdlcad.language.source import Source, make_source, read_source

# more than anyone reads, and a file that is not MDL at all would keep us busy
_MOST_FINDINGS = 100


def read_device(path: Path) -> Device:
    """Read, parse and check an MDL file.

    Raises:
        InputError: the file cannot be read or the program is wrong; it carries every finding, in the file's order.
    """
    return _device(read_source(path))


def parse_device(text: str, file: str) -> Device:
    """Parse and check a program; ``file`` is what messages call it.

    Raises:
        InputError: the program is wrong; it carries every finding, in the program's order.
    """
    return _device(make_source(text, file))


def _device(source: Source) -> Device:
    sections = cut(source)
    program, findings = parse_declarations(source, sections.declarations_end)
    findings += islice(check_program(source, program, sections), _MOST_FINDINGS + 1)
    findings += islice(check_verilog(source, sections), _MOST_FINDINGS + 1)
    findings += sections.findings
    if findings:
        raise InputError(_first(source, sorted(findings)))
    return _build(source, sections, program)


def _first(source: Source, findings: list[Diagnostic]) -> list[Diagnostic]:
    if len(findings) <= _MOST_FINDINGS:
        return findings
    more = source.error(source.end(), f"there are more than {_MOST_FINDINGS} findings", "mend the first ones first")
    return [*findings[:_MOST_FINDINGS], more]


def _build(source: Source, sections: Sections, program: Program) -> Device:
    """The device of a program without findings."""
    lines = read_lines(program.boundaries[0])
    if lines is None:
        raise AssertionError("coordinates were checked")
    return Device(
        name=program.names[0].text,
        boundary=lines,
        sensors=tuple(
            Sensor(port.name.text, _places(port), _values(port), _type(port), port.name.where)
            for port in program.ports
            if port.kind == "sensor"
        ),
        actuators=tuple(
            Actuator(port.name.text, _type(port), _places(port), _values(port), port.name.where)
            for port in program.ports
            if port.kind == "actuator"
        ),
        verilog=_verilog(source, sections),
        file=PurePosixPath(source.file.replace("\\", "/")).name,
        where=program.names[0].where,
    )


def _verilog(source: Source, sections: Sections) -> str:
    start = source.where(sections.declarations_end)
    text = source.text[sections.declarations_end : sections.verilog_end].rstrip()
    return "\n" * (start.line - 1) + " " * (start.column - 1) + text + "\n"


def _places(port: WrittenPort) -> tuple[Place, ...]:
    return tuple(
        Place(place.line.text, position, place.where)
        for _, places in port.locations
        for place in places
        if (position := read_position(place.position)) is not None
    )


def _values(port: WrittenPort) -> tuple[Value, ...]:
    return tuple(
        Value(bits, value.label.text)
        for _, values in port.values
        for value in values
        if (bits := read_key(value.key)) is not None
    )


def _type(port: WrittenPort) -> str:
    return port.types[0][1].text if port.types else ""
