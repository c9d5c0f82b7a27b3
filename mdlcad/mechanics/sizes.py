"""What sizing decides about each unit, coupler and bias leaf, with the numbers it gives the network back."""

from __future__ import annotations

from dataclasses import dataclass

from mdlcad.mechanics.leaves import LeafSize


@dataclass(frozen=True, slots=True)
class CouplerSize:
    """The flexure of one coupling and its reduced-model numbers (in units of S0).

    Attributes:
        strength: signed c that the flexure has; self_stiffness: s it adds to both masses.
        quartic: in units of a mass's own quartic.
    """

    coupling: str
    leaf: LeafSize
    strength: float
    self_stiffness: float
    quartic: float


@dataclass(frozen=True, slots=True)
class BiasSize:
    """The bias leaf of one mass.

    Attributes:
        offset: place of the post in y from the row's centre, mm, where the leaf pulls with -q F0 on a shuttle at 0.
        bias: q that it gives; self_stiffness: what it adds to its mass there, in units of S0.
    """

    mass: str
    leaf: LeafSize
    offset: float
    bias: float
    self_stiffness: float


@dataclass(frozen=True, slots=True)
class UnitSize:
    """One mass's unit.

    Attributes:
        compensation_network: what the cell library computed; compensation: minus the self terms of the parts built.
        preload: mm by which the clock block is pushed towards the shuttle when the clock stands in its middle (p = 1);
            room: the least and the most that its slot has room for.
        amplitude: largest |y| seen, mm; strain: largest in its beams there, at large displacements, at either end of
            the clock's motion.
    """

    mass: str
    phase: int
    compensation_network: float
    compensation: float
    preload: float
    room: tuple[float, float]
    amplitude: float
    strain: float
