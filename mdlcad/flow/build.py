"""Run the pipeline into a folder that is whole or is not there."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import msgspec

from mdlcad import __version__
from mdlcad.artefact import checksum, to_json, write_atomic
from mdlcad.errors import InputError, SignoffError, UsageError
from mdlcad.flow.companions import Companions
from mdlcad.flow.earlier import load_earlier
from mdlcad.flow.folder import REPORT, new_folder, resting_place
from mdlcad.flow.inputs import digests_of, inputs_of
from mdlcad.flow.kept import Reuse, Standing, standing_build
from mdlcad.flow.plans import steps_with
from mdlcad.flow.result import make_report
from mdlcad.flow.state import Job, Outlines, State, joined, narrowed
from mdlcad.flow.step import Step
from mdlcad.flow.steps import STEPS
from mdlcad.language import anchored
from mdlcad.mapping import CELLS_FILE, Library, MappingRequest, load_library, recorded_library
from mdlcad.mechanics import load_process
from mdlcad.placement.placers import ANNEAL, Placer
from mdlcad.report.page import write_page
from mdlcad.report.report import Origin, StageRecord, Stopped
from mdlcad.routing.driver import SMALLEST, Size

# What ``--from`` can take from a folder instead of making it.
_LOADED = ("device", "netlist", "network", "proof", "sizing", "placement", "layout", "compensation")


@dataclass(frozen=True, slots=True)
class Request:
    """A build as the command line asks for it; ``first`` and ``last`` are names of steps.

    Attributes:
        cells: name or path of the cell library; None for the default, or with ``first`` the one in the folder.
        placer: decides who sits where. seeds: how many seeds placement tries, from ``seed`` on.
        like: folder of the build that this one is to be like.
        reuse: whether stages may be taken over from the build that now is where this one goes.
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
    outlines: Outlines = Outlines.AS_DESIGNED
    reuse: Reuse = Reuse.KEEP
    placer: Placer = ANNEAL
    seeds: int = 1
    like: Path | None = None


def build(request: Request, say: Callable[[str], None]) -> tuple[Path, list[str]]:
    """Build into a folder; the folder, and what does not hold in it, in words (empty: all holds).

    A build whose network or layout does not hold ends there; the folder keeps what was made, and its report says why.
    It never replaces a build that holds: it is then put beside it (``resting_place``).

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
    source = None if loaded else request.source
    place = request.place or (request.source if loaded else Path("exports") / _design_name(request.source))
    job = Job(
        source,
        library,
        process,
        request.seed,
        request.source,
        request.workers,
        request.size,
        request.outlines,
        request.placer,
        request.seeds,
        None if request.like is None else load_earlier(request.like, library, process),
    )
    states = _load(job, loaded)
    state = states[-1] if states else State()
    standing = standing_build(place, request.reuse)
    made: dict[str, str] = {}
    records: list[StageRecord] = []
    stopped: Stopped | None = None
    with new_folder(place) as folder:
        job = replace(job, folder=folder)
        # what the build leans on goes with it, so that it can be signed off again elsewhere
        write_atomic(folder / "process.json", to_json(process))
        write_atomic(folder / CELLS_FILE, to_json(library))
        # each as it was then: a later stage may make an artefact anew
        for step, before in zip(loaded, states, strict=True):
            records.append(_written(step, job, before))
            made |= digests_of(step.makes, before, folder)
            stopped = stopped or _objection(step, before)
        with Companions() as companions:
            for step in steps:
                if stopped is not None:
                    break
                inputs = inputs_of(step, job, made)
                try:
                    done = _kept(step, job, state, standing, inputs, say)
                    if done is None:
                        companions.begin(_beside(step, steps, job, made, standing), job, state)
                        done = _run(step, job, state, inputs, say, companions)
                    state, record = done
                except SignoffError as problem:
                    stopped = _stopped(step, problem, folder)
                    break
                records.append(record)
                made |= digests_of(step.makes, state, folder)
                stopped = _objection(step, state)
        report = make_report(state, job, tuple(records), stopped, __version__)
        write_atomic(folder / REPORT, to_json(report))
        write_page(folder)
        rest = resting_place(folder, place)
    if rest != place:
        say(f"{place} keeps the build that it has, which holds; this one does not, and is put beside it")
    return rest, list(report.failures)


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
            latest = names[max(names.index(name) for name in names if name in _LOADED) + 1]
            raise UsageError(f"--from {first}: starts too late; a build can start again from any stage up to {latest}")
    if first and not plan[start].makes:
        before = names[start - 1]
        raise UsageError(f"--from {first}: is made together with {before}; start from {before}, or after {first}")
    return plan[start:stop], plan[:start]


def _load(job: Job, steps: tuple[Step, ...]) -> list[State]:
    """The states that the artefacts in the job's folder make, after each of ``steps``."""
    if steps and not job.folder.is_dir():
        raise UsageError(f"{job.folder}: no such build folder; --from needs one")
    states: list[State] = []
    for step in steps:
        states.append(step.restore(job, states[-1] if states else State(), ()))
    return states


def _written(step: Step, job: Job, state: State) -> StageRecord:
    """The artefact of a loaded step, written again."""
    before = _listing(job.folder)
    digest = _write(step, job, state)
    return StageRecord(step.name, 0.0, digest, "", _fresh(job.folder, before), Origin.LOADED)


def _kept(
    step: Step, job: Job, state: State, standing: Standing | None, inputs: str, say: Callable[[str], None]
) -> tuple[State, StageRecord] | None:
    """The state with what ``step`` made in the standing build; None if that ran on other inputs or is not whole."""
    began = time.perf_counter()
    old = None if standing is None else standing.copy(step.name, inputs, job.folder)
    if old is None:
        return None
    try:
        result = step.restore(job, narrowed(state, (*step.needs, *step.told)), old.files)
    except (UsageError, msgspec.ValidationError):
        # the report vouches for files that no build writes: someone edited both
        for file in old.files:
            (job.folder / file).unlink()
        return None
    state = joined(state, result, step.makes)
    record = replace(old, seconds=round(time.perf_counter() - began, 3), origin=Origin.KEPT)
    _tell(step, state, record, say)
    return state, record


def _beside(
    step: Step, steps: Sequence[Step], job: Job, made: Mapping[str, str], standing: Standing | None
) -> list[Step]:
    """The steps that may run beside ``step`` and cannot be taken over from the standing build."""
    later = (other for other in steps if other.beside == step.name)
    old = {} if standing is None else {name: record.inputs for name, record in standing.stages.items()}
    return [other for other in later if old.get(other.name) != inputs_of(other, job, made)]


def _run(
    step: Step, job: Job, state: State, inputs: str, say: Callable[[str], None], companions: Companions
) -> tuple[State, StageRecord]:
    began, before = time.perf_counter(), _listing(job.folder)

    def progress(words: str) -> None:
        if sys.stderr.isatty():
            sys.stderr.write(f"\r\033[K  {step.name}: {words}")
            sys.stderr.flush()

    progress("...")
    taken: tuple[State, float] | None = None
    try:
        taken = companions.take(step, job)
        result = taken[0] if taken else step.run(job, narrowed(state, (*step.needs, *step.told)), progress)
    except InputError as problem:
        raise (problem if job.source is None else anchored(problem, job.source)) from None
    finally:
        if sys.stderr.isatty():
            sys.stderr.write("\r\033[K")
    state = joined(state, result, step.makes)
    digest = _write(step, job, state)
    files = _fresh(job.folder, before)
    if step.artefact is None:
        lines = [f"{name} {checksum((job.folder / name).read_bytes())}\n" for name in files]
        digest = checksum("".join(lines).encode())
    seconds = taken[1] if taken else time.perf_counter() - began
    record = StageRecord(step.name, round(seconds, 3), digest, inputs, files)
    _tell(step, state, record, say)
    return state, record


def _write(step: Step, job: Job, state: State) -> str:
    """Write the step's artefact and what goes beside it; SHA-256 of the artefact ("" if it has none)."""
    data = step.artefact(state) if step.artefact is not None else None
    if data is not None:
        write_atomic(job.folder / f"{step.name}.json", data)
    step.draw(job, state)
    return "" if data is None else checksum(data)


def _tell(step: Step, state: State, record: StageRecord, say: Callable[[str], None]) -> None:
    kept = "  (kept)" if record.origin is Origin.KEPT else ""
    say(f"{step.name:<11} {step.summary(state):<78} {record.seconds:7.2f} s  {record.checksum[:12]}{kept}")


def _listing(folder: Path) -> frozenset[str]:
    """Paths of the files in ``folder``, relative to it (for membership only), but those of steps beside the others."""
    files = (path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    return frozenset(file.as_posix() for file in files if not file.parts[0].startswith("."))


def _fresh(folder: Path, before: frozenset[str]) -> tuple[str, ...]:
    return tuple(sorted(_listing(folder) - before))
