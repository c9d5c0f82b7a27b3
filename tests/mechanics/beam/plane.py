"""Plane stress of an outline, by six-noded triangles: what beam theory leaves out. Shares no code with the package."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.linalg import splu
from scipy.spatial import Delaunay
from shapely import Polygon

Array = NDArray[np.float64]

POISSON = 0.35  # of POM and PETG, suppliers' sheets: 0.35 to 0.4
_THREE = ((1 / 6, 1 / 6), (2 / 3, 1 / 6), (1 / 6, 2 / 3))  # exact for the squares of linear strains


@dataclass(frozen=True)
class Found:
    """force: N per mm of depth and unit of modulus, in y, on what was moved; strain: largest principal one by node."""

    force: float
    places: Array
    strain: Array


def mesh(shape: Polygon, fine: float, coarse: float, roots: list[tuple[float, float]], around: float) -> tuple:
    """Points and triangles of ``shape``: ``fine`` within ``around`` of ``roots``, ``coarse`` elsewhere."""
    low_x, low_y, high_x, high_y = shape.bounds
    points = []
    for ring in (shape.exterior, *shape.interiors):
        ends = np.asarray(ring.coords)
        for a, b in pairwise(ends):
            near = any(np.hypot(*((a + b) / 2 - root)) < around + np.hypot(*(b - a)) / 2 for root in roots)
            count = max(1, int(np.ceil(np.hypot(*(b - a)) / (fine / 1.5 if near else coarse / 1.5))))
            points += [a + (b - a) * i / count for i in range(count)]
    edge = np.array(points)
    inner = []
    for step in (fine, coarse):
        x, y = np.meshgrid(np.arange(low_x, high_x, step), np.arange(low_y, high_y, step * 0.866))
        x[1::2] += step / 2
        grid = np.column_stack([x.ravel(), y.ravel()])
        near = np.min([np.hypot(*(grid - root).T) for root in roots], axis=0) < around
        grid = grid[near if step == fine else ~near]
        inside = shapely.contains_xy(shape.buffer(-0.4 * step), *grid.T)
        inner.append(grid[inside])
    points = np.concatenate([edge, *inner])
    corners = Delaunay(points).simplices
    kept = corners[shapely.contains_xy(shape, *points[corners].mean(axis=1).T)]
    a, b, c = points[kept].transpose(1, 0, 2)
    area = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    kept = kept[np.abs(area) > 1e-9]
    assert abs(np.abs(area).sum() / shape.area - 1.0) < 2e-4
    return points, kept


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


@dataclass(frozen=True)
class _Elements:
    """nodes: float[n, 2]; elements: six nodes each; grad: of their area coordinates; whole: stiffness matrix."""

    nodes: Array
    elements: NDArray[np.intp]
    grad: Array
    whole: csc_matrix

    @property
    def places(self) -> NDArray[np.intp]:
        return np.stack([2 * self.elements, 2 * self.elements + 1], -1).reshape(len(self.elements), 12)

    def strains(self, place: tuple[float, float, float]) -> Array:
        """Strain of every element at area coordinates ``place`` from its displacements: float[m, 3, 12]."""
        return _strains(self.grad, place)


def _strains(grad: Array, place: tuple[float, float, float]) -> Array:
    shapes = [(4 * place[i] - 1) * grad[:, i] for i in range(3)]
    shapes += [4 * (place[i] * grad[:, j] + place[j] * grad[:, i]) for i, j in ((0, 1), (1, 2), (2, 0))]
    b = np.zeros((len(grad), 3, 12))
    for k, one in enumerate(shapes):
        b[:, 0, 2 * k] = b[:, 2, 2 * k + 1] = one[:, 0]
        b[:, 1, 2 * k + 1] = b[:, 2, 2 * k] = one[:, 1]
    return b


def _assembled(points: Array, corners: NDArray[np.intp]) -> _Elements:
    """What ``mesh`` made, of modulus and depth 1."""
    edges = np.sort(corners[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    unique, number = np.unique(edges, axis=0, return_inverse=True)
    nodes = np.concatenate([points, points[unique].mean(axis=1)])
    elements = np.column_stack([corners, len(points) + number.reshape(-1, 3)])
    at = nodes[corners]
    flip = _cross(at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]) < 0
    elements[flip] = elements[flip][:, [0, 2, 1, 5, 4, 3]]
    at = nodes[elements[:, :3]]
    double = _cross(at[:, 1] - at[:, 0], at[:, 2] - at[:, 0])
    # gradients of the three area coordinates
    grad = np.stack(
        [at[:, [1, 2, 0]][..., 1] - at[:, [2, 0, 1]][..., 1], at[:, [2, 0, 1]][..., 0] - at[:, [1, 2, 0]][..., 0]], -1
    )
    grad = grad / double[:, None, None]
    elastic = np.array([[1, POISSON, 0], [POISSON, 1, 0], [0, 0, (1 - POISSON) / 2]]) / (1 - POISSON**2)
    local = np.zeros((len(elements), 12, 12))
    for p, q in _THREE:
        b = _strains(grad, (1 - p - q, p, q))
        local += (double / 6)[:, None, None] * (b.transpose(0, 2, 1) @ elastic @ b)
    places = np.stack([2 * elements, 2 * elements + 1], -1).reshape(len(elements), 12)
    row, column = np.repeat(places, 12, axis=1).ravel(), np.tile(places, (1, 12)).ravel()
    whole = coo_matrix((local.ravel(), (row, column)), shape=(2 * len(nodes),) * 2).tocsc()
    return _Elements(nodes, elements, grad, whole)


def pulled(points: Array, corners: NDArray[np.intp], held_x: float, moved_x: float) -> Found:
    """What ``mesh`` made, of modulus 1, held where x <= ``held_x`` and moved by 1 in y where x >= ``moved_x``."""
    made = _assembled(points, corners)
    nodes, whole = made.nodes, made.whole
    still, moved = np.flatnonzero(nodes[:, 0] <= held_x + 1e-9), np.flatnonzero(nodes[:, 0] >= moved_x - 1e-9)
    given = np.concatenate([2 * still, 2 * still + 1, 2 * moved, 2 * moved + 1])
    u = np.zeros(2 * len(nodes))
    u[2 * moved + 1] = 1.0
    free = np.setdiff1d(np.arange(2 * len(nodes)), given)
    u[free] = splu(whole[free][:, free]).solve(-(whole[free] @ u))
    force = float((whole[2 * moved + 1] @ u).sum())
    worst = np.zeros(len(nodes))
    for k, place in enumerate(((1, 0, 0), (0, 1, 0), (0, 0, 1), (0.5, 0.5, 0), (0, 0.5, 0.5), (0.5, 0, 0.5))):
        x, y, shear = np.einsum("mij,mj->im", made.strains(place), u[made.places])
        principal = np.abs(x + y) / 2 + np.hypot((x - y) / 2, shear / 2)
        np.maximum.at(worst, made.elements[:, k], principal)
    return Found(force, nodes, worst)


@dataclass(frozen=True)
class Grip:
    """Holds an outline where ``where`` is true of its nodes float[n, 2], and moves it there as a rigid body."""

    where: Callable[[Array], NDArray[np.bool_]]
    about: tuple[float, float]


def gripped(points: Array, corners: NDArray[np.intp], grips: Sequence[Grip]) -> Array:
    """Stiffness of what ``mesh`` made, of modulus and depth 1, at x, y and turn of every grip: float[3 g, 3 g]."""
    made = _assembled(points, corners)
    nodes, size = made.nodes, 2 * len(made.nodes)
    moves = np.zeros((size, 3 * len(grips)))
    for number, grip in enumerate(grips):
        held = np.flatnonzero(grip.where(nodes))
        moves[2 * held, 3 * number] = moves[2 * held + 1, 3 * number + 1] = 1.0
        moves[2 * held, 3 * number + 2] = grip.about[1] - nodes[held, 1]
        moves[2 * held + 1, 3 * number + 2] = nodes[held, 0] - grip.about[0]
    given = np.flatnonzero(np.abs(moves).sum(axis=1))
    given = np.unique(np.concatenate([given - given % 2, given - given % 2 + 1]))
    free = np.setdiff1d(np.arange(size), given)
    across = np.asarray(made.whole[free] @ moves)
    inner = splu(made.whole[free][:, free]).solve(across)
    return np.asarray(moves.T @ (made.whole @ moves) - across.T @ inner)
