"""Fillets at the roots of flexing walls: how much stiffer they make them, and how far they raise the strain there.

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
from functools import cache

import numpy as np


@dataclass(frozen=True, slots=True)
class Zone:
    """A stretch of a beam that is stiffer than the rest of it.

    Attributes:
        start, stop: mm from the beam's start.
        bend, stretch: its mean compliance over that of the rest, in bending and along the beam: 1 if there is no
            difference, 0 if it is rigid.
    """

    start: float
    stop: float
    bend: float
    stretch: float

    def reversed(self, length: float) -> Zone:
        """The same, counted from the other end of a beam of ``length`` mm."""
        return Zone(length - self.stop, length - self.start, self.bend, self.stretch)


@dataclass(frozen=True, slots=True)
class Root:
    """Where a wall meets a block: the fillet's radius, on how many of its two sides, and how far along the wall.

    ``reach`` is less than the radius where the fillet runs into a round eye; ``inside``: how far the beam's end, as
    modelled, is inside of what it meets (half a wall where two walls meet at their centre lines).
    """

    radius: float
    sides: int
    reach: float
    inside: float = 0.0


SHARP = Root(0.0, 0, 0.0)
"""A root without fillets."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


def flat_root(radius: float, sides: int, inside: float = 0.0) -> Root:
    """A root at a straight face."""
    return Root(radius, sides, radius, inside)


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


@cache
def root_zones(wall: float, root: Root) -> tuple[Zone, ...]:
    """The stretches from a beam's end to the end of the root's fillets, and how compliant they are.

    The integrals are Gauss-Legendre quadratures, of an integrand that is smooth but for the vertical tangent at the
    block, where the thickness is greatest and little is added.
    """
    if root.radius <= 0.0 or root.sides == 0 or root.reach <= 0.0:
        return ()
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
    """By how much a root's fillets shorten a wall, mm: as far as it bends, and as far as it stretches."""
    zones = root_zones(wall, root)
    bend, stretch = (
        sum((zone.stop - zone.start) * (1.0 - share) for zone, share in zip(zones, shares, strict=True))
        for shares in ([zone.bend for zone in zones], [zone.stretch for zone in zones])
    )
    return bend, stretch


def bending_matrix(length: float, zones: Sequence[Zone]) -> tuple[float, float, float]:
    """(a, b, c): end moments are E I / length (a A + b B) and E I / length (b A + c B) for end turns A and B.

    The inverse of the flexibility of a beam held at its two ends, whose moment runs straight from one end to the
    other: integrals of (1 - s)^2, -(1 - s) s and s^2 over 1 / E I. (4, 2, 4) without zones.
    """
    if not zones:
        return 4.0, 2.0, 4.0
    first, both, last = 1.0 / 3.0, -1.0 / 6.0, 1.0 / 3.0
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
