"""How every point of a body follows the bodies of reference (frame, clock plates, shuttles) that it is attached to.

A rigid body goes with one reference. A flexure joins two or three: its ends go with them, and in between the motion is
interpolated along its length (3 s^2 - 2 s^3, the shape of a beam whose ends do not turn; straight for a rocker, which
turns about its post). That shows who moves whom and how far; it is not the bent shape that ``mechanics`` computes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from shapely import Polygon

from mdlcad.mechanics import Process, Sizing
from mdlcad.network.model import Network
from mdlcad.parts.body import Body, BodyKind
from mdlcad.view.built import Built

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

FRAME = 0


@dataclass(frozen=True, slots=True, eq=False)
class Follow:
    """For n points: displacement = (1 - share) displacement[first] + share displacement[second].

    Attributes:
        first, second: int[n], references; share: float[n].
    """

    first: Ints
    second: Ints
    share: Floats


@dataclass(frozen=True, slots=True, eq=False)
class References:
    """Numbers of the bodies of reference: 0 the frame, 1..P the clock plates, then the masses in network order."""

    names: tuple[str, ...]

    def index(self, name: str) -> int:
        """Number of a reference, of those in ``names``."""
        return self.names.index(name)


def references_of(network: Network) -> References:
    """The references of a device."""
    clocks = (f"clock:{phase}" for phase in range(network.dynamics.phases))
    return References(("frame", *clocks, *(f"mass:{mass.name}" for mass in network.masses)))


def displacements(built: Built, x: Floats, waves: Floats) -> Floats:
    """float[r, 2], mm: how far every reference stands from where it is drawn.

    Args:
        x: float[n], displacements of the masses in network order (dimensionless).
        waves: float[P], the clock waves p_k. A clock plate is drawn in its middle, at p = 1; there k is k0 + k1, and
            each unit of k less is ``stroke_per_k`` mm of push towards the shuttles (lower x).
    """
    masses = built.network.masses
    moved = np.zeros((1 + len(waves) + len(masses), 2))
    for phase, wave in enumerate(waves):
        gain = min((mass.k1 for mass in masses if mass.phase == phase), default=0.0)
        moved[1 + phase, 0] = built.sizing.law.stroke_per_k * gain * (wave - 1.0)
    moved[1 + len(waves) :, 1] = built.process.unit.throw_unit * x
    return moved


class Follower:
    """Says how the points of each body of one device follow its references."""

    def __init__(self, built: Built) -> None:
        self._references = references_of(built.network)
        self._sizing: Sizing = built.sizing
        self._process: Process = built.process
        self._hubs = {place.mass: (place.x, place.y) for place in built.placement.masses}
        # twice the middle of the boundary in y
        self._across = sum(Polygon(built.placement.boundary).bounds[1::2])
        self._couplers = {item.coupling: item.leaf.reach for item in built.sizing.couplers}
        self._biases = {item.mass: item.leaf.reach for item in built.sizing.biases}
        self._preloads = {unit.mass: unit.preload for unit in built.sizing.units}
        self._flexures: dict[BodyKind, Callable[[Body, Floats], Follow]] = {
            BodyKind.UNIT: self._unit,
            BodyKind.COUPLER: self._coupler,
            BodyKind.ROCKER: self._rocker,
            BodyKind.BIAS: self._bias,
            BodyKind.GUIDE: self._guide,
        }

    def follow(self, body: Body, points: Floats) -> Follow:
        """For ``points``, float[n, 2] in mm, of ``body``. A flexure of a kind unknown here goes with its first."""
        flexure = self._flexures.get(body.kind)
        if flexure is None or len(body.moves_with) == 1:
            return self._rigid(body, points)
        return flexure(body, points)

    def _number(self, body: Body, kind: str) -> int:
        """The body's first reference of a kind ("mass", "clock")."""
        return self._references.index(next(ref for ref in body.moves_with if ref.startswith(f"{kind}:")))

    def _rigid(self, body: Body, points: Floats) -> Follow:
        number = np.full(len(points), self._references.index(body.moves_with[0]), dtype=np.int64)
        return Follow(number, number, np.zeros(len(points)))

    def _along(self, mass: str, reach: float, points: Floats) -> Floats:
        """0 at the face of the mass's hub block, 1 at the flexure's other end."""
        start = np.abs(points[:, 0] - self._hubs[mass][0]) - self._sizing.rules.hub_half
        share: Floats = np.clip(start / max(reach, 1e-9), 0.0, 1.0)
        return share

    def _coupler(self, body: Body, points: Floats) -> Follow:
        source, target = body.moves_with[0], body.moves_with[1]
        reach = self._couplers.get(body.name.partition(".")[2], 0.0)
        share = _smooth(self._along(target.partition(":")[2], reach, points))
        return self._between(target, source, share)

    def _rocker(self, body: Body, points: Floats) -> Follow:
        source, target = body.moves_with[0], body.moves_with[1]
        reach = self._couplers.get(body.name.partition(".")[2], 0.0)
        along = 2.0 * self._along(target.partition(":")[2], reach, points)
        near = self._between(target, "frame", np.clip(along, 0.0, 1.0))
        far = self._between("frame", source, np.clip(along - 1.0, 0.0, 1.0))
        return _choose(along <= 1.0, near, far)

    def _bias(self, body: Body, points: Floats) -> Follow:
        hub = body.moves_with[0]
        mass = hub.partition(":")[2]
        return self._between(hub, "frame", _smooth(self._along(mass, self._biases.get(mass, 0.0), points)))

    def _guide(self, body: Body, points: Floats) -> Follow:
        """Its root with the frame, its end, which is the one farther from the rim, with the plate."""
        plate = self._references.names[self._number(body, "clock")]
        low, high = body.section.bounds[1], body.section.bounds[3]
        share = (points[:, 1] - low) / (high - low)
        return self._between("frame", plate, _smooth(share if low + high < self._across else 1.0 - share))

    def _unit(self, body: Body, points: Floats) -> Follow:
        """Shuttle, beams to the frame (left) and to the end block (right), then the series spring and clock block."""
        shuttle, clock = self._number(body, "mass"), self._number(body, "clock")
        mass = self._references.names[shuttle].partition(":")[2]
        rules, span, series = self._sizing.rules, self._process.unit.span, self._sizing.series
        x, y = points[:, 0] - self._hubs[mass][0], np.abs(points[:, 1] - self._hubs[mass][1])
        beam = _smooth(np.clip((np.abs(x) - rules.hub_half) / span, 0.0, 1.0))
        swaying = self._between(self._references.names[shuttle], "frame", beam)
        # the end block yields to the clock as the series spring does to the beams
        law = self._sizing.law
        block = law.series_stiffness / (law.series_stiffness + law.beams_axial)
        end = rules.hub_half + span + self._process.unit.block_width
        near = end + series.clear_block + series.wall / 2.0 + (series.leaves - 1) * series.pitch
        middle = near + (series.wall + series.clear - self._preloads[mass]) / 2.0
        bank = (series.leaves - 1) * series.pitch + series.wall
        last = near + series.wall / 2.0 + series.clear + bank
        root = series.arm / 2.0
        bend = 0.5 * _smooth(np.clip((y - root) / series.length, 0.0, 1.0))
        drive = np.where(x < middle, bend, 1.0 - bend)
        drive = np.where((x > last) & (y < root + series.length), 1.0, drive)
        drive = np.where((x <= end + 1e-6), 0.0, drive)
        pushed = self._between("frame", self._references.names[clock], block + (1.0 - block) * drive)
        return _choose(x < rules.hub_half + span - 1e-6, swaying, pushed)

    def _between(self, first: str, second: str, share: Floats) -> Follow:
        n = len(share)
        return Follow(
            np.full(n, self._references.index(first), dtype=np.int64),
            np.full(n, self._references.index(second), dtype=np.int64),
            share,
        )


def _smooth(s: Floats) -> Floats:
    shape: Floats = s * s * (3.0 - 2.0 * s)
    return shape


def _choose(where: NDArray[np.bool_], one: Follow, other: Follow) -> Follow:
    return Follow(
        np.where(where, one.first, other.first),
        np.where(where, one.second, other.second),
        np.where(where, one.share, other.share),
    )
