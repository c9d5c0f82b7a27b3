"""Seeded random numbers, the same in Python and in compiled code."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from mdlcad.compiled import inlined


def random_source(seed: int) -> npt.NDArray[np.uint64]:
    """The state of a generator; splitmix64 spreads neighbouring seeds apart."""
    z: Any = (seed * 0x9E3779B97F4A7C15 + 0x9E3779B97F4A7C15) & 0xFFFFFFFFFFFFFFFF
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & 0xFFFFFFFFFFFFFFFF
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & 0xFFFFFFFFFFFFFFFF
    return np.array([(z ^ (z >> 31)) | 1], np.uint64)


@inlined
def draw(random: npt.NDArray[np.uint64]) -> float:
    """xorshift64*: uniform in [0, 1)."""
    x = random[0]
    x ^= x >> np.uint64(12)
    x ^= x << np.uint64(25)
    x ^= x >> np.uint64(27)
    random[0] = x
    return float((x * np.uint64(2685821657736338717)) >> np.uint64(11)) / 9007199254740992.0
