"""Fixed-step RK4 of one lane: SIMD over its masses instead.

Couplings are summed mass by mass; displacements of two stages lie side by side, so that one coupling adds to the
forces of both stages at once. The rest of the step goes over the masses in vectors.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from mdlcad.compiled import kernel
from mdlcad.simulation.plan import UNROLLED, Plan
from mdlcad.simulation.schedule import due_steps, interval_at
from mdlcad.simulation.simd import evens, larger, loader, odds, paired, store
from mdlcad.simulation.stages import first_half, second_half

_WIDTH = 4

load_pair = loader(2)
load = loader(_WIDTH)
load_pairs = loader(2 * _WIDTH)

_ONE = np.uint64(1)
_TWO = np.uint64(2)
_STRIDE = np.uint64(_WIDTH)


def _rows(length: int) -> Any:
    """Forces on masses start .. stop, which all have ``length`` couplings: a constant, so the inner loop unrolls."""
    count = np.uint64(length)

    @numba.njit
    def rows(f: Any, push: Any, row_start: Any, column: Any, strength: Any, y: Any, start: Any, stop: Any) -> None:
        for i in range(start, stop):
            both = load_pair(push, _TWO * i)
            first = row_start[start] + (i - start) * count
            for k in range(count):
                e = first + k
                both = both + load_pair(strength, _TWO * e) * load_pair(y, column[e])
            store(f, _TWO * i, both)

    return rows


_rows_0, _rows_1, _rows_2, _rows_3, _rows_4, _rows_5 = (_rows(length) for length in range(UNROLLED))


@numba.njit
def _forces(f: Any, push: Any, plan: Plan, column: Any, strength: Any, product_strength: Any, y: Any, n: Any) -> None:
    """Forces on every mass at two stages, pair by pair, from displacements ``y`` and strengths, also in pairs."""
    start = plan.class_start
    row = plan.row_start
    _rows_0(f, push, row, column, strength, y, start[0], start[1])
    _rows_1(f, push, row, column, strength, y, start[1], start[2])
    _rows_2(f, push, row, column, strength, y, start[2], start[3])
    _rows_3(f, push, row, column, strength, y, start[3], start[4])
    _rows_4(f, push, row, column, strength, y, start[4], start[5])
    _rows_5(f, push, row, column, strength, y, start[5], start[6])
    for i in range(start[6], n):
        both = load_pair(push, _TWO * i)
        for e in range(row[i], row[i + _ONE]):
            both = both + load_pair(strength, _TWO * e) * load_pair(y, column[e])
        store(f, _TWO * i, both)
    for e in range(np.uint64(plan.product_mass.shape[0])):
        i, a, b = _TWO * plan.product_mass[e], _TWO * plan.product_first[e], _TWO * plan.product_second[e]
        both = load_pair(f, i) + load_pair(product_strength, _TWO * e) * load_pair(y, a) * load_pair(y, b)
        store(f, i, both)


@numba.njit
def _clocked(into: Any, parts: Any, count: Any, sine1: float, cosine1: float, sine2: float, cosine2: float) -> None:
    """Coefficients at two instants, in pairs."""
    for e in range(count):
        u0, u1, u2 = parts[0, e], parts[1, e], parts[2, e]
        into[_TWO * e] = u0 + u1 * sine1 + u2 * cosine1
        into[_TWO * e + _ONE] = u0 + u1 * sine2 + u2 * cosine2


@kernel
def advance_one(
    lane: int,
    x_out: Any,
    v_out: Any,
    peak_out: Any,
    plan: Plan,
    turn: Any,
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
) -> None:
    """``kernel_lanes.advance_block`` for the single lane ``lane``; the arguments are the same."""
    n = np.uint64(x_out.shape[0])
    padded = (n + _STRIDE - _ONE) // _STRIDE * _STRIDE
    points = turn.shape[0]
    period_steps = points // 2
    early, late, f, push = np.zeros(2 * padded), np.zeros(2 * padded), np.zeros(2 * padded), np.zeros(2 * padded)
    v, a1, a2, peak = np.zeros(padded), np.zeros(padded), np.zeros(padded), np.zeros(padded)
    stiffness = np.zeros((3, padded))
    for i in range(n):
        x0, v0 = x_out[plan.order[i], lane], v_out[plan.order[i], lane]
        early[_TWO * i], early[_TWO * i + _ONE] = x0, x0 + 0.5 * h * v0
        v[i] = v0
        peak[i] = abs(x0)
        push[_TWO * i] = push[_TWO * i + _ONE] = -plan.bias[i]
        for part in range(3):
            stiffness[part, i] = plan.stiffness[part, i]

    entries = np.uint64(plan.column.shape[0])
    products = np.uint64(plan.product_first.shape[0])
    column = np.empty(entries, dtype=np.uint64)
    for e in range(entries):
        column[e] = _TWO * plan.column[e]
    # strengths at the two stages of each half
    c_early, c_late = np.empty(2 * entries), np.empty(2 * entries)
    d_early, d_late = np.empty(2 * products), np.empty(2 * products)
    _clocked(c_early, plan.strength, entries, 0.0, 0.0, 0.0, 0.0)
    if not plan.modulated:
        c_late = c_early
    due = due_steps(instant, period_steps)

    span = -1
    for step in range(steps + 1):
        within = step % period_steps
        if due[within] and step // period_steps < readings.shape[0]:
            for w in range(watched.shape[0]):
                if instant[w] == within:
                    readings[step // period_steps, w, lane] = early[2 * watched[w]]
        if stride > 0 and step % stride == 0:
            for i in range(n):
                trace[step // stride, plan.order[i], lane] = early[_TWO * i]
        if step == steps:
            break

        last = span
        span = interval_at(step, first_interval, interval, force.shape[0])
        if span != last:
            for s in range(driven.shape[0]):
                i = driven[s]
                push[_TWO * i] = push[_TWO * i + _ONE] = force[span, s, lane] - plan.bias[i]

        sine0, cosine0 = turn[2 * within]
        sine1, cosine1 = turn[2 * within + 1]
        sine2, cosine2 = turn[(2 * within + 2) % points]
        if plan.modulated:
            _clocked(c_early, plan.strength, entries, sine0, cosine0, sine1, cosine1)
            _clocked(c_late, plan.strength, entries, sine1, cosine1, sine2, cosine2)
        _clocked(d_early, plan.product_strength, products, sine0, cosine0, sine1, cosine1)
        _clocked(d_late, plan.product_strength, products, sine1, cosine1, sine2, cosine2)

        _forces(f, push, plan, column, c_early, d_early, early, n)
        for i in range(np.uint64(0), padded, _STRIDE):
            u0, u1, u2 = load(stiffness, i), load(stiffness, padded + i), load(stiffness, _TWO * padded + i)
            forces, places = load_pairs(f, _TWO * i), load_pairs(early, _TWO * i)
            next_a1, next_a2, y3, y4 = first_half(
                evens(places),
                odds(places),
                load(v, i),
                evens(forces),
                odds(forces),
                u0 + u1 * sine0 + u2 * cosine0,
                u0 + u1 * sine1 + u2 * cosine1,
                h,
                plan.damping,
                plan.quartic,
            )
            store(a1, i, next_a1)
            store(a2, i, next_a2)
            store(late, _TWO * i, paired(y3, y4))

        _forces(f, push, plan, column, c_late, d_late, late, n)
        for i in range(np.uint64(0), padded, _STRIDE):
            u0, u1, u2 = load(stiffness, i), load(stiffness, padded + i), load(stiffness, _TWO * padded + i)
            forces, places = load_pairs(f, _TWO * i), load_pairs(late, _TWO * i)
            xn, y2, vn = second_half(
                evens(load_pairs(early, _TWO * i)),
                evens(places),
                odds(places),
                load(v, i),
                load(a1, i),
                load(a2, i),
                evens(forces),
                odds(forces),
                u0 + u1 * sine1 + u2 * cosine1,
                u0 + u1 * sine2 + u2 * cosine2,
                h,
                plan.damping,
                plan.quartic,
            )
            store(early, _TWO * i, paired(xn, y2))
            store(v, i, vn)
            store(peak, i, larger(load(peak, i), xn))

    for i in range(n):
        x_out[plan.order[i], lane] = early[_TWO * i]
        v_out[plan.order[i], lane] = v[i]
        peak_out[plan.order[i], lane] = peak[i]
