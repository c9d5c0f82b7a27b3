"""Guides: two leaves along y, side by side, that let a clock plate move in x and keep it from turning.

A clock plate is pushed at its handle, its units push back along their own rows: what they push unevenly would turn the
plate, and each unit's clock would be off by the turn times its height above the handle. Two leaves from the rim to the
plate, far apart in x, take that moment as a push in one and a pull in the other.

Each leaf is a guided beam (both ends clamped, one displaced): sway 12 E I / L^3, along its length E A / L, strain
3 t a / L^2 at a displacement a (``docs/mechanics.md``). A pull P along it adds P a / 10 to its end moments (the sway
force is 12 E I a / L^3 + 6/5 P a / L, the beam constraint model's first term, and the moments balance). Held in x by
its plate, it buckles as a beam clamped at both ends does: 4 pi^2 E I / L^2 (Euler). L is what is left of it between
its fillets (``fillet.shortening``), where it is strained by the notch factor more than beam theory says.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from mdlcad.mechanics.fillet import Seat, flat_root, notch_factor, shortening
from mdlcad.mechanics.findings import Finding
from mdlcad.mechanics.process import Plate, Process

STROKE_SHARE = 0.7
"""Of its strain limit, what a leaf's stroke may take: the rest is left for its load and for walls cut too thick."""
BUCKLING_SHARE = 0.5
"""Of its buckling load, what a leaf may bear: our choice, twofold safety against what imperfect leaves bear less."""
STEP = 0.5
"""Lengths of leaves are multiples of this, mm."""


@dataclass(frozen=True, slots=True)
class GuideLeaf:
    """One leaf.

    Attributes:
        wall, length: in its plate's plane, mm; depth: the plate's thickness, mm; modulus: MPa.
        fillet: radius at its roots, on both sides, mm.
    """

    wall: float
    length: float
    depth: float
    modulus: float
    fillet: float

    @property
    def _bent(self) -> float:
        """As long as it bends, mm."""
        return self.length - 2.0 * shortening(self.wall, flat_root(self.fillet, 2, seat=Seat.BLOCK))[0]

    @property
    def _stretched(self) -> float:
        """As long as it stretches, mm."""
        return self.length - 2.0 * shortening(self.wall, flat_root(self.fillet, 2, seat=Seat.BLOCK))[1]

    @property
    def _bending(self) -> float:
        """E I, N mm^2."""
        return self.modulus * self.depth * self.wall**3 / 12.0

    @property
    def sway(self) -> float:
        """Stiffness in x, N/mm."""
        return 12.0 * self._bending / self._bent**3

    @property
    def along(self) -> float:
        """Stiffness along its length, N/mm."""
        return self.modulus * self.depth * self.wall / self._stretched

    @property
    def buckling(self) -> float:
        """Load along its length, N, at which it buckles between its clamped ends."""
        return 4.0 * math.pi**2 * self._bending / self._bent**2

    def strain(self, stroke: float, load: float) -> float:
        """Largest strain with one end displaced by ``stroke`` mm in x under a ``load`` N along its length."""
        bent = 3.0 * self.wall * stroke / self._bent**2
        more = load * stroke / 10.0 * self.wall / 2.0 / self._bending
        return self._notch * (bent + more + load / (self.modulus * self.depth * self.wall))

    @property
    def _notch(self) -> float:
        """Strain in a fillet over that of beam theory at its end; sharp corners are taken as if they were none."""
        return notch_factor(self.wall, self.fillet) if self.fillet else 1.0


@dataclass(frozen=True, slots=True)
class GuideLoad:
    """What a plate's guides bear and do.

    Attributes:
        load: along each leaf, N. turn: of the plate, rad. error: largest distance, mm, by which that moves the clock
            of any unit. strain: of a leaf. sway_force: at the end of the stroke, of both leaves, N.
    """

    load: float
    turn: float
    error: float
    strain: float
    sway_force: float


def guide_leaf(process: Process, plate: Plate, stroke: float, wall: float) -> GuideLeaf:
    """The shortest leaf of a ``wall`` (mm) in ``plate`` that its ``stroke`` (mm, half of the plate's way) strains no
    more than its share of the material's limit."""
    material, fillet = process.material(plate), process.machine.fillet
    notch = notch_factor(wall, fillet) if fillet else 1.0
    bent = math.sqrt(3.0 * wall * stroke * notch / (STROKE_SHARE * material.strain_limit))
    length = bent + 2.0 * shortening(wall, flat_root(fillet, 2, seat=Seat.BLOCK))[0]
    rounded = round(math.ceil(length / STEP - 1e-9) * STEP, 6)
    return GuideLeaf(wall, rounded, plate.thickness, material.modulus, fillet)


def walls(process: Process) -> Iterator[float]:
    """Walls of leaves to try, thinnest first, as for other flexures; mm."""
    wall = process.machine.min_wall
    while wall <= process.link.wall_max + 1e-9:
        yield round(wall, 6)
        wall += process.link.wall_step


def guide_load(leaf: GuideLeaf, span: float, stroke: float, moment: float, lever: float, reach: float) -> GuideLoad:
    """Two leaves ``span`` mm apart under a ``moment`` (N mm).

    Args:
        lever: height, mm, of the leaves' middle over the handle: there their own sway pushes back.
        reach: greatest height, mm, of a unit's clock pin over the handle, either way.
    """
    swaying = 2.0 * leaf.sway * stroke
    turning = abs(moment) + swaying * abs(lever)
    turn = turning / (leaf.along * span**2 / 2.0)
    load = turning / span
    return GuideLoad(load, turn, turn * reach, leaf.strain(stroke, load), swaying)


def guide_findings(subject: str, leaf: GuideLeaf, load: GuideLoad, process: Process, plate: Plate) -> list[Finding]:
    """Limits that a pair of guides misses: rules ``guide_strain``, ``guide_buckling`` and ``guide_turn``."""
    strain, most = process.material(plate).strain_limit, BUCKLING_SHARE * leaf.buckling
    error = process.machine.repeatability
    found = []
    if load.strain > strain:
        words = f"{100 * load.strain:.3f} % strain at the end of its stroke, {100 * strain:.3f} % allowed"
        found.append(Finding("guide_strain", subject, load.strain, strain, words))
    if load.load > most:
        words = f"bears {load.load:.1f} N along its length, {most:.1f} N is what it may without buckling"
        found.append(Finding("guide_buckling", subject, load.load, most, words))
    if load.error > error:
        words = (
            f"lets the plate turn so that a unit's clock is off by {load.error:.3f} mm, more than the {error:g} mm to "
            "which the machine repeats"
        )
        found.append(Finding("guide_turn", subject, load.error, error, words))
    return found
