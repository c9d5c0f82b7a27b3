"""A linear plane frame: Euler-Bernoulli beams with axial stiffness, supports and springs.

Three degrees of freedom a node: x, y (mm) and rotation (rad, anticlockwise). Forces in N, moments in N mm. The beam's
stiffness matrix is the textbook one (cubic shape functions, exact for end loads), e.g. Przemieniecki, Theory of Matrix
Structural Analysis, chapter 5.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mdlcad.mechanics.fillet import Zone, bare_wall, bending_matrix, stretch_factor

Array = NDArray[np.float64]

X, Y, TURN = 0, 1, 2


def dof(node: int, direction: int) -> int:
    """Number of a degree of freedom; ``direction`` is X, Y or TURN."""
    return 3 * node + direction


@dataclass(frozen=True, slots=True)
class Beam:
    """A straight beam between two nodes: ``axial`` = E A in N, ``bending`` = E I in N mm^2; ``zones`` are stiffer.

    ``shear``: E I / (kappa G A), mm^2; 0 for one that is taken not to shear.
    """

    start: int
    end: int
    axial: float
    bending: float
    zones: tuple[Zone, ...] = ()
    shear: float = 0.0


@dataclass(frozen=True, slots=True)
class Spring:
    """A spring from one degree of freedom to the ground (N/mm, or N mm/rad for a rotation)."""

    dof: int
    stiffness: float


@dataclass(frozen=True, slots=True)
class Tie:
    """A spring between two degrees of freedom of one direction (N/mm, or N mm/rad for a rotation): a pin's give."""

    first: int
    second: int
    stiffness: float


@dataclass(frozen=True, slots=True)
class Solution:
    """displacements and reactions, shape (3 nodes,); reactions are 0 (to rounding) at free degrees of freedom."""

    displacements: Array
    reactions: Array


class Frame:
    """Nodes of shape (n, 2) in mm, joined by beams and ties; every node must be held by one of them or a spring."""

    def __init__(
        self,
        nodes: Sequence[tuple[float, float]],
        beams: Sequence[Beam],
        springs: Sequence[Spring] = (),
        ties: Sequence[Tie] = (),
    ):
        self.nodes: Array = np.asarray(nodes, dtype=np.float64)
        self.beams = tuple(beams)
        self.springs = tuple(springs)
        self.ties = tuple(ties)

    def matrix(self) -> Array:
        """Stiffness matrix, shape (3 n, 3 n), no supports applied."""
        size = 3 * len(self.nodes)
        total = np.zeros((size, size))
        start, end = (
            np.array([getattr(beam, name) for beam in self.beams], dtype=np.intp) for name in ("start", "end")
        )
        places = np.concatenate([3 * start[:, None] + np.arange(3), 3 * end[:, None] + np.arange(3)], axis=1)
        np.add.at(total, (places[:, :, None], places[:, None, :]), self._beam_matrices(start, end))
        for spring in self.springs:
            total[spring.dof, spring.dof] += spring.stiffness
        for tie in self.ties:
            ends = [tie.first, tie.second]
            total[np.ix_(ends, ends)] += tie.stiffness * np.array([[1.0, -1.0], [-1.0, 1.0]])
        return total

    def solve(self, prescribed: Mapping[int, float], loads: Mapping[int, float] | None = None) -> Solution:
        """Displacements under prescribed displacements (supports have 0) and loads, both by degree of freedom.

        Raises:
            numpy.linalg.LinAlgError: the supports leave a rigid motion free.
        """
        matrix = self.matrix()
        size = len(matrix)
        given = np.array(sorted(prescribed), dtype=np.intp)
        free = np.setdiff1d(np.arange(size), given)
        displacement = np.zeros(size)
        displacement[given] = [prescribed[int(i)] for i in given]
        force = np.zeros(size)
        for place, value in (loads or {}).items():
            force[place] += value
        if len(free):
            right = force[free] - matrix[np.ix_(free, given)] @ displacement[given]
            displacement[free] = np.linalg.solve(matrix[np.ix_(free, free)], right)
        return Solution(displacement, matrix @ displacement - force)

    def condense(self, keep: Sequence[int], held: Sequence[int] = ()) -> Array:
        """Stiffness matrix seen at the degrees of freedom ``keep``, others free, ``held`` ones at 0.

        Returns: shape (len(keep), len(keep)).
        """
        matrix = self.matrix()
        kept = np.array(keep, dtype=np.intp)
        free = np.setdiff1d(np.arange(len(matrix)), [*keep, *held])
        inner = matrix[np.ix_(kept, kept)]
        if not len(free):
            return inner
        across = matrix[np.ix_(free, kept)]
        return np.asarray(inner - across.T @ np.linalg.solve(matrix[np.ix_(free, free)], across), dtype=np.float64)

    def length(self, beam: Beam) -> float:
        """Length of a beam in mm."""
        return float(np.hypot(*(self.nodes[beam.end] - self.nodes[beam.start])))

    def end_moments(self, beam: Beam, solution: Solution) -> tuple[float, float]:
        """Bending moments at the two ends of a beam, N mm (magnitude and sign of the end forces)."""
        length = self.length(beam)
        _, v0, r0, _, v1, r1 = self.local(beam, solution)
        a, b, c = bending_matrix(length, beam.zones, beam.shear)
        first, last = r0 - (v1 - v0) / length, r1 - (v1 - v0) / length
        stiff = beam.bending / length
        return float(stiff * (a * first + b * last)), float(stiff * (b * first + c * last))

    def wall_moment(self, beam: Beam, solution: Solution) -> float:
        """Largest bending moment where a beam is bare wall, N mm: at the ends of its fillets, if it has any."""
        first, last = self.end_moments(beam, solution)
        # the moment runs straight from one end to the other
        places = bare_wall(self.length(beam), beam.zones) or (0.5, 0.5)
        return max(abs(first - s * (first + last)) for s in places)

    def local(self, beam: Beam, solution: Solution) -> Array:
        """End displacements (along, across, turn) x 2 of a beam in its own axes, shape (6,)."""
        places = [3 * beam.start + i for i in range(3)] + [3 * beam.end + i for i in range(3)]
        return self._rotation(beam) @ solution.displacements[places]

    def deformed(self, beam: Beam, solution: Solution, at: Array) -> tuple[Array, Array]:
        """Deformed points, shape (m, 2), and turns, shape (m,), at fractions ``at`` of a beam's length."""
        length = self.length(beam)
        u0, v0, r0, u1, v1, r1 = self.local(beam, solution)
        along = u0 + (u1 - u0) * at
        h = (1 - 3 * at**2 + 2 * at**3, at - 2 * at**2 + at**3, 3 * at**2 - 2 * at**3, at**3 - at**2)
        across = h[0] * v0 + h[1] * length * r0 + h[2] * v1 + h[3] * length * r1
        slope = (6 * at**2 - 6 * at) * (v0 - v1) / length + (1 - 4 * at + 3 * at**2) * r0 + (3 * at**2 - 2 * at) * r1
        axis = (self.nodes[beam.end] - self.nodes[beam.start]) / length
        normal = np.array([-axis[1], axis[0]])
        base = self.nodes[beam.start] + np.outer(at * length, axis)
        return base + np.outer(along, axis) + np.outer(across, normal), slope

    def _beam_matrices(self, start: NDArray[np.intp], end: NDArray[np.intp]) -> Array:
        """Stiffness matrices of all beams in the frame's axes, shape (m, 6, 6)."""
        chord = self.nodes[end] - self.nodes[start]
        length = np.hypot(chord[:, 0], chord[:, 1])
        c, s = (chord / length[:, None]).T
        zones = [(float(own), beam.zones) for own, beam in zip(length, self.beams, strict=True)]
        a = np.array([beam.axial for beam in self.beams]) / length * [stretch_factor(*item) for item in zones]
        b = np.array([beam.bending for beam in self.beams]) / length**3
        turning = [bending_matrix(*item, beam.shear) for item, beam in zip(zones, self.beams, strict=True)]
        aa, ab, bb = np.array(turning).T
        zero = np.zeros_like(a)
        # stretching along (c, s); bending, whose shape is that of a unit displacement across and of two end turns
        along = np.stack([-c, -s, zero, c, s, zero], axis=1)
        across = np.stack([s, -c, zero, -s, c, zero], axis=1) / length[:, None]
        first, second = across.copy(), across.copy()
        first[:, 2] -= 1.0
        second[:, 5] -= 1.0
        stiff = a[:, None, None] * along[:, :, None] * along[:, None, :]
        pairs = ((aa, first, first), (bb, second, second), (ab, first, second), (ab, second, first))
        for factor, one, other in pairs:
            stiff += (factor * b * length**2)[:, None, None] * one[:, :, None] * other[:, None, :]
        return np.asarray(stiff, dtype=np.float64)

    def _rotation(self, beam: Beam) -> Array:
        c, s = (self.nodes[beam.end] - self.nodes[beam.start]) / self.length(beam)
        turn = np.zeros((6, 6))
        turn[:3, :3] = turn[3:, 3:] = [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]
        return turn
