"""Whether a boundary can hold a device at any sensible scale, asked before the long search for the smallest."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations

from shapely import Polygon

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.grid import clearance, free_intervals, inside
from mdlcad.placement.ports import PortPlace

SEARCH = 1.06
"""Ratio of one scale to the next while looking for one with room for every unit."""
LARGEST_MM = 100_000.0
"""Longest side, in mm, of a device that the search goes up to."""


@dataclass(frozen=True, slots=True)
class Lack:
    """Why a boundary is too small.

    Attributes:
        bit: the port bit whose tab has no room beside another's, or None if it is the units that have none.
        what: in words, with millimetres.
        mend: in words.
    """

    bit: str | None
    what: str
    mend: str


def lack_of_room(
    network: Network,
    boundary: tuple[tuple[int, int], ...],
    ports: tuple[PortPlace, ...],
    rules: LayoutRules,
    units: int,
    largest_scale: float,
) -> Lack | None:
    """What does not fit at ``largest_scale`` (mm per grid unit), or None.

    Args:
        boundary: vertices on the grid, clockwise. ports: places in grid units. units: slots that are needed.
    """
    return _crowded(network, ports, rules, largest_scale) or _thin(network, boundary, rules, units, largest_scale)


def _crowded(network: Network, ports: tuple[PortPlace, ...], rules: LayoutRules, largest_scale: float) -> Lack | None:
    used = {bit.bit for bit in (*network.sensors, *network.actuators)}
    worst: tuple[float, PortPlace, PortPlace, float, float] | None = None
    for one, two in combinations([port for port in ports if port.bit in used], 2):
        if one.line != two.line:
            continue
        # on a wall whose normal lies in x, tabs move along the wall, towards each other
        along = abs(one.normal[0]) >= abs(one.normal[1])
        need = clearance(rules.bar_width, rules.bar_width, rules) if along else rules.bar_width + rules.gap
        distance = math.dist((one.x, one.y), (two.x, two.y))
        scale = need / distance if distance else math.inf
        if scale > largest_scale and (worst is None or scale > worst[0]):
            worst = (scale, one, two, need, distance)
    if worst is None:
        return None
    scale, one, two, need, distance = worst
    return Lack(
        two.bit,
        f"the places of {one.bit} and {two.bit} are {distance:.3g} grid units apart, at most "
        f"{distance * largest_scale:.2f} mm in a device of this size, but their tabs need {need:.1f} mm",
        f"move them apart to at least {math.ceil(1000 * need / largest_scale) / 1000:g} grid units",
    )


def _thin(
    network: Network,
    boundary: tuple[tuple[int, int], ...],
    rules: LayoutRules,
    units: int,
    largest_scale: float,
) -> Lack | None:
    if _fits(boundary, rules, units, largest_scale):
        return None
    x_low, y_low, x_high, y_high = Polygon(boundary).bounds
    wide, tall = x_high - x_low, y_high - y_low
    scale = largest_scale
    while scale * max(wide, tall) <= LARGEST_MM and not _fits(boundary, rules, units, scale):
        scale *= SEARCH
    if _fits(boundary, rules, units, scale):
        enough = f"only at {scale * wide:.0f} x {scale * tall:.0f} mm would it have room"
    else:
        enough = f"not even at {scale * wide:.0f} x {scale * tall:.0f} mm would it have room"
    rim = 2 * (rules.frame_width + rules.gap)
    return Lack(
        None,
        f"the boundary is too thin for the device: its {len(network.masses)} units, each "
        f"{rules.unit_left + rules.unit_right:.0f} x {rules.row_pitch:.0f} mm inside a rim of {rim / 2:.1f} mm, do not "
        f"fit at {largest_scale * wide:.0f} x {largest_scale * tall:.0f} mm, and {enough}",
        "make the outline less slender: wider where it is thin",
    )


def _fits(boundary: tuple[tuple[int, int], ...], rules: LayoutRules, units: int, scale: float) -> bool:
    """Whether rows packed without regard to columns would hold ``units``: no lattice holds more."""
    inner = inside(tuple((x * scale, y * scale) for x, y in boundary), rules)
    if inner.is_empty:
        return False
    _, y_low, _, y_high = inner.bounds
    rows = int((y_high - y_low) / rules.row_pitch + 1e-9)
    spare = (y_high - y_low) - rows * rules.row_pitch
    width = rules.unit_left + rules.unit_right
    return any(
        sum(
            int((high - low) / width + 1e-9)
            for row in range(rows)
            for low, high in free_intervals(
                inner, y_low + offset + row * rules.row_pitch, y_low + offset + (row + 1) * rules.row_pitch
            )
        )
        >= units
        for offset in (0.0, spare / 2, spare)
    )
