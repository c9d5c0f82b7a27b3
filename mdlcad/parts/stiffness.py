"""How stiff a carrier is where its couplers begin: rungs and trunks that bend, on a shuttle that can turn.

Reads the placement and layout artefacts, so it is not part of sizing: the flow calls it once a layout exists.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from mdlcad.mechanics.findings import Finding
from mdlcad.mechanics.flexure import RIGID, Sheet
from mdlcad.mechanics.frame import TURN, Beam, Frame, Spring, X, Y, dof
from mdlcad.mechanics.leaves import LeafKind, trim
from mdlcad.mechanics.process import Plate, PlateRole, Process
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.mechanics.sizing import Sizing
from mdlcad.network.model import Network
from mdlcad.placement.placement import Placement
from mdlcad.routing.layout import EndKind, Layout, Rung, Trunk


@dataclass(frozen=True, slots=True)
class CarrierStiffness:
    """Stiffness of a carrier in y as one coupler feels it.

    Attributes:
        stiffness: N/mm, bars bending and the source's shuttle turning in the plane, the shuttle held in y.
        ratio: that over the coupler's own stiffness; the coupling is weakened by about 1 / (1 + ratio).
        tilt_ratio: the same ratio for the shuttle tilting about x under the height of the rung plate, if no other
            plate supported the carrier in z (plates slide on shims, so this is the worst case).
    """

    coupling: str
    stiffness: float
    ratio: float
    tilt_ratio: float


def rung_width(rung: Rung, rules: LayoutRules) -> float:
    """Height in y of a rung's bar, mm: a row keeps the height of a hub free for it, a bar's for a tab's."""
    to_tab = EndKind.TAB in (rung.left.kind, rung.right.kind)
    return rules.bar_width if to_tab else max(rules.bar_width, rules.hub_height)


def carrier_stiffnesses(
    network: Network, placement: Placement, layout: Layout, sizing: Sizing, process: Process
) -> tuple[CarrierStiffness, ...]:
    """One entry for every coupling that the layout realises, in the network's order.

    Raises:
        ValueError: a carrier does not hang together.
    """
    parts = {item.coupling: item for item in sizing.couplers}
    hub_x = {place.mass: place.x for place in placement.masses}
    hub_y = {place.mass: place.y for place in placement.masses}
    ends = {
        end.ref: (rung, end.x)
        for rung in layout.rungs
        for end in (rung.left, rung.right)
        if end.kind is EndKind.COUPLER
    }
    found = []
    built: dict[str, _Carrier] = {}
    for coupling in network.couplings:
        if coupling.name not in ends:
            continue
        net = coupling.source
        if net not in built:
            rungs = [rung for rung in layout.rungs if rung.net == net]
            trunks = [trunk for trunk in layout.trunks if trunk.net == net]
            built[net] = _Carrier(net, (hub_x[net], hub_y[net]), rungs, trunks, sizing, process)
        rung, x = ends[coupling.name]
        leaf = parts[coupling.name].leaf
        # a leaf whose ends do not turn pulls at its middle; of a rocker, only the half up to the post
        arm = leaf.reach / (4.0 if leaf.kind is LeafKind.ROCKER else 2.0)
        stiffness = built[net].stiffness_at(x, rung.y, arm if rung.right.ref == coupling.name else -arm)
        unit, plate = process.plates(PlateRole.UNIT)[0], process.plate(rung.plate)
        height = process.z_of(plate.name) + plate.thickness / 2.0 - process.z_of(unit.name) - unit.thickness / 2.0
        tilt = sizing.law.shuttle_tilt / height**2
        found.append(
            CarrierStiffness(coupling.name, trim(stiffness), trim(stiffness / leaf.own), trim(tilt / leaf.own))
        )
    return tuple(found)


def carrier_findings(stiffnesses: Sequence[CarrierStiffness], process: Process) -> tuple[Finding, ...]:
    """Carriers that are too soft for the couplers they end in."""
    limit = process.link.carrier_ratio
    message = "its carrier is too soft for it: bring it closer to its trunk, or stiffen the bars"
    return tuple(
        Finding("carrier", f"coupler.{item.coupling}", item.ratio, limit, message)
        for item in stiffnesses
        if item.ratio < limit
    )


class _Carrier:
    """The plane frame of one net; nodes are the places where bars meet or end."""

    def __init__(
        self,
        net: str,
        hub: tuple[float, float],
        rungs: Sequence[Rung],
        trunks: Sequence[Trunk],
        sizing: Sizing,
        process: Process,
    ) -> None:
        self.net = net
        self.nodes: list[tuple[float, float]] = [hub]
        self.places: dict[tuple[float, float], int] = {(round(hub[0], 4), round(hub[1], 4)): 0}
        self.beams: list[Beam] = []
        rules = sizing.rules
        for rung in rungs:
            width = rung_width(rung, rules)
            sheet = _sheet(process, process.plate(rung.plate))
            low = self._end(rung.left.x, rung.y, rung.left.kind, hub, rules.hub_half, sheet, width)
            high = self._end(rung.right.x, rung.y, rung.right.kind, hub, -rules.hub_half, sheet, width)
            self.beams.append(sheet.beam(low, high, width))
        sheet = _sheet(process, process.plates(PlateRole.TRUNK)[0])
        for trunk in trunks:
            heights = sorted(
                {r.y for r in rungs for e in (r.left, r.right) if e.kind is EndKind.VIA and e.ref == trunk.name}
            )
            stops = [self._node(trunk.x, y) for y in heights]
            self.beams += [sheet.beam(a, b, rules.bar_width) for a, b in pairwise(stops)]
        self.frame = Frame(self.nodes, self.beams, [Spring(dof(0, TURN), sizing.law.shuttle_turn)])

    def stiffness_at(self, x: float, y: float, arm: float) -> float:
        """Stiffness in y, N/mm, of a point ``arm`` mm beyond the node at (x, y), rigidly joined to it."""
        node = self.places[(round(x, 4), round(y, 4))]
        supports = {dof(0, X): 0.0, dof(0, Y): 0.0}
        try:
            moved = self.frame.solve(supports, {dof(node, Y): 1.0, dof(node, TURN): arm}).displacements
        except np.linalg.LinAlgError as error:
            raise ValueError(f"the carrier of {self.net} does not hang together") from error
        return float(1.0 / (moved[dof(node, Y)] + arm * moved[dof(node, TURN)]))

    def _node(self, x: float, y: float) -> int:
        key = (round(x, 4), round(y, 4))
        if key not in self.places:
            self.places[key] = len(self.nodes)
            self.nodes.append((x, y))
        return self.places[key]

    def _end(
        self, x: float, y: float, kind: EndKind, hub: tuple[float, float], block: float, sheet: Sheet, width: float
    ) -> int:
        """Node of a rung's end; at a hub, the block (``block`` mm wide, signed) is rigid."""
        if kind is not EndKind.HUB:
            return self._node(x, y)
        edge = self._node(hub[0] + block, y)
        self.beams.append(sheet.beam(0, edge, width, RIGID))
        return edge


def _sheet(process: Process, plate: Plate) -> Sheet:
    material = process.material(plate)
    return Sheet(material.modulus, plate.thickness, material.strain_limit)
