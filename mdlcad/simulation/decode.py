"""From displacements to bits, and the other way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mdlcad.simulation.system import Floats, Ints, System

UNDECIDED = 2

# A mass nearer to 0 than this part of its well is neither 0 nor 1.
DECIDED = 0.25


def instants(system: System, masses: Ints, steps_per_period: int) -> Ints:
    """int[w]: the time step within the clock cycle at which each mass is to be read.

    A mass is read where its wells are deepest: at the peak of its clock wave, t = T (1/4 + k/P) (at the trough, half a
    period later, if its stiffness grows with the wave).
    """
    late = np.where(system.stiffness_swing[masses] > 0.0, 0.5, 0.0)
    turns = 0.25 + system.phase[masses] / system.phases + late
    steps: Ints = np.rint(turns * steps_per_period).astype(np.int64) % steps_per_period
    return steps


def wells(system: System, masses: Ints) -> Floats:
    """float[w]: distance of the mass's wells from 0 at its instant, sqrt(-k/lambda); 0 where it has no wells.

    k is the mass's intended stiffness there: couplings and bias move the true equilibrium somewhat.
    """
    swing = system.stiffness_swing[masses]
    stiffness = system.stiffness_base[masses] + np.minimum(2.0 * swing, 0.0)
    found: Floats = np.sqrt(np.maximum(-stiffness, 0.0) / system.quartic)
    return found


def decode(system: System, masses: Ints, x: Floats) -> NDArray[np.uint8]:
    """Bits of displacements ``x`` (float[..., w, lanes]) of ``masses``: 0, 1, or UNDECIDED.

    Logic 1 is the sign of the mass's polarity. A mass that is not finite or nearer to 0 than DECIDED of its well is
    undecided, so that a dead network never reads as zeros.
    """
    logic = x * system.polarity[masses][:, None]
    floor = DECIDED * wells(system, masses)[:, None]
    decided = np.isfinite(x) & (np.abs(x) > floor)
    return np.where(decided, logic > 0.0, UNDECIDED).astype(np.uint8)
