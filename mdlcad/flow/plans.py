"""Which steps a build takes: as far as its cell library has parts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from mdlcad.artefact import load, to_json
from mdlcad.errors import SignoffError, UsageError
from mdlcad.flow.device import SEARCH_FILE, draw_placement, how_placed
from mdlcad.flow.placing import Work, best_of
from mdlcad.flow.state import Job, State, need
from mdlcad.flow.step import Step
from mdlcad.flow.steps import STEPS
from mdlcad.mapping import Library
from mdlcad.mapping.two_phase import TwoPhaseLibrary
from mdlcad.placement.check_grid import check_grid
from mdlcad.placement.unit_grid import GridPlacement
from mdlcad.report.report import Search


def _place(job: Job, state: State, progress: Callable[[str], None]) -> State:
    network, boundary, ports = need(state.network), need(state.outline).boundary, need(state.outline).ports
    work = Work(network, boundary, ports, job.placer, None, job.size, job.like)
    best = best_of(work, job.seed, job.seeds, job.workers, progress)
    grid = best.result
    assert isinstance(grid, GridPlacement)
    found = check_grid(network, grid, boundary, ports)
    if found:
        raise SignoffError("; ".join(found[:3]))
    return replace(state, grid=grid, search=best.search)


def _words(state: State) -> str:
    grid = need(state.grid)
    worth = f"length {grid.length:.0f}, {grid.crossings} crossings"
    return f"{len(grid.masses)} masses on the grid, {worth}{how_placed(state)}"


def _restore(job: Job, state: State, files: tuple[str, ...]) -> State:
    grid, search = load(job.folder, "placement.json", GridPlacement), load(job.folder, SEARCH_FILE, Search)
    return replace(state, grid=grid, search=search)


GRID_STEPS: tuple[Step, ...] = (
    *(step for step in STEPS if step.name in ("device", "netlist", "network", "proof")),
    Step(
        "placement",
        ("outline", "network"),
        ("grid", "search"),
        _place,
        _words,
        lambda s: to_json(s.grid),
        _restore,
        ("seed", "placer", "seeds", "like"),
        draw=draw_placement,
    ),
)
"""The steps with a library whose springs have no parts yet: its masses are placed, without a size."""


def steps_with(library: Library, last: str | None) -> tuple[Step, ...]:
    """The steps of a build with ``library`` that is to go as far as the step ``last`` (None: as far as there is).

    Raises:
        UsageError: the library has no parts for what comes before ``last``; says how far it goes.
    """
    if not isinstance(library, TwoPhaseLibrary):
        return STEPS
    beyond = {step.name for step in STEPS} - {step.name for step in GRID_STEPS}
    if last is None or last in beyond:
        raise UsageError(
            f"the cell library {library.name} couples masses by springs that the power clock switches and opens "
            "latches by springs that multiply, for which there are no parts yet; a whole build would have to leave "
            f"them out. Build with --to {GRID_STEPS[-1].name}, or with --cells parametron"
        )
    return GRID_STEPS
