"""Where the program wants what: of the device, all that placement looks at."""

from __future__ import annotations

from dataclasses import dataclass

from mdlcad.language import Actuator, Device, Sensor, Where
from mdlcad.placement.ports import PortPlace


@dataclass(frozen=True, slots=True)
class Outline:
    """Of a device, what decides where things can be: boundary corners (clockwise) and ports, in grid units."""

    boundary: tuple[tuple[int, int], ...]
    ports: tuple[PortPlace, ...]


def outline_of(device: Device) -> Outline:
    """The device's boundary and ports."""
    return Outline(tuple(line.start for line in device.boundary), port_places(device))


def place_of(device: Device, bit: str) -> Where:
    """Where the program gives the place of the port bit "NAME[i]"."""
    name, _, index = bit.removesuffix("]").rpartition("[")
    ports: tuple[Sensor | Actuator, ...] = (*device.sensors, *device.actuators)
    return next(port.places[int(index)].where for port in ports if port.name == name)


def port_places(device: Device) -> tuple[PortPlace, ...]:
    """Every sensor and actuator bit at its place on the boundary, in grid units."""
    lines = {line.name: line for line in device.boundary}
    places = []
    ports: tuple[Sensor | Actuator, ...] = (*device.sensors, *device.actuators)
    for port in ports:
        for index, place in enumerate(port.places):
            line = lines[place.line]
            dx, dy = line.end[0] - line.start[0], line.end[1] - line.start[1]
            length = (dx * dx + dy * dy) ** 0.5
            places.append(
                PortPlace(
                    bit=f"{port.name}[{index}]",
                    line=line.name,
                    x=line.start[0] + place.position * dx,
                    y=line.start[1] + place.position * dy,
                    # the boundary runs clockwise, so outside is to the left of a line
                    normal=(-dy / length, dx / length),
                )
            )
    return tuple(places)
