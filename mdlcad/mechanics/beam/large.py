"""A plane frame at large displacements and turns: corotational Euler-Bernoulli elements, Newton's method.

The element is that of M. A. Crisfield, Non-linear Finite Element Analysis of Solids and Structures, vol. 1 (1991),
chapter 7: a linear beam in axes that go with its chord. With chord length l, direction cosines c, s, elongation u and
end turns a, b against the chord:

    N = E A u / L,   Ma = E I (4 a + 2 b) / L,   Mb = E I (2 a + 4 b) / L,    (other factors where fillets stiffen it)
    forces = B' (N, Ma, Mb),   tangent = B' C B + N z z' / l + (Ma + Mb) (r z' + z r') / l^2.

Long beams are cut into several elements. The motion is driven by prescribed displacements, in steps that are halved
where Newton's method does not converge: so a force that falls (a beam that snaps through) is no obstacle.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from mdlcad.mechanics.fillet import Zone, bare_wall, bending_matrix, stretch_factor
from mdlcad.mechanics.frame import Array, Beam, Frame

_ITERATIONS = 25
_HALVINGS = 12


@dataclass(frozen=True, slots=True)
class Pose:
    """displacements and reactions, shape (3 nodes,): x, y and turn of each; reactions are 0 where nothing holds."""

    displacements: Array
    reactions: Array


class LargeFrame:
    """``frame`` with beam i cut into ``cuts[i]`` elements; the frame's own nodes and their numbers stay the first.

    The frame's springs stay linear.
    """

    def __init__(self, frame: Frame, cuts: Sequence[int]):
        nodes = [tuple(node) for node in frame.nodes]
        elements: list[Beam] = []
        self.part: list[int] = []
        for index, (beam, count) in enumerate(zip(frame.beams, cuts, strict=True)):
            ends = frame.nodes[[beam.start, beam.end]]
            chain = [beam.start]
            for cut in range(1, count):
                chain.append(len(nodes))
                nodes.append(tuple(ends[0] + (ends[1] - ends[0]) * cut / count))
            chain.append(beam.end)
            step = frame.length(beam) / count
            elements += [
                Beam(a, b, beam.axial, beam.bending, _part_of(beam.zones, cut * step, (cut + 1) * step), beam.shear)
                for cut, (a, b) in enumerate(pairwise(chain))
            ]
            self.part += [index] * count
        self.size = 3 * len(nodes)
        self._springs = frame.springs
        self._nodes = np.array(nodes)
        start, end = (np.array([getattr(e, name) for e in elements]) for name in ("start", "end"))
        self._places = np.concatenate([3 * start[:, None] + np.arange(3), 3 * end[:, None] + np.arange(3)], axis=1)
        self._start, self._end = start, end
        self._axial = np.array([e.axial for e in elements])
        self._bending = np.array([e.bending for e in elements])
        chord = self._nodes[end] - self._nodes[start]
        self._length = np.hypot(chord[:, 0], chord[:, 1])
        zones = [(float(length), e.zones) for length, e in zip(self._length, elements, strict=True)]
        self._stretching = self._axial * [stretch_factor(*item) for item in zones]
        turning = [bending_matrix(*item, e.shear) for item, e in zip(zones, elements, strict=True)]
        self._turning = np.array(turning).T
        bare = [bare_wall(*item) for item in zones]
        self._bare = np.array([item or (0.0, 0.0) for item in bare]).T
        self._strained = np.array([item is not None for item in bare])
        own = np.array([spring.dof for spring in frame.springs], dtype=np.intp)
        # where the entries of the elements' matrices, and of the springs, belong
        self._row = np.append(np.repeat(self._places, 6, axis=1).ravel(), own)
        self._column = np.append(np.tile(self._places, (1, 6)).ravel(), own)
        self._cosine, self._sine = (chord / self._length[:, None]).T

    def rest(self) -> Pose:
        """Nothing moved."""
        return Pose(np.zeros(self.size), np.zeros(self.size))

    def move(self, pose: Pose, prescribed: Mapping[int, float]) -> Pose:
        """The equilibrium nearby, with the degrees of freedom of ``prescribed`` at those displacements.

        Raises:
            ArithmeticError: no equilibrium was found that continues ``pose``.
        """
        held = np.array(sorted(prescribed), dtype=np.intp)
        goal = np.array([prescribed[int(i)] for i in held])
        free = np.setdiff1d(np.arange(self.size), held)
        here, done, share, halvings = pose.displacements, 0.0, 1.0, 0
        begin = here[held]
        while done < 1.0:
            share = min(share, 1.0 - done)
            found = self._newton(here, held, free, begin + (done + share) * (goal - begin))
            if found is None:
                share, halvings = share / 2.0, halvings + 1
                if halvings > _HALVINGS:
                    raise ArithmeticError("the beams' equilibrium is lost: no force holds this position")
                continue
            here, done = found, done + share
        return Pose(here, self._forces(here)[0])

    def strains(self, pose: Pose, walls: Sequence[float]) -> Array:
        """Largest strain of each beam of the frame, bending and stretching; ``walls`` are their thicknesses."""
        stretch, moments = self._inner(pose.displacements)[:2]
        wall = np.array(walls)[self.part]
        # held where the wall is bare: where fillets make it thicker, the moment weighs less
        bare = [np.abs(moments[0] - share * (moments[0] + moments[1])) for share in self._bare]
        bending = np.max(bare, axis=0) * wall / (2.0 * self._bending)
        strain = np.zeros(len(walls))
        np.maximum.at(strain, self.part, self._strained * (bending + np.abs(stretch) / self._axial))
        return strain

    def line(self, pose: Pose) -> list[Array]:
        """The two ends of every element where they are, shape (2, 2) each."""
        now = self._nodes + pose.displacements.reshape(-1, 3)[:, :2]
        return [now[[a, b]] for a, b in zip(self._start, self._end, strict=True)]

    def _newton(self, from_here: Array, held: NDArray[np.intp], free: NDArray[np.intp], goal: Array) -> Array | None:
        here = from_here.copy()
        jump = np.zeros(self.size)
        jump[held] = goal - here[held]
        place = np.full(self.size, -1)
        place[free] = np.arange(len(free))
        inner = (place[self._row] >= 0) & (place[self._column] >= 0)
        row, column = place[self._row][inner], place[self._column][inner]
        for iteration in range(_ITERATIONS):
            force, values = self._forces(here)
            if iteration == 0:
                np.add.at(force, self._row, values * jump[self._column])
                here[held] = goal
            tangent = csc_matrix((values[inner], (row, column)), shape=(len(free), len(free)))
            step = splu(tangent).solve(-force[free])
            if not np.all(np.isfinite(step)) or np.max(np.abs(step)) > 5.0:
                return None
            here[free] += step
            if iteration and np.max(np.abs(step)) < 1e-9:
                return here
        return None

    def _inner(self, q: Array) -> tuple[Array, Array, Array, Array, Array]:
        """Stretching forces, end moments (2, m), chord lengths and direction cosines."""
        at = q[self._places]
        chord = np.stack([self._length * self._cosine, self._length * self._sine]) + (at[:, 3:5] - at[:, 0:2]).T
        length = np.hypot(chord[0], chord[1])
        cosine, sine = chord / length
        turn = np.arctan2(sine * self._cosine - cosine * self._sine, cosine * self._cosine + sine * self._sine)
        # elongation without the cancellation of length - self._length
        elongation = (length**2 - self._length**2) / (length + self._length)
        # against the chord, whose own turn is known only up to whole turns
        a, b = (end - 2.0 * np.pi * np.round(end / (2.0 * np.pi)) for end in (at[:, 2] - turn, at[:, 5] - turn))
        stiff = self._bending / self._length
        aa, ab, bb = self._turning
        return (
            self._stretching * elongation / self._length,
            np.stack([stiff * (aa * a + ab * b), stiff * (ab * a + bb * b)]),
            length,
            cosine,
            sine,
        )

    def _forces(self, q: Array) -> tuple[Array, Array]:
        """Forces of the beams and springs, and the entries of the tangent at ``_row``, ``_column``."""
        stretch, moments, length, c, s = self._inner(q)
        zero, one = np.zeros_like(c), np.ones_like(c)
        r = np.stack([-c, -s, zero, c, s, zero], axis=1)
        z = np.stack([s, -c, zero, -s, c, zero], axis=1)
        lean = -z / length[:, None]
        first, second = lean.copy(), lean.copy()
        first[:, 2] += one
        second[:, 5] += one
        rows = np.stack([r, first, second], axis=1)  # B, shape (m, 3, 6)
        inner = np.stack([stretch, moments[0], moments[1]], axis=1)
        elastic = np.zeros((len(c), 3, 3))
        stiff = self._bending / self._length
        elastic[:, 0, 0] = self._stretching / self._length
        aa, ab, bb = self._turning
        elastic[:, 1, 1], elastic[:, 2, 2] = aa * stiff, bb * stiff
        elastic[:, 1, 2] = elastic[:, 2, 1] = ab * stiff
        local = rows.transpose(0, 2, 1) @ (elastic @ rows)
        local += (stretch / length)[:, None, None] * z[:, :, None] * z[:, None, :]
        both = r[:, :, None] * z[:, None, :]
        local += ((moments[0] + moments[1]) / length**2)[:, None, None] * (both + both.transpose(0, 2, 1))
        force = np.zeros(self.size)
        np.add.at(force, self._places, (inner[:, None, :] @ rows)[:, 0])
        for spring in self._springs:
            force[spring.dof] += spring.stiffness * q[spring.dof]
        return force, np.append(local.ravel(), [spring.stiffness for spring in self._springs])


def _part_of(zones: Sequence[Zone], low: float, high: float) -> tuple[Zone, ...]:
    """The zones of a beam between ``low`` and ``high`` mm, counted from there."""
    cut = [Zone(max(z.start, low) - low, min(z.stop, high) - low, z.bend, z.stretch) for z in zones]
    return tuple(zone for zone in cut if zone.stop > zone.start)
