"""Check a layout against the network, the placement and the rules. Shares no code with the placer or the router.

The checker rebuilds what would be cut (bars, hub blocks, flexure boxes, pins, posts, tabs) as rectangles and discs from
the layout artefact alone, sweeps everything that moves by the throw in y, and measures distances. What it finds is
listed by rule:

    unit_slot        a unit outside the rim, off its lattice point, or two units in each other's footprint
    containment      a carrier, flexure or pin that reaches into the rim
    clearance        two bodies that move independently come nearer than the gap on one plate
    overlap          a flexure runs into a rigid part that it is tied to
    hub_side         two items fixed to one hub side on one plate
    carrier          a net whose rungs and trunks do not hang together, or that is not pinned to its hub
    coupler          a coupling realised never, twice, or with the wrong source, target, reach or plate
    bias             a bias leaf missing, double, unasked for, or with its post in the wrong place
    tab              a port without a tab, with two, or with a tab that does not lead from its net to its place
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from shapely import Polygon, STRtree, box

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.placement import Placement
from mdlcad.routing.check_bodies import Solid, rebuild
from mdlcad.routing.check_motion import check_motion
from mdlcad.routing.check_nets import check_nets
from mdlcad.routing.decks import deck_parts
from mdlcad.routing.layout import Layout

RULES = (
    "unit_slot",
    "containment",
    "clearance",
    "overlap",
    "hub_side",
    "carrier",
    "coupler",
    "bias",
    "tab",
)


@dataclass(frozen=True, slots=True, order=True)
class Finding:
    """One thing that is wrong: which rule, in words, where (mm), and the names of what is involved."""

    rule: str
    message: str
    x: float
    y: float
    names: tuple[str, ...]


def check_layout(network: Network, placement: Placement, layout: Layout, rules: LayoutRules) -> tuple[Finding, ...]:
    """Everything that is wrong with ``layout``; empty if it is sound. Sorted, each finding once.

    Of a device with two decks each is checked by itself: a net that crosses needs the same slot in both.
    """
    decks = deck_parts(network, placement, layout, rules)
    if decks is None:
        return _check_deck(network, placement, layout, rules)
    parts = [_check_deck(deck.network, deck.placement, deck.layout, deck.rules) for deck in decks.values()]
    return tuple(sorted({finding for part in parts for finding in part}))


def _check_deck(network: Network, placement: Placement, layout: Layout, rules: LayoutRules) -> tuple[Finding, ...]:
    found = [Finding(*item) for item in _check_units(network, placement, rules)]
    if {unit.mass for unit in placement.masses} != {mass.name for mass in network.masses}:
        return tuple(sorted(found))  # without its hubs nothing else can be measured
    found += [Finding(*item) for item in check_nets(network, placement, layout, rules)]
    solids = rebuild(network, placement, layout, rules)
    found += [Finding(*item) for item in check_motion(solids, rules)]
    found += [Finding(*item) for item in _check_containment(placement, solids, rules)]
    return tuple(sorted(set(found)))


Raw = tuple[str, str, float, float, tuple[str, ...]]


def _check_units(network: Network, placement: Placement, rules: LayoutRules) -> list[Raw]:
    found: list[Raw] = []
    times = Counter(unit.mass for unit in placement.masses)
    for mass in sorted(m.name for m in network.masses):
        if times[mass] != 1:
            found.append(("unit_slot", f"mass {mass} is placed {times[mass]} times", 0.0, 0.0, (mass,)))
    usable = Polygon(placement.boundary).buffer(-(rules.frame_width + rules.gap) + 1e-6, join_style="mitre")
    boxes = []
    for unit in placement.masses:
        on_lattice = (
            0 <= unit.column < len(placement.column_x)
            and 0 <= unit.row < len(placement.row_y)
            and abs(placement.column_x[unit.column] - unit.x) < 1e-6
            and abs(placement.row_y[unit.row] - unit.y) < 1e-6
        )
        if not on_lattice:
            found.append(("unit_slot", f"unit {unit.mass} is off its lattice point", unit.x, unit.y, (unit.mass,)))
        half = rules.row_pitch / 2
        shape = box(unit.x - rules.unit_left, unit.y - half, unit.x + rules.unit_right, unit.y + half)
        if not usable.contains(shape):
            found.append(("unit_slot", f"unit {unit.mass} reaches into the rim", unit.x, unit.y, (unit.mass,)))
        boxes.append(shape)
    near, other = STRtree(boxes).query(np.array(boxes, object), predicate="intersects")
    for i, j in sorted(zip(near.tolist(), other.tolist(), strict=True)):
        if j < i and boxes[i].intersection(boxes[j]).area > 1e-6:
            pair = (placement.masses[j].mass, placement.masses[i].mass)
            where = placement.masses[i]
            found.append(("unit_slot", f"units {pair[0]} and {pair[1]} overlap", where.x, where.y, pair))
    return found


def _check_containment(placement: Placement, solids: Sequence[Solid], rules: LayoutRules) -> list[Raw]:
    usable = Polygon(placement.boundary).buffer(-(rules.frame_width + rules.gap) + 1e-6, join_style="mitre")
    found: list[Raw] = []
    for solid in solids:
        if solid.may_leave or usable.contains(solid.swept):
            continue
        x, y = solid.shape.centroid.x, solid.shape.centroid.y
        found.append(("containment", f"{solid.name} reaches into the rim", x, y, (solid.name,)))
    return found
