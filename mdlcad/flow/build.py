"""Run the pipeline into a folder that is whole or is not there."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from mdlcad import __version__
from mdlcad.artefact import checksum, load, to_json, write_atomic
from mdlcad.errors import InputError, SignoffError, UsageError
from mdlcad.flow.folder import REPORT, new_folder
from mdlcad.flow.plans import steps_with
from mdlcad.flow.result import make_report
from mdlcad.flow.state import Job, State
from mdlcad.flow.steps import STEPS, Step
from mdlcad.language import Device, anchored
from mdlcad.mapping import CELLS_FILE, Library, MappingRequest, load_library, recorded_library
from mdlcad.mechanics import Sizing, load_process
from mdlcad.network.model import Network
from mdlcad.placement.placement import Placement
from mdlcad.proof.outcome import Proof
from mdlcad.report.page import write_page
from mdlcad.report.report import StageRecord, Stopped
from mdlcad.routing.driver import SMALLEST, Size
from mdlcad.routing.layout import Layout
from mdlcad.synthesis.netlist import Netlist

# What ``--from`` can take from a folder instead of making it.
_LOADED: dict[str, type] = {
    "device": Device,
    "netlist": Netlist,
    "network": Network,
    "proof": Proof,
    "sizing": Sizing,
    "placement": Placement,
    "layout": Layout,
}


@dataclass(frozen=True, slots=True)
class Request:
    """A build as the command line asks for it; ``first`` and ``last`` are names of steps.

    Attributes:
        cells: name or path of the cell library; None for the default, or with ``first`` the one in the folder.
    """

    source: Path
    place: Path | None
    cells: str | None
    mapping: MappingRequest
    process: str
    seed: int
    first: str | None
    last: str | None
    workers: int
    size: Size = SMALLEST


def build(request: Request, say: Callable[[str], None]) -> tuple[Path, list[str]]:
    """Build into a folder; the folder, and what does not hold in it, in words (empty: all holds).

    A build whose network or layout does not hold ends there; the folder keeps what was made, and its report says why.

    Raises:
        InputError, UsageError: the program or the request cannot be used; nothing was written.
    """
    _chosen(STEPS, request.first, request.last)
    library, process = _library(request), load_process(request.process)
    steps, loaded = _chosen(steps_with(library, request.last), request.first, request.last)
    if request.cells is not None and any(step.name == "network" for step in loaded):
        raise UsageError(
            f"--cells {request.cells}: the network is taken from the folder; leave it out, or start earlier"
        )
    state = State()
    source: Path | None = request.source
    if loaded:
        state = _load(request.source, loaded)
        source = None
        place = request.place or request.source
    else:
        place = request.place or Path("exports") / _design_name(request.source)
    records: list[StageRecord] = []
    stopped: Stopped | None = None
    with new_folder(place) as folder:
        job = Job(source, library, process, request.seed, folder, request.workers, request.size)
        # what the build leans on goes with it, so that it can be signed off again elsewhere
        write_atomic(folder / "process.json", to_json(process))
        write_atomic(folder / CELLS_FILE, to_json(library))
        for step in loaded:
            if step.artefact is not None:
                data = step.artefact(state)
                write_atomic(folder / f"{step.name}.json", data)
                records.append(StageRecord(step.name, 0.0, checksum(data)))
            step.draw(job, state)
            stopped = stopped or _objection(step, state)
        for step in steps:
            if stopped is not None:
                break
            try:
                state, record = _run(step, job, state, say)
            except SignoffError as problem:
                stopped = _stopped(step, problem, folder)
                break
            records.append(record)
            stopped = _objection(step, state)
        report = make_report(state, job, tuple(records), stopped, __version__)
        write_atomic(folder / REPORT, to_json(report))
        write_page(folder)
    return place, list(report.failures)


def _stopped(step: Step, problem: SignoffError, folder: Path) -> Stopped:
    """Why the build ends at ``step``; the picture of it, if there is one, is kept in the folder."""
    if problem.picture is None:
        return Stopped(step.name, str(problem))
    write_atomic(folder / problem.picture.name, problem.picture.data)
    return Stopped(step.name, f"{problem}; {problem.picture.name} shows where")


def _objection(step: Step, state: State) -> Stopped | None:
    reason = step.objection(state)
    return None if reason is None else Stopped(step.name, reason)


def _design_name(source: Path) -> str:
    from mdlcad.language import read_device

    return read_device(source).name


def _library(request: Request) -> Library:
    """The library asked for; of a build that starts from a folder, the folder's own if none is."""
    if request.first is None:
        return load_library(request.cells or "parametron", request.mapping)
    if request.cells is not None:
        return load_library(request.cells, request.mapping)
    for option in request.mapping.stated():
        raise UsageError(f"{option}: say of which library, with --cells; or build from the program, without --from")
    if not request.source.is_dir():
        raise UsageError(f"{request.source}: no such build folder; --from needs one")
    return recorded_library(request.source)


def _chosen(plan: tuple[Step, ...], first: str | None, last: str | None) -> tuple[tuple[Step, ...], tuple[Step, ...]]:
    """The steps of ``plan`` to run and the steps whose artefacts are loaded instead."""
    names = [step.name for step in plan]
    for flag, name in (("--from", first), ("--to", last)):
        if name is not None and name not in names:
            raise UsageError(f"{flag} {name}: no such stage; the stages are {', '.join(names)}")
    start = names.index(first) if first else 0
    stop = names.index(last) + 1 if last else len(plan)
    if start >= stop:
        raise UsageError(f"--from {first} comes after --to {last}: nothing to do")
    for step in plan[:start]:
        if step.name not in _LOADED:
            latest = [name for name in names if name in _LOADED][-1]
            raise UsageError(f"--from {first}: a build can start again from any stage up to the one after {latest}")
    if first and not set(plan[start].needs) <= set(names[:start]):
        before = names[start - 1]
        raise UsageError(f"--from {first}: is made together with {before}; start from {before}, or after {first}")
    return plan[start:stop], plan[:start]


def _load(folder: Path, steps: tuple[Step, ...]) -> State:
    if not folder.is_dir():
        raise UsageError(f"{folder}: no such build folder; --from needs one")
    return replace(State(), **{step.name: load(folder, f"{step.name}.json", _LOADED[step.name]) for step in steps})


def _run(step: Step, job: Job, state: State, say: Callable[[str], None]) -> tuple[State, StageRecord]:
    began = time.perf_counter()

    def progress(words: str) -> None:
        if sys.stderr.isatty():
            sys.stderr.write(f"\r\033[K  {step.name}: {words}")
            sys.stderr.flush()

    progress("...")
    before = set(state.files)
    try:
        state = step.run(job, state, progress)
    except InputError as problem:
        raise (problem if job.source is None else anchored(problem, job.source)) from None
    finally:
        if sys.stderr.isatty():
            sys.stderr.write("\r\033[K")
    if step.artefact is not None:
        data = step.artefact(state)
        digest = checksum(data)
        write_atomic(job.folder / f"{step.name}.json", data)
        step.draw(job, state)
    else:
        fresh = sorted(set(state.files) - before)
        digest = checksum("".join(f"{name} {checksum((job.folder / name).read_bytes())}\n" for name in fresh).encode())
    seconds = time.perf_counter() - began
    say(f"{step.name:<11} {step.summary(state):<78} {seconds:7.2f} s  {digest[:12]}")
    return state, StageRecord(step.name, round(seconds, 3), digest)
