"""Square pins: from a shuttle up to its carriers and flexures, and from a trunk up to its rungs."""

from __future__ import annotations

from mdlcad.parts import palette
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.shapes import square
from mdlcad.parts.stack import Hub, Stack, mass_ref
from mdlcad.parts.unit import hub_pin_x
from mdlcad.routing.layout import EndKind, Layout, Side


def hub_plates(layout: Layout) -> dict[tuple[str, Side], list[str]]:
    """Plates that hold a block, by (mass, side of its hub)."""
    found: dict[tuple[str, Side], list[str]] = {}
    for rung in layout.rungs:
        for end, side in ((rung.left, Side.RIGHT), (rung.right, Side.LEFT)):
            if end.kind is EndKind.HUB:
                found.setdefault((end.ref, side), []).append(rung.plate)
    for leaf in layout.couplers:
        found.setdefault((target_of(leaf.coupling), leaf.side), []).append(leaf.plate)
    for bias in layout.biases:
        found.setdefault((bias.mass, bias.side), []).append(bias.plate)
    return found


def target_of(coupling: str) -> str:
    """The target's name in a coupling's."""
    return coupling.rpartition("->")[2]


def source_of(coupling: str) -> str:
    """The source's name in a coupling's."""
    return coupling.rpartition("->")[0]


def hub_pin(stack: Stack, hub: Hub, side: Side, plates: list[str]) -> Body:
    """The pin of one side of a hub, up to the highest plate in use there."""
    rules = stack.sizing.rules
    top = max(plates, key=stack.level)
    return stack.upright(
        f"pin.hub.{hub.place.mass}.{side.value}",
        BodyKind.PIN,
        stack.unit_plate,
        top,
        square(hub_pin_x(stack, hub, side), hub.y, rules.pin),
        (0.0, rules.throw),
        hub.ref,
        palette.PIN,
    )


def via_pins(stack: Stack, layout: Layout) -> list[Body]:
    """The pins that join rungs to trunks; rungs of one trunk at one height share a pin."""
    rules = stack.sizing.rules
    nets: dict[tuple[str, float], tuple[str, float, list[str]]] = {}
    for rung in layout.rungs:
        for end in (rung.left, rung.right):
            if end.kind is EndKind.VIA:
                nets.setdefault((end.ref, rung.y), (rung.net, end.x, []))[2].append(rung.plate)
    bodies: list[Body] = []
    for (trunk, y), (net, x, plates) in sorted(nets.items()):
        bodies.append(
            stack.upright(
                f"pin.via.{trunk.removeprefix('trunk.')}.{len(bodies)}",
                BodyKind.PIN,
                stack.trunk_plate,
                max(plates, key=stack.level),
                square(x, y, rules.pin),
                (0.0, rules.throw),
                mass_ref(net),
                palette.PIN,
            )
        )
    return bodies
