"""Checks a placement on the grid by itself: nothing of the placer is trusted."""

from __future__ import annotations

from collections import Counter

from shapely import Point, Polygon

from mdlcad.network.model import Network
from mdlcad.placement.ports import PortPlace
from mdlcad.placement.unit_grid import GridPlacement

_NEAR = 1e-6


def check_grid(
    network: Network,
    placement: GridPlacement,
    boundary: tuple[tuple[int, int], ...],
    ports: tuple[PortPlace, ...],
) -> list[str]:
    """What is wrong with ``placement``, in words; nothing if every mass has a place of its own inside the boundary and
    every port bit of the network its place of the program, with its mass."""
    found = []
    if placement.boundary != tuple((float(x), float(y)) for x, y in boundary):
        found.append("the boundary is not the program's")
    names = [item.mass for item in placement.masses]
    if names != [mass.name for mass in network.masses]:
        found.append("the masses are not those of the network")
    spots = Counter((item.x, item.y) for item in placement.masses)
    found += [f"{count} masses are at ({x:g}, {y:g})" for (x, y), count in sorted(spots.items()) if count > 1]
    outline = Polygon(boundary)
    inner = outline.buffer(_NEAR)
    for item in placement.masses:
        if not inner.contains(Point(item.x, item.y)):
            found.append(f"{item.mass} is outside the boundary")
        elif item.port is None:
            steps = (item.x / placement.footprint, item.y / placement.footprint)
            if any(abs(step - round(step)) > _NEAR for step in steps):
                found.append(f"{item.mass} is on no site of the grid")
    places = {place.bit: place for place in ports}
    bits = [(port.bit, port.mass) for port in (*network.sensors, *network.actuators)]
    if [(port.bit, port.mass) for port in placement.ports] != bits:
        found.append("the ports are not those of the network")
        return found
    seats = {item.mass: item for item in placement.masses}
    for port in placement.ports:
        place, seat = places[port.bit], seats.get(port.mass)
        if max(abs(port.x - place.x), abs(port.y - place.y)) > _NEAR:
            found.append(f"port {port.bit} is not where the program has it")
        if seat is not None and seat.port == port.bit and max(abs(seat.x - port.x), abs(seat.y - port.y)) > _NEAR:
            found.append(f"{port.mass} is not at its port {port.bit}")
    return found
