"""When, within a run, masses are read and forces change: the same for every kernel."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np


@numba.njit
def due_steps(instant: Any, period_steps: int) -> Any:
    """bool[period_steps]: whether any mass is read so many steps into a cycle."""
    due = np.zeros(period_steps, dtype=np.bool_)
    for w in range(instant.shape[0]):
        due[instant[w]] = True
    return due


@numba.njit
def interval_at(step: int, first_interval: int, interval: int, count: int) -> int:
    """Which of ``count`` intervals of the stimulus a step is in; the last goes on for ever."""
    if step < first_interval:
        return 0
    return min(1 + (step - first_interval) // interval, count - 1)
