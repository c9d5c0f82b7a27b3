"""The design rule on the order of assembly: nothing that is there already is in the way of a part."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import shapely
from shapely import Polygon

from mdlcad.mechanics.decks import Deck
from mdlcad.mechanics.process import Process
from mdlcad.parts.assembly import assembly_of, decks_of, turned
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.leaf import occupied
from mdlcad.signoff.drc import TOLERANCE_MM, Finding


def check_order(bodies: Sequence[Body], process: Process) -> list[Finding]:
    """Rule ``trapped`` on the order in which a device is put together, deck by deck, and deck on deck."""
    steps = assembly_of(bodies, process)
    decks = decks_of(bodies, process)
    order = {deck: [b for step in steps if step.deck is deck for b in step.bodies] for deck in Deck}
    top = max(body.z + body.thickness for body in bodies)
    findings = check_assembly(order[Deck.LOWER] if not decks[Deck.UPPER] else _without(order[Deck.LOWER], decks))
    if decks[Deck.UPPER]:
        findings += check_assembly([turned(body, top) for body in order[Deck.UPPER]])
        # the upper deck comes down as a whole; the screws come last
        findings += _trapped(decks[Deck.LOWER], decks[Deck.UPPER])
        whole = (*decks[Deck.LOWER], *decks[Deck.UPPER])
        findings += _trapped(whole, [body for body in bodies if body.kind is BodyKind.SCREW])
    return findings


def _without(order: Sequence[Body], decks: Mapping[Deck, Sequence[Body]]) -> list[Body]:
    """What of ``order`` belongs to the lower deck itself."""
    own = {body.name for body in decks[Deck.LOWER]}
    return [body for body in order if body.name in own]


def check_assembly(order: Sequence[Body]) -> list[Finding]:
    """Rule ``trapped``: every body comes straight down to its place past all that is before it in ``order``.

    Taken apart in the opposite order, every body then comes straight up.
    """
    shapes = [occupied(body) for body in order]
    tree = shapely.STRtree(shapes)
    findings = []
    for later, (body, shape) in enumerate(zip(order, shapes, strict=True)):
        for earlier in sorted(tree.query(shape, predicate="intersects").tolist()):
            if earlier < later:
                findings += _in_the_way(body, shape, order[earlier], shapes[earlier])
    return findings


def _trapped(before: Sequence[Body], after: Sequence[Body]) -> list[Finding]:
    """What of ``after`` cannot come straight down past ``before``."""
    shapes = [occupied(body) for body in before]
    tree = shapely.STRtree(shapes)
    findings = []
    for body in after:
        shape = occupied(body)
        for index in sorted(tree.query(shape, predicate="intersects").tolist()):
            findings += _in_the_way(body, shape, before[index], shapes[index])
    return findings


def _in_the_way(body: Body, shape: Polygon, other: Body, there: Polygon) -> list[Finding]:
    """The finding that ``other`` is in the way of ``body`` as it comes down, if it is."""
    below = other.z + other.thickness - body.z
    if below < 1e-6:
        return []
    common = shapely.intersection(shape, there)
    if common.area <= TOLERANCE_MM:
        return []
    place = common.representative_point()
    message = f"cannot come down past {other.name}, which is there before it"
    return [Finding("trapped", (body.name, other.name), place.x, place.y, round(below, 4), 0.0, message)]
