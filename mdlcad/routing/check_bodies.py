"""The checker's own reading of a layout as solids on plates."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from shapely import LineString, MultiPoint, Point, Polygon, box, get_coordinates, union_all
from shapely.affinity import translate

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.placement import PlacedMass, Placement
from mdlcad.routing.layout import EndKind, Layout, Rung, RungEnd, Side

TRUNK_PLATE = "V"
FRAME = "frame"


@dataclass(frozen=True, slots=True)
class Solid:
    """One piece on one plate.

    Attributes:
        shape: at rest; ``swept``: everywhere its motion takes it (mm).
        masses: the shuttles it moves with; empty if it is fixed.
        flexible: a leaf, which ties what it moves with (or the frame) together.
        tied: names of the solids that it is cut in one piece with or rests against by design.
        may_leave: part of a tab, which goes through the rim.
    """

    name: str
    plate: str
    shape: Polygon
    swept: Polygon
    masses: tuple[str, ...]
    flexible: bool = False
    tied: tuple[str, ...] = ()
    may_leave: bool = False


def rebuild(network: Network, placement: Placement, layout: Layout, rules: LayoutRules) -> tuple[Solid, ...]:
    """Every piece of ``layout``. Pieces that name unknown masses or couplings are left to the checks by name."""
    maker = _Maker(network, placement, rules)
    maker.hubs(layout)
    for trunk in layout.trunks:
        half = rules.bar_width / 2
        shape = box(trunk.x - half, trunk.y_low - half, trunk.x + half, trunk.y_high + half)
        maker.moving(f"trunk {trunk.name}", TRUNK_PLATE, shape, trunk.net)
    for rung in layout.rungs:
        maker.rung(rung)
    maker.leaves(layout)
    for tab in layout.tabs:
        shape = LineString(tab.path).buffer(rules.bar_width / 2, cap_style="flat", join_style="mitre")
        maker.moving(f"tab {tab.bit}", tab.plate, shape, tab.net, may_leave=True)
    return tuple(maker.solids)


class _Maker:
    def __init__(self, network: Network, placement: Placement, rules: LayoutRules) -> None:
        self.rules = rules
        self.hub: dict[str, PlacedMass] = {unit.mass: unit for unit in placement.masses}
        self.couplings = {coupling.name: coupling for coupling in network.couplings}
        self.solids: list[Solid] = []

    def moving(
        self,
        name: str,
        plate: str,
        shape: Polygon,
        net: str,
        tied: tuple[str, ...] = (),
        may_leave: bool = False,
    ) -> None:
        swept = _sweep(shape, self.rules.throw)
        self.solids.append(Solid(name, plate, shape, swept, (net,), tied=tied, may_leave=may_leave))

    def below(self, plate: str) -> list[str]:
        plates = self.rules.link_plates
        return [TRUNK_PLATE, *plates[: plates.index(plate) + 1]] if plate in plates else []

    def hubs(self, layout: Layout) -> None:
        """Hub blocks wherever something is fixed to a hub, and the hub's pins through every plate."""
        used = set()
        for rung in layout.rungs:
            for end, side in ((rung.left, Side.RIGHT), (rung.right, Side.LEFT)):
                if end.kind is EndKind.HUB and end.ref in self.hub:
                    used.add((end.ref, side.value, rung.plate))
        for leaf in layout.couplers:
            if leaf.coupling in self.couplings:
                used.add((self.couplings[leaf.coupling].target, leaf.side.value, leaf.plate))
        for bias in layout.biases:
            if bias.mass in self.hub:
                used.add((bias.mass, bias.side.value, bias.plate))
        half = self.rules.hub_height / 2
        for mass, where, plate in sorted(used):
            hub = self.hub[mass]
            low, high = self.rules.hub_gap / 2, self.rules.hub_half
            a, b = (low, high) if where == "right" else (-high, -low)
            shape = box(hub.x + a, hub.y - half, hub.x + b, hub.y + half)
            self.moving(_block(mass, where, plate), plate, shape, mass)
        side_of_pin = self.rules.pin / 2
        for mass in sorted(self.hub):
            hub = self.hub[mass]
            for where, sign in (("left", -1), ("right", 1)):
                x = hub.x + sign * self.rules.hub_pin_offset
                shape = box(x - side_of_pin, hub.y - side_of_pin, x + side_of_pin, hub.y + side_of_pin)
                for plate in (TRUNK_PLATE, *self.rules.link_plates):
                    self.moving(f"hub pin {mass} {where} on {plate}", plate, shape, mass)

    def rung(self, rung: Rung) -> None:
        to_tab = EndKind.TAB in (rung.left.kind, rung.right.kind)
        half = (self.rules.bar_width if to_tab else max(self.rules.bar_width, self.rules.hub_height)) / 2
        low, high = self._reach(rung.left, -1), self._reach(rung.right, 1)
        shape = box(min(low, high), rung.y - half, max(low, high), rung.y + half)
        self.moving(f"rung {rung.name}", rung.plate, shape, rung.net, may_leave=to_tab)
        pin = self.rules.pin / 2
        for end in (rung.left, rung.right):
            if end.kind is EndKind.VIA:
                square = box(end.x - pin, rung.y - pin, end.x + pin, rung.y + pin)
                for plate in self.below(rung.plate)[:-1]:
                    self.moving(f"via of {rung.name} on {plate}", plate, square, rung.net)

    def _reach(self, end: RungEnd, outward: int) -> float:
        """Where the bar really ends: it covers its pin by half a bar, and begins at the edge of its hub's block."""
        if end.kind is EndKind.VIA:
            return end.x + outward * self.rules.bar_width / 2
        if end.kind is EndKind.HUB:
            return end.x - outward * self.rules.hub_gap / 2
        return end.x

    def leaves(self, layout: Layout) -> None:
        half = self.rules.hub_height / 2
        driving: dict[str, list[Rung]] = {}
        for rung in layout.rungs:
            for ref in sorted({rung.left.ref, rung.right.ref}):
                driving.setdefault(ref, []).append(rung)
        for leaf in layout.couplers:
            coupling = self.couplings.get(leaf.coupling)
            if coupling is None:
                continue
            hub = self.hub[coupling.target]
            sign = 1 if leaf.side is Side.RIGHT else -1
            x = sorted((hub.x + sign * self.rules.hub_half, leaf.start_x))
            shape = box(x[0], leaf.y - half, x[1], leaf.y + half)
            tied = [_block(coupling.target, leaf.side.value, leaf.plate)]
            tied += [f"rung {rung.name}" for rung in driving.get(leaf.coupling, ()) if rung.net == coupling.source]
            name = f"coupler {leaf.coupling}"
            swept = _sweep(shape, self.rules.throw)
            masses = (coupling.source, coupling.target)
            self.solids.append(Solid(name, leaf.plate, shape, swept, masses, True, tuple(tied)))
            if leaf.post_x is not None:
                self._post(name, leaf.plate, leaf.post_x, leaf.y)
        for bias in layout.biases:
            if bias.mass not in self.hub:
                continue
            hub = self.hub[bias.mass]
            sign = 1 if bias.side is Side.RIGHT else -1
            far = self.rules.bias_ends.get(bias.mass, abs(bias.post_x - hub.x) + self.rules.post_radius)
            x = sorted((hub.x + sign * self.rules.hub_half, hub.x + sign * far))
            shape = box(x[0], hub.y - half, x[1], hub.y + half)
            post_y = hub.y + self.rules.bias_offsets.get(bias.mass, 0.0)
            eye = Point(bias.post_x, post_y).buffer(max(self.rules.eye_radius, self.rules.post_radius))
            swept = union_all([_sweep(shape, self.rules.throw), eye]).convex_hull
            name = f"bias {bias.mass}"
            tied = [_block(bias.mass, bias.side.value, bias.plate)]
            self.solids.append(Solid(name, bias.plate, shape, swept, (bias.mass,), True, tuple(tied)))
            self._post(name, bias.plate, bias.post_x, post_y)

    def _post(self, leaf: str, plate: str, x: float, y: float) -> None:
        """A post stands still from the cover down through every plate above its leaf's, and into the leaf's eye."""
        plates = self.rules.link_plates
        if plate not in plates:
            return
        shape = Point(x, y).buffer(self.rules.post_radius)
        for above in plates[plates.index(plate) :]:
            self.solids.append(Solid(f"post of {leaf} on {above}", above, shape, shape, (), tied=(leaf,)))


def _block(mass: str, side: str, plate: str) -> str:
    return f"hub block {mass} {side} on {plate}"


def _sweep(shape: Polygon, throw: float) -> Polygon:
    """Where a body goes that moves by up to ``throw`` up and down (all shapes here are convex or axis-parallel)."""
    if shape.convex_hull.equals(shape):
        corners, away = get_coordinates(shape), np.array((0.0, throw))
        return MultiPoint(np.concatenate([corners - away, corners + away])).convex_hull
    steps: Sequence[float] = (-throw, 0.0, throw)
    # a bent tab: sweep each of its convex edges' boxes
    coordinates = list(shape.exterior.coords)
    pieces = [translate(shape, 0.0, step) for step in steps]
    for (x0, y0), (x1, y1) in pairwise(coordinates):
        pieces.append(box(min(x0, x1), min(y0, y1) - throw, max(x0, x1), max(y0, y1) + throw))
    return union_all([piece for piece in pieces if piece.area > 0])
