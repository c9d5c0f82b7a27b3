"""Meander flexures: couplers, rockers and bias leaves, sized by the frame solver.

A meander runs along x between two ends at y = 0: legs of wall ``wall`` along y, joined by short bridges along x. It is
soft in y (the signal) and, unlike a straight leaf, soft in x, so that the shortening that goes with a transverse
deflection does not stiffen it. Lengths in mm, forces in N.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from mdlcad.mechanics.fillet import Root, Zone, eye_root, flat_root, shear_area, zones_of
from mdlcad.mechanics.frame import TURN, Array, Beam, Frame, Solution, X, Y, dof

RIGID = 1e4
"""Stiffness of a part taken as rigid, in multiples of the flexure's own."""


@dataclass(frozen=True, slots=True)
class Meander:
    """A meander as cut: ``legs`` upright legs of ``wall``, ``pitch`` apart, centre line up to +-``amplitude``.

    ``fillet`` is the radius of every inner corner, at its ends as at its bends.
    """

    wall: float
    legs: int
    pitch: float
    amplitude: float
    fillet: float = 0.0

    @property
    def length(self) -> float:
        """End to end along x, mm: a stub of one pitch at either end."""
        return (self.legs + 1) * self.pitch

    def path(self) -> list[tuple[float, float]]:
        """Centre line from (0, 0) to (length, 0); first and last leg are half legs. Symmetric about the middle."""
        points = [(0.0, 0.0)]
        side = 0.0
        for leg in range(self.legs):
            x = (leg + 1) * self.pitch
            points.append((x, side))
            if leg == self.legs - 1:
                side = 0.0
            else:
                side = self.amplitude if leg % 2 == 0 else -self.amplitude
            points.append((x, side))
        points.append((self.length, 0.0))
        return points


@dataclass(frozen=True, slots=True)
class Sheet:
    """What a flexure is cut from: modulus in MPa, depth (plate thickness) in mm, strain limit."""

    modulus: float
    depth: float
    strain_limit: float

    def beam(self, start: int, end: int, wall: float, factor: float = 1.0, zones: tuple[Zone, ...] = ()) -> Beam:
        """A beam of this sheet: E A = E d w, E I = E d w^3 / 12; stiffer in ``zones``."""
        stretch = self.modulus * self.depth * wall * factor
        return Beam(start, end, stretch, stretch * wall**2 / 12.0, zones)

    def shearing(self, start: int, end: int, wall: float, zones: tuple[Zone, ...] = ()) -> Beam:
        """The same, of one so short that it matters that it shears as well."""
        return replace(self.beam(start, end, wall, zones=zones), shear=shear_area(wall))

    def walls(
        self,
        nodes: Sequence[tuple[float, float]],
        walls: Sequence[float],
        ends: tuple[Root, Root],
        bends: Sequence[float],
    ) -> list[Beam]:
        """The walls of a meander from node to node.

        Args:
            ends: the roots of its two ends; bends: radius of the fillet at each node between.

        Raises:
            ValueError: two of its fillets do not fit between their bends.
        """
        beams = []
        for i, wall in enumerate(walls):
            # a bend is filleted on its inner side only, and modelled to where the centre lines meet
            before = ends[0] if i == 0 else flat_root(bends[i - 1], 1, walls[i - 1] / 2.0)
            after = ends[1] if i == len(walls) - 1 else flat_root(bends[i], 1, walls[i + 1] / 2.0)
            length = math.dist(nodes[i], nodes[i + 1])
            beams.append(self.beam(i, i + 1, wall, zones=zones_of(length, wall, before, after)))
        return beams


@dataclass(frozen=True, slots=True)
class Chain:
    """A flexure as a frame: node numbers of its ends and of its eye (None if it has none)."""

    frame: Frame
    flexible: int
    left: int
    right: int
    eye: int | None
    wall: float

    def clamped(self, node: int) -> list[int]:
        """Degrees of freedom that an end block holds besides y."""
        return [dof(node, X), dof(node, TURN)]


def coupler_chain(meander: Meander, sheet: Sheet) -> Chain:
    """A meander between two blocks that do not turn."""
    nodes, end = meander.path(), flat_root(meander.fillet, 2)
    count = len(nodes) - 1
    beams = sheet.walls(nodes, [meander.wall] * count, (end, end), [meander.fillet] * (count - 1))
    return Chain(Frame(nodes, beams), len(beams), 0, len(nodes) - 1, None, meander.wall)


def to_eye(meander: Meander, sheet: Sheet, eye_radius: float) -> list[Beam]:
    """The walls of a meander from a block to an eye of that outer radius."""
    path = meander.path()
    count = len(path) - 1
    ends = flat_root(meander.fillet, 2), eye_root(meander.fillet, meander.wall, eye_radius)
    return sheet.walls(path, [meander.wall] * count, ends, [meander.fillet] * (count - 1))


def mirrored(beam: Beam, length: float, last: int) -> Beam:
    """A beam of a chain whose nodes are numbered backwards from ``last``, as it runs in the other half of a rocker."""
    zones = tuple(zone.reversed(length) for zone in reversed(beam.zones))
    return replace(beam, start=last - beam.end, end=last - beam.start, zones=zones)


def rocker_chain(meander: Meander, sheet: Sheet, eye_radius: float) -> Chain:
    """Two mirrored meanders joined by an eye of outer radius ``eye_radius`` that turns freely on a fixed post."""
    half = meander.path()
    centre = meander.length + eye_radius
    nodes = [*half, (centre, 0.0), *[(2.0 * centre - x, y) for x, y in reversed(half)]]
    count = len(half)
    beams = to_eye(meander, sheet, eye_radius)
    beams += [mirrored(beam, math.dist(half[beam.start], half[beam.end]), 2 * count) for beam in reversed(beams)]
    rigid = [sheet.beam(count - 1, count, meander.wall, RIGID), sheet.beam(count, count + 1, meander.wall, RIGID)]
    return Chain(Frame(nodes, beams + rigid), len(beams), 0, 2 * count, count, meander.wall)


def bias_chain(meander: Meander, sheet: Sheet, eye_radius: float) -> Chain:
    """A meander from the hub's block (left) to a slotted eye that turns and slides along x on a fixed post (right)."""
    path = meander.path()
    nodes = [*path, (meander.length + eye_radius, 0.0)]
    count = len(path)
    beams = to_eye(meander, sheet, eye_radius)
    rigid = [sheet.beam(count - 1, count, meander.wall, RIGID)]
    return Chain(Frame(nodes, beams + rigid), len(beams), 0, count, count, meander.wall)


def signal_matrix(chain: Chain) -> Array:
    """Stiffness at (y left, y right), N/mm, shape (2, 2), for end blocks that do not turn; the eye is on its post."""
    keep = [dof(chain.left, Y), dof(chain.right, Y)]
    held = chain.clamped(chain.left)
    if chain.eye == chain.right:
        return chain.frame.condense(keep, held)
    held += chain.clamped(chain.right)
    if chain.eye is not None:
        held += [dof(chain.eye, X), dof(chain.eye, Y)]
    return chain.frame.condense(keep, held)


def axial_stiffness(chain: Chain) -> float:
    """Stiffness in x, N/mm, of the stretch from the left end to the eye (or the right end) at no deflection in y.

    0 for a bias leaf, whose slotted eye lets it slide.
    """
    if chain.eye == chain.right:
        return 0.0
    far = chain.right if chain.eye is None else chain.eye
    held = [dof(far, X), dof(far, Y), dof(chain.left, Y), dof(chain.left, TURN)]
    if far != chain.right:
        held += [dof(chain.right, i) for i in (X, Y, TURN)]
    else:
        held.append(dof(far, TURN))
    return float(chain.frame.condense([dof(chain.left, X)], held)[0, 0])


def drawn_in(chain: Chain, solution: Solution) -> float:
    """How far a bias leaf's eye is drawn towards the hub, mm: what the frame gives, and the shortening."""
    return examine(chain, solution).shortening - float(solution.displacements[dof(chain.right, X)])


def driven(chain: Chain, left: float, right: float) -> dict[int, float]:
    """What is prescribed when the ends are displaced in y; blocks are held in x and do not turn, eyes turn freely."""
    prescribed = {dof(chain.left, Y): left, dof(chain.right, Y): right}
    prescribed |= dict.fromkeys(chain.clamped(chain.left), 0.0)
    if chain.eye != chain.right:
        prescribed |= dict.fromkeys(chain.clamped(chain.right), 0.0)
        if chain.eye is not None:
            prescribed |= {dof(chain.eye, X): 0.0, dof(chain.eye, Y): 0.0}
    return prescribed


def deflect(chain: Chain, left: float, right: float) -> Solution:
    """The flexure with its ends displaced in y (see ``driven``), by linear theory."""
    return chain.frame.solve(driven(chain, left, right))


@dataclass(frozen=True, slots=True)
class Deflection:
    """What a deflection does to a flexure.

    Attributes:
        strain: largest bending strain, M w / (2 E I).
        slope: largest turn, rad; eye: turn of the eye, rad.
        clearance: least distance between the walls of two legs, or of a leg and an end face, mm.
        sweep: largest displacement in x, mm.
        shortening: 1/2 integral of turn^2 over the bridges (the parts along x) from the left end to the eye, mm.
    """

    strain: float
    slope: float
    eye: float
    clearance: float
    sweep: float
    shortening: float


_AT = np.linspace(0.0, 1.0, 5)
_SIMPSON = np.array([1.0, 4.0, 2.0, 4.0, 1.0]) / 12.0  # exact enough: the square of a quadratic, in four steps


def examine(chain: Chain, solution: Solution) -> Deflection:
    """Strain, turns and clearances of a deflected flexure (linear theory, which overstates the clearance loss)."""
    frame = chain.frame
    strain = slope = sweep = shortening = 0.0
    legs: list[Array] = []
    last = float(frame.nodes[chain.right if chain.eye is None else chain.eye][0])
    for beam in frame.beams[: chain.flexible]:
        points, turns = frame.deformed(beam, solution, _AT)
        turns = turns + 0.0
        moment = frame.wall_moment(beam, solution)
        strain = max(strain, moment * chain.wall / (2.0 * beam.bending))
        slope = max(slope, float(np.max(np.abs(turns))))
        ends = frame.nodes[[beam.start, beam.end]]
        straight = ends[0] + np.outer(_AT, ends[1] - ends[0])
        sweep = max(sweep, float(np.max(np.abs(points[:, 0] - straight[:, 0]))))
        if ends[0][1] == ends[1][1]:
            if max(ends[:, 0]) <= last:
                shortening += 0.5 * float(_SIMPSON @ turns**2) * frame.length(beam)
        else:
            legs.append(points)
    eye = 0.0 if chain.eye is None else float(solution.displacements[dof(chain.eye, TURN)])
    faces = (float(frame.nodes[chain.left][0]), float(frame.nodes[chain.right][0]))
    return Deflection(strain, slope, abs(eye), _clearance(legs, faces, chain.wall), sweep, shortening)


def _clearance(legs: list[Array], faces: tuple[float, float], wall: float) -> float:
    least = min(float(np.min(np.vstack(legs)[:, 0])) - faces[0], faces[1] - float(np.max(np.vstack(legs)[:, 0])))
    least -= wall / 2.0
    for one, other in pairwise(legs):
        # both legs run through the same heights; compare them there
        low = max(one[:, 1].min(), other[:, 1].min())
        high = min(one[:, 1].max(), other[:, 1].max())
        heights = np.linspace(low, high, 9)
        least = min(least, float(np.min(_x_at(other, heights) - _x_at(one, heights))) - wall)
    return least


def _x_at(leg: Array, heights: Array) -> Array:
    order = np.argsort(leg[:, 1], kind="stable")
    return np.asarray(np.interp(heights, leg[order, 1], leg[order, 0]), dtype=np.float64)


def pitch_for(stiffness: Callable[[float], float], target: float, low: float, high: float) -> float | None:
    """The pitch in [low, high], to 1 um, at which the falling ``stiffness(pitch)`` is ``target``, or None.

    Solved by Brent's method on the logarithm of the stiffness, which is close to linear in that of the pitch.
    """
    if stiffness(low) < target or stiffness(high) > target:
        return None
    root = brentq(lambda log: math.log(stiffness(math.exp(log)) / target), math.log(low), math.log(high), xtol=1e-6)
    return round(math.exp(root), 3)
