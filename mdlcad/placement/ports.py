"""Where the program wants its sensors and actuators: the placer's only view of the language."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PortPlace:
    """One sensor or actuator bit on the boundary.

    Attributes:
        bit: "NAME[i]".
        line: name of the boundary line it stands on.
        x, y: its point on that line, in grid units (not rounded).
        normal: outward unit normal of the line.
    """

    bit: str
    line: str
    x: float
    y: float
    normal: tuple[float, float]
