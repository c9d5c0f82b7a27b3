"""The free space of a placed lattice: channels between hub columns, rows, and where a tab meets the rim.

A *channel* k lies between hub columns k-1 and k (channel 0 left of the first column, channel n right of the last).
Everything a channel may use in a row is an interval in x; walls that slope or notch shorten or split it.
All lengths in mm. Coordinates of hubs are multiples of ``RESOLUTION``, so that routing can count in integers.
"""

from __future__ import annotations

from dataclasses import dataclass

from shapely import Polygon, box
from shapely.geometry.base import BaseGeometry

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.placement.placement import PlacedPort

RESOLUTION = 0.05
"""mm; tracks and hubs sit on multiples of this."""

Interval = tuple[float, float]


@dataclass(frozen=True, slots=True)
class TabTerminal:
    """How one port is reached from inside.

    Attributes:
        bit, mass: the port and the mass whose net carries its tab.
        vertical: True for a wall whose normal is mostly y: the tab leaves the rung's row in y.
        channel: the channel that holds the bend (vertical) or ends at the wall (horizontal).
        rows: rows of the lattice whose items the tab's rung may meet (its own row, or the two it lies between).
        row: the lattice row that the rung lies in exactly, or None if it lies between rows.
        x: the bend (vertical) or the inner edge of the rim (horizontal). y: the rung's height.
        outside: +1 if the wall is at higher x (horizontal) or y (vertical), else -1.
        path: centre line of the tab from the rung's end to its tip.
    """

    bit: str
    mass: str
    vertical: bool
    channel: int
    rows: tuple[int, ...]
    row: int | None
    x: float
    y: float
    outside: int
    path: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class Way:
    """How the net of a mass in some column gets to a tab: from ``channel`` over the hub columns first..last (none if
    first > last), whose slots in the tab's rows must be empty."""

    channel: int
    first: int
    last: int


def way(tab: TabTerminal, column: int) -> Way | None:
    """The way from a mass in ``column`` to ``tab``; None if the wall itself is in between."""
    if column < tab.channel:
        if not tab.vertical and tab.outside < 0 and column < tab.channel - 1:
            return None
        return Way(column + 1, column + 1, tab.channel - 1)
    if not tab.vertical and tab.outside > 0 and column > tab.channel:
        return None
    return Way(column, tab.channel, column - 1)


def inside(boundary: tuple[tuple[float, float], ...], rules: LayoutRules) -> Polygon:
    """The boundary (mm) less its rim and one gap: what bodies may use at the worst of their strokes.

    Returns an empty polygon if nothing is left; the largest piece if the rim cuts the device in two.
    """
    inner = Polygon(boundary).buffer(-(rules.frame_width + rules.gap), join_style="mitre")
    if inner.geom_type == "Polygon":
        return inner
    return max(inner.geoms, key=lambda piece: piece.area)


def free_intervals(inner: BaseGeometry, y_low: float, y_high: float) -> tuple[Interval, ...]:
    """Every maximal x interval whose whole strip y_low..y_high lies in ``inner``."""
    x_low, _, x_high, _ = inner.bounds
    blocked = box(x_low, y_low, x_high, y_high).difference(inner)
    pieces = [blocked] if blocked.geom_type == "Polygon" else list(getattr(blocked, "geoms", ()))
    spans = sorted((piece.bounds[0], piece.bounds[2]) for piece in pieces if piece.area > 1e-9)
    free: list[Interval] = []
    at = x_low
    for low, high in spans:
        if low > at + 1e-9:
            free.append((at, low))
        at = max(at, high)
    if x_high > at + 1e-9:
        free.append((at, x_high))
    return tuple(free)


def holding(intervals: tuple[Interval, ...], x: float) -> Interval | None:
    """The interval that holds ``x``, if any."""
    for low, high in intervals:
        if low - 1e-9 <= x <= high + 1e-9:
            return low, high
    return None


def clearance(height_a: float, height_b: float, rules: LayoutRules) -> float:
    """Least distance in y of the centres of two bodies of given heights that both move."""
    return (height_a + height_b) / 2 + 2 * rules.throw + rules.gap


def channel_at(column_x: tuple[float, ...], x: float) -> int:
    """The channel that holds ``x`` (a point over a hub column belongs to the channel on its own side)."""
    return sum(1 for hub in column_x if hub <= x)


def terminals(
    ports: tuple[PlacedPort, ...],
    inner: Polygon,
    column_x: tuple[float, ...],
    row_y: tuple[float, ...],
    rules: LayoutRules,
) -> tuple[TabTerminal, ...]:
    """How every port's tab leaves the device, in the order of ``ports``.

    A port too near a corner for its tab to pass the rim there passes as near as it can and steps sideways outside, onto
    a foot of a bar's full width in the middle of the port's place.
    """
    return tuple(
        _vertical(port, inner, column_x, row_y, rules)
        if abs(port.normal[1]) > abs(port.normal[0])
        else _horizontal(port, inner, column_x, row_y, rules)
        for port in ports
    )


def _snap(value: float) -> float:
    return round(round(value / RESOLUTION) * RESOLUTION, 6)


def _overhang(port: PlacedPort, rules: LayoutRules) -> float:
    """How far a tab stands out: a sloping wall is still cleared by the tab's far edge."""
    across, along = sorted((abs(port.normal[0]), abs(port.normal[1])))
    return rules.throw + rules.bar_width * (1 + across / along / 2)


def _horizontal(
    port: PlacedPort, inner: Polygon, column_x: tuple[float, ...], row_y: tuple[float, ...], rules: LayoutRules
) -> TabTerminal:
    outside = 1 if port.normal[0] > 0 else -1
    reach = rules.bar_width / 2 + rules.throw
    tip = port.x + outside * _overhang(port, rules)
    y, edge = port.y, None
    # pins of one trunk stand a bar apart: a tab nearer to a row takes the row, and steps sideways outside
    crowded = tuple(row for row in row_y if 1e-9 < abs(row - port.y) < rules.bar_width)
    for candidate in (*crowded, *_outwards(port.y, inner.bounds[1] + reach, inner.bounds[3] - reach, row_y)):
        spans = free_intervals(inner, candidate - reach, candidate + reach)
        near = [span[1] if outside > 0 else span[0] for span in spans]
        near = [x for x in near if abs(x - port.x) <= 3 * (rules.frame_width + rules.gap)]
        if near:
            y, edge = candidate, min(near, key=lambda x: abs(x - port.x))
            break
    if edge is None:
        edge = port.x - outside * (rules.frame_width + rules.gap)
    pitch = clearance(rules.bar_width, rules.hub_height, rules)
    rows = tuple(r for r, row in enumerate(row_y) if abs(row - y) < pitch - 1e-9)
    exact = next((r for r in rows if abs(row_y[r] - y) < 1e-6), None)
    path = [(edge, y), (tip, y)]
    if abs(y - port.y) > 1e-9:
        path += [(tip, port.y), (tip + outside * rules.bar_width / 2, port.y)]
    inward = edge - outside * rules.bar_width
    return TabTerminal(
        port.bit, port.mass, False, channel_at(column_x, inward), rows, exact, edge, y, outside, tuple(path)
    )


def _outwards(y: float, low: float, high: float, row_y: tuple[float, ...]) -> tuple[float, ...]:
    """Heights to try for a horizontal tab: its own, else the nearest that has room."""
    clamped = min(max(y, low), high)
    rows = sorted(row_y, key=lambda row: (abs(row - y), row))
    return (y, clamped, *rows) if low <= y <= high else (clamped, *rows)


def _vertical(
    port: PlacedPort, inner: Polygon, column_x: tuple[float, ...], row_y: tuple[float, ...], rules: LayoutRules
) -> TabTerminal:
    outside = 1 if port.normal[1] > 0 else -1
    half = rules.bar_width / 2
    order = sorted(range(len(row_y)), key=lambda r: -outside * row_y[r])
    x, row = port.x, order[0]
    best = float("inf")
    for r in order:
        spans = free_intervals(inner, row_y[r] - rules.row_pitch / 2, row_y[r] + rules.row_pitch / 2)
        for low, high in spans:
            if high - low < 2 * half:
                continue
            at = min(max(port.x, low + half), high - half)
            # prefer the true x; among rows that allow it, the outermost
            if abs(at - port.x) < best - 1e-9:
                best, x, row = abs(at - port.x), at, r
        if best <= half:
            break
    x = _snap(x)
    rows = tuple(r for r in range(len(row_y)) if outside * (row_y[r] - row_y[row]) >= 0)
    tip = port.y + outside * _overhang(port, rules)
    path = [(x, row_y[row]), (x, tip)]
    if abs(x - port.x) > RESOLUTION:
        path += [(port.x, tip), (port.x, tip + outside * rules.bar_width / 2)]
    return TabTerminal(
        port.bit, port.mass, True, channel_at(column_x, x), rows, row, x, row_y[row], outside, tuple(path)
    )
