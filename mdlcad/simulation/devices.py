"""Devices as they are built: one structure, every number of every mass and spring its own, and springs that stiffen.

Beside ``network.model``, a device's mass has its own quartic and a cubic term, and a spring has terms of fourth and
third order in how far its ends are apart and in their sum (a rocker's ends push each other through both):

    V = sum_i [ lambda_i/4 x^4 + beta_i/3 x^3 + 1/2 (u_i + w_i p) x^2 + q_i x ]
      + sum_springs [ - c x_i x_j + Q/4 (x_i - x_j)^4 + C/4 (x_i + x_j)^4 + B (x_i + x_j) (x_i - x_j)^2 ]

and dry friction, Coulomb's law made smooth where what rubs all but stands still: of a mass (f + f' x + f'' x^2)
v / (|v| + CREEP), and of a spring with an eye that turns on a post, between its ends, R |x_i + x_j| w / (|w| + CREEP)
with w = v_i - v_j. The classical Runge-Kutta step, all devices of a block side by side.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mdlcad.compiled import kernel
from mdlcad.simulation.schedule import due_steps, interval_at
from mdlcad.simulation.tilting import BLOCK, Tilts, settle

Floats = NDArray[np.float64]

CREEP = 0.05
"""Speed at which friction is half of its bound; masses that switch move at 1 and more."""


@dataclass(frozen=True, slots=True, eq=False)
class Devices:
    """L devices of n masses and e coupling entries, in the order of ``System``; L = 1 stands for every lane.

    Attributes:
        base, swing, bias, quartic, cubic: float[n, L]: u, w, q, lambda, beta.
        friction, friction_slope, friction_curve: float[n, L]: f, f', f''.
        strength, apart, together, skew: float[e, L]: c, Q, C, B of each entry (two a spring).
        rub: float[e, L]: R of each entry.
        tilts: how their shuttles tilt, None if they are held from it.
    """

    base: Floats
    swing: Floats
    bias: Floats
    quartic: Floats
    cubic: Floats
    friction: Floats
    friction_slope: Floats
    friction_curve: Floats
    strength: Floats
    apart: Floats
    together: Floats
    skew: Floats
    rub: Floats
    tilts: Tilts | None = None

    @property
    def count(self) -> int:
        """L."""
        return int(self.base.shape[1])

    def block(self, start: int) -> tuple[tuple[Floats, ...], tuple[Floats, ...]]:
        """Numbers of masses, float[8, n, BLOCK], and of springs, float[5, e, BLOCK], of the lanes from ``start`` on."""
        lanes = np.minimum(np.arange(start, start + BLOCK), self.count - 1)
        masses = (
            self.base,
            self.swing,
            self.bias,
            self.quartic,
            self.cubic,
            self.friction,
            self.friction_slope,
            self.friction_curve,
        )
        springs = (self.strength, self.apart, self.together, self.skew, self.rub)
        return (
            tuple(np.ascontiguousarray(array[:, lanes]) for array in masses),
            tuple(np.ascontiguousarray(array[:, lanes]) for array in springs),
        )


@kernel
def pushes(
    out: Any,
    x: Any,
    v: Any,
    wave: Any,
    phase: Any,
    masses: Any,
    springs: Any,
    row_start: Any,
    column: Any,
    force: Any,
    damping: float,
    angle: Any,
    tip: Any,
    tilting: Any,
    lifts: Any,
) -> None:
    """Write m x'' of every mass to ``out`` (float[n, BLOCK]); ``wave`` is p of every phase, ``force`` from outside."""
    base, swing, bias, quartic, cubic, friction, friction_slope, friction_curve = masses
    strength, apart, together, skew, rub = springs
    leaf, leaf_stiffness, pressing = tilting[3], tilting[4], tilting[6]
    own, other, self_stiffness = lifts
    for i in range(x.shape[0]):
        p = wave[phase[i]]
        lifted = leaf[i] * leaf_stiffness[i]
        for lane in range(BLOCK):
            y = x[i, lane]
            stiff = base[i, lane] + swing[i, lane] * p + (cubic[i, lane] + quartic[i, lane] * y) * y
            bound = friction[i, lane] + (friction_slope[i, lane] + friction_curve[i, lane] * y) * y
            bound = max(bound, 0.0) + pressing[i] * tip[i, lane] * tip[i, lane]
            drag = damping + bound / (abs(v[i, lane]) + CREEP)
            out[i, lane] = force[i, lane] - bias[i, lane] - drag * v[i, lane] - stiff * y - lifted * angle[i, lane]
        for e in range(row_start[i], row_start[i + 1]):
            j, h, g, s = column[e], own[e], other[e], self_stiffness[e]
            for lane in range(BLOCK):
                up = h * angle[i, lane]
                y, z = x[i, lane] + up, x[j, lane] + g * angle[j, lane]
                difference, total = y - z, y + z
                out[i, lane] += (
                    strength[e, lane] * z
                    - s * up
                    - apart[e, lane] * difference * difference * difference
                    - together[e, lane] * total * total * total
                    - skew[e, lane] * difference * (difference + 2.0 * total)
                )
            # what rubs does so in every device; most springs do not
            if rub[e, 0] > 0.0:
                for lane in range(BLOCK):
                    apace = v[i, lane] - v[j, lane]
                    total = x[i, lane] + x[j, lane]
                    out[i, lane] -= rub[e, lane] * abs(total) * apace / (abs(apace) + CREEP)


@kernel
def advance_devices(
    lane0: int,
    x: Any,
    v: Any,
    peak: Any,
    masses: Any,
    springs: Any,
    row_start: Any,
    column: Any,
    phase: Any,
    wave: Any,
    inertia: float,
    damping: float,
    driven: Any,
    force: Any,
    first_interval: int,
    interval: int,
    steps: int,
    h: float,
    watched: Any,
    instant: Any,
    readings: Any,
    stride: int,
    trace: Any,
    tilt: Any,
    tilts: bool,
    tilting: Any,
    lifts: Any,
) -> None:
    """Advance lanes lane0 .. lane0 + BLOCK of x, v (float[n, lanes]) by ``steps`` steps of length ``h``, in place.

    ``wave`` is float[2 * steps a period, phases], p at every half step; ``force`` float[intervals, driven, lanes];
    ``readings`` float[cycles, watched, lanes]; ``trace`` float[frames, n, lanes], written every ``stride`` steps
    (0: never). If shuttles tilt (``tilts``), ``tilt`` is float[n, lanes], the largest angle of
    each, were there no stops.
    """
    n = x.shape[0]
    points = wave.shape[0]
    period = points // 2
    y, u = np.empty((n, BLOCK)), np.empty((n, BLOCK))
    stage_y, stage_u = np.empty((n, BLOCK)), np.empty((n, BLOCK))
    sum_y, sum_u = np.empty((n, BLOCK)), np.empty((n, BLOCK))
    push, outside, angle = np.empty((n, BLOCK)), np.zeros((n, BLOCK)), np.zeros((n, BLOCK))
    tip = np.zeros((n, BLOCK))
    for i in range(n):
        for lane in range(BLOCK):
            y[i, lane] = x[i, lane0 + lane]
            u[i, lane] = v[i, lane0 + lane]
            peak[i, lane0 + lane] = abs(y[i, lane])
    due = due_steps(instant, period)
    per = 1.0 / inertia
    span = -1
    for step in range(steps + 1):
        within = step % period
        if due[within] and step // period < readings.shape[0]:
            for w in range(watched.shape[0]):
                if instant[w] == within:
                    for lane in range(BLOCK):
                        readings[step // period, w, lane0 + lane] = y[watched[w], lane]
        if stride > 0 and step % stride == 0:
            for i in range(n):
                for lane in range(BLOCK):
                    trace[step // stride, i, lane0 + lane] = y[i, lane]
        if step == steps:
            break
        last = span
        span = interval_at(step, first_interval, interval, force.shape[0])
        if span != last:
            for s in range(driven.shape[0]):
                for lane in range(BLOCK):
                    outside[driven[s], lane] = force[span, s, lane0 + lane]
        if tilts:
            for i in range(n):
                for lane in range(BLOCK):
                    stage_y[i, lane] = y[i, lane] + 0.5 * h * u[i, lane]
            settle(angle, tip, stage_y, masses[2], springs, tilting, lifts, row_start, column, outside)
            for i in range(n):
                for lane in range(BLOCK):
                    tilt[i, lane0 + lane] = max(tilt[i, lane0 + lane], abs(tip[i, lane]))
        for i in range(n):
            for lane in range(BLOCK):
                stage_y[i, lane], stage_u[i, lane] = y[i, lane], u[i, lane]
        for stage in range(4):
            at = 2 * within + (stage + 1) // 2
            pushes(
                push,
                stage_y,
                stage_u,
                wave[at % points],
                phase,
                masses,
                springs,
                row_start,
                column,
                outside,
                damping,
                angle,
                tip,
                tilting,
                lifts,
            )
            share = 1.0 if stage == 0 or stage == 3 else 2.0
            ahead = h if stage == 2 else 0.5 * h
            for i in range(n):
                for lane in range(BLOCK):
                    slope = stage_u[i, lane]
                    rate = per * push[i, lane]
                    if stage == 0:
                        sum_y[i, lane], sum_u[i, lane] = slope, rate
                    else:
                        sum_y[i, lane] += share * slope
                        sum_u[i, lane] += share * rate
                    if stage < 3:
                        stage_y[i, lane] = y[i, lane] + ahead * slope
                        stage_u[i, lane] = u[i, lane] + ahead * rate
        for i in range(n):
            for lane in range(BLOCK):
                y[i, lane] += h / 6.0 * sum_y[i, lane]
                u[i, lane] += h / 6.0 * sum_u[i, lane]
                if abs(y[i, lane]) > peak[i, lane0 + lane]:
                    peak[i, lane0 + lane] = abs(y[i, lane])
    for i in range(n):
        for lane in range(BLOCK):
            x[i, lane0 + lane] = y[i, lane]
            v[i, lane0 + lane] = u[i, lane]
