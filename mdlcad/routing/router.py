"""Route a placed network: sides, then every channel exactly, then the pieces of the layout."""

from __future__ import annotations

from shapely import Polygon

from mdlcad.errors import SignoffError
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.grid import inside, terminals
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.placement import Placement
from mdlcad.placement.placer import choose_sides
from mdlcad.routing.assemble import assemble
from mdlcad.routing.channel import ChannelRoute, solve
from mdlcad.routing.gather import channels
from mdlcad.routing.layout import Layout
from mdlcad.routing.pieces import Channel

SIDE_TRIES = 3
"""Choices of channel sides and bias sides to try on one placement."""


def lattice_of(placement: Placement, rules: LayoutRules) -> Lattice:
    """The lattice that a placement was made on, rebuilt from the artefact alone."""
    inner: Polygon = inside(placement.boundary, rules)
    tabs = terminals(placement.ports, inner, placement.column_x, placement.row_y, rules)
    return Lattice(
        placement.boundary,
        placement.mm_per_grid,
        inner,
        placement.column_x,
        placement.row_y,
        placement.slots,
        placement.ports,
        tabs,
    )


def route(network: Network, placement: Placement, rules: LayoutRules, seed: int) -> Layout:
    """Tracks and plates for every carrier, coupler, bias leaf and tab.

    Couplings that mechanics has no linkage for end in ``Layout.unrealised``.

    Raises:
        SignoffError: a channel has no legal routing (or none was found); names the channel and its fullest nets.
    """
    lattice = lattice_of(placement, rules)
    reason = ""
    for attempt in range(SIDE_TRIES):
        sides = choose_sides(network, placement, lattice, rules, seed + attempt)
        work = channels(network, placement, lattice, sides, rules, attempt)
        routes: list[ChannelRoute] = []
        for channel in work:
            found = solve(channel, rules, seed)
            if found is None:
                reason = _complaint(channel, placement)
                break
            routes.append(found)
        else:
            return assemble(network, placement, lattice, work, routes, rules, seed)
    raise SignoffError(reason)


def _complaint(channel: Channel, placement: Placement) -> str:
    last = len(placement.column_x)
    where = (
        "left of the first column"
        if channel.index == 0
        else "right of the last column"
        if channel.index == last
        else f"between columns {channel.index - 1} and {channel.index}"
    )
    if channel.trouble:
        return f"channel {channel.index} ({where}): {'; '.join(channel.trouble)}"
    tallest = sorted(channel.trunks, key=lambda t: (t.y_low - t.y_high, t.net))[:4]
    nets = ", ".join(trunk.net for trunk in tallest)
    return (
        f"channel {channel.index} ({where}) cannot hold its {len(channel.trunks)} trunks with their "
        f"{len(channel.items)} items; its longest nets are {nets}. "
        "A larger scale, another seed or a lower fan-out would help"
    )
