"""From network, placement, layout and sizes to every body of the device."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from msgspec import UNSET
from shapely import Polygon

from mdlcad.mechanics.decks import Deck
from mdlcad.mechanics.process import Process
from mdlcad.mechanics.sizing import Sizing
from mdlcad.network.model import Network
from mdlcad.parts.assembly import turned
from mdlcad.parts.bias import bias_bodies
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.carrier import joined_rungs, rung_body, tab_body, tab_notch, trunk_body
from mdlcad.parts.clock import Handle, clock_pin, clock_plates, handle_notch, handle_place
from mdlcad.parts.coupler import coupler_body
from mdlcad.parts.frame import frame_bodies, rib_posts, ribs
from mdlcad.parts.pins import hub_pin, hub_plates, source_of, target_of, via_pins
from mdlcad.parts.rocker import rocker_bodies
from mdlcad.parts.screws import screw_bodies
from mdlcad.parts.stack import Hub, Stack, make_stack
from mdlcad.parts.unit import unit_body
from mdlcad.parts.windows import crossing_slot, windows
from mdlcad.placement.placement import Placement
from mdlcad.routing.decks import deck_parts
from mdlcad.routing.layout import Layout, Side

NOTHING: Mapping[str, float] = MappingProxyType({})


def build_parts(
    network: Network,
    placement: Placement,
    layout: Layout,
    sizing: Sizing,
    process: Process,
    device_boundary: Polygon | None = None,
    turning: Mapping[str, float] = NOTHING,
) -> tuple[Body, ...]:
    """All bodies, bottom to top as far as they lie in plates; pins, posts and shims come with what they belong to.

    Args:
        process: with the plates of both decks, if the placement has two.
        device_boundary: the device's outline in mm; the placement's own if not given.
        turning: by clock plate, the moment (N mm) about its handle that its guides are to bear.

    Raises:
        UsageError: the process lacks a plate that the network needs, or the boundary leaves a clock plate in pieces.
        ValueError: the layout contradicts itself or the sizing.
    """
    boundary = Polygon(placement.boundary) if device_boundary is None else device_boundary
    decks = deck_parts(network, placement, layout, sizing.rules)
    if decks is None:
        stack = make_stack(process, sizing, network.dynamics.phases)
        only = _deck(stack, network, placement, layout, hub_plates(layout), boundary, turning)
        screws = screw_bodies(stack, boundary, only.cuts)
        openings = windows(stack, network, boundary, only.hub_pins, [*only.over, *screws])
        return only.bodies(stack, boundary, screws, openings, screws)
    used = hub_plates(layout)
    stacks = {deck: make_stack(process, sizing, network.dynamics.phases, deck) for deck in Deck}
    made = {
        deck: _deck(stacks[deck], part.network, part.placement, part.layout, used, boundary, turning)
        for deck, part in decks.items()
    }
    screws = screw_bodies(stacks[Deck.LOWER], boundary, [cut for half in made.values() for cut in half.cuts])
    slots = [crossing_slot(stacks[deck], pin) for deck in Deck for pin in made[deck].hub_pins]
    across = [slot for slot in slots if slot is not None]
    top = stacks[Deck.UPPER].top(stacks[Deck.UPPER].base_plate)
    found: list[Body] = []
    for deck, part in decks.items():
        # each deck is started by itself, its cover on top: the upper one is looked at as it lies then
        pins, over = made[deck].hub_pins, (*made[deck].over, *screws)
        if deck is Deck.UPPER:
            pins, over = tuple(turned(body, top) for body in pins), tuple(turned(body, top) for body in over)
        openings = windows(stacks[Deck.LOWER], part.network, boundary, pins, over, across)
        found += made[deck].bodies(stacks[deck], boundary, () if found else screws, [*across, *openings], screws)
    return tuple(found)


@dataclass(frozen=True, slots=True)
class _Made:
    """What is in a deck before its frame is cut around it.

    Attributes:
        over: carriers, tabs and flexures. cuts: notches in the rims of its plates, by plate in ``notches``.
    """

    units: tuple[Body, ...]
    clock_pins: tuple[Body, ...]
    hub_pins: tuple[Body, ...]
    links: tuple[Body, ...]
    via_pins: tuple[Body, ...]
    tabs: tuple[Body, ...]
    flexures: tuple[Body, ...]
    ribs: tuple[Polygon, ...]
    posts: tuple[Body, ...]
    handle: Handle
    notches: dict[str, list[Polygon]]
    turning: Mapping[str, float]

    @property
    def over(self) -> tuple[Body, ...]:
        return (*self.links, *self.tabs, *self.flexures)

    @property
    def cuts(self) -> list[Polygon]:
        return [notch for cuts in self.notches.values() for notch in cuts]

    def bodies(
        self,
        stack: Stack,
        boundary: Polygon,
        screws: Sequence[Body],
        openings: Sequence[Polygon],
        through: Sequence[Body],
    ) -> tuple[Body, ...]:
        """All bodies of the deck, frame and ``screws`` included; ``through``: the screws that it has holes for."""
        hanging = [body for body in self.flexures if body.kind is BodyKind.POST]
        return (
            *frame_bodies(stack, boundary, self.ribs, [*self.posts, *hanging], self.notches, through, openings),
            *self.posts,
            *clock_plates(stack, boundary, self.handle, self.clock_pins, self.posts, self.turning),
            *self.clock_pins,
            *self.units,
            *self.hub_pins,
            *self.links,
            *self.via_pins,
            *self.tabs,
            *self.flexures,
            *screws,
        )


def _deck(
    stack: Stack,
    network: Network,
    placement: Placement,
    layout: Layout,
    used: Mapping[tuple[str, Side], list[str]],
    boundary: Polygon,
    turning: Mapping[str, float],
) -> _Made:
    """A deck's units, carriers and flexures; ``used``: plates that hold a block, of all decks."""
    sizing = stack.sizing
    hubs = {place.mass: Hub(place) for place in placement.masses}
    here = [place for place in placement.masses if place.deck in (UNSET, stack.deck)]
    own = {place.mass for place in here}
    standing = [hubs[place.mass] for place in here]
    couplers = {item.coupling: item for item in sizing.couplers}
    biases = {item.mass: item for item in sizing.biases}

    links = joined_rungs([rung_body(stack, hubs, rung) for rung in layout.rungs])
    links += [trunk_body(stack, trunk, layout.rungs) for trunk in layout.trunks]
    tabs = [tab_body(stack, tab, links, layout.rungs) for tab in layout.tabs]
    flexures: list[Body] = []
    for leaf in layout.couplers:
        source, target = hubs[source_of(leaf.coupling)], hubs[target_of(leaf.coupling)]
        part = couplers[leaf.coupling]
        if part.strength > 0.0:
            flexures.append(coupler_body(stack, source, target, leaf, part))
        else:
            flexures += rocker_bodies(stack, source, target, leaf, part)
    for bias in layout.biases:
        flexures += bias_bodies(stack, hubs[bias.mass], bias, biases[bias.mass])

    sizes = [unit for unit in sizing.units if unit.mass in own]
    units = [
        unit_body(stack, hubs[unit.mass], unit, [side for side in Side if (unit.mass, side) in used]) for unit in sizes
    ]
    found = ribs(stack, standing, boundary)
    handle = handle_place(stack, boundary)
    notches: dict[str, list[Polygon]] = {plate: [handle_notch(stack, handle)] for plate in stack.clock_plates}
    for tab in layout.tabs:
        notches.setdefault(tab.plate, []).extend(tab_notch(stack, tab))
    return _Made(
        units=tuple(units),
        clock_pins=tuple(clock_pin(stack, hubs[unit.mass], unit) for unit in sizes),
        hub_pins=tuple(
            hub_pin(stack, hubs[mass], side, plates) for (mass, side), plates in sorted(used.items()) if mass in own
        ),
        links=tuple(links),
        via_pins=tuple(via_pins(stack, layout)),
        tabs=tuple(tabs),
        flexures=tuple(flexures),
        ribs=tuple(found),
        posts=tuple(rib_posts(stack, standing, found, boundary)),
        handle=handle,
        notches=notches,
        turning=turning,
    )
