"""What shuttles take from their couplings by tilting: every coupling pulls some way above the shuttles that it joins.

A shuttle that tilts freely by theta takes the ends of its couplings, h above it, along by h theta, and theta is the sum
of their forces times their heights over its tilting stiffness K. With s the couplings' stiffnesses in a row with their
carriers, the forces of all are f = (diag(1 / s) + H H' / K)^-1 d for ends that are d apart at tilts of zero; H holds a
coupling's heights over its source and its target. This is linear statics; what plates help by is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix, diags
from scipy.sparse.linalg import splu

from mdlcad.mechanics.preload import RIGID_CARRIER

_LEAST = 1e-3
"""Share of a coupling that is left at the least, so that a hopeless one is a number still."""


@dataclass(frozen=True, slots=True)
class Pull:
    """One coupling as it pulls at two shuttles.

    Attributes:
        stiffness: N/mm, in a row with its carrier.
        source_height, target_height: of its flexure above the middles of their unit plates, mm.
        turning: -1 of a coupler, +1 of a rocker: which way its target's end goes with it.
    """

    source: str
    target: str
    stiffness: float
    source_height: float
    target_height: float
    turning: float


def lean_stiffnesses(pulls: Sequence[Pull], tilt: float) -> tuple[float, ...]:
    """For each coupling, N/mm: the spring that, in a row with it, weakens it as its shuttles' tilting does.

    What counts is the force in y that its target feels when its source moves and the middles of all other shuttles are
    held. (Phases see to it that no two masses are joined twice.)

    Args:
        tilt: stiffness of a shuttle against tilting about x, N mm / rad.
    """
    if not pulls:
        return ()
    masses = {name: i for i, name in enumerate(sorted({name for p in pulls for name in (p.source, p.target)}))}
    at = np.arange(len(pulls))
    sources = np.array([masses[pull.source] for pull in pulls])
    targets = np.array([masses[pull.target] for pull in pulls])
    turning = np.array([pull.turning for pull in pulls])
    low = np.array([pull.source_height for pull in pulls])
    high = turning * np.array([pull.target_height for pull in pulls])
    stiffness = np.array([pull.stiffness for pull in pulls])
    shape = (len(pulls), len(masses))
    rows, columns = np.concatenate([at, at]), np.concatenate([sources, targets])
    heights = csc_matrix((np.concatenate([low, high]), (rows, columns)), shape=shape)
    moves = csc_matrix((np.concatenate([np.ones(len(pulls)), turning]), (rows, columns)), shape=shape)
    solver = splu(csc_matrix(diags(1.0 / stiffness) + heights @ heights.T / tilt))
    force = np.empty(len(pulls))
    for mass in range(len(masses)):
        mine = at[sources == mass]
        if len(mine):
            felt = moves.T @ solver.solve(moves[:, [mass]].toarray()[:, 0])
            force[mine] = turning[mine] * felt[targets[mine]]
    # where others take more than it has, next to nothing is left of a coupling; where they add to it, it has no lean
    left = np.maximum(force, _LEAST * stiffness)
    lost = np.maximum(1.0 / left - 1.0 / stiffness, 1.0 / RIGID_CARRIER)
    return tuple(float(value) for value in 1.0 / lost)
