"""How stiff a carrier is where its couplers begin: bars that bend, pins that bend and twist, a shuttle that can turn.

Reads the placement and layout artefacts, so it is not part of sizing: the flow calls it once a layout exists.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from mdlcad.mechanics.decks import Deck, deck_of_plate, plate_in
from mdlcad.mechanics.flexure import RIGID, Sheet
from mdlcad.mechanics.frame import TURN, Beam, Frame, Spring, Tie, X, Y, dof
from mdlcad.mechanics.lean import Lifts
from mdlcad.mechanics.leaves import LeafKind, trim
from mdlcad.mechanics.process import Plate, PlateRole, Process
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.mechanics.sizing import Sizing, turn_stiffness
from mdlcad.network.model import Coupling, Network
from mdlcad.parts.lean import Pull, lean_stiffnesses
from mdlcad.placement.decks import Lean
from mdlcad.placement.placement import PlacedMass, Placement
from mdlcad.routing.layout import EndKind, Layout, Rung, Trunk


@dataclass(frozen=True, slots=True)
class CarrierStiffness:
    """Stiffness of a carrier in y as one coupler feels it, and how far the whole net tilts its shuttle.

    Attributes:
        stiffness: N/mm, of bars, hub pin, via pins and the source's shuttle turning in the plane; shuttle held in y.
        ratio: that over the coupler's own stiffness; the coupling is weakened by about 1 / (1 + ratio).
        lean: N/mm, of a spring in a row with the carrier that takes as much of the coupling as the tilting of both
            shuttles about x does, if no plate holds them (``lean.py``).
        tilt: angle about x by which all couplers of the net together tilt its shuttle, rad, with source and targets at
            opposite ends of the largest throws seen; the same for all couplers of a net.
    """

    coupling: str
    stiffness: float
    ratio: float
    lean: float
    tilt: float

    @property
    def leaning(self) -> float:
        """N/mm, of the carrier in a row with its lean."""
        return 1.0 / (1.0 / self.stiffness + 1.0 / self.lean)

    @property
    def leaned(self) -> float:
        """Share of the coupling, in a row with its carrier, that the lean takes."""
        row = self.stiffness / (1.0 + self.ratio)
        return row / (row + self.lean)


@dataclass(frozen=True, slots=True)
class CarrierFault:
    """A carrier that misses a limit at one coupler: ``rule`` is carrier_stiffness or shuttle_tilt."""

    rule: str
    coupling: str
    value: float
    limit: float
    message: str


def carrier_faults(
    stiffnesses: Sequence[CarrierStiffness], sizing: Sizing, process: Process
) -> tuple[CarrierFault, ...]:
    """Carriers that are too soft for their couplers, and nets that tilt their shuttle into its neighbours."""
    least, most = process.link.carrier_ratio, tilt_limit(sizing, process)
    found = []
    for item in stiffnesses:
        if item.ratio < least:
            words = f"its carrier is {item.ratio:.1f} times as stiff as it is, {least:g} times is needed"
            found.append(CarrierFault("carrier_stiffness", item.coupling, item.ratio, least, words))
        if item.tilt > most:
            words = (
                f"with the net's other couplers it tilts its shuttle by {item.tilt:.3f} rad, {most:.3f} is the limit"
            )
            found.append(CarrierFault("shuttle_tilt", item.coupling, item.tilt, most, words))
    return tuple(found)


def tilt_limit(sizing: Sizing, process: Process) -> float:
    """The angle, rad, at which a shuttle tilting about x meets the plates above and below it."""
    return process.stack.z_gap / (sizing.law.shuttle_height / 2.0)


def rung_width(rung: Rung, rules: LayoutRules) -> float:
    """Height in y of a rung's bar, mm: a row keeps the height of a hub free for it, a bar's for a tab's."""
    to_tab = EndKind.TAB in (rung.left.kind, rung.right.kind)
    return rules.bar_width if to_tab else max(rules.bar_width, rules.hub_height)


def carrier_stiffnesses(
    network: Network, placement: Placement, layout: Layout, sizing: Sizing, process: Process
) -> tuple[CarrierStiffness, ...]:
    """One entry for every coupling that the layout realises, in the network's order.

    Args:
        process: with the plates of both decks, if the device has two.

    Raises:
        ValueError: a carrier does not hang together.
    """
    parts = {item.coupling: item for item in sizing.couplers}
    hubs = {place.mass: place for place in placement.masses}
    ends = {
        end.ref: (rung, end.x)
        for rung in layout.rungs
        for end in (rung.left, rung.right)
        if end.kind is EndKind.COUPLER
    }
    tilts = _tilts(network, hubs, ends, sizing, process)
    found: list[tuple[Coupling, float, float]] = []
    built: dict[str, _Carrier] = {}
    for coupling in network.couplings:
        if coupling.name not in ends:
            continue
        net = coupling.source
        if net not in built:
            rungs = [rung for rung in layout.rungs if rung.net == net]
            trunks = [trunk for trunk in layout.trunks if trunk.net == net]
            built[net] = _Carrier(net, hubs[net], rungs, trunks, sizing, process)
        rung, x = ends[coupling.name]
        leaf = parts[coupling.name].leaf
        # a leaf whose ends do not turn pulls at its middle; of a rocker, only the half up to the post
        arm = leaf.reach / (4.0 if leaf.kind is LeafKind.ROCKER else 2.0)
        found.append(
            (coupling, built[net].stiffness_at(x, rung, arm if rung.right.ref == coupling.name else -arm), leaf.own)
        )
    pulls = []
    for coupling, stiffness, own in found:
        low, high = (
            _height(process, _unit_plate(process, hubs[mass]), ends[coupling.name][0].plate)
            for mass in (coupling.source, coupling.target)
        )
        turning = 1.0 if parts[coupling.name].leaf.kind is LeafKind.ROCKER else -1.0
        pulls.append(Pull(coupling.source, coupling.target, own * stiffness / (own + stiffness), low, high, turning))
    sums = zip(found, lean_stiffnesses(pulls, sizing.law.shuttle_tilt), strict=True)
    return tuple(
        CarrierStiffness(
            coupling.name, trim(stiffness), trim(stiffness / own), trim(lean), trim(tilts[coupling.source])
        )
        for (coupling, stiffness, own), lean in sums
    )


def lifts_of(placement: Placement, layout: Layout, process: Process) -> Lifts:
    """How high every coupler and bias leaf of a layout lies above the unit plates that it pulls at.

    Args:
        process: with the plates of both decks, if the device has two.
    """
    hubs = {place.mass: place for place in placement.masses}

    def above(mass: str, plate: str) -> float:
        unit, own = _unit_plate(process, hubs[mass]), process.plate(plate)
        return trim(process.z_of(plate) + own.thickness / 2.0 - process.z_of(unit.name) - unit.thickness / 2.0)

    couplings = {}
    for leaf in layout.couplers:
        source, _, target = leaf.coupling.rpartition("->")
        couplings[leaf.coupling] = (above(source, leaf.plate), above(target, leaf.plate))
    return Lifts(couplings, {bias.mass: above(bias.mass, bias.plate) for bias in layout.biases})


def _tilts(
    network: Network,
    hubs: Mapping[str, PlacedMass],
    ends: Mapping[str, tuple[Rung, float]],
    sizing: Sizing,
    process: Process,
) -> dict[str, float]:
    """Angle of every source's shuttle: the couplers' largest forces times their heights, over its stiffness."""
    turns = _turns(network, sizing)
    tilts: dict[str, float] = {}
    for coupling in network.couplings:
        if coupling.name not in ends:
            continue
        height = _height(process, _unit_plate(process, hubs[coupling.source]), ends[coupling.name][0].plate)
        tilts[coupling.source] = tilts.get(coupling.source, 0.0) + turns[coupling.name] * height
    return tilts


def leans(network: Network, sizing: Sizing, process: Process) -> dict[str, Lean]:
    """What share of its limit every coupling takes of its source's tilt, with its leaf on a rung plate in the middle.

    Args:
        process: with the plates of both decks.
    """
    unit, rungs = process.plates(PlateRole.UNIT)[0], process.plates(PlateRole.RUNG)
    middle = rungs[(len(rungs) // 2 - 1) // 2].name
    own, across = (_height(process, unit, plate_in(deck, middle)) for deck in (Deck.LOWER, Deck.UPPER))
    most = tilt_limit(sizing, process)
    return {name: Lean(turn * own / most, turn * across / most) for name, turn in _turns(network, sizing).items()}


def _turns(network: Network, sizing: Sizing) -> dict[str, float]:
    """By coupling, rad for each mm that its leaf is from its source's unit: its largest force over that stiffness."""
    parts = {item.coupling: item for item in sizing.couplers}
    throws = {item.mass: item.amplitude for item in sizing.units}
    turns = {}
    for coupling in network.couplings:
        if coupling.name in parts:
            leaf = parts[coupling.name].leaf
            force = leaf.own * throws[coupling.source] + leaf.coupling * throws[coupling.target]
            turns[coupling.name] = force / sizing.law.shuttle_tilt
    return turns


def _height(process: Process, unit: Plate, plate: str) -> float:
    """Distance in z, mm, of the middle of ``plate`` from that of a unit plate."""
    middles = [process.z_of(item.name) + item.thickness / 2.0 for item in (process.plate(plate), unit)]
    return abs(middles[0] - middles[1])


def _unit_plate(process: Process, hub: PlacedMass) -> Plate:
    deck = Deck.UPPER if hub.deck is Deck.UPPER else Deck.LOWER
    return process.plate(plate_in(deck, process.plates(PlateRole.UNIT)[0].name))


class _Carrier:
    """The plane frame of one net; nodes are the places on a plate where bars meet, end, or are pinned."""

    def __init__(
        self,
        net: str,
        place: PlacedMass,
        rungs: Sequence[Rung],
        trunks: Sequence[Trunk],
        sizing: Sizing,
        process: Process,
    ) -> None:
        self.net, self.hub, self.process, self.rules = net, (place.x, place.y), process, sizing.rules
        self.nodes: list[tuple[float, float]] = [self.hub]
        self.places: dict[tuple[float, float, str], int] = {}
        self.beams: list[Beam] = []
        self.ties: list[Tie] = []
        self.unit, self.trunk = _unit_plate(process, place), process.plates(PlateRole.TRUNK)[0]
        for rung in rungs:
            sheet, width = _sheet(process, process.plate(rung.plate)), rung_width(rung, sizing.rules)
            low = self._end(rung.left.x, rung, rung.left.kind, 1.0, sheet, width)
            high = self._end(rung.right.x, rung, rung.right.kind, -1.0, sheet, width)
            self.beams.append(sheet.beam(low, high, width))
        sheet = _sheet(process, self.trunk)
        for trunk in trunks:
            heights = sorted(
                {r.y for r in rungs for e in (r.left, r.right) if e.kind is EndKind.VIA and e.ref == trunk.name}
            )
            plate = self._trunk_plate(Deck.UPPER if trunk.deck is Deck.UPPER else Deck.LOWER)
            stops = [self._node(trunk.x, y, plate.name) for y in heights]
            self.beams += [sheet.beam(a, b, sizing.rules.bar_width) for a, b in pairwise(stops)]
        self.frame = Frame(
            self.nodes, self.beams, [Spring(dof(0, TURN), turn_stiffness(sizing.law, sizing.series))], self.ties
        )

    def stiffness_at(self, x: float, rung: Rung, arm: float) -> float:
        """Stiffness in y, N/mm, of a point ``arm`` mm beyond the end of ``rung`` at ``x``, rigidly joined to it."""
        node = self.places[(round(x, 4), round(rung.y, 4), rung.plate)]
        supports = {dof(0, X): 0.0, dof(0, Y): 0.0}
        try:
            moved = self.frame.solve(supports, {dof(node, Y): 1.0, dof(node, TURN): arm}).displacements
        except np.linalg.LinAlgError as error:
            raise ValueError(f"the carrier of {self.net} does not hang together") from error
        return float(1.0 / (moved[dof(node, Y)] + arm * moved[dof(node, TURN)]))

    def _trunk_plate(self, deck: Deck) -> Plate:
        return self.process.plate(plate_in(deck, self.trunk.name))

    def _node(self, x: float, y: float, plate: str) -> int:
        key = (round(x, 4), round(y, 4), plate)
        if key not in self.places:
            self.places[key] = self._free_node(x, y)
        return self.places[key]

    def _free_node(self, x: float, y: float) -> int:
        self.nodes.append((x, y))
        return len(self.nodes) - 1

    def _pin(self, below: Plate, above: str, low: int, high: int) -> None:
        """A square pin pressed into ``below`` at node ``low`` and into the plate ``above`` at ``high``.

        Between them it is a cantilever, 3 E I / L^3, and a twisted bar, G J / L with J = 0.1406 side^4 (Saint-Venant,
        square section; Young's tables) and G = E / 2.6.
        """
        low_plate, high_plate = sorted((below, self.process.plate(above)), key=lambda p: self.process.z_of(p.name))
        length = self.process.z_of(high_plate.name) - self.process.z_of(low_plate.name) - low_plate.thickness
        modulus, side = self.process.materials[self.process.stack.pin_material].modulus, self.rules.pin
        bend = 3.0 * modulus * side**4 / 12.0 / length**3
        twist = modulus / 2.6 * 0.1406 * side**4 / length
        for direction, stiffness in ((X, bend), (Y, bend), (TURN, twist)):
            self.ties.append(Tie(dof(low, direction), dof(high, direction), stiffness))

    def _end(self, x: float, rung: Rung, kind: EndKind, side: float, sheet: Sheet, width: float) -> int:
        """Node of a rung's end; ``side`` is +1 if the rung begins on the right of a hub. Hub blocks are rigid."""
        key = (round(x, 4), round(rung.y, 4), rung.plate)
        if kind is EndKind.VIA:
            known = key in self.places
            node = self._node(x, rung.y, rung.plate)
            if not known:
                trunk = self._trunk_plate(deck_of_plate(rung.plate))
                self._pin(trunk, rung.plate, self._node(x, rung.y, trunk.name), node)
            return node
        if kind is not EndKind.HUB:
            return self._node(x, rung.y, rung.plate)
        at = self.hub[0] + side * self.rules.hub_pin_offset
        foot, head = self._free_node(at, rung.y), self._free_node(at, rung.y)
        edge = self._free_node(self.hub[0] + side * self.rules.hub_half, rung.y)
        self.beams += [sheet.beam(0, foot, width, RIGID), sheet.beam(head, edge, width, RIGID)]
        self._pin(self.unit, rung.plate, foot, head)
        return edge


def _sheet(process: Process, plate: Plate) -> Sheet:
    material = process.material(plate)
    return Sheet(material.modulus, plate.thickness, material.strain_limit)
