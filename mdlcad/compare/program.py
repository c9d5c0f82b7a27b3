"""The program: ports, their places, the outline and what the behaviour does; never how it is written."""

from __future__ import annotations

import re
from dataclasses import dataclass

from shapely import Polygon

from mdlcad.compare.change import Change, Sort
from mdlcad.compare.equivalence import compare_behaviour
from mdlcad.compare.fields import counted, keyed_changes
from mdlcad.compare.pair import Findings, Pair
from mdlcad.language import Actuator, Device, Sensor
from mdlcad.language.device import Line

_COMMENT_OR_SPACE = re.compile(r"//[^\n]*|/\*.*?\*/|\s+", re.S)
_TOKEN = re.compile(r'"(?:\\.|[^"\\])*"|\\\S+|[\w$\'`]+|[^\w\s]')


@dataclass(frozen=True, slots=True)
class _Port:
    """A port but for its places: ``values`` as "0b1=WALL"."""

    direction: str
    type: str
    bits: int
    values: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class _Spot:
    """Where a bit stands."""

    line: str
    position: float


@dataclass(frozen=True, slots=True)
class _Line:
    """A side of the outline without its place in the file."""

    start: tuple[int, int]
    end: tuple[int, int]


def program_changes(pair: Pair) -> Findings:
    """Changes of the program, and remarks."""
    a, b = pair.both("device.json", Device)
    changes = keyed_changes("program", {"name": a.name}, {"name": b.name})
    changes += keyed_changes(
        "port", _ports(a), _ports(b), lambda port: f"{port.direction} of {counted(port.bits, 'bit')}"
    )
    spots_a, spots_b = _spots(a), _spots(b)
    both = [name for name in spots_a if name in spots_b]  # bits that come or go are told with their port
    changes += keyed_changes("place", {n: spots_a[n] for n in both}, {n: spots_b[n] for n in both})
    changes += keyed_changes("boundary line", _lines(a), _lines(b), lambda line: f"{line.start} to {line.end}")
    notes = []
    if _outline(a) != _outline(b):
        before, after = Polygon(_outline(a)).area, Polygon(_outline(b)).area
        words = f"its area is {before:g} -> {after:g} grid units squared"
        changes.append(Change("boundary", "outline", Sort.CHANGED, words, size=abs(after - before), unit="grid2"))
    elif any(change.what == "boundary line" for change in changes):
        notes.append("the outline is the same; its lines go by other names")
    if a.verilog != b.verilog:
        if tokens(a.verilog) == tokens(b.verilog):
            notes.append("the Verilog differs in comments or spaces alone")
        else:
            found = compare_behaviour(a, b)
            if found.differs:
                changes.append(Change("behaviour", b.name, Sort.CHANGED, found.words))
            else:
                notes.append(found.words)
    return Findings(changes, notes)


def tokens(verilog: str) -> list[str]:
    """The words of a Verilog text, without comments and white space."""
    # strings may hold what looks like a comment
    found, at = [], 0
    while at < len(verilog):
        skip = _COMMENT_OR_SPACE.match(verilog, at)
        if skip:
            at = skip.end()
            continue
        token = _TOKEN.match(verilog, at)
        found.append(token[0] if token else verilog[at])
        at = token.end() if token else at + 1
    return found


def _all_ports(device: Device) -> list[tuple[str, Sensor | Actuator]]:
    sensors: list[tuple[str, Sensor | Actuator]] = [("sensor", port) for port in device.sensors]
    return sensors + [("actuator", port) for port in device.actuators]


def _ports(device: Device) -> dict[str, _Port]:
    return {
        port.name: _Port(
            direction,
            port.type,
            len(port.places),
            tuple(sorted(f"0b{value.bits}={value.label}" for value in port.values)),
        )
        for direction, port in _all_ports(device)
    }


def _spots(device: Device) -> dict[str, _Spot]:
    return {
        f"{port.name}[{index}]": _Spot(place.line, place.position)
        for _, port in _all_ports(device)
        for index, place in enumerate(port.places)
    }


def _lines(device: Device) -> dict[str, _Line]:
    return {line.name: _Line(line.start, line.end) for line in device.boundary}


def _outline(device: Device) -> list[tuple[int, int]]:
    """The corners, from the least one on: where the list starts does not matter, nor do corners that bend nothing."""
    lines: tuple[Line, ...] = device.boundary
    corners = [
        line.start
        for before, line in zip((lines[-1], *lines[:-1]), lines, strict=True)
        if _turns(before.start, line.start, line.end)
    ]
    least = corners.index(min(corners)) if corners else 0
    return corners[least:] + corners[:least]


def _turns(a: tuple[int, int], b: tuple[int, int], c: tuple[int, int]) -> bool:
    return (b[0] - a[0]) * (c[1] - b[1]) != (b[1] - a[1]) * (c[0] - b[0])
