"""A network on a grid of 1 x 1 footprints inside its boundary: the placed network before it has parts.

The sites are the points of the program's own integer grid inside the boundary, as in the paper; where there are too
few, of a grid divided by a whole number.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import shapely
from shapely import Polygon

from mdlcad.errors import UsageError
from mdlcad.network.model import Network
from mdlcad.placement.names import PlacerName
from mdlcad.placement.placers import Placer
from mdlcad.placement.ports import PortPlace
from mdlcad.placement.sites import Sited, SiteProblem
from mdlcad.placement.sites.problem import lines_between


class Seating(StrEnum):
    """How a port meets the network. ON_BOUNDARY: its mass stands at the port's own place, as the paper's separate gates
    for inputs and outputs do (a mass of several ports is tabbed). TAB: its mass moves, and a line joins it to the port.
    """

    ON_BOUNDARY = "on boundary"
    TAB = "tab"


@dataclass(frozen=True, slots=True)
class GridMass:
    """A mass at its place, in grid units; ``port`` if it stands on the boundary for that port bit."""

    mass: str
    x: float
    y: float
    port: str | None


@dataclass(frozen=True, slots=True)
class GridPort:
    """A port bit at its place, in grid units, and the mass that serves it."""

    bit: str
    mass: str
    x: float
    y: float


@dataclass(frozen=True, slots=True)
class GridPlacement:
    """Who sits where.

    Attributes:
        boundary: one vertex a line, in grid units.
        footprint: distance of neighbouring sites, grid units.
        crossings: pairs of couplings without a common mass whose straight lines meet.
        length: of all couplings as straight lines, in footprints.
    """

    placer: PlacerName
    seed: int
    boundary: tuple[tuple[float, float], ...]
    footprint: float
    masses: tuple[GridMass, ...]
    ports: tuple[GridPort, ...]
    crossings: int
    length: float


@dataclass(frozen=True, slots=True, eq=False)
class GridProblem:
    """The sites inside a boundary and the network's lines, with the names behind the numbers.

    Attributes:
        order: names of the masses behind the nodes and then the pins of ``sites``; a pin without a mass is "".
        scale: grid units of a footprint.
    """

    sites: SiteProblem
    order: tuple[str, ...]
    ports: tuple[GridPort, ...]
    scale: float


def place_on_grid(
    network: Network,
    boundary: tuple[tuple[int, int], ...],
    ports: tuple[PortPlace, ...],
    placer: Placer,
    seating: Seating,
    seed: int,
) -> GridPlacement:
    """Place ``network`` inside ``boundary`` (grid units) with its ports at their places.

    Raises:
        UsageError: a port of the network has no place.
    """
    problem = grid_problem(network, boundary, ports, seating)
    return grid_placement(network, boundary, problem, placer.on_sites(problem.sites, seed), placer.name, seed)


def grid_problem(
    network: Network, boundary: tuple[tuple[int, int], ...], ports: tuple[PortPlace, ...], seating: Seating
) -> GridProblem:
    """Sites and lines for ``network``.

    Raises:
        UsageError: a port of the network has no place.
    """
    places = {place.bit: place for place in ports}
    bits = (*network.sensors, *network.actuators)
    for bit in bits:
        if bit.bit not in places:
            raise UsageError(f"port {bit.bit} has no place on the boundary; give it a location")
    placed = tuple(GridPort(bit.bit, bit.mass, places[bit.bit].x, places[bit.bit].y) for bit in bits)
    served = Counter(port.mass for port in placed)
    seated = {port.mass: port for port in placed if seating is Seating.ON_BOUNDARY and served[port.mass] == 1}
    moving = [mass.name for mass in network.masses if mass.name not in seated]
    tabbed = [port for port in placed if port.mass not in seated]
    scale, sites = _sites(Polygon(boundary), max(1, len(moving)))
    still = [seated[name] for name in sorted(seated)] + tabbed
    node = {name: index for index, name in enumerate([*moving, *sorted(seated)])}
    pairs = [(node[item.source], node[item.target]) for item in network.couplings]
    pairs += [(node[port.mass], len(node) + index) for index, port in enumerate(tabbed)]
    pins = np.array([(port.x, port.y) for port in still]).reshape(-1, 2) / scale
    return GridProblem(
        sites=SiteProblem(len(moving), sites, pins, lines_between(pairs)),
        order=(*moving, *sorted(seated), *("" for _ in tabbed)),
        ports=placed,
        scale=scale,
    )


def _sites(outline: Polygon, need: int) -> tuple[float, np.ndarray]:
    """The footprint, and the (S, 2) integer places of at least ``need`` of them: points of the program's own grid
    strictly inside the boundary, or of that grid divided by the smallest whole number that gives enough."""
    x_low, y_low, x_high, y_high = outline.bounds
    shapely.prepare(outline)
    divisor = 1
    while True:
        axes = (
            np.arange(int(low) * divisor, int(high) * divisor + 1) for low, high in ((x_low, x_high), (y_low, y_high))
        )
        x, y = (axis.ravel() for axis in np.meshgrid(*axes, indexing="ij"))
        inside = shapely.contains_properly(outline, shapely.points(x / divisor, y / divisor))
        if int(inside.sum()) >= need:
            return 1 / divisor, np.stack([x[inside], y[inside]], axis=1).astype(np.float64)
        divisor += 1


def grid_placement(
    network: Network,
    boundary: tuple[tuple[int, int], ...],
    problem: GridProblem,
    found: Sited,
    placer: PlacerName,
    seed: int,
) -> GridPlacement:
    """The artefact of a solution."""
    points = problem.sites.points(found.site_of) * problem.scale
    where = {name: points[index] for index, name in enumerate(problem.order) if name}
    moving = set(problem.order[: problem.sites.nodes])
    port_of = {port.mass: port.bit for port in problem.ports if port.mass not in moving}
    return GridPlacement(
        placer=placer,
        seed=seed,
        boundary=tuple((float(x), float(y)) for x, y in boundary),
        footprint=round(problem.scale, 9),
        masses=tuple(
            GridMass(
                mass.name,
                round(float(where[mass.name][0]), 9),
                round(float(where[mass.name][1]), 9),
                port_of.get(mass.name),
            )
            for mass in network.masses
        ),
        ports=problem.ports,
        crossings=found.crossings,
        length=round(found.length, 9),
    )
