"""The order in which a device is put together: plate on plate from the base up, every part straight down to its place.

Pins stand in the lowest plate that they join and go in with it. Posts that hang in the cover go in last, from above,
each through its hole in the cover and the eye that turns on it; the screws go after them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

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
    """One step: the plate that is laid (None for posts and screws), and its bodies in the order they go in."""

    kind: StepKind
    plate: str | None
    bodies: tuple[Body, ...]


def assembly_of(bodies: Sequence[Body], process: Process) -> tuple[AssemblyStep, ...]:
    """The steps; every body is in exactly one."""
    top = max(body.z + body.thickness for body in bodies)
    screws = [body for body in bodies if body.kind is BodyKind.SCREW]
    hanging = [body for body in bodies if body.kind is BodyKind.POST and body.z + body.thickness > top - 1e-6]
    last = {body.name for body in (*screws, *hanging)}
    rest = [body for body in bodies if body.name not in last]
    steps: list[AssemblyStep] = []
    placed: set[str] = set()
    for plate in process.stack.plates:
        bottom = process.z_of(plate.name)
        mine = [body for body in rest if body.name not in placed and body.z < bottom + plate.thickness / 2.0]
        # what lies under the plate, then the plate, then the pins that stand in it
        mine.sort(key=lambda body: (body.kind in STOCK, body.z))
        placed |= {body.name for body in mine}
        if mine:
            steps.append(AssemblyStep(_OF_ROLE[plate.role], plate.name, tuple(mine)))
    for kind, group in ((StepKind.POSTS, hanging), (StepKind.SCREWS, screws)):
        if group:
            steps.append(AssemblyStep(kind, None, tuple(group)))
    return tuple(steps)
