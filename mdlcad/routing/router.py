"""Route a placed network: sides, then every channel exactly, then the pieces of the layout."""

from __future__ import annotations

from shapely import Polygon

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.grid import inside, terminals
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.placement import Placement
from mdlcad.placement.placer import Sides, choose_sides
from mdlcad.routing.ahead import Ahead
from mdlcad.routing.assemble import assemble
from mdlcad.routing.channel import ChannelRoute
from mdlcad.routing.gather import channels
from mdlcad.routing.horizon import solve_any
from mdlcad.routing.jam import Jam, JamError
from mdlcad.routing.judge import Judge, Objection, lowered, no_objection
from mdlcad.routing.keep import Keeper
from mdlcad.routing.layout import Layout
from mdlcad.routing.pieces import Channel

ROUNDS = 8
"""Times that a routing is tried again because of what its judge objects to."""
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


def route(
    network: Network,
    placement: Placement,
    rules: LayoutRules,
    seed: int,
    judge: Judge = no_objection,
    keeper: Keeper | None = None,
    sides: Sides | None = None,
    workers: int = 1,
) -> Layout:
    """Tracks and plates for every carrier, coupler, bias leaf and tab.

    Couplings that mechanics has no linkage for end in ``Layout.unrealised``. With a ``keeper`` all is routed as it was
    in the earlier layout, where that is still possible. ``sides`` are tried first, if the placer has given them.
    So many channels as there are ``workers`` are solved at once; the layout is the same for any number.

    Raises:
        JamError: a channel has no legal routing (or none was found), and then it names the channel and its fullest
            nets; or none that the judge accepts, and then it names the coupling.
    """
    with Ahead(workers) as ahead:
        return _route(network, placement, rules, seed, judge, keeper, sides, ahead)


def _route(
    network: Network,
    placement: Placement,
    rules: LayoutRules,
    seed: int,
    judge: Judge,
    keeper: Keeper | None,
    sides: Sides | None,
    ahead: Ahead,
) -> Layout:
    lattice = lattice_of(placement, rules)
    jam = JamError(f"{network.design} has no channels", Jam(placement))
    turns = range(SIDE_TRIES) if keeper is None else keeper.turns(placement, lattice, rules, SIDE_TRIES)
    choose, solve_channel = (choose_sides, solve_any) if keeper is None else (keeper.sides, keeper.solve)
    for attempt, turn in enumerate(turns):
        chosen = sides if sides and not attempt else choose(network, placement, lattice, rules, seed + attempt)
        work = channels(network, placement, lattice, chosen, rules, turn)
        routes: dict[int, ChannelRoute] = {}

        def solved(index: int, work: tuple[Channel, ...] = work) -> ChannelRoute | None:
            return solve_channel(work[index], rules, seed)

        again = set(range(len(work)))
        for _ in range(ROUNDS):
            for index, found in ahead.each(sorted(again), solved):
                if found is None:
                    jam = JamError(_complaint(work[index], placement), Jam(placement, work[index]))
                    break
                routes[index] = found
            else:
                found_routes = [routes[index] for index in range(len(work))]
                layout = assemble(network, placement, lattice, work, found_routes, rules, seed)
                objections = judge(placement, layout)
                if not objections:
                    return layout
                jam = _objected(objections[0], placement, work)
                levels = [found.plates for found in found_routes]
                lower = lowered(work, levels, objections, len(rules.link_plates) - 1)
                if lower is not None:
                    again = lower
                    continue
            break
    raise jam


def _objected(objection: Objection, placement: Placement, work: tuple[Channel, ...]) -> JamError:
    found = (channel for channel in work if any(item.ref == objection.coupling for item in channel.items))
    words = (
        f"coupling {objection.coupling}: {objection.message}. A smaller size (shorter arms), a lower fan-out of "
        f"{objection.net}, or a deeper unit plate would help"
    )
    return JamError(words, Jam(placement, next(found, None)), judged=True)


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
        words = "; ".join(channel.trouble[:3])
        return f"channel {channel.index} ({where}): {words}. A larger size or more columns would help"
    tallest = sorted(channel.trunks, key=lambda t: (t.y_low - t.y_high, t.net))[:4]
    nets = ", ".join(trunk.net for trunk in tallest)
    return (
        f"channel {channel.index} ({where}) cannot hold its {len(channel.trunks)} trunks with their "
        f"{len(channel.items)} items; its longest nets are {nets}. "
        "A larger size, more columns, one more rung plate or another seed would help"
    )
