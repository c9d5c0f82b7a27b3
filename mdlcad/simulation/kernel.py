"""Fixed-step RK4 over a block of lanes, compiled by numba.

A *lane* is one independent run of the same network. A block holds ``width`` lanes, and ``width`` is a constant of the
compiled function: the inner loops then have known length and known distance between their arrays, which is what lets
the compiler use SIMD without asking whether the arrays overlap. Every lane goes through the same operations in the
same order at any width (no fastmath, no fused multiply-add), so results do not depend on how lanes are grouped.

The second-order system x' = v, v' = a(x, v, t) is stepped by the classical tableau (1/6, 1/3, 1/3, 1/6); the clock
waves come from a table at half steps, so that every period sees the very same numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba
import numpy as np

BLOCK = 16

_SLOTS = 8


def _build(width: int) -> Callable[..., None]:
    """Compile-time specialisation of the kernel for blocks of ``width`` lanes."""
    u64 = np.uint64
    # A block keeps all numbers of a mass together; a single lane keeps each kind of number together, so that SIMD can
    # go over the masses instead.
    single = width == 1
    row = u64(1 if single else _SLOTS * width)

    def kernel(
        lane0: int,
        x: Any,
        v: Any,
        peak: Any,
        phase: Any,
        stiffness_base: Any,
        stiffness_swing: Any,
        bias: Any,
        row_start: Any,
        column: Any,
        base: Any,
        swing: Any,
        wave: Any,
        latch_clock: Any,
        latch_mass: Any,
        latch_base: Any,
        latch_swing: Any,
        latch_wave: Any,
        waves: Any,
        driven: Any,
        force: Any,
        first_interval: int,
        interval: int,
        steps: int,
        step_time: float,
        inverse_inertia: float,
        damping: float,
        quartic: float,
        watched: Any,
        instant: Any,
        readings: Any,
        stride: int,
        trace: Any,
    ) -> None:
        """Advance lanes lane0 .. lane0 + width of x, v (float[n, lanes]) by ``steps`` steps, in place.

        ``waves`` is float[2 * steps a period, P]; ``force`` float[intervals, driven, lanes]; ``readings``
        float[cycles, watched, lanes]; ``trace`` float[frames, n, lanes], written every ``stride`` steps (0: never).
        """
        n = x.shape[0]
        points = waves.shape[0]
        period_steps = points // 2
        slot = u64(n) if single else u64(width)
        # Places in the workspace: state, stage state, sums of slopes, force, largest |x| so far.
        at_x, at_v, at_xs, at_vs = u64(0), slot, u64(2) * slot, u64(3) * slot
        at_sx, at_sv, at_f, at_peak = u64(4) * slot, u64(5) * slot, u64(6) * slot, u64(7) * slot
        work = np.zeros(n * _SLOTS * width)
        for i in range(n):
            o = u64(i) * row
            for lane in range(width):
                u = o + u64(lane)
                work[u + at_x] = x[i, lane0 + lane]
                work[u + at_xs] = x[i, lane0 + lane]
                work[u + at_v] = v[i, lane0 + lane]
                work[u + at_vs] = v[i, lane0 + lane]
                work[u + at_peak] = abs(x[i, lane0 + lane])
        stiffness = np.empty(n)
        entries = base.shape[0]
        strength = base.copy()
        modulated = False
        for e in range(entries):
            if swing[e] != 0.0:
                modulated = True
        latches = latch_base.shape[0]
        latch_strength = np.empty(latches)
        sensors = driven.shape[0]

        for step in range(steps + 1):
            within = step % period_steps
            for w in range(watched.shape[0]):
                if instant[w] == within and step // period_steps < readings.shape[0]:
                    o = u64(watched[w]) * row
                    for lane in range(width):
                        readings[step // period_steps, w, lane0 + lane] = work[o + at_x + u64(lane)]
            if stride > 0 and step % stride == 0:
                for i in range(n):
                    o = u64(i) * row
                    for lane in range(width):
                        trace[step // stride, i, lane0 + lane] = work[o + at_x + u64(lane)]
            if step == steps:
                break

            span = 0
            if step >= first_interval:
                span = 1 + (step - first_interval) // interval
            span = min(span, force.shape[0] - 1)

            for stage in range(4):
                if stage != 2:  # stages 1 and 2 share the half step's clock
                    point = (2 * step + (stage + 1) // 2) % points
                    for i in range(n):
                        stiffness[i] = stiffness_base[i] + stiffness_swing[i] * waves[point, phase[i]]
                    if modulated:
                        for e in range(entries):
                            strength[e] = base[e] + swing[e] * waves[point, wave[e]]
                    for e in range(latches):
                        latch_strength[e] = latch_base[e] + latch_swing[e] * waves[point, latch_wave[e]]
                weight = step_time / 6.0 if stage == 0 or stage == 3 else step_time / 3.0
                reach = step_time if stage == 2 else 0.5 * step_time

                for i in range(n):
                    o = u64(i) * row
                    for lane in range(width):
                        work[o + at_f + u64(lane)] = -bias[i]
                    for e in range(row_start[i], row_start[i + 1]):
                        c = strength[e]
                        other = u64(column[e]) * row
                        for lane in range(width):
                            work[o + at_f + u64(lane)] += c * work[other + at_xs + u64(lane)]
                for e in range(latches):
                    clock = u64(latch_clock[e]) * row
                    latch = u64(latch_mass[e]) * row
                    c = latch_strength[e]
                    for lane in range(width):
                        x_clock = work[clock + at_xs + u64(lane)]
                        x_latch = work[latch + at_xs + u64(lane)]
                        work[clock + at_f + u64(lane)] += c * x_latch * x_latch
                        work[latch + at_f + u64(lane)] += 2.0 * c * x_clock * x_latch
                for s in range(sensors):
                    o = u64(driven[s]) * row
                    for lane in range(width):
                        work[o + at_f + u64(lane)] += force[span, s, lane0 + lane]

                for i in range(n):
                    o = u64(i) * row
                    k = stiffness[i]
                    for lane in range(width):
                        u = o + u64(lane)
                        xs = work[u + at_xs]
                        vs = work[u + at_vs]
                        a = (work[u + at_f] - damping * vs - (k + quartic * xs * xs) * xs) * inverse_inertia
                        work[u + at_sx] += weight * vs
                        work[u + at_sv] += weight * a
                        work[u + at_xs] = work[u + at_x] + reach * vs
                        work[u + at_vs] = work[u + at_v] + reach * a

            for i in range(n):
                o = u64(i) * row
                for lane in range(width):
                    u = o + u64(lane)
                    xn = work[u + at_x] + work[u + at_sx]
                    vn = work[u + at_v] + work[u + at_sv]
                    work[u + at_x] = xn
                    work[u + at_xs] = xn
                    work[u + at_v] = vn
                    work[u + at_vs] = vn
                    work[u + at_sx] = 0.0
                    work[u + at_sv] = 0.0
                    work[u + at_peak] = max(work[u + at_peak], abs(xn))

        for i in range(n):
            o = u64(i) * row
            for lane in range(width):
                x[i, lane0 + lane] = work[o + at_x + u64(lane)]
                v[i, lane0 + lane] = work[o + at_v + u64(lane)]
                peak[i, lane0 + lane] = work[o + at_peak + u64(lane)]

    try:
        return numba.njit(nogil=True, error_model="numpy", cache=True)(kernel)  # type: ignore[no-any-return]
    except RuntimeError:  # no place to keep the cache (read-only installation without a home)
        return numba.njit(nogil=True, error_model="numpy")(kernel)  # type: ignore[no-any-return]


advance_one = _build(1)
advance_block = _build(BLOCK)
