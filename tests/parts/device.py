"""A small device laid out by hand: 2 columns, 3 rows, one coupler, one rocker, one bias leaf, one tab, two trunks."""

from dataclasses import dataclass

from shapely import Polygon

from mdlcad.mechanics import Process, Sizing, load_process, size
from mdlcad.network.model import Coupling, Dynamics, Mass, MassKind, Network
from mdlcad.parts import Body, build_parts
from mdlcad.placement.placement import PlacedMass, Placement
from mdlcad.routing.layout import (
    BiasLeaf,
    CouplerLeaf,
    EndKind,
    Layout,
    Rung,
    RungEnd,
    Side,
    Tab,
    Trunk,
)


@dataclass(frozen=True)
class Device:
    network: Network
    placement: Placement
    layout: Layout
    sizing: Sizing
    process: Process
    boundary: Polygon

    def bodies(self) -> tuple[Body, ...]:
        return build_parts(self.network, self.placement, self.layout, self.sizing, self.process, self.boundary)


def small_network() -> Network:
    masses = tuple(
        Mass(
            name=f"m{i}",
            kind=MassKind.GATE,
            phase=i % 3,
            k0=3.5,
            k1=-3.0,
            compensation=-0.3 if i in (0, 3) else 0.0,
            bias=0.5 if i == 2 else 0.0,
            initial=0.0,
        )
        for i in range(6)
    )
    couplings = (Coupling("m0", "m3", 0.25, 0.3), Coupling("m1", "m4", -0.3, 0.5))
    dynamics = Dynamics(inertia=0.05, damping=0.25, quartic=1.0, period=10.0, phases=3)
    return Network("small", "parametron", dynamics, masses, couplings, (), (), (), None, 4)


def small_device(process_name: str = "pom_cut", peak: float = 1.8) -> Device:
    network, process = small_network(), load_process(process_name)
    sizing = size(network, process, {mass.name: peak for mass in network.masses})
    rules = sizing.rules
    rim = rules.frame_width
    x0 = rim + rules.unit_left + 0.5
    x1 = x0 + rules.column_pitch
    y0 = rim + rules.row_pitch / 2 + 0.5
    rows = tuple(y0 + i * rules.row_pitch for i in range(3))
    width = x1 + rules.unit_right + rim + 0.5
    height = rows[2] + rules.row_pitch / 2 + rim + 0.5
    boundary = ((0.0, 0.0), (0.0, height), (width, height), (width, 0.0))
    # the right column starts with m5, so that both nets change rows
    slots = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (1, 0))
    places = tuple(PlacedMass(f"m{i}", c, r, (x0, x1)[c], rows[r]) for i, (c, r) in enumerate(slots))
    placement = Placement(boundary, 1.0, (x0, x1), rows, slots, places, (), 1)
    outer = x0 + rules.hub_half + rules.gap + rules.bar_width + 2.0
    inner = outer + rules.track_pitch + 1.0
    straight, turned = x1 - rules.couplers["m0->m3"], x1 - rules.couplers["m1->m4"]
    into_m3, into_m4 = RungEnd(EndKind.COUPLER, straight, "m0->m3"), RungEnd(EndKind.COUPLER, turned, "m1->m4")
    via_0, via_1 = RungEnd(EndKind.VIA, inner, "m0.t"), RungEnd(EndKind.VIA, outer, "m1.t")
    rungs = (
        Rung("m0.0", "m0", "H0", rows[0], RungEnd(EndKind.HUB, x0, "m0"), via_0),
        Rung("m0.1", "m0", "H0", rows[1], via_0, into_m3),
        Rung("m1.0", "m1", "H0", rows[1], RungEnd(EndKind.HUB, x0, "m1"), via_1),
        Rung("m1.1", "m1", "H0", rows[2], via_1, into_m4),
        Rung("m5.0", "m5", "H0", rows[0], RungEnd(EndKind.HUB, x1, "m5"), RungEnd(EndKind.TAB, width - rim, "out[0]")),
    )
    layout = Layout(
        rungs=rungs,
        trunks=(Trunk("m0.t", "m0", inner, rows[0], rows[1]), Trunk("m1.t", "m1", outer, rows[1], rows[2])),
        couplers=(
            CouplerLeaf("m0->m3", "H0", Side.LEFT, straight, rows[1], None),
            CouplerLeaf("m1->m4", "H0", Side.LEFT, turned, rows[2], x1 - rules.post_offset["m1->m4"]),
        ),
        biases=(BiasLeaf("m2", "H1", Side.RIGHT, x0 + rules.biases["m2"], rows[2] + rules.bias_offsets["m2"]),),
        tabs=(Tab("out[0]", "m5", "H0", ((width - rim, rows[0]), (width + 4.0, rows[0]))),),
        unrealised=(),
        seed=1,
    )
    return Device(network, placement, layout, sizing, process, Polygon(boundary))
