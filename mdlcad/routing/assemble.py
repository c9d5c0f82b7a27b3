"""From solved channels to the layout artefact."""

from __future__ import annotations

from dataclasses import dataclass, field

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.grid import TabTerminal
from mdlcad.placement.lattice import Lattice
from mdlcad.placement.linkable import unrealisable
from mdlcad.placement.placement import Placement
from mdlcad.routing.channel import ChannelRoute
from mdlcad.routing.layout import BiasLeaf, CouplerLeaf, EndKind, Layout, Rung, RungEnd, Side, Tab, Trunk
from mdlcad.routing.pieces import Channel, Item, Role


@dataclass(slots=True)
class _Pieces:
    """The layout's lists while they grow."""

    rungs: list[Rung] = field(default_factory=list)
    trunks: list[Trunk] = field(default_factory=list)
    couplers: list[CouplerLeaf] = field(default_factory=list)
    biases: list[BiasLeaf] = field(default_factory=list)
    tabs: list[Tab] = field(default_factory=list)
    rungs_of: dict[str, int] = field(default_factory=dict)

    def add_rung(self, net: str, plate: str, y: float, left: RungEnd, right: RungEnd) -> None:
        """A rung, numbered within its net."""
        number = self.rungs_of.get(net, 0)
        self.rungs_of[net] = number + 1
        self.rungs.append(Rung(f"{net}.{number}", net, plate, y, left, right))

    def far_end(
        self,
        item: Item,
        plate: str,
        hubs: dict[str, tuple[float, float]],
        targets: dict[str, str],
        tabs: dict[str, TabTerminal],
        rules: LayoutRules,
    ) -> RungEnd:
        """The end of an item's rung away from its trunk (or source hub); adds the flexure or tab found there."""
        if item.role is Role.SOURCE:
            return RungEnd(EndKind.HUB, hubs[item.net][0], item.net)
        if item.role in (Role.TAB, Role.STRAIGHT_TAB):
            tab = tabs[item.ref]
            self.tabs.append(Tab(item.ref, item.net, plate, tab.path))
            return RungEnd(EndKind.TAB, tab.x, item.ref)
        mass = targets[item.ref]
        x, y = hubs[mass]
        side = next(side for hub, side in item.hubs if hub == mass)
        sign = 1 if side == 1 else -1
        start = round(x + sign * rules.couplers[item.ref], 6)
        post = None
        if item.ref in rules.post_offset:
            post = round(x + sign * rules.post_offset[item.ref], 6)
        self.couplers.append(CouplerLeaf(item.ref, plate, Side.RIGHT if sign > 0 else Side.LEFT, start, y, post))
        return RungEnd(EndKind.COUPLER, start, item.ref)


def assemble(
    network: Network,
    placement: Placement,
    lattice: Lattice,
    work: tuple[Channel, ...],
    routes: list[ChannelRoute],
    rules: LayoutRules,
    seed: int,
) -> Layout:
    """The layout artefact, in an order that depends on the network alone."""
    hubs = {placed.mass: (placed.x, placed.y) for placed in placement.masses}
    targets = {coupling.name: coupling.target for coupling in network.couplings}
    tabs = {tab.bit: tab for tab in lattice.tabs}
    out = _Pieces()
    for channel, found in zip(work, routes, strict=True):
        names = []
        for trunk, x in zip(channel.trunks, found.tracks, strict=True):
            name = f"{trunk.net}.{'right' if hubs[trunk.net][0] < x else 'left'}"
            names.append(name)
            out.trunks.append(Trunk(name, trunk.net, x, trunk.y_low, trunk.y_high))
        for item, k in zip(channel.items, found.plates, strict=True):
            if item.role is Role.GUEST:
                continue
            plate = rules.link_plates[k]
            if item.role is Role.BIAS:
                sign = 1 if item.hubs[0][1] == 1 else -1
                x, y = hubs[item.net]
                post = round(x + sign * rules.biases[item.net], 6)
                out.biases.append(BiasLeaf(item.net, plate, Side.RIGHT if sign > 0 else Side.LEFT, post, y))
                continue
            via = None
            if item.trunk is not None:
                via = RungEnd(EndKind.VIA, found.tracks[item.trunk], names[item.trunk])
            far = out.far_end(item, plate, hubs, targets, tabs, rules)
            near = via if via is not None else RungEnd(EndKind.HUB, hubs[item.net][0], item.net)
            left, right = sorted((near, far), key=lambda end: end.x)
            y = (item.y_low + item.y_high) / 2
            out.add_rung(item.net, plate, round(y, 6), left, right)
    order = {mass.name: index for index, mass in enumerate(network.masses)}
    never = unrealisable(network, rules)
    unrealised = tuple(
        (coupling.name, never[coupling.name]) for coupling in network.couplings if coupling.name in never
    )
    return Layout(
        rungs=tuple(sorted(out.rungs, key=lambda rung: (order[rung.net], rung.name))),
        trunks=tuple(sorted(out.trunks, key=lambda trunk: (order[trunk.net], trunk.name))),
        couplers=tuple(sorted(out.couplers, key=lambda leaf: leaf.coupling)),
        biases=tuple(sorted(out.biases, key=lambda leaf: order[leaf.mass])),
        tabs=tuple(sorted(out.tabs, key=lambda tab: tab.bit)),
        unrealised=unrealised,
        seed=seed,
    )
