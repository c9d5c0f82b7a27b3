"""The artefacts of a device with two decks: one placement and one layout of all, made of those of the decks, and back.

In the whole, the pieces of a net in the deck where it has a bare hub are called "across": so no two have one name.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from mdlcad.mechanics.decks import Deck, deck_of_plate, two_decks
from mdlcad.mechanics.process import Process
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.decks import Units, crossing, network_in, rules_in
from mdlcad.placement.placement import PlacedMass, Placement
from mdlcad.routing.layout import EndKind, Layout, Rung, RungEnd, Trunk

ACROSS = "across"


@dataclass(frozen=True, slots=True)
class DeckParts:
    """One deck as a device of its own: what it realises, where, how, and by which rules."""

    network: Network
    placement: Placement
    layout: Layout
    rules: LayoutRules


EMPTY = Layout((), (), (), (), (), (), 0)
"""A deck that is not routed yet."""


def units_of(placement: Placement) -> dict[str, Deck] | None:
    """The deck of every mass; None for a device with one unit plate."""
    units = {unit.mass: unit.deck for unit in placement.masses}
    return {mass: deck for mass, deck in units.items() if isinstance(deck, Deck)} or None


def process_of(process: Process, placement: Placement) -> Process:
    """The process as the device stacks it: with the plates of both decks, if it has two.

    Raises:
        UsageError: the plates of the process have names that those of a second deck would have.
    """
    return process if units_of(placement) is None else two_decks(process)


def joined_placement(network: Network, units: Units, parts: Mapping[Deck, Placement]) -> Placement:
    """One placement of all units; a slot that is usable in either deck is usable."""
    placed = {unit.mass: unit for placement in parts.values() for unit in placement.masses}
    lower, upper = parts[Deck.LOWER], parts[Deck.UPPER]
    ports = {port.bit: port for placement in parts.values() for port in placement.ports}
    return replace(
        lower,
        slots=tuple(sorted({*lower.slots, *upper.slots})),
        masses=tuple(replace(placed[mass.name], deck=units[mass.name]) for mass in network.masses),
        ports=tuple(ports[bit.bit] for bit in (*network.sensors, *network.actuators)),
    )


def joined_layout(network: Network, units: Units, parts: Mapping[Deck, Layout]) -> Layout:
    """One layout of all pieces."""
    order = {mass.name: index for index, mass in enumerate(network.masses)}
    rungs: list[Rung] = []
    trunks: list[Trunk] = []
    for deck, layout in parts.items():
        for trunk in layout.trunks:
            trunks.append(replace(trunk, name=_named(trunk.name, trunk.net, units, deck), deck=deck))
        for rung in layout.rungs:
            ends = (_renamed(end, rung.net, units, deck) for end in (rung.left, rung.right))
            rungs.append(Rung(_named(rung.name, rung.net, units, deck), rung.net, rung.plate, rung.y, *ends))
    layouts = list(parts.values())
    return Layout(
        rungs=tuple(sorted(rungs, key=lambda rung: (order[rung.net], rung.name))),
        trunks=tuple(sorted(trunks, key=lambda trunk: (order[trunk.net], trunk.name))),
        couplers=tuple(sorted((x for item in layouts for x in item.couplers), key=lambda leaf: leaf.coupling)),
        biases=tuple(sorted((x for item in layouts for x in item.biases), key=lambda leaf: order[leaf.mass])),
        tabs=tuple(sorted((x for item in layouts for x in item.tabs), key=lambda tab: tab.bit)),
        unrealised=tuple(sorted(x for item in layouts for x in item.unrealised)),
        seed=parts[Deck.LOWER].seed,
    )


def _named(name: str, net: str, units: Units, deck: Deck) -> str:
    return name if units[net] is deck else f"{net}.{ACROSS}{name.removeprefix(net)}"


def _renamed(end: RungEnd, net: str, units: Units, deck: Deck) -> RungEnd:
    return replace(end, ref=_named(end.ref, net, units, deck)) if end.kind is EndKind.VIA else end


def deck_parts(
    network: Network, placement: Placement, layout: Layout, rules: LayoutRules
) -> dict[Deck, DeckParts] | None:
    """The decks of a device, each by itself; None for a device with one unit plate."""
    units = units_of(placement)
    if units is None:
        return None
    own = {deck: network_in(network, units, deck) for deck in Deck}
    return {
        deck: DeckParts(
            own[deck],
            _placement_in(own[deck], placement, units, deck),
            _layout_in(own[deck], layout, deck),
            rules_in(rules, network, units, deck),
        )
        for deck in Deck
    }


def _placement_in(own: Network, placement: Placement, units: Units, deck: Deck) -> Placement:
    here = {mass.name for mass in own.masses}
    return replace(
        placement,
        masses=tuple(unit for unit in placement.masses if unit.mass in here),
        ports=tuple(port for port in placement.ports if units[port.mass] is deck),
    )


def _layout_in(own: Network, layout: Layout, deck: Deck) -> Layout:
    ends = {coupling.name for coupling in own.couplings}
    return replace(
        layout,
        rungs=tuple(item for item in layout.rungs if deck_of_plate(item.plate) is deck),
        trunks=tuple(item for item in layout.trunks if item.deck is deck),
        couplers=tuple(item for item in layout.couplers if deck_of_plate(item.plate) is deck),
        biases=tuple(item for item in layout.biases if deck_of_plate(item.plate) is deck),
        tabs=tuple(item for item in layout.tabs if deck_of_plate(item.plate) is deck),
        unrealised=tuple(item for item in layout.unrealised if item[0] in ends),
    )


def bare_hubs(network: Network, placement: Placement, deck: Deck) -> tuple[PlacedMass, ...]:
    """Where the nets of the other deck come through into ``deck``."""
    units = units_of(placement) or {}
    bare = {mass for mass in crossing(network, units) if units[mass] is not deck} if units else set()
    return tuple(unit for unit in placement.masses if unit.mass in bare)
