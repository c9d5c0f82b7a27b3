"""Where masses are drawn: in their slots if the design has been placed, else spread inside the boundary."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import msgspec
import networkx
import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment
from scipy.spatial.distance import pdist

from mdlcad.language import Device
from mdlcad.network.model import Network
from mdlcad.scenario.ports import Port

Point = tuple[float, float]

UPPER = "upper"
"""The deck, in placement.json, that stands above the other."""


class _Mass(msgspec.Struct, frozen=True):
    mass: str
    x: float
    y: float
    deck: str = "lower"


class _Port(msgspec.Struct, frozen=True):
    bit: str
    x: float
    y: float


class PlacedSeats(msgspec.Struct, frozen=True):
    """Of placement.json, the artefact of a later stage, what a picture needs."""

    boundary: tuple[Point, ...]
    masses: tuple[_Mass, ...]
    ports: tuple[_Port, ...]


@dataclass(frozen=True, slots=True)
class Seats:
    """Places in one unit of length (mm if ``placed``, else the program's grid).

    Attributes:
        ports: bit "NAME[i]" -> its place on the boundary.
        placed: the masses are where the device has them.
        aside: how far right of there those of the upper deck are drawn, as some stand above one of the lower.
    """

    boundary: tuple[Point, ...]
    masses: Mapping[str, Point]
    ports: Mapping[str, Point]
    placed: bool
    aside: float = 0.0


def placed_seats(found: PlacedSeats) -> Seats:
    """The seats of a placement; those of an upper deck half the least distance of two places aside."""
    aside = 0.0
    if any(item.deck == UPPER for item in found.masses):
        places = np.array(sorted({(item.x, item.y) for item in found.masses}))
        aside = 0.5 * float(pdist(places).min()) if len(places) > 1 else 0.0
    return Seats(
        found.boundary,
        {item.mass: (item.x + (aside if item.deck == UPPER else 0.0), item.y) for item in found.masses},
        {item.bit: (item.x, item.y) for item in found.ports},
        True,
        aside,
    )


def free_seats(device: Device, network: Network) -> Seats:
    """Ports on the boundary, their masses just inside; the others spread by springs, each in a place of its own."""
    boundary = tuple((float(line.start[0]), float(line.start[1])) for line in device.boundary)
    lines = {line.name: line for line in device.boundary}
    outline = shapely.Polygon(boundary)
    inset = 0.06 * float(np.sqrt(outline.area))
    ports: dict[str, Point] = {}
    pinned: dict[str, Point] = {}
    served = {port.bit: port.mass for port in (*network.sensors, *network.actuators)}
    ports_found: tuple[Port, ...] = (*device.sensors, *device.actuators)
    for port in ports_found:
        for index, place in enumerate(port.places):
            line = lines[place.line]
            dx, dy = line.end[0] - line.start[0], line.end[1] - line.start[1]
            x, y = line.start[0] + place.position * dx, line.start[1] + place.position * dy
            bit = f"{port.name}[{index}]"
            ports[bit] = (x, y)
            length = (dx * dx + dy * dy) ** 0.5
            # the boundary runs clockwise, so inside is to the right of a line
            pinned.setdefault(served[bit], (x + inset * dy / length, y - inset * dx / length))

    graph = networkx.Graph()
    graph.add_nodes_from(mass.name for mass in network.masses)
    graph.add_edges_from((coupling.source, coupling.target) for coupling in network.couplings)
    middle = outline.representative_point() if not outline.contains(outline.centroid) else outline.centroid
    n = len(network.masses)
    start = {}
    for i, mass in enumerate(network.masses):
        turn = 2.0 * np.pi * i / n
        start[mass.name] = pinned.get(
            mass.name, (middle.x + 3 * inset * np.cos(turn), middle.y + 3 * inset * np.sin(turn))
        )
    spread = networkx.spring_layout(
        graph,
        pos=start,
        fixed=sorted(pinned) or None,
        k=0.75 * float(np.sqrt(outline.area / n)),
        iterations=300 if n < 300 else 40,
        seed=1,
    )
    free = [mass.name for mass in network.masses if mass.name not in pinned]
    slots = _lattice(outline.buffer(-0.7 * inset), list(pinned.values()), len(free))
    wanted = np.array([spread[name] for name in free]).reshape(len(free), 2)
    cost = ((wanted[:, None, :] - slots[None, :, :]) ** 2).sum(axis=2)
    _, chosen = linear_sum_assignment(cost)
    seats = pinned | {name: (float(slots[i, 0]), float(slots[i, 1])) for name, i in zip(free, chosen, strict=True)}
    return Seats(boundary, seats, ports, False)


def _lattice(inside: shapely.Polygon, taken: list[Point], least: int) -> NDArray[np.float64]:
    """float[s, 2], a triangular lattice of s >= ``least`` points in ``inside``, none on a point of ``taken``."""
    west, south, east, north = inside.bounds
    pitch = float(np.sqrt(inside.area / max(1, least)))
    while True:
        rows = np.arange(south, north, 0.87 * pitch)
        points = np.array(
            [(x, y) for i, y in enumerate(rows) for x in np.arange(west + (i % 2) * 0.5 * pitch, east + 1e-9, pitch)]
        )
        keep = shapely.contains_xy(inside, points[:, 0], points[:, 1])
        for spot in taken:
            keep &= np.hypot(*(points - np.array(spot)).T) > 0.8 * pitch
        if keep.sum() >= least:
            found: NDArray[np.float64] = points[keep]
            return found
        pitch *= 0.95
