"""From network, placement, layout and sizes to every body of the device."""

from __future__ import annotations

from shapely import Polygon

from mdlcad.mechanics.process import Process
from mdlcad.mechanics.sizing import Sizing
from mdlcad.network.model import Network
from mdlcad.parts.bias import bias_bodies
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.carrier import joined_rungs, rung_body, tab_body, tab_notch, trunk_body
from mdlcad.parts.clock import clock_pin, clock_plates, handle_notch, handle_place
from mdlcad.parts.coupler import coupler_body
from mdlcad.parts.frame import frame_bodies, rib_posts, ribs
from mdlcad.parts.pins import hub_pin, hub_plates, source_of, target_of, via_pins
from mdlcad.parts.rocker import rocker_bodies
from mdlcad.parts.screws import screw_bodies
from mdlcad.parts.stack import Hub, make_stack
from mdlcad.parts.unit import unit_body
from mdlcad.parts.windows import windows
from mdlcad.placement.placement import Placement
from mdlcad.routing.layout import Layout, Side


def build_parts(
    network: Network,
    placement: Placement,
    layout: Layout,
    sizing: Sizing,
    process: Process,
    device_boundary: Polygon | None = None,
) -> tuple[Body, ...]:
    """All bodies, bottom to top as far as they lie in plates; pins, posts and shims come with what they belong to.

    Args:
        device_boundary: the device's outline in mm; the placement's own if not given.

    Raises:
        UsageError: the process lacks a plate that the network needs, or the boundary leaves a clock plate in pieces.
        ValueError: the layout contradicts itself or the sizing.
    """
    boundary = Polygon(placement.boundary) if device_boundary is None else device_boundary
    stack = make_stack(process, sizing, network.dynamics.phases)
    hubs = {place.mass: Hub(place) for place in placement.masses}
    standing = list(hubs.values())
    couplers = {item.coupling: item for item in sizing.couplers}
    biases = {item.mass: item for item in sizing.biases}
    used = hub_plates(layout)

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

    units = [
        unit_body(stack, hubs[unit.mass], unit, [side for side in Side if (unit.mass, side) in used])
        for unit in sizing.units
    ]
    clock_pins = [clock_pin(stack, hubs[unit.mass], unit) for unit in sizing.units]
    hub_pins = [hub_pin(stack, hubs[mass], side, plates) for (mass, side), plates in sorted(used.items())]
    found = ribs(stack, standing, boundary)
    posts = rib_posts(stack, standing, found, boundary)
    handle = handle_place(stack, boundary)
    notches: dict[str, list[Polygon]] = {plate: [handle_notch(stack, handle)] for plate in stack.clock_plates}
    for tab in layout.tabs:
        notches.setdefault(tab.plate, []).extend(tab_notch(stack, tab))
    hanging = [body for body in flexures if body.kind is BodyKind.POST]
    screws = screw_bodies(stack, boundary, [notch for cuts in notches.values() for notch in cuts])
    openings = windows(stack, network, boundary, hub_pins, [*links, *tabs, *flexures, *screws])
    return (
        *frame_bodies(stack, boundary, found, [*posts, *hanging], notches, screws, openings),
        *posts,
        *clock_plates(stack, boundary, handle, clock_pins, posts),
        *clock_pins,
        *units,
        *hub_pins,
        *links,
        *via_pins(stack, layout),
        *tabs,
        *flexures,
        *screws,
    )
