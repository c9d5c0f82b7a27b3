"""The order in which a device is put together: plate on plate from the base up, every part straight down to its place.

Pins stand in the lowest plate that they join and go in with it. Posts that hang in the cover go in last, from above,
each through its hole in the cover and the eye that turns on it; the screws go after them.

Of a device with two decks, each is put together like that by itself, the upper one upside down. Then it is turned over
and laid on the lower one, cover on cover, so that the pins of nets that cross enter the other deck's carriers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

from mdlcad.mechanics.decks import Deck, deck_of_plate, plate_in
from mdlcad.mechanics.process import PlateRole, Process
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.plates import STOCK


class StepKind(StrEnum):
    """What is done in a step of the assembly."""

    BASE = "base"
    CLOCK = "clock"
    UNITS = "units"
    TRUNKS = "trunks"
    RUNGS = "rungs"
    COVER = "cover"
    POSTS = "posts"
    JOIN = "join"
    SCREWS = "screws"


_OF_ROLE = {
    PlateRole.BASE: StepKind.BASE,
    PlateRole.CLOCK: StepKind.CLOCK,
    PlateRole.UNIT: StepKind.UNITS,
    PlateRole.TRUNK: StepKind.TRUNKS,
    PlateRole.RUNG: StepKind.RUNGS,
    PlateRole.COVER: StepKind.COVER,
}


@dataclass(frozen=True, slots=True)
class AssemblyStep:
    """One step: the plate that is laid (None for posts and screws), and its bodies in the order they go in.

    Attributes:
        deck: the deck that is being put together; the upper one lies upside down. JOIN and SCREWS are of the lower.
    """

    kind: StepKind
    plate: str | None
    bodies: tuple[Body, ...]
    deck: Deck = Deck.LOWER


def assembly_of(bodies: Sequence[Body], process: Process) -> tuple[AssemblyStep, ...]:
    """The steps; every body is in exactly one.

    Args:
        process: with the plates of both decks, if the device has two.
    """
    screws = tuple(body for body in bodies if body.kind is BodyKind.SCREW)
    decks = decks_of(bodies, process)
    steps = _deck_steps(decks[Deck.LOWER], process, Deck.LOWER)
    if decks[Deck.UPPER]:
        top = max(body.z + body.thickness for body in bodies)
        by_name = {body.name: body for body in bodies}
        joint = [body for body in decks[Deck.UPPER] if body.kind is BodyKind.SPACER and body.z < _middle(process)]
        joined = {body.name for body in joint}
        rest = [body for body in decks[Deck.UPPER] if body.name not in joined]
        upper = _deck_steps([turned(body, top) for body in rest], process, Deck.UPPER)
        steps += [replace(step, bodies=tuple(by_name[body.name] for body in step.bodies)) for step in upper]
        steps.append(AssemblyStep(StepKind.JOIN, None, tuple(joint)))
    if screws:
        steps.append(AssemblyStep(StepKind.SCREWS, None, screws))
    return tuple(steps)


def decks_of(bodies: Sequence[Body], process: Process) -> dict[Deck, tuple[Body, ...]]:
    """The bodies that are put together with each deck, screws left out; a pin that crosses goes with its unit."""
    found: dict[Deck, list[Body]] = {deck: [] for deck in Deck}
    middle = _middle(process)
    unit = process.z_of(process.plates(PlateRole.UNIT)[0].name)
    for body in bodies:
        if body.kind is BodyKind.SCREW:
            continue
        crosses = body.z < middle < body.z + body.thickness and body.kind in STOCK
        lower = abs(body.z - unit) < 1e-6 if crosses else body.z + body.thickness < middle
        found[Deck.LOWER if lower else Deck.UPPER].append(body)
    return {deck: tuple(members) for deck, members in found.items()}


def _middle(process: Process) -> float:
    """Height that only what belongs to an upper deck, or crosses, reaches above: the middle of the joint, if any."""
    cover = process.plates(PlateRole.COVER)[0]
    return process.z_of(cover.name) + cover.thickness + process.stack.z_gap / 2.0


def turned(body: Body, top: float) -> Body:
    """The body as it lies when a stack of height ``top`` is turned over (in z alone: seen from below as from above)."""
    return replace(body, z=round(top - body.z - body.thickness, 6))


def _deck_steps(bodies: Sequence[Body], process: Process, deck: Deck) -> list[AssemblyStep]:
    """The steps of one deck, its base lowest."""
    top = max(body.z + body.thickness for body in bodies if body.kind is BodyKind.COVER)
    hanging = [body for body in bodies if body.kind is BodyKind.POST and abs(body.z + body.thickness - top) < 1e-6]
    last = {body.name for body in hanging}
    rest = [body for body in bodies if body.name not in last]
    steps: list[AssemblyStep] = []
    placed: set[str] = set()
    for plate in process.stack.plates:
        if deck_of_plate(plate.name) is not Deck.LOWER:
            continue
        bottom = process.z_of(plate.name)
        mine = [body for body in rest if body.name not in placed and body.z < bottom + plate.thickness / 2.0]
        # what lies under the plate, then the plate, then the pins that stand in it
        mine.sort(key=lambda body: (body.kind in STOCK, body.z))
        placed |= {body.name for body in mine}
        if mine:
            steps.append(AssemblyStep(_OF_ROLE[plate.role], plate_in(deck, plate.name), tuple(mine), deck))
    if hanging:
        steps.append(AssemblyStep(StepKind.POSTS, None, tuple(hanging), deck))
    return steps
