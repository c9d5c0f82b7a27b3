"""Is every net one carrier, and every coupling, bias and port realised once and in the right place?"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.placement import PlacedMass, Placement
from mdlcad.routing.layout import EndKind, Layout, Rung, RungEnd, Side, Trunk

Raw = tuple[str, str, float, float, tuple[str, ...]]
NEAR = 1e-4


def check_nets(network: Network, placement: Placement, layout: Layout, rules: LayoutRules) -> list[Raw]:
    """Findings of the rules carrier, coupler, bias, tab and hub_side."""
    hubs = {unit.mass: unit for unit in placement.masses}
    return [
        *_carriers(network, placement, layout, hubs),
        *_couplers(network, layout, hubs, rules),
        *_biases(network, layout, hubs, rules),
        *_tabs(placement, layout, rules),
        *_hub_sides(network, layout, hubs),
    ]


def _ends(rung: Rung) -> tuple[RungEnd, RungEnd]:
    return rung.left, rung.right


def _ends_at(layout: Layout, kind: EndKind) -> dict[str, list[tuple[Rung, RungEnd]]]:
    """All ends of one kind, by what they are at."""
    found: dict[str, list[tuple[Rung, RungEnd]]] = {}
    for rung in layout.rungs:
        for end in _ends(rung):
            if end.kind is kind:
                found.setdefault(end.ref, []).append((rung, end))
    return found


def _carriers(network: Network, placement: Placement, layout: Layout, hubs: dict[str, PlacedMass]) -> Iterable[Raw]:
    trunks: dict[str, Trunk] = {}
    for trunk in layout.trunks:
        if trunk.name in trunks:
            yield "carrier", f"two trunks are named {trunk.name}", trunk.x, trunk.y_low, (trunk.name,)
        trunks[trunk.name] = trunk
    needing = {c.source for c in network.couplings}
    needing |= {port.mass for port in placement.ports}
    rungs_of: dict[str, list[Rung]] = {}
    for rung in layout.rungs:
        rungs_of.setdefault(rung.net, []).append(rung)
    trunks_of: dict[str, list[Trunk]] = {}
    for trunk in layout.trunks:
        trunks_of.setdefault(trunk.net, []).append(trunk)
    for net in sorted({*rungs_of, *trunks_of, *needing}):
        if net not in hubs:
            yield "carrier", f"net {net} has no mass", 0.0, 0.0, (net,)
            continue
        hub = hubs[net]
        joined: dict[str, str] = {}

        def find(node: str, joined: dict[str, str] = joined) -> str:
            while joined.get(node, node) != node:
                node = joined[node]
            return node

        members = {"hub"}
        for rung in rungs_of.get(net, ()):
            members.add(f"rung {rung.name}")
            if rung.left.x >= rung.right.x:
                yield "carrier", f"rung {rung.name} has no length", rung.left.x, rung.y, (rung.name,)
            for end in _ends(rung):
                if end.kind is EndKind.HUB:
                    if end.ref != net or abs(end.x - hub.x) > NEAR or abs(rung.y - hub.y) > NEAR:
                        words = f"rung {rung.name} is not pinned to the hub of {net}"
                        yield "carrier", words, end.x, rung.y, (rung.name,)
                    else:
                        joined[find(f"rung {rung.name}")] = find("hub")
                elif end.kind is EndKind.VIA:
                    on = trunks.get(end.ref)
                    if (
                        on is None
                        or on.net != net
                        or abs(on.x - end.x) > NEAR
                        or not on.y_low - NEAR <= rung.y <= on.y_high + NEAR
                    ):
                        words = f"rung {rung.name} is not on its trunk {end.ref}"
                        yield "carrier", words, end.x, rung.y, (rung.name, end.ref)
                    else:
                        joined[find(f"rung {rung.name}")] = find(f"trunk {end.ref}")
        members |= {f"trunk {trunk.name}" for trunk in trunks_of.get(net, ())}
        parts = {find(member) for member in members}
        if len(parts) > 1 or (net in needing and len(members) == 1):
            loose = sorted(member for member in members if find(member) != find("hub"))
            words = f"carrier of {net} is in {len(parts)} parts" if loose else f"net {net} has no carrier"
            yield "carrier", words, hub.x, hub.y, (net, *loose)


def _couplers(network: Network, layout: Layout, hubs: dict[str, PlacedMass], rules: LayoutRules) -> Iterable[Raw]:
    known = {coupling.name: coupling for coupling in network.couplings}
    leaves = Counter(leaf.coupling for leaf in layout.couplers)
    excused = dict(layout.unrealised)
    for coupling in network.couplings:
        # what the layout says it could not realise is no excuse
        if leaves[coupling.name] != 1 or coupling.name in excused:
            hub = hubs[coupling.target]
            why = f" (the layout says: {excused[coupling.name]})" if coupling.name in excused else ""
            words = f"coupling {coupling.name} has {leaves[coupling.name]} couplers, 1 wanted{why}"
            yield "coupler", words, hub.x, hub.y, (coupling.name,)
    for name in sorted({*leaves, *excused} - set(known)):
        yield "coupler", f"the network has no coupling {name}", 0.0, 0.0, (name,)
    ends = [(rung, end) for rung in layout.rungs for end in _ends(rung) if end.kind is EndKind.COUPLER]
    ends_at = _ends_at(layout, EndKind.COUPLER)
    for rung, end in ends:
        if end.ref not in known or known[end.ref].source != rung.net:
            words = f"rung {rung.name} of net {rung.net} drives {end.ref}, which is not its own"
            yield "coupler", words, end.x, rung.y, (rung.name, end.ref)
    for leaf in layout.couplers:
        if leaf.coupling not in known:
            continue
        coupling = known[leaf.coupling]
        hub = hubs[coupling.target]
        sign = 1 if leaf.side is Side.RIGHT else -1
        reach = rules.couplers.get(leaf.coupling)
        here = (leaf.start_x, leaf.y, (leaf.coupling,))
        if reach is None or abs(hub.x + sign * reach - leaf.start_x) > NEAR or abs(leaf.y - hub.y) > NEAR:
            yield "coupler", f"coupler {leaf.coupling} does not end at the hub of {coupling.target}", *here
        offset = rules.post_offset.get(leaf.coupling)
        if (offset is None) != (leaf.post_x is None) or (
            offset is not None and leaf.post_x is not None and abs(hub.x + sign * offset - leaf.post_x) > NEAR
        ):
            yield "coupler", f"coupler {leaf.coupling} has its post in the wrong place, or one too many or few", *here
        if leaf.plate not in rules.link_plates:
            yield "coupler", f"coupler {leaf.coupling} is on {leaf.plate}, which is no rung plate", *here
        held = [
            (rung, end)
            for rung, end in ends_at.get(leaf.coupling, ())
            if rung.plate == leaf.plate
            and abs(rung.y - leaf.y) < NEAR
            and abs(end.x - leaf.start_x) < NEAR
            and (end is rung.left) == (leaf.side is Side.RIGHT)
        ]
        if len(held) != 1 or len(ends_at[leaf.coupling]) != 1:
            yield "coupler", f"coupler {leaf.coupling} is not held by exactly one rung of {coupling.source}", *here


def _biases(network: Network, layout: Layout, hubs: dict[str, PlacedMass], rules: LayoutRules) -> Iterable[Raw]:
    count = Counter(leaf.mass for leaf in layout.biases)
    for mass in sorted({*count, *rules.biases}):
        want = 1 if mass in rules.biases else 0
        if count[mass] != want:
            x, y = (hubs[mass].x, hubs[mass].y) if mass in hubs else (0.0, 0.0)
            yield "bias", f"mass {mass} has {count[mass]} bias leaves, {want} wanted", x, y, (mass,)
    for leaf in layout.biases:
        if leaf.mass not in rules.biases or leaf.mass not in hubs:
            continue
        hub = hubs[leaf.mass]
        sign = 1 if leaf.side is Side.RIGHT else -1
        heights = (hub.y, hub.y + rules.bias_offsets.get(leaf.mass, 0.0))
        if (
            abs(hub.x + sign * rules.biases[leaf.mass] - leaf.post_x) > NEAR
            or min(abs(leaf.post_y - y) for y in heights) > NEAR
            or leaf.plate not in rules.link_plates
        ):
            words = f"bias leaf of {leaf.mass} has its post in the wrong place or lies on no rung plate"
            yield "bias", words, leaf.post_x, leaf.post_y, (leaf.mass,)
    for item in sorted(mass.name for mass in network.masses if mass.bias != 0 and mass.name not in rules.biases):
        yield "bias", f"mass {item} is biased but sizing gave it no leaf", hubs[item].x, hubs[item].y, (item,)


def _tabs(placement: Placement, layout: Layout, rules: LayoutRules) -> Iterable[Raw]:
    ports = {port.bit: port for port in placement.ports}
    count = Counter(tab.bit for tab in layout.tabs)
    for bit in sorted({*count, *ports}):
        want = 1 if bit in ports else 0
        if count[bit] != want:
            x, y = (ports[bit].x, ports[bit].y) if bit in ports else (0.0, 0.0)
            yield "tab", f"port {bit} has {count[bit]} tabs, {want} wanted", x, y, (bit,)
    ends_at = _ends_at(layout, EndKind.TAB)
    for tab in layout.tabs:
        if tab.bit not in ports:
            continue
        port = ports[tab.bit]
        along = 1 if abs(port.normal[1]) > abs(port.normal[0]) else 0
        tip, place = tab.path[-1], (port.x, port.y)
        beyond = (tip[along] - place[along]) * (1 if port.normal[along] > 0 else -1)
        aside = abs(tip[1 - along] - place[1 - along])
        here = (port.x, port.y, (tab.bit,))
        if tab.net != port.mass or beyond < rules.throw or aside > 0.1:
            yield "tab", f"tab of {tab.bit} does not lead from {port.mass} to its place", *here
        if any(
            abs(a[0] - b[0]) > NEAR and abs(a[1] - b[1]) > NEAR for a, b in zip(tab.path, tab.path[1:], strict=False)
        ):
            yield "tab", f"tab of {tab.bit} is not made of axis-parallel pieces", *here
        held = [
            rung
            for rung, end in ends_at.get(tab.bit, ())
            if rung.net == tab.net and rung.plate == tab.plate
            and abs(end.x - tab.path[0][0]) < NEAR and abs(rung.y - tab.path[0][1]) < NEAR
        ]  # fmt: skip
        if len(held) != 1:
            yield "tab", f"tab of {tab.bit} is not held by exactly one rung of {tab.net}", *here


def _hub_sides(network: Network, layout: Layout, hubs: dict[str, PlacedMass]) -> Iterable[Raw]:
    """Two items on one hub side and plate would be cut as one body."""
    targets = {coupling.name: coupling.target for coupling in network.couplings}
    used: dict[tuple[str, str, str], list[str]] = {}
    for rung in layout.rungs:
        for end, side in ((rung.left, Side.RIGHT), (rung.right, Side.LEFT)):
            if end.kind is EndKind.HUB:
                used.setdefault((end.ref, side.value, rung.plate), []).append(f"rung {rung.name}")
    for leaf in layout.couplers:
        key = (targets.get(leaf.coupling, ""), leaf.side.value, leaf.plate)
        used.setdefault(key, []).append(f"coupler {leaf.coupling}")
    for bias in layout.biases:
        used.setdefault((bias.mass, bias.side.value, bias.plate), []).append(f"bias {bias.mass}")
    for (mass, where, plate), names in sorted(used.items()):
        if len(names) > 1 and mass in hubs:
            words = f"the {where} side of hub {mass} holds {len(names)} items on plate {plate}"
            yield "hub_side", words, hubs[mass].x, hubs[mass].y, tuple(sorted(names))
