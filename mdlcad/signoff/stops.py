"""How far a shuttle can tilt about x before plates stop it: found from the bodies, as an angle that it cannot pass.

A shuttle and all that is rigidly fixed to it (its *net*: rungs, trunks, tabs) is one body, free to rise by z, to tilt
by t about x and to roll by r about y. A point of it at (x, y) from the hub rises by z + t y + r x, and can rise by no
more than the sum of the gaps between it and the nearest fixed face over it: what lies between is pushed together at the
worst, and where a plate has nothing over the point, the plate's thickness is way as well. So too downwards. The largest
t that all points of the net allow, z and r being as they like, is a linear programme of three unknowns, one for either
way. The true angle is smaller: beams hold z and r, what lies between is not pushed together by nothing, and what flexes
is taken to give way altogether.

What moves counts only where it surely is. A net moves by its throw, and what lies over it by its own, independently:
the first is held against those faces alone that are over a point for all of its motion, and the second counts where it
is for all of its own (``worn``). Shims between the rims of plates are left out.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from scipy.optimize import linprog
from shapely import MultiPolygon, Polygon, box
from shapely.geometry.base import BaseGeometry

from mdlcad.mechanics.leaves import trim
from mdlcad.mechanics.process import PlateRole, Process
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.signoff.lvs import Recovered
from mdlcad.signoff.measure import UnitSeen
from mdlcad.signoff.readback import ReadBody

MOST_TILT = 1.0
"""rad: what is said of a net that nothing stops before."""

_CRUMB_MM2 = 1e-4
_GRID_MM = 1e-4
_SAME_MM = 1e-3


@dataclass(frozen=True, slots=True)
class Stop:
    """The angles about x, rad, that a shuttle cannot tilt beyond: ``low`` is negative, ``high`` positive."""

    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Contact:
    """A region of a net, mm from its hub, that can go no farther than ``way`` mm, up (+1) or down (-1: ``side``)."""

    side: int
    way: float
    corners: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class _Level:
    """A plate: its faces, what stands still in it, and what moves, by owner, where it surely is."""

    low: float
    high: float
    still: BaseGeometry
    owners: tuple[str, ...]
    moving: tuple[BaseGeometry, ...]
    tree: shapely.STRtree

    def sure(self, region: BaseGeometry, net: str) -> BaseGeometry:
        """What surely lies in ``region``, of other nets."""
        found = [self.moving[i] for i in sorted(self.tree.query(region)) if self.owners[i] != net]
        return _flat(shapely.union_all(found, grid_size=_GRID_MM)) if found else Polygon()


def stops_of(
    found: Sequence[ReadBody],
    recovered: Recovered,
    units: Mapping[str, UnitSeen],
    process: Process,
    rules: LayoutRules,
) -> dict[str, Stop]:
    """The stops of every shuttle, by mass.

    Args:
        found: the device's bodies; recovered: who moves with whom; process: with the plates of both decks.
    """
    bodies = {body.name: body for body in found}
    nets: dict[str, list[tuple[float, Polygon]]] = {}
    for mass, unit in units.items():
        shuttle = _shuttle(unit)
        own = [(bodies[f"unit.{mass}"].z, shuttle)]
        for name in recovered.carriers.get(mass, ()):
            if name.partition(".")[0] in ("rung", "trunk", "tab"):
                own.append((bodies[name].z, bodies[name].section))
        nets[mass] = own
    levels = _levels(found, nets, process, rules)
    stops = {}
    for mass, own in nets.items():
        unit = units[mass]
        touching = [
            contact
            for z, section in own
            for contact in _contacts(mass, z, section, levels, rules.throw, (unit.x, unit.y))
        ]
        stops[mass] = Stop(-farthest(touching, -1), farthest(touching, 1))
    return stops


def farthest(contacts: Sequence[Contact], turn: int) -> float:
    """The largest angle, rad, one way (``turn`` +1 or -1) that all contacts together allow."""
    rows, limits = [], []
    for contact in contacts:
        for x, y in contact.corners:
            rows.append([contact.side, contact.side * y, contact.side * x])
            limits.append(contact.way)
    if not rows:
        return MOST_TILT
    bounds = [(None, None), (-MOST_TILT, MOST_TILT), (None, None)]
    best = linprog([0.0, -float(turn), 0.0], A_ub=np.array(rows), b_ub=np.array(limits), bounds=bounds, method="highs")
    return trim(float(turn * best.x[1])) if best.status == 0 else MOST_TILT


def worn(shape: BaseGeometry, dx: float, dy: float) -> BaseGeometry:
    """What of ``shape`` is covered at every point of a motion by up to +-dx, then +-dy: less what its edges sweep."""
    for move in (np.array([dx, 0.0]), np.array([0.0, dy])):
        if move.any():
            edges = _dragged_edges(shape, move)
            shape = _flat(shapely.difference(shape, edges, grid_size=_GRID_MM))
    return shape


def _dragged_edges(shape: BaseGeometry, move: np.ndarray) -> BaseGeometry:
    swept = []
    for part in _polygons(shape):
        for ring in (part.exterior, *part.interiors):
            at = np.asarray(ring.coords)[:, :2]
            start, end = at[:-1], at[1:]
            swept.append(shapely.polygons(np.stack([start - move, end - move, end + move, start + move], axis=1)))
    if not swept:
        return Polygon()
    edges = np.concatenate(swept)
    return shapely.union_all([shapely.make_valid(edge) for edge in edges[shapely.area(edges) > 0]], grid_size=_GRID_MM)


def _shuttle(unit: UnitSeen) -> Polygon:
    high = max(abs(beam.y) + beam.wall / 2.0 for beam in (*unit.left, *unit.right))
    return box(unit.x - unit.half_hub, unit.y - high, unit.x + unit.half_hub, unit.y + high)


def _levels(
    found: Sequence[ReadBody],
    nets: Mapping[str, Sequence[tuple[float, Polygon]]],
    process: Process,
    rules: LayoutRules,
) -> list[_Level]:
    levels = []
    for plate in process.stack.plates:
        z = process.z_of(plate.name)
        here = [body for body in found if abs(body.z - z) < _SAME_MM]
        still = [
            body.section
            for body in here
            if body.name.partition(".")[0] in ("frame", "spacer")
            or (plate.role in (PlateRole.BASE, PlateRole.COVER) and body.name.partition(".")[0] == plate.name)
        ]
        moving = [
            (net, worn(s, 0.0, rules.throw)) for net, own in nets.items() for at, s in own if abs(at - z) < _SAME_MM
        ]
        if plate.role is PlateRole.CLOCK:
            clocks = [body for body in here if body.name.partition(".")[0] == plate.name]
            moving += [(plate.name, worn(body.section, rules.clock_throw, 0.0)) for body in clocks]
        shapes = tuple(shape for _, shape in moving)
        fixed = _flat(shapely.union_all(still, grid_size=_GRID_MM)) if still else Polygon()
        owners = tuple(owner for owner, _ in moving)
        levels.append(_Level(z, z + plate.thickness, fixed, owners, shapes, shapely.STRtree(shapes)))
    return levels


def _contacts(
    net: str, z: float, section: Polygon, levels: Sequence[_Level], throw: float, hub: tuple[float, float]
) -> Iterable[Contact]:
    """Where one body of a net surely meets something, above and below, and after how many mm."""
    place = next(index for index, level in enumerate(levels) if abs(level.low - z) < _SAME_MM)
    drawn = _dragged_edges(section, np.array([0.0, throw]))
    over = _flat(shapely.union_all([section, drawn], grid_size=_GRID_MM))
    for side, path in ((1, levels[place + 1 :]), (-1, levels[:place][::-1])):
        met: list[tuple[float, BaseGeometry]] = []
        face = levels[place].high if side > 0 else levels[place].low
        open_to = [(0.0, over)]
        for level in path:
            near, far = (level.low, level.high) if side > 0 else (level.high, level.low)
            gap, through = abs(near - face), abs(far - near)
            face, ahead = far, []
            for way, region in open_to:
                met.append((way + gap, _both(region, level.still)))
                rest = _less(region, level.still)
                sure = level.sure(rest, net)
                ahead += [(way + gap, _both(rest, sure)), (way + gap + through, _less(rest, sure))]
            open_to = [(way, region) for way, region in ahead if not region.is_empty]
        sofar: BaseGeometry = Polygon()
        for way in sorted({round(way, 6) for way, region in met if not region.is_empty}):
            sofar = shapely.union_all(
                [sofar, *(region for at, region in met if round(at, 6) == way)], grid_size=_GRID_MM
            )
            touching = _both(worn(_flat(sofar), 0.0, throw), section)
            if not touching.is_empty:
                corners = shapely.get_coordinates(touching.convex_hull)[:-1]
                yield Contact(side, way, tuple((float(x - hub[0]), float(y - hub[1])) for x, y in corners))


def _both(a: BaseGeometry, b: BaseGeometry) -> BaseGeometry:
    return _flat(shapely.intersection(a, b, grid_size=_GRID_MM))


def _less(a: BaseGeometry, b: BaseGeometry) -> BaseGeometry:
    return _flat(shapely.difference(a, b, grid_size=_GRID_MM))


def _polygons(shape: BaseGeometry) -> list[Polygon]:
    return [part for part in getattr(shape, "geoms", [shape]) if isinstance(part, Polygon) and not part.is_empty]


def _flat(shape: BaseGeometry) -> BaseGeometry:
    """The areas alone of what an overlay leaves, crumbs of the drawing grid left out."""
    parts = [part for part in _polygons(shape) if part.area > _CRUMB_MM2]
    return parts[0] if len(parts) == 1 else MultiPolygon(parts)
