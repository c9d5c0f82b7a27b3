"""Fixed-step RK4 over a block of lanes, side by side in SIMD.

A *lane* is one independent run of the same network. All numbers of one mass lie together, each kind of number of a
block's lanes in one vector.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from mdlcad.compiled import kernel
from mdlcad.simulation.plan import Plan
from mdlcad.simulation.schedule import due_steps, interval_at
from mdlcad.simulation.simd import larger, loader, store
from mdlcad.simulation.stages import first_half, second_half

BLOCK = 8

load = loader(BLOCK)

# Places of the numbers of a mass: displacements of the four stages, velocity, two accelerations, force, largest |x|.
_X, _Y2, _Y3, _Y4, _V, _A1, _A2, _F, _PEAK = (np.uint64(BLOCK * slot) for slot in range(9))
_ROW = np.uint64(BLOCK * 9)
_ONE = np.uint64(1)
_LINE = 8  # doubles in a cache line


@kernel
def advance_block(
    lane0: int,
    x: Any,
    v: Any,
    peak: Any,
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
    """Advance lanes lane0 .. lane0 + BLOCK of x, v (float[n, lanes]) by ``steps`` steps of length ``h``, in place.

    ``turn`` is float[2 * steps a period, 2] (``plan.turn_table``); ``driven`` and ``watched`` are places in the plan's
    order; ``force`` float[intervals, driven, lanes], divided by the inertia; ``readings`` float[cycles, watched,
    lanes]; ``trace`` float[frames, n, lanes], written every ``stride`` steps (0: never).
    """
    n = np.uint64(x.shape[0])
    points = turn.shape[0]
    period_steps = points // 2
    room = np.zeros(n * _ROW + np.uint64(_LINE))
    work = room[(-(room.ctypes.data // 8)) % _LINE :]
    for i in range(n):
        o = i * _ROW
        for lane in range(BLOCK):
            u = o + np.uint64(lane)
            start_x, start_v = x[plan.order[i], lane0 + lane], v[plan.order[i], lane0 + lane]
            work[u + _X] = start_x
            work[u + _Y2] = start_x + 0.5 * h * start_v
            work[u + _V] = start_v
            work[u + _PEAK] = abs(start_x)
            work[u + _F] = -plan.bias[i]

    column = np.empty(plan.column.shape[0], dtype=np.uint64)
    entries = np.uint64(plan.column.shape[0])
    products = np.uint64(plan.product_first.shape[0])
    for e in range(entries):
        column[e] = plan.column[e] * _ROW
    # stiffness and strengths at the beginning, the middle and the end of the step
    k0, k1, k2 = np.empty(n), np.empty(n), np.empty(n)
    c0 = plan.strength[0].copy()
    c1, c2 = c0, c0
    if plan.modulated:
        c1, c2 = np.empty(entries), np.empty(entries)
    d0, d1, d2 = np.empty(products), np.empty(products), np.empty(products)
    sine, cosine = turn[0]
    for i in range(n):
        k2[i] = plan.stiffness[0, i] + plan.stiffness[1, i] * sine + plan.stiffness[2, i] * cosine
    if plan.modulated:
        for e in range(entries):
            c2[e] = plan.strength[0, e] + plan.strength[1, e] * sine + plan.strength[2, e] * cosine
    for e in range(products):
        d2[e] = plan.product_strength[0, e] + plan.product_strength[1, e] * sine + plan.product_strength[2, e] * cosine
    due = due_steps(instant, period_steps)

    span = -1
    for step in range(steps + 1):
        within = step % period_steps
        if due[within] and step // period_steps < readings.shape[0]:
            for w in range(watched.shape[0]):
                if instant[w] == within:
                    o = watched[w] * _ROW
                    for lane in range(BLOCK):
                        readings[step // period_steps, w, lane0 + lane] = work[o + _X + np.uint64(lane)]
        if stride > 0 and step % stride == 0:
            for i in range(n):
                o = i * _ROW
                for lane in range(BLOCK):
                    trace[step // stride, plan.order[i], lane0 + lane] = work[o + _X + np.uint64(lane)]
        if step == steps:
            break

        last = span
        span = interval_at(step, first_interval, interval, force.shape[0])
        if span != last:
            for s in range(driven.shape[0]):
                o = driven[s] * _ROW
                for lane in range(BLOCK):
                    work[o + _F + np.uint64(lane)] = force[span, s, lane0 + lane] - plan.bias[driven[s]]

        k0, k2 = k2, k0
        sine1, cosine1 = turn[2 * within + 1]
        sine2, cosine2 = turn[(2 * within + 2) % points]
        for i in range(n):
            k1[i] = plan.stiffness[0, i] + plan.stiffness[1, i] * sine1 + plan.stiffness[2, i] * cosine1
            k2[i] = plan.stiffness[0, i] + plan.stiffness[1, i] * sine2 + plan.stiffness[2, i] * cosine2
        if plan.modulated:
            c0, c2 = c2, c0
            for e in range(entries):
                u0, u1, u2 = plan.strength[0, e], plan.strength[1, e], plan.strength[2, e]
                c1[e] = u0 + u1 * sine1 + u2 * cosine1
                c2[e] = u0 + u1 * sine2 + u2 * cosine2
        d0, d2 = d2, d0
        for e in range(products):
            u0, u1, u2 = plan.product_strength[0, e], plan.product_strength[1, e], plan.product_strength[2, e]
            d1[e] = u0 + u1 * sine1 + u2 * cosine1
            d2[e] = u0 + u1 * sine2 + u2 * cosine2

        for i in range(n):
            o = i * _ROW
            f1 = load(work, o + _F)
            f2 = f1
            for e in range(plan.row_start[i], plan.row_start[i + _ONE]):
                other = column[e]
                f1 = f1 + c0[e] * load(work, other + _X)
                f2 = f2 + c1[e] * load(work, other + _Y2)
            for e in range(plan.product_start[i], plan.product_start[i + _ONE]):
                a, b = plan.product_first[e] * _ROW, plan.product_second[e] * _ROW
                f1 = f1 + d0[e] * load(work, a + _X) * load(work, b + _X)
                f2 = f2 + d1[e] * load(work, a + _Y2) * load(work, b + _Y2)
            a1, a2, y3, y4 = first_half(
                load(work, o + _X),
                load(work, o + _Y2),
                load(work, o + _V),
                f1,
                f2,
                k0[i],
                k1[i],
                h,
                plan.damping,
                plan.quartic,
            )
            store(work, o + _A1, a1)
            store(work, o + _A2, a2)
            store(work, o + _Y3, y3)
            store(work, o + _Y4, y4)

        for i in range(n):
            o = i * _ROW
            f3 = load(work, o + _F)
            f4 = f3
            for e in range(plan.row_start[i], plan.row_start[i + _ONE]):
                other = column[e]
                f3 = f3 + c1[e] * load(work, other + _Y3)
                f4 = f4 + c2[e] * load(work, other + _Y4)
            for e in range(plan.product_start[i], plan.product_start[i + _ONE]):
                a, b = plan.product_first[e] * _ROW, plan.product_second[e] * _ROW
                f3 = f3 + d1[e] * load(work, a + _Y3) * load(work, b + _Y3)
                f4 = f4 + d2[e] * load(work, a + _Y4) * load(work, b + _Y4)
            xn, y2, vn = second_half(
                load(work, o + _X),
                load(work, o + _Y3),
                load(work, o + _Y4),
                load(work, o + _V),
                load(work, o + _A1),
                load(work, o + _A2),
                f3,
                f4,
                k1[i],
                k2[i],
                h,
                plan.damping,
                plan.quartic,
            )
            store(work, o + _X, xn)
            store(work, o + _Y2, y2)
            store(work, o + _V, vn)
            store(work, o + _PEAK, larger(load(work, o + _PEAK), xn))

    for i in range(n):
        o = i * _ROW
        for lane in range(BLOCK):
            u = o + np.uint64(lane)
            x[plan.order[i], lane0 + lane] = work[u + _X]
            v[plan.order[i], lane0 + lane] = work[u + _V]
            peak[plan.order[i], lane0 + lane] = work[u + _PEAK]
