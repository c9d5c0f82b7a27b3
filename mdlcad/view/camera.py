"""Where to look from: presets, and the distance from which something just fills the picture."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from mdlcad.view.motion import Floats


class Preset(StrEnum):
    """A direction to look from. TOP and BOTTOM are drawn to scale (parallel), as are the sides."""

    ISO = "iso"
    TOP = "top"
    BOTTOM = "bottom"
    FRONT = "front"
    BACK = "back"
    LEFT = "left"
    RIGHT = "right"


# towards the camera, and up
DIRECTIONS: dict[Preset, tuple[tuple[float, float, float], tuple[float, float, float]]] = {
    Preset.ISO: ((0.5, -0.75, 0.72), (0.0, 0.0, 1.0)),
    Preset.TOP: ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
    Preset.BOTTOM: ((0.0, 0.0, -1.0), (0.0, 1.0, 0.0)),
    Preset.FRONT: ((0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
    Preset.BACK: ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    Preset.LEFT: ((-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    Preset.RIGHT: ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
}

VIEW_ANGLE = 30.0
"""Vertical angle of view, degrees."""

_MARGIN = 1.06

# a found part is shown with at least this much around it, mm, so that one sees where it is
_LEAST_MM = 45.0


@dataclass(frozen=True, slots=True)
class Pose:
    """A camera: where it is, where it looks, which way is up; ``half_height`` mm if it draws in parallel, else None."""

    position: tuple[float, float, float]
    focus: tuple[float, float, float]
    up: tuple[float, float, float]
    half_height: float | None


def pose(preset: Preset, points: Floats, aspect: float) -> Pose:
    """The camera that sees all ``points`` (float[n, 3], mm) as large as it can.

    In axes (right, above, towards) about any middle, a point (u, v, w) is seen from a distance d if |u| and |v| are at
    most (d - w) times the slope of the picture's edges: the extremes of u +- slope w give both the least d and where
    the camera has to stand across.

    Args:
        aspect: width over height of the picture.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    centre, half = (low + high) / 2.0, np.maximum((high - low) / 2.0, _LEAST_MM / 2.0)
    small = bool(np.all(high - low < _LEAST_MM))
    corners = centre + np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * half
    seen = (corners if small else points) - centre
    towards, up = (np.array(vector, dtype=np.float64) for vector in DIRECTIONS[preset])
    towards /= np.linalg.norm(towards)
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    above = np.cross(towards, right)
    parallel = preset is not Preset.ISO
    slope = math.tan(math.radians(VIEW_ANGLE) / 2.0)
    near = seen @ towards
    far = 0.0
    for axis, edge in ((right, slope * aspect), (above, slope)):
        lean = 0.0 if parallel else edge
        most, least = float((seen @ axis + lean * near).max()), float((seen @ axis - lean * near).min())
        centre = centre + (most + least) / 2.0 * axis
        far = max(far, (most - least) / (2.0 * edge))
    far *= _MARGIN
    position = centre + (far + float(np.linalg.norm(half)) * 4.0 if parallel else far) * towards
    return Pose(_triple(position), _triple(centre), _triple(up), far * slope if parallel else None)


def _triple(vector: Floats) -> tuple[float, float, float]:
    return float(vector[0]), float(vector[1]), float(vector[2])
