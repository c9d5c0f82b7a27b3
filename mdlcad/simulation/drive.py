"""The tick of a network that makes none of its own: a force from outside, once in every decision."""

from __future__ import annotations

import numpy as np

from mdlcad.network.model import Network
from mdlcad.simulation.run import Stimulus
from mdlcad.simulation.system import System

TICK_FORCE = 1.0

_QUARTERS = 4


def with_tick(network: Network, system: System, stimulus: Stimulus, steps_per_period: int) -> Stimulus:
    """``stimulus``, whose intervals are whole decisions, and the force that ticks where the network has to be ticked.

    The tick mass (of phase 0) is pushed to 1 in the cycle ``tick_drive`` of every decision and to 0 otherwise. The
    force turns a quarter of a period before a cycle begins, when the mass has but one place to rest, as it does in the
    cells of a clock.

    Raises:
        ValueError: ``steps_per_period`` is no multiple of 4.
    """
    if network.tick is None or network.tick_drive is None:
        return stimulus
    if steps_per_period % _QUARTERS:
        raise ValueError(f"{steps_per_period} steps a period cannot be quartered")
    pieces = _QUARTERS * network.cycles_per_tick
    decisions, _, lanes = stimulus.force.shape
    ticking = np.zeros(pieces)
    # quarter 4 c - 1 is the last before cycle c; before cycle 0 it is the last of the decision before
    ticking[np.arange(_QUARTERS * network.tick_drive - 1, _QUARTERS * network.tick_drive + _QUARTERS - 1)] = 1.0
    tick = np.array([system.index(network.tick)], dtype=np.int64)
    push = TICK_FORCE * (2.0 * np.tile(ticking, decisions) - 1.0) * system.polarity[tick[0]]
    force = np.concatenate(
        [
            np.repeat(stimulus.force, pieces, axis=0),
            np.broadcast_to(push[:, None, None], (len(push), 1, lanes)),
        ],
        axis=1,
    )
    quarter = steps_per_period // _QUARTERS
    return Stimulus(np.concatenate([stimulus.masses, tick]), np.ascontiguousarray(force), quarter, quarter)
