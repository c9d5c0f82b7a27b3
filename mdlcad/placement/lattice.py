"""Lattices of unit slots inside a boundary at one scale, best first."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from shapely import Polygon, box, prepare

from mdlcad.errors import UsageError
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.grid import RESOLUTION, TabTerminal, inside, terminals
from mdlcad.placement.placement import PlacedPort, Placement
from mdlcad.placement.ports import PortPlace


@dataclass(frozen=True, slots=True)
class Lattice:
    """A boundary in mm with rows, columns and usable slots; ``inner`` is the boundary less rim and gap."""

    boundary: tuple[tuple[float, float], ...]
    mm_per_grid: float
    inner: Polygon
    column_x: tuple[float, ...]
    row_y: tuple[float, ...]
    slots: tuple[tuple[int, int], ...]
    ports: tuple[PlacedPort, ...]
    tabs: tuple[TabTerminal, ...]


def place_ports(network: Network, ports: tuple[PortPlace, ...], scale: float) -> tuple[PlacedPort, ...]:
    """The network's port bits at their places in mm, in the network's order (sensors, then actuators).

    Places without a mass in the network (a sensor that nothing reads) get no tab.

    Raises:
        UsageError: the network has a port bit without a place.
    """
    places = {place.bit: place for place in ports}
    placed = []
    for bit in (*network.sensors, *network.actuators):
        if bit.bit not in places:
            raise UsageError(f"port {bit.bit} has no place on the boundary; give it a location")
        place = places[bit.bit]
        x, y = round(place.x * scale, 6), round(place.y * scale, 6)
        placed.append(PlacedPort(bit.bit, bit.mass, place.line, x, y, place.normal))
    return tuple(placed)


def outline_at(boundary: Iterable[tuple[int, int]], scale: float) -> tuple[tuple[float, float], ...]:
    """The corners of a boundary on the program's grid in mm, at ``scale`` mm per grid unit."""
    return tuple((round(x * scale, 6), round(y * scale, 6)) for x, y in boundary)


def bare_placement(
    network: Network, boundary: Iterable[tuple[int, int]], ports: tuple[PortPlace, ...], scale: float, seed: int
) -> Placement:
    """Outline and ports at ``scale``, nobody placed.

    Raises:
        UsageError: as ``place_ports``.
    """
    return Placement(outline_at(boundary, scale), scale, (), (), (), (), place_ports(network, ports, scale), seed)


def lattices(
    boundary_grid: tuple[tuple[int, int], ...],
    ports: tuple[PlacedPort, ...],
    rules: LayoutRules,
    scale: float,
    need: int,
) -> tuple[Lattice, ...]:
    """Lattices of at least ``need`` slots at ``scale`` mm per grid unit; few columns and wide channels first."""
    boundary = outline_at(boundary_grid, scale)
    inner = inside(boundary, rules)
    if inner.is_empty:
        return ()
    x_low, y_low, x_high, y_high = inner.bounds
    most_columns = int((x_high - x_low - rules.unit_left - rules.unit_right) / rules.column_pitch) + 1
    rows = int((y_high - y_low) / rules.row_pitch + 1e-9)
    found: list[tuple[tuple[float, ...], Lattice]] = []
    for columns in range(most_columns, 0, -1):
        if columns * rows < need:
            break
        least = math.ceil(rules.column_pitch / RESOLUTION - 1e-9) * RESOLUTION
        spare = x_high - x_low - rules.unit_left - rules.unit_right - (columns - 1) * least - RESOLUTION
        if spare < 0:
            continue
        pitches = dict.fromkeys(
            math.floor(
                max(least, min(least + share * spare / max(1, columns - 1), rules.column_most)) / RESOLUTION + 1e-9
            )
            for share in (0.5, 0.0, 0.85)
        )
        for order, pitch in enumerate(pitches):
            margin = (spare - (columns - 1) * (pitch * RESOLUTION - least)) / 2
            first = math.ceil((x_low + rules.unit_left + margin) / RESOLUTION - 1e-9)
            column_x = tuple(round((first + column * pitch) * RESOLUTION, 6) for column in range(columns))
            best: tuple[tuple[float, ...], Lattice] | None = None
            for y_first in _row_offsets(ports, y_low, y_high, rows, rules):
                row_y = tuple(round(y_first + r * rules.row_pitch, 6) for r in range(rows))
                lattice = make_lattice(boundary, scale, inner, column_x, row_y, ports, rules)
                aligned = sum(1 for tab in lattice.tabs if not tab.vertical and tab.row is not None)
                key = (-min(len(lattice.slots), need + 4), -aligned, order, -columns)
                if len(lattice.slots) >= need and (best is None or key < best[0]):
                    best = (key, lattice)
            if best is not None:
                found.append(best)
    found.sort(key=lambda pair: (pair[0][2], pair[0][0], pair[0][3]))
    return tuple(lattice for _, lattice in found)


def _row_offsets(
    ports: tuple[PlacedPort, ...], y_low: float, y_high: float, rows: int, rules: LayoutRules
) -> tuple[float, ...]:
    """Heights of the first row to try: bottom, middle and top of the spare height, and every port's own height."""
    first = y_low + rules.row_pitch / 2
    spare = max(0.0, y_high - y_low - rows * rules.row_pitch)
    offsets = [first + spare / 2, first, first + spare]
    for port in ports:
        if abs(port.normal[0]) >= abs(port.normal[1]):
            shift = (port.y - first) % rules.row_pitch
            if shift <= spare:
                offsets.append(first + shift)
    return tuple(dict.fromkeys(round(offset, 6) for offset in offsets))


def make_lattice(
    boundary: tuple[tuple[float, float], ...],
    scale: float,
    inner: Polygon,
    column_x: tuple[float, ...],
    row_y: tuple[float, ...],
    ports: tuple[PlacedPort, ...],
    rules: LayoutRules,
) -> Lattice:
    """The lattice of those columns and rows: its slots are what lies inside and is not taken by a tab."""
    tabs = terminals(ports, inner, column_x, row_y, rules)
    keep = rules.hub_half + rules.bar_width / 2 + rules.gap
    # a vertical tab over a hub column takes the hub's place in its rows
    taken = {
        (column, row)
        for tab in tabs
        if tab.vertical
        for column, hub in enumerate(column_x)
        if abs(hub - tab.x) < keep
        for row in tab.rows
    }
    roomy = inner.buffer(1e-6, join_style="mitre")
    prepare(roomy)
    half = rules.row_pitch / 2
    slots = tuple(
        (column, row)
        for column, x in enumerate(column_x)
        for row, y in enumerate(row_y)
        if (column, row) not in taken
        and roomy.contains(box(x - rules.unit_left, y - half, x + rules.unit_right, y + half))
    )
    return Lattice(boundary, scale, inner, column_x, row_y, slots, ports, tabs)
