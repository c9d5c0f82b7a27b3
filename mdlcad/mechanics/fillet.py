"""The roots of flexing walls: how much stiffer fillets make them and how far they raise the strain there, how a block
gives way under them, and what walls shear.

A wall of thickness t that meets a block (or another wall) in fillets of radius r is thicker near it: at the distance u
from the fillet's end by n (r - sqrt(r^2 - u^2)), n being the number of its sides that have one. Its compliance there is
the integral of 1 / I and of 1 / A over that thickness, by beam theory, as for corner-filleted flexure hinges
(N. Lobontiu, J. S. N. Paine, E. Garcia, M. Goldfarb, Corner-Filleted Flexure Hinges, J. Mech. Des. 123 (2001)).
Lengths in mm.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cache

import numpy as np


@dataclass(frozen=True, slots=True)
class Zone:
    """A stretch of a beam that is stiffer, or softer, than the rest of it.

    Attributes:
        start, stop: mm from the beam's start.
        bend, stretch: its mean compliance over that of the rest, in bending and along the beam: 1 if there is no
            difference, 0 if it is rigid, more than 1 where a root turns in its block.
    """

    start: float
    stop: float
    bend: float
    stretch: float

    def reversed(self, length: float) -> Zone:
        """The same, counted from the other end of a beam of ``length`` mm."""
        return Zone(length - self.stop, length - self.start, self.bend, self.stretch)


class Seat(StrEnum):
    """What a wall is rooted in, and how far that gives way under the root.

    BLOCK: one many walls thick. BAR: one a wall or two thick, which bends as a beam as well. RIGID: not at all.
    """

    BLOCK = "block"
    BAR = "bar"
    RIGID = "rigid"


@dataclass(frozen=True, slots=True)
class Root:
    """Where a wall meets a block: the fillet's radius, on how many of its two sides, and how far along the wall.

    ``sides`` are those with an inner corner, filleted or sharp: of a wall that is flush with its block's edge, one.
    ``reach`` is less than the radius where the fillet runs into a round eye; ``inside``: how far the beam's end, as
    modelled, is inside of what it meets (half a wall where two walls meet at their centre lines). ``thick``: of the
    bar that is its seat, mm.
    """

    radius: float
    sides: int
    reach: float
    inside: float = 0.0
    seat: Seat = Seat.RIGID
    thick: float = 0.0


SHARP = Root(0.0, 0, 0.0)
"""A root without fillets."""

POISSON = 0.35
"""Of what flexures are cut from (POM, PETG, PA12: suppliers' sheets give 0.35 to 0.4; aluminium 0.33)."""

_SHEAR = 1.2 * 2.0 * (1.0 + POISSON) / 12.0
"""E I / (kappa G A) of a rectangular section over the square of its height; kappa = 5/6 (Timoshenko)."""


def shear_area(wall: float) -> float:
    """E I / (kappa G A) of a wall, mm^2: what ``bending_matrix`` asks for."""
    return _SHEAR * wall**2


def shear_length(wall: float, length: float) -> float:
    """By how much longer a guided wall seems because it shears as well, mm: 12 E I / (kappa G A l^2) = 3 dl / l."""
    return 4.0 * shear_area(wall) / length


def block_give(wall: float, radius: float, sides: int) -> float:
    """By how much longer a wall seems, mm, because the block it is rooted in turns under its end moment.

    From plane-stress computations (``tests/mechanics/beam/test_plane.py``) with r / t from 0 to 0.8, within 1.5 % of
    them: 0.40 t for a sharp root in the middle of a face, 0.64 t for one that is flush with the block's edge. For the
    former W. J. O'Donnell, The Additional Deflection of a Cantilever Due to the Elasticity of the Support, J. Appl.
    Mech. 27 (1960) has a turn of 16.67 M / (pi E w t^2), that is 0.44 t; it knows neither fillets nor edges.
    """
    ratio = radius / wall
    if sides == 1:
        return wall * 0.64 * math.pow(1.0 + 0.71 * ratio, -0.8)
    return wall * 0.402 * math.pow(1.0 + 1.9 * ratio, -0.6)


def block_push(wall: float, sides: int) -> float:
    """By how much longer a wall seems, mm, because it pushes the block's face in.

    From the same computations: a whole shuttle with its beams, its rib and its end block. It grows with the logarithm
    of the block's size (a strip of load on a half plane), which is taken as that of these.
    """
    return wall * (2.33 if sides == 1 else 1.7)


def _bar_share(ratio: float) -> float:
    """Of what a block would give, what a bar ``ratio`` times as thick as the wall gives besides bending.

    From plane-stress computations of whole series springs, with stems and trusses of 1.4 to 2.6 walls.
    """
    return max(0.0, 1.0 - 0.8 / ratio**2)


def _gives(wall: float, root: Root) -> tuple[float, float]:
    """By how much longer a wall seems for what it is rooted in, mm: as it bends, and as it stretches."""
    if root.seat is Seat.BLOCK:
        return block_give(wall, root.radius, root.sides), block_push(wall, root.sides)
    if root.seat is Seat.BAR:
        return _bar_share(root.thick / wall) * block_give(wall, root.radius, root.sides), 0.0
    return 0.0, 0.0


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


def flat_root(radius: float, sides: int, inside: float = 0.0, seat: Seat = Seat.RIGID) -> Root:
    """A root at a straight face."""
    return Root(radius, sides, radius, inside, seat)


def bar_root(radius: float, sides: int, thick: float) -> Root:
    """A root at the straight face of a bar that is ``thick`` mm thick."""
    return Root(radius, sides, radius, 0.0, Seat.BAR, thick)


def eye_root(radius: float, wall: float, eye: float) -> Root:
    """A root, filleted on both sides, at an eye of outer radius ``eye`` that the wall runs at the middle of.

    The fillet touches the wall at the distance sqrt((eye + r)^2 - (wall / 2 + r)^2) from the eye's centre; the wall
    is taken to begin at the eye's front.
    """
    if not radius:
        return SHARP
    return Root(radius, 2, max(0.0, math.sqrt((eye + radius) ** 2 - (wall / 2.0 + radius) ** 2) - eye))


_PIECES = 3
"""A fillet counts as so many stretches of even compliance: most of what it does, it does nearest to the block."""
_TURNING = 0.1
"""A sharp root turns in its block within so much of its wall's thickness."""


@cache
def root_zones(wall: float, root: Root) -> tuple[Zone, ...]:
    """The stretches from a beam's end to the end of the root's fillets, and how compliant they are.

    What the block gives is in the first of them: a turn of the root is a sharp bend of the beam's end.

    The integrals are Gauss-Legendre quadratures, of an integrand that is smooth but for the vertical tangent at the
    block, where the thickness is greatest and little is added.
    """
    give, push = _gives(wall, root)
    if root.radius <= 0.0 or root.sides == 0 or root.reach <= 0.0:
        turning = _TURNING * wall
        return (Zone(0.0, turning, 1.0 + give / turning, 1.0 + push / turning),) if give else ()
    zones = []
    step = root.reach / _PIECES
    for piece in range(_PIECES):
        # from the fillet's end
        u = root.reach - step * (piece + (_NODES + 1.0) / 2.0)
        thick = wall + root.sides * (root.radius - np.sqrt(root.radius**2 - u**2))
        inside = root.inside if piece == 0 else 0.0
        bend, stretch = (
            (inside + step * float(_WEIGHTS @ (wall / thick) ** power) / 2.0) / (inside + step) for power in (3, 1)
        )
        if piece == 0:
            bend, stretch = bend + give / (inside + step), stretch + push / (inside + step)
        stop = root.inside + step * (piece + 1)
        zones.append(Zone(stop - step - inside, stop, bend, stretch))
    return tuple(zones)


def zones_of(length: float, wall: float, first: Root, last: Root) -> tuple[Zone, ...]:
    """The stiffer stretches of a beam of ``length`` and ``wall`` with these roots, as it runs.

    Raises:
        ValueError: the beam is too short for its two fillets.
    """
    before = root_zones(wall, first)
    after = tuple(zone.reversed(length) for zone in reversed(root_zones(wall, last)))
    if before and after and before[-1].stop > after[0].start + 1e-6:
        raise ValueError(
            f"a wall {length:.3f} mm long has no room for fillets of {first.radius:g} and {last.radius:g} mm"
        )
    return before + after


def shortening(wall: float, root: Root) -> tuple[float, float]:
    """By how much a root shortens a wall, mm: as far as it bends, and as far as it stretches.

    Fillets shorten it; a block that gives way makes it longer, so both may be less than 0.
    """
    zones = root_zones(wall, root)
    bend, stretch = (
        sum((zone.stop - zone.start) * (1.0 - share) for zone, share in zip(zones, shares, strict=True))
        for shares in ([zone.bend for zone in zones], [zone.stretch for zone in zones])
    )
    return bend, stretch


def bending_matrix(length: float, zones: Sequence[Zone], shear: float = 0.0) -> tuple[float, float, float]:
    """(a, b, c): end moments are E I / length (a A + b B) and E I / length (b A + c B) for end turns A and B.

    The inverse of the flexibility of a beam held at its two ends, whose moment runs straight from one end to the
    other: integrals of (1 - s)^2, -(1 - s) s and s^2 over 1 / E I. (4, 2, 4) without zones and shear.

    Args:
        shear: E I / (kappa G A), mm^2, 0 for a beam that does not shear.
    """
    if not zones and not shear:
        return 4.0, 2.0, 4.0
    slid = shear / length**2
    first, both, last = 1.0 / 3.0 + slid, -1.0 / 6.0 + slid, 1.0 / 3.0 + slid
    for zone in zones:
        low, high, less = zone.start / length, zone.stop / length, 1.0 - zone.bend
        first -= less * ((1.0 - low) ** 3 - (1.0 - high) ** 3) / 3.0
        both += less * ((high**2 - low**2) / 2.0 - (high**3 - low**3) / 3.0)
        last -= less * (high**3 - low**3) / 3.0
    size = first * last - both**2
    return last / size, -both / size, first / size


def stretch_factor(length: float, zones: Sequence[Zone]) -> float:
    """E A / length times this is the beam's stiffness along itself; 1 without zones."""
    return 1.0 / (1.0 - sum((zone.stop - zone.start) / length * (1.0 - zone.stretch) for zone in zones))


def bare_wall(length: float, zones: Sequence[Zone]) -> tuple[float, float] | None:
    """From where to where, as shares of its length, a beam is bare wall; None if fillets thicken all of it."""
    low, high = 0.0, length
    for zone in zones:
        if zone.start < low + 1e-9:
            low = zone.stop
    for zone in reversed(zones):
        if zone.stop > high - 1e-9:
            high = zone.start
    return (low / length, high / length) if low <= high else None


def notch_factor(wall: float, radius: float, sides: int = 2) -> float:
    """By how much the strain in a fillet exceeds that of beam theory at the fillet's end; infinite for a sharp corner.

    Fitted to plane-stress computations of a wall between blocks, filleted on both its sides or flush with the blocks'
    edges on one (``tests/mechanics/beam/plane.py``), for r / t from 0.1 to 0.6, within 5 %. For both sides Roark's
    table 17.1 (shoulder fillet, bending) gives the same within 8 %. Sharper fillets: growing as the stress towards a
    sharp inner corner of a right angle does, with the power 0.4555 (M. L. Williams, J. Appl. Mech. 19 (1952)).
    """
    if radius <= 0.0:
        return math.inf
    scale, power = (1.21, 0.27) if sides == 1 else (1.14, 0.22)
    ratio = radius / wall
    return max(1.0, scale * math.pow(max(ratio, 0.1), -power) * math.pow(max(1.0, 0.1 / ratio), 0.4555))
