"""Which steps a build takes: as far as its cell library has parts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from mdlcad.artefact import to_json
from mdlcad.errors import SignoffError, UsageError
from mdlcad.flow.state import Job, State, need
from mdlcad.flow.steps import STEPS, Step, draw_placement, port_places
from mdlcad.mapping import Library
from mdlcad.mapping.two_phase import TwoPhaseLibrary
from mdlcad.placement.points import check_points, place_points


def _place(job: Job, state: State, progress: Callable[[str], None]) -> State:
    device, network = need(state.device), need(state.network)
    boundary = tuple(line.start for line in device.boundary)
    placement = place_points(network, boundary, port_places(device), job.seed)
    found = check_points(network, placement)
    if found:
        raise SignoffError("; ".join(found[:3]))
    return replace(state, placement=placement)


POINT_STEPS: tuple[Step, ...] = (
    *(step for step in STEPS if step.name in ("device", "netlist", "network", "proof")),
    Step(
        "placement",
        ("device", "network"),
        ("placement",),
        _place,
        lambda s: f"{len(need(s.placement).masses)} masses on {len(need(s.placement).slots)} places, sizes still open",
        lambda s: to_json(s.placement),
        draw_placement,
    ),
)
"""The steps with a library whose springs have no parts yet: masses are placed as points."""


def steps_with(library: Library, last: str | None) -> tuple[Step, ...]:
    """The steps of a build with ``library`` that is to go as far as the step ``last`` (None: as far as there is).

    Raises:
        UsageError: the library has no parts for what comes before ``last``; says how far it goes.
    """
    if not isinstance(library, TwoPhaseLibrary):
        return STEPS
    if last is None or last in {step.name for step in STEPS} - {step.name for step in POINT_STEPS}:
        raise UsageError(
            f"the cell library {library.name} couples masses by springs that the power clock switches, and latches by "
            "springs that multiply; there are no parts for either yet, and a whole build would have to leave them "
            "out. Build with --to placement (the proved network, placed and drawn), or with --cells parametron"
        )
    return POINT_STEPS
