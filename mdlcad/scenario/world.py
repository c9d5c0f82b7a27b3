"""Worlds: what a device feels, and what its answer changes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol, TypeVar

import numpy as np

from mdlcad.errors import UsageError
from mdlcad.language import Actuator, Device, Sensor
from mdlcad.scenario.file import GridWalk, ScenarioFile, Script
from mdlcad.scenario.ports import Bits, Port, digits_of, read_value, set_digits

# rows count downwards
DIRECTIONS = {"left": (0, -1), "up": (-1, 0), "right": (0, 1), "down": (1, 0)}

Cell = tuple[int, int]
_P = TypeVar("_P", Sensor, Actuator)


@dataclass(frozen=True, slots=True)
class Ports:
    """Names of the bits, "NAME[i]", in the order of a device's vectors of inputs and outputs, and the ports."""

    sensors: tuple[Sensor, ...]
    actuators: tuple[Actuator, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]


def ports_of(device: Device) -> Ports:
    """The ports of ``device``; bits are in the order that its reference uses as well."""

    def bits(ports: tuple[Port, ...]) -> tuple[str, ...]:
        return tuple(f"{port.name}[{i}]" for port in ports for i in range(len(port.places)))

    return Ports(device.sensors, device.actuators, bits(device.sensors), bits(device.actuators))


class World(Protocol):
    """One moment of a world; a decision later there is another one."""

    @property
    def ports(self) -> Ports:
        """The ports of the device, and the order of its vectors of bits."""
        ...

    @property
    def finished(self) -> bool:
        """No further decision is wanted."""
        ...

    def feels(self) -> Bits:
        """uint8[I], the sensor bits during this decision."""
        ...

    def after(self, outputs: Bits) -> World:
        """The world after a decision that ended with the actuator bits ``outputs`` (uint8[O], 2: undecided)."""
        ...


@dataclass(frozen=True, slots=True)
class Maze:
    """A device in a cell of a map.

    Attributes:
        rows: the map, as in ``GridWalk``.
        cell: (row, column) of the device; exit: of the exit.
        looks: (place in the vector of inputs, direction) of every sensor that feels walls.
        moves: value of ``actuator`` -> (rows, columns) to go.
        left: decisions left.
    """

    ports: Ports
    rows: tuple[str, ...]
    cell: Cell
    exit: Cell
    looks: tuple[tuple[int, Cell], ...]
    actuator: Actuator
    moves: Mapping[str, Cell]
    left: int

    @property
    def finished(self) -> bool:
        return self.cell == self.exit or self.left == 0

    def feels(self) -> Bits:
        felt = np.zeros(len(self.ports.inputs), dtype=np.uint8)
        for place, (down, right) in self.looks:
            felt[place] = self.is_wall((self.cell[0] + down, self.cell[1] + right))
        return felt

    def after(self, outputs: Bits) -> Maze:
        """A wall, or a value that is undecided or moves nothing, leaves the device where it is."""
        down, right = self.moves.get(digits_of(self.actuator, self.ports.outputs, outputs), (0, 0))
        there = (self.cell[0] + down, self.cell[1] + right)
        return replace(self, cell=self.cell if self.is_wall(there) else there, left=self.left - 1)

    def is_wall(self, cell: Cell) -> bool:
        row, column = cell
        inside = 0 <= row < len(self.rows) and 0 <= column < len(self.rows[0])
        return not inside or self.rows[row][column] == "#"


@dataclass(frozen=True, slots=True)
class ScriptStep:
    """One decision of a script: all sensors' digits; what actuators must show after it; words for people."""

    sensors: tuple[tuple[Sensor, str], ...]
    expected: tuple[tuple[Actuator, str], ...]
    words: str


@dataclass(frozen=True, slots=True)
class Hands:
    """Somebody who does one thing after the other to the device, whatever it answers."""

    ports: Ports
    steps: tuple[ScriptStep, ...]
    done: int = 0

    @property
    def finished(self) -> bool:
        return self.done == len(self.steps)

    def feels(self) -> Bits:
        felt = np.zeros(len(self.ports.inputs), dtype=np.uint8)
        for sensor, digits in self.steps[self.done].sensors:
            set_digits(sensor, digits, self.ports.inputs, felt)
        return felt

    def after(self, outputs: Bits) -> Hands:
        return replace(self, done=self.done + 1)


def make_world(scenario: ScenarioFile, device: Device, file: str) -> Maze | Hands:
    """The world of ``scenario`` before the first decision of ``device``.

    Raises:
        UsageError: the scenario names ports or values that the device has not; the message names ``file`` and key.
    """
    if isinstance(scenario, GridWalk):
        return _maze(scenario, device, file)
    return _hands(scenario, device, file)


def each_sensor(device: Device) -> Hands:
    """Nothing pressed, then every sensor bit on its own, then all of them, then nothing again."""
    ports = ports_of(device)
    steps = []
    for words, pressed in (
        ("nothing pressed", ()),
        *((f"{bit} pressed", (bit,)) for bit in ports.inputs),
        ("all pressed", ports.inputs),
        ("nothing pressed", ()),
    ):
        sensors = tuple(
            (
                sensor,
                "".join("01"[f"{sensor.name}[{i}]" in pressed] for i in reversed(range(len(sensor.places)))),
            )
            for sensor in device.sensors
        )
        steps.append(ScriptStep(sensors, (), words))
    return Hands(ports, tuple(steps))


def _maze(walk: GridWalk, device: Device, file: str) -> Maze:
    ports = ports_of(device)
    looks = []
    for name, direction in walk.sensors.items():
        sensor = _port(device.sensors, (name,), f"{file}: sensors.{name}", device.name, "sensor")
        if len(sensor.places) != 1:
            raise UsageError(
                f"{file}: sensors.{name}: feels walls, so it must have one bit; it has {len(sensor.places)}"
            )
        looks.append((ports.inputs.index(f"{name}[0]"), _direction(direction, f"{file}: sensors.{name}")))
    looks = looks or facing(device)
    if not looks:
        raise UsageError(f"{file}: sensors: no side of {device.name} with a sensor faces left, up, right or down")
    actuator, moves = _moves(walk, device, file)

    def find(mark: str) -> Cell:
        return next((row, text.index(mark)) for row, text in enumerate(walk.map) if mark in text)

    return Maze(ports, walk.map, find("S"), find("E"), tuple(looks), actuator, moves, walk.decisions)


def _moves(walk: GridWalk, device: Device, file: str) -> tuple[Actuator, dict[str, Cell]]:
    for name, values in walk.moves.items():
        actuator = _port(device.actuators, (name,), f"{file}: moves.{name}", device.name, "actuator")
        moves: dict[str, Cell] = {}
        for value, direction in values.items():
            key = f"{file}: moves.{name}.{value}"
            digits = _value(actuator, value, key)
            if digits in moves:
                raise UsageError(f"{key}: gives the value {digits} a second direction")
            moves[digits] = (0, 0) if direction == "stay" else _direction(direction, key)
        return actuator, moves
    told = [(actuator, found) for actuator in device.actuators if (found := labelled_ways(actuator))]
    if len(told) != 1:
        raise UsageError(
            f"{file}: moves: {len(told)} actuators of {device.name} have values that are called left, up, right or "
            "down; say under [moves.NAME] which values move it where"
        )
    return told[0]


def facing(device: Device) -> list[tuple[int, Cell]]:
    """(place in the vector of inputs, direction) of every sensor bit on a side that faces left, up, right or down."""
    lines = {line.name: line for line in device.boundary}
    places = [place for sensor in device.sensors for place in sensor.places]
    looks = []
    for number, place in enumerate(places):
        (x0, y0), (x1, y1) = lines[place.line].start, lines[place.line].end
        # the boundary runs clockwise with y upwards, so (y0 - y1, x1 - x0) points outwards; rows count downwards
        out = (x0 - x1, y0 - y1)
        if 0 in out:
            looks.append((number, (_sign(out[0]), _sign(out[1]))))
    return looks


def labelled_ways(actuator: Actuator) -> dict[str, Cell]:
    """The values of ``actuator`` whose labels have one of the words left, up, right, down, in any case."""
    ways = {}
    for value in actuator.values:
        words = [word for word in value.label.lower().split() if word in DIRECTIONS]
        if len(words) == 1 and len(value.bits) == len(actuator.places):
            ways[value.bits] = DIRECTIONS[words[0]]
    return ways


def _sign(number: int) -> int:
    return (number > 0) - (number < 0)


def _hands(script: Script, device: Device, file: str) -> Hands:
    now = {sensor.name: "0" * len(sensor.places) for sensor in device.sensors}
    steps = []
    for number, step in enumerate(script.steps):
        place = f"{file}: steps[{number}]"
        for name, value in step.set.items():
            names = (name, *script.also.get(name, ()))
            sensor = _port(device.sensors, names, f"{place}.set.{name}", device.name, "sensor")
            now[sensor.name] = _value(sensor, value, f"{place}.set.{name}")
        expected = []
        for name, value in step.expect.items():
            names = (name, *script.also.get(name, ()))
            actuator = _port(device.actuators, names, f"{place}.expect.{name}", device.name, "actuator")
            expected.append((actuator, _value(actuator, value, f"{place}.expect.{name}")))
        sensors = tuple((sensor, now[sensor.name]) for sensor in device.sensors)
        steps += [ScriptStep(sensors, (), step.say)] * (step.repeat - 1)
        steps.append(ScriptStep(sensors, tuple(expected), step.say))
    return Hands(ports_of(device), tuple(steps))


def _port(ports: Sequence[_P], names: tuple[str, ...], key: str, design: str, kind: str) -> _P:
    for port in ports:
        if port.name in names:
            return port
    known = ", ".join(port.name for port in ports)
    raise UsageError(f"{key}: {design} has no {kind} of this name; it has {known}")


def _value(port: Port, text: str, key: str) -> str:
    try:
        return read_value(port, text)
    except ValueError as problem:
        raise UsageError(f"{key}: {problem}") from None


def _direction(text: str, key: str) -> Cell:
    if text not in DIRECTIONS:
        raise UsageError(f'{key}: "{text}" is no direction; give one of {", ".join(DIRECTIONS)}')
    return DIRECTIONS[text]
