"""Shuttles that tilt about x while they move in y: an angle a mass, without inertia, between two stops.

A spring that pulls h above the middle of its mass's shuttle finds it at u = x + h theta, and turns it with h times its
force. The angle is where the moments of all that pulls and K theta balance, or at the stop before it. It is found by
Gauss-Seidel sweeps over the masses, once a time step for its middle, from where the last step left it; a
step is 1/400 of a clock period or less.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mdlcad.compiled import kernel

Floats = NDArray[np.float64]

BLOCK = 8
"""Lanes side by side, as in ``devices``."""

SWEEPS = 2


@dataclass(frozen=True, slots=True, eq=False)
class Tilts:
    """How n shuttles with e coupling entries (in the order of ``System``) tilt in L devices; L = 1 stands for all.

    Angles are in rad, heights above the shuttle's middle in X0.

    Attributes:
        stiffness: float[n], K, in F0 X0 per rad.
        low, high: float[n, L], the angles that it cannot pass, low at most 0 and high at least; both 0: it is held.
        bias_height, bias_stiffness: float[n], of its bias leaf; the leaf's force is q and its stiffness times u.
        force_height: float[n], of where forces from outside act.
        rub: float[n], what plates brake it with at the most, in F0 over the square of the angle without stops.
        own, other: float[e], height of an entry's spring above its mass, and above the mass that it leads to.
        self_stiffness: float[e], what the spring adds to the entry's mass.
    """

    stiffness: Floats
    low: Floats
    high: Floats
    bias_height: Floats
    bias_stiffness: Floats
    force_height: Floats
    rub: Floats
    own: Floats
    other: Floats
    self_stiffness: Floats

    @property
    def count(self) -> int:
        """L."""
        return int(self.low.shape[1])

    def block(self, start: int) -> tuple[tuple[Floats, ...], tuple[Floats, ...]]:
        """Of masses and entries, as ``settle`` takes them; stops are float[n, BLOCK], of lanes from ``start`` on."""
        lanes = np.minimum(np.arange(start, start + BLOCK), self.count - 1)
        masses = (
            self.stiffness,
            np.ascontiguousarray(self.low[:, lanes]),
            np.ascontiguousarray(self.high[:, lanes]),
            self.bias_height,
            self.bias_stiffness,
            self.force_height,
            self.rub,
        )
        return masses, (self.own, self.other, self.self_stiffness)


def held(masses: int, entries: int) -> Tilts:
    """Shuttles of which none tilts: every height is zero."""
    none, flat, stop = np.zeros(masses), np.zeros(entries), np.zeros((masses, 1))
    return Tilts(np.ones(masses), stop, stop, none, none, none, none, flat, flat, flat)


@kernel
def settle(
    angle: Any,
    tip: Any,
    x: Any,
    bias: Any,
    springs: Any,
    tilting: Any,
    lifts: Any,
    row_start: Any,
    column: Any,
    force: Any,
) -> None:
    """Bring ``angle`` (float[n, BLOCK], in place) to rest at displacements ``x`` and ``force`` from outside.

    ``tip`` (the same shape) is the angle that K alone would hold against what then pulls.
    """
    strength, apart, together, skew, _ = springs
    stiffness, low, high, bias_height, bias_stiffness, force_height, _ = tilting
    own, other, self_stiffness = lifts
    moment, slope = np.empty(BLOCK), np.empty(BLOCK)
    for _sweep in range(SWEEPS):
        for i in range(x.shape[0]):
            hb, hf = bias_height[i], force_height[i]
            for lane in range(BLOCK):
                a = angle[i, lane]
                u = x[i, lane] + hb * a
                moment[lane] = hf * force[i, lane] - hb * (bias[i, lane] + bias_stiffness[i] * u) - stiffness[i] * a
                slope[lane] = stiffness[i] + hb * hb * bias_stiffness[i]
            for e in range(row_start[i], row_start[i + 1]):
                j, h, g, s = column[e], own[e], other[e], self_stiffness[e]
                for lane in range(BLOCK):
                    u = x[i, lane] + h * angle[i, lane]
                    w = x[j, lane] + g * angle[j, lane]
                    d, t = u - w, u + w
                    moment[lane] += h * (
                        strength[e, lane] * w
                        - s * u
                        - apart[e, lane] * d * d * d
                        - together[e, lane] * t * t * t
                        - skew[e, lane] * d * (d + 2.0 * t)
                    )
                    slope[lane] += h * h * (s + 3.0 * (apart[e, lane] * d * d + together[e, lane] * t * t))
            for lane in range(BLOCK):
                tip[i, lane] = angle[i, lane] + moment[lane] / stiffness[i]
                angle[i, lane] = min(max(angle[i, lane] + moment[lane] / slope[lane], low[i, lane]), high[i, lane])
