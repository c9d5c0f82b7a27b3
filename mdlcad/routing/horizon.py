"""Routing of a long channel, a few rows at a time from the bottom up.

Each window looks further up than it decides: trunks that begin in its lower half, and the items there, are kept as
they come out; the others are decided again by the next. What was kept stands fixed in the windows above. The model is
that of a whole channel, so the result is legal by the same rules; that there is none does not prove that the channel
has none.
"""

from __future__ import annotations

import math
from dataclasses import replace

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.placement.grid import RESOLUTION
from mdlcad.routing.channel import ChannelRoute, solve
from mdlcad.routing.pieces import Channel, Edge, Item

MOST_TRUNKS = 200
"""A channel of more trunks is routed in windows, which may miss the routing that the whole of it has. (The whole of 126
trunks with 300 items takes some two seconds.)"""
ROWS = (8, 16, 32)
"""Rows that a window decides; it looks as many further up. More are tried where what was kept leaves no way."""


def solve_any(channel: Channel, rules: LayoutRules, seed: int) -> ChannelRoute | None:
    """Tracks and plates for ``channel``: at once, or in windows if it is long. None if none were found."""
    if channel.trouble or len(channel.trunks) <= MOST_TRUNKS:
        return solve(channel, rules, seed)
    tries = (_by_windows(channel, rules, seed, rows) for rows in ROWS)
    return next((found for found in tries if found is not None), None)


def _by_windows(channel: Channel, rules: LayoutRules, seed: int, rows: int) -> ChannelRoute | None:
    """Tracks and plates, ``rows`` decided at a time."""
    tracks: dict[int, float] = {}
    plates: dict[int, int] = {}
    low = min(item.y_low for item in channel.items)
    high = max(item.y_high for item in channel.items)
    reach = rows * rules.row_pitch
    for window in range(math.ceil((high - low) / reach)):
        bottom = low + window * reach
        part = _Part(channel, bottom - rules.row_pitch - 2 * rules.throw, bottom + 2 * reach, tracks, plates)
        found = solve(part.channel, rules, seed)
        if found is None:
            return None
        for index, x in zip(part.trunks, found.tracks, strict=True):
            if channel.trunks[index].y_low < bottom + reach:
                tracks[index] = x
        for index, plate in zip(part.items, found.plates, strict=True):
            if channel.items[index].y_low < bottom + reach:
                plates[index] = plate
    return ChannelRoute(
        tuple(tracks[index] for index in range(len(channel.trunks))),
        tuple(plates[index] for index in range(len(channel.items))),
    )


class _Part:
    """The trunks and items of a channel that are seen between two heights, with what is decided already held fast.

    Attributes:
        trunks, items: their indices in the whole channel.
    """

    def __init__(
        self, channel: Channel, low: float, high: float, tracks: dict[int, float], plates: dict[int, int]
    ) -> None:
        self.items = [i for i, item in enumerate(channel.items) if _seen(item, low, high)]
        named = {channel.items[i].trunk for i in self.items}
        self.trunks = [
            i for i, trunk in enumerate(channel.trunks) if i in named or (trunk.y_low < high and low < trunk.y_high)
        ]
        place = {trunk: index for index, trunk in enumerate(self.trunks)}
        self.channel = Channel(channel.index)
        for index in self.trunks:
            trunk = channel.trunks[index]
            if index in tracks:
                at = round(tracks[index] / RESOLUTION)
                trunk = replace(trunk, domain=((at, at),))
            self.channel.trunks.append(trunk)
        for index in self.items:
            item = channel.items[index]
            self.channel.items.append(
                replace(
                    item,
                    trunk=None if item.trunk is None else place[item.trunk],
                    left=_moved(item.left, place),
                    right=_moved(item.right, place),
                    plate=plates.get(index, item.plate),
                )
            )


def _seen(item: Item, low: float, high: float) -> bool:
    tall = item.rises or (0, 0, item.y_low, item.y_high)
    return min(item.y_low, tall[2]) < high and low < max(item.y_high, tall[3])


def _moved(edge: Edge, place: dict[int, int]) -> Edge:
    return edge if edge.trunk is None else Edge(edge.at, place[edge.trunk])
