"""What a layout is held to besides its clearances: limits that depend on whole carriers.

Whether a carrier is stiff enough shows only when all its channels are routed. The router therefore asks a judge, and
routes what it objects to again, with the couplings that were named kept to lower plates: their pins are shorter there,
and pull the shuttle over less.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from mdlcad.placement.placement import Placement
from mdlcad.routing.layout import Layout
from mdlcad.routing.pieces import Channel, Item, Role


@dataclass(frozen=True, slots=True)
class Objection:
    """Something about the carrier of ``net``, as its coupling ``coupling`` feels it, in words."""

    net: str
    coupling: str
    message: str


Judge = Callable[[Placement, Layout], tuple[Objection, ...]]


def no_objection(placement: Placement, layout: Layout) -> tuple[Objection, ...]:
    """The judge for a layout that no carrier limits hold for."""
    return ()


def lowered(
    work: tuple[Channel, ...], plates: list[tuple[int, ...]], objections: tuple[Objection, ...], top: int
) -> set[int] | None:
    """Set ceilings for the items that were objected to; the channels to route again, or None if nothing can go lower.

    Of every net, the highest item among the couplings named goes one plate down; when all lie lowest, the rung to its
    own hub does. A net whose unit is in the other deck has its items moved up instead, towards that.

    Args:
        plates: the plate that every item of every channel lies on, in the order of ``work``. top: the highest.
    """
    named: dict[str, set[str]] = {}
    for objection in objections:
        named.setdefault(objection.net, set()).add(objection.coupling)
    again: set[int] = set()
    for net in sorted(named):
        places = [
            (item, level if item.floor is None else top - level, channel.index, position)
            for channel, levels in zip(work, plates, strict=True)
            for position, (item, level) in enumerate(zip(channel.items, levels, strict=True))
            if item.net == net and level != (0 if item.floor is None else top)
        ]
        ends = [place for place in places if place[0].ref in named[net] and _carries(place[0])]
        own = [place for place in places if place[0].role is Role.SOURCE]
        for choice in (ends, own):
            if choice:
                item, level, index, position = max(choice, key=lambda place: (place[1], place[0].ref))
                nearer = (
                    replace(item, ceiling=level - 1) if item.floor is None else replace(item, floor=top - level + 1)
                )
                work[index].items[position] = nearer
                again.add(index)
                break
        else:
            return None
    return again


def _carries(item: Item) -> bool:
    return item.role in (Role.COUPLER, Role.STRAIGHT)
