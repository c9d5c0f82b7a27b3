"""How much stiffer couplers are drawn because shuttles may tilt: right between both ends of what plates allow.

Every flexure pulls some way above the shuttles that it joins, and tips them: a shuttle that is free to tilt takes part
of each of its couplings, and of its bias, along. Plates hold shuttles from that, more or less, so no drawing is right
for both. What a mass decides by is how its inputs compare with each other and with its bias; so each coupling is made
such that half way between shuttles held and tilting freely it has what was asked for, less the share that its target's
bias has lost there. (No coupling is drawn softer than sized, which would take higher legs.)

With y the displacements, t the angles, A, B, C the stiffnesses between y and y, y and t, t and t (beams included), what
is left of the couplings of freely tilting shuttles is A - B C^-1 B', and of the biases q - B C^-1 H q, H their heights.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mdlcad.mechanics.fit import in_row
from mdlcad.mechanics.leaves import LeafKind, LeafSize
from mdlcad.mechanics.sizes import BiasSize
from mdlcad.mechanics.unit import UnitLaw
from mdlcad.network.model import Network

_ROUNDS = 12
_MOST = 1.4
"""A coupling that would have to be drawn stiffer than this is left at it: legs get low, and its ends are held more."""


@dataclass(frozen=True, slots=True)
class Lifts:
    """How far flexures lie above the middles of the shuttles that they pull at, mm; negative below.

    Attributes:
        couplings: by name, above the source's and the target's; biases: by mass.
    """

    couplings: Mapping[str, tuple[float, float]]
    biases: Mapping[str, float]


NO_LIFTS = Lifts({}, {})


@dataclass(frozen=True, slots=True)
class Lean:
    """What tilting does to couplings and biases, n masses and e couplings.

    Attributes:
        held, free: float[e], the stiffness between each coupling's ends, N/mm, signed as in a stiffness matrix.
        biases: float[n], share of its bias that a freely tilting shuttle feels; 1 where there is none.
    """

    held: NDArray[np.float64]
    free: NDArray[np.float64]
    biases: NDArray[np.float64]


def lean_of(
    network: Network,
    leaves: Sequence[LeafSize],
    factors: NDArray[np.float64],
    carriers: Sequence[float],
    biases: Sequence[BiasSize],
    law: UnitLaw,
    lifts: Lifts,
) -> Lean:
    """Couplings of ``leaves`` (of the network's, in its order), each ``factors`` times stiffer, on their carriers."""
    place = {mass.name: index for index, mass in enumerate(network.masses)}
    n = len(place)
    stiff, mixed, turning = np.zeros((n, n)), np.zeros((n, n)), law.shuttle_tilt * np.eye(n)

    def add(i: int, j: int, value: float, low: float, high: float) -> None:
        stiff[i, j] += value
        mixed[i, j] += value * high
        turning[i, j] += value * low * high

    ends: list[tuple[int, int]] = []
    for coupling, leaf, factor, carrier in zip(network.couplings, leaves, factors, carriers, strict=True):
        across = leaf.coupling if leaf.kind is LeafKind.ROCKER else -leaf.coupling
        row = in_row(factor * leaf.own, factor * across, factor * leaf.own, carrier)
        a, b = place[coupling.source], place[coupling.target]
        low, high = lifts.couplings.get(coupling.name, (0.0, 0.0))
        add(a, a, row.source, low, low)
        add(b, b, row.target, high, high)
        add(a, b, row.strength, low, high)
        add(b, a, row.strength, high, low)
        ends.append((a, b))
    pull, height = np.zeros(n), np.zeros(n)
    for bias in biases:
        at = place[bias.mass]
        pull[at], height[at] = bias.bias, lifts.biases.get(bias.mass, 0.0)
        add(at, at, bias.self_stiffness * law.stiffness_unit, height[at], height[at])
    give = mixed @ np.linalg.inv(turning)
    free = stiff - give @ mixed.T
    felt = pull - give @ (height * pull)
    share = np.divide(felt, pull, out=np.ones(n), where=pull != 0.0)
    i, j = np.array(ends, dtype=np.int64).reshape(-1, 2).T
    return Lean(stiff[i, j], free[i, j], share)


def middle_factors(
    network: Network,
    leaves: Sequence[LeafSize],
    carriers: Sequence[float],
    biases: Sequence[BiasSize],
    law: UnitLaw,
    lifts: Lifts,
) -> NDArray[np.float64]:
    """How many times stiffer than ``leaves`` every coupling is to be drawn, float[e]; at least 1."""
    place = {mass.name: index for index, mass in enumerate(network.masses)}
    targets = [place[coupling.target] for coupling in network.couplings]
    asked = np.array([leaf.coupling if leaf.kind is LeafKind.ROCKER else -leaf.coupling for leaf in leaves])
    factors = np.ones(len(leaves))
    for _ in range(_ROUNDS):
        found = lean_of(network, leaves, factors, carriers, biases, law, lifts)
        share = 0.5 * (1.0 + found.biases[targets])
        left = np.maximum(0.5 * (found.held + found.free) / asked, 1.0 / _MOST)
        factors = np.clip(factors * share / left, 1.0, _MOST)
    return factors
