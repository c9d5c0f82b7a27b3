"""Compiled inner loops: crossings of straight lines, swaps that only reduce them, and annealing."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from mdlcad.compiled import inlined, kernel, part
from mdlcad.placement.chance import draw


@inlined
def _side(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """+1, 0 or -1: on which side of the line a-b the point c lies."""
    turn = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if turn > 1e-9:
        return 1
    if turn < -1e-9:
        return -1
    return 0


@part
def _meet(points: Any, a: int, b: int, c: int, d: int) -> bool:
    """Whether the closed segments a-b and c-d, which share no node, have a point in common."""
    ax, ay, bx, by = points[a, 0], points[a, 1], points[b, 0], points[b, 1]
    cx, cy, dx, dy = points[c, 0], points[c, 1], points[d, 0], points[d, 1]
    if max(ax, bx) < min(cx, dx) or max(cx, dx) < min(ax, bx) or max(ay, by) < min(cy, dy) or max(cy, dy) < min(ay, by):
        return False
    c_side, d_side = _side(ax, ay, bx, by, cx, cy), _side(ax, ay, bx, by, dx, dy)
    if c_side * d_side > 0:
        return False
    # on one line their boxes overlap (tested above), which on one line means that they do
    a_side, b_side = _side(cx, cy, dx, dy, ax, ay), _side(cx, cy, dx, dy, bx, by)
    return bool(a_side * b_side <= 0)


@kernel
def count_crossings(points: Any, lines: Any) -> int:
    """Pairs of ``lines`` (int[L, 2]) without a common node that meet, nodes at ``points`` (float[N, 2])."""
    found = 0
    for i in range(len(lines)):
        a, b = lines[i, 0], lines[i, 1]
        for j in range(i):
            c, d = lines[j, 0], lines[j, 1]
            if a != c and a != d and b != c and b != d and _meet(points, a, b, c, d):
                found += 1
    return found


@part
def _touching(points: Any, lines: Any, at: Any, of: Any, p: int, q: int, mark: Any, stamp: int) -> tuple[int, float]:
    """Crossings and length of all lines at node p or (if not -1) q; ``mark`` (int[L]) is room for stamps."""
    crossings, length = 0, 0.0
    for node in (p, q):
        if node < 0:
            continue
        for e in range(at[node], at[node + 1]):
            i = of[e]
            if mark[i] == stamp:
                continue
            mark[i] = stamp
            a, b = lines[i, 0], lines[i, 1]
            length += math.hypot(points[a, 0] - points[b, 0], points[a, 1] - points[b, 1])
            for j in range(len(lines)):
                if mark[j] == stamp:
                    continue  # counted from the other end of the pair
                c, d = lines[j, 0], lines[j, 1]
                if a != c and a != d and b != c and b != d and _meet(points, a, b, c, d):
                    crossings += 1
    return crossings, length


@kernel
def swap_greedily(
    points: Any, lines: Any, at: Any, of: Any, site_of: Any, radius: float, sweeps: int, tests: int
) -> int:
    """Swap pairs of nodes at most ``radius`` apart where that lowers their crossings; the number of pairs tested.

    ``points`` and ``site_of`` change in place. Stops after ``sweeps`` scans, a scan without a swap, or ``tests`` pairs.
    """
    nodes = len(site_of)
    mark = np.zeros(len(lines), np.int64)
    stamp, tested = 0, 0
    for _ in range(sweeps):
        swapped = False
        for p in range(nodes):
            for q in range(p + 1, nodes):
                if math.hypot(points[p, 0] - points[q, 0], points[p, 1] - points[q, 1]) > radius:
                    continue
                if tested == tests:
                    return tested
                tested += 1
                stamp += 1
                before, _ = _touching(points, lines, at, of, p, q, mark, stamp)
                _exchange(points, p, q)
                stamp += 1
                after, _ = _touching(points, lines, at, of, p, q, mark, stamp)
                if after < before:
                    site_of[p], site_of[q] = site_of[q], site_of[p]
                    swapped = True
                else:
                    _exchange(points, p, q)
        if not swapped:
            break
    return tested


@inlined
def _exchange(points: Any, p: int, q: int) -> None:
    for k in range(2):
        kept = points[p, k]
        points[p, k] = points[q, k]
        points[q, k] = kept


@kernel
def anneal_straight(
    points: Any,
    sites: Any,
    lines: Any,
    at: Any,
    of: Any,
    site_of: Any,
    moves: int,
    hot: float,
    cold: float,
    price: float,
    source: Any,
) -> None:
    """Move single nodes to other sites, exchanging with whoever sits there; ``points``, ``site_of`` end at the best.

    The cost is length + ``price`` x crossings, the temperature falls geometrically from ``hot`` to ``cold``. Half of
    the moves go to a place beside a neighbour of the node, which is where short lines are.
    """
    nodes = len(site_of)
    node_at = np.full(len(sites), -1, np.int64)
    for node in range(nodes):
        node_at[site_of[node]] = node
    mark = np.zeros(len(lines), np.int64)
    best = site_of.copy()
    stamp, cost, least = 0, 0.0, 0.0
    for move in range(moves):
        heat = hot * (cold / hot) ** (move / moves)
        p = int(draw(source) * nodes)
        target = int(draw(source) * len(sites))
        degree = at[p + 1] - at[p]
        if degree > 0 and draw(source) < 0.5:
            i = of[at[p] + int(draw(source) * degree)]
            other = lines[i, 0] + lines[i, 1] - p
            # of a few random sites the nearest to that neighbour
            for _ in range(5):
                rival = int(draw(source) * len(sites))
                if math.hypot(sites[rival, 0] - points[other, 0], sites[rival, 1] - points[other, 1]) < math.hypot(
                    sites[target, 0] - points[other, 0], sites[target, 1] - points[other, 1]
                ):
                    target = rival
        home = site_of[p]
        if target == home:
            continue
        q = node_at[target]
        stamp += 1
        crossed, long = _touching(points, lines, at, of, p, q, mark, stamp)
        _sit(points, sites, site_of, p, target)
        if q >= 0:
            _sit(points, sites, site_of, q, home)
        stamp += 1
        now_crossed, now_long = _touching(points, lines, at, of, p, q, mark, stamp)
        change = now_long - long + price * (now_crossed - crossed)
        if change <= 0.0 or draw(source) < math.exp(-change / heat):
            node_at[home], node_at[target] = q, p
            cost += change
            if cost < least - 1e-9:
                least = cost
                best[:] = site_of
        else:
            _sit(points, sites, site_of, p, home)
            if q >= 0:
                _sit(points, sites, site_of, q, target)
    for node in range(nodes):
        _sit(points, sites, site_of, node, best[node])


@inlined
def _sit(points: Any, sites: Any, site_of: Any, node: int, site: int) -> None:
    site_of[node] = site
    points[node, 0], points[node, 1] = sites[site, 0], sites[site, 1]
