"""Which couplings can be given a linkage at all, whatever the placement."""

from __future__ import annotations

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import CouplingKind, Network

SIDES = 2


def unrealisable(network: Network, rules: LayoutRules) -> dict[str, str]:
    """Couplings that no layout can hold, by name, with the reason.

    A post comes down from the cover through every plate above its own, so a hub side has room for one. A hub has one
    item a side and rung plate: its inputs, its bias leaf and at least one rung of its own net.
    """
    reasons: dict[str, str] = {}
    posts = {mass.name: int(mass.name in rules.biases) for mass in network.masses}
    items = dict(posts)
    for source in {coupling.source for coupling in network.couplings} | {port.mass for port in network.actuators}:
        items[source] += 1
    most = SIDES * len(rules.link_plates)
    for coupling in network.couplings:
        if coupling.kind is not CouplingKind.LINEAR:
            reasons[coupling.name] = "there is no linkage for a coupling that multiplies displacements"
        elif coupling.name not in rules.couplers:
            reasons[coupling.name] = "sizing gives it no linkage"
        elif coupling.name in rules.post_offset and posts[coupling.target] >= SIDES:
            reasons[coupling.name] = (
                f"{coupling.target} would need more than {SIDES} fixed posts (negative couplings and its bias), "
                "one fits on either side of its hub"
            )
        elif items[coupling.target] >= most:
            reasons[coupling.name] = f"the hub of {coupling.target} holds at most {most} inputs, leaves and rungs"
        else:
            posts[coupling.target] += coupling.name in rules.post_offset
            items[coupling.target] += 1
    return reasons
