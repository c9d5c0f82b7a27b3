"""A step of the pipeline: what it needs, makes and reads, how it runs, and how its result is taken from a folder."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from mdlcad.artefact import load
from mdlcad.flow.state import Job, State

Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Step:
    """One step.

    Attributes:
        name: what ``--from`` and ``--to`` call it, and the stem of its artefact.
        needs, makes: fields of ``State``; it sees no others, and what it makes depends on no others.
        reads: fields of ``Job`` that what it makes depends on.
        told: fields of ``State`` that it sees for the words and places of its errors alone.
        run: does it. Raises InputError or UsageError for bad input, SignoffError if what it made does not hold.
        summary: one line about what came out.
        artefact: the bytes of what it made, kept as NAME.json; None if it made files of its own.
        restore: the state with what it makes, from the files that it once wrote (all of them are in the job's folder).
        draw: writes what belongs beside that artefact, whether it was made or taken from a folder.
        beside: the step, before it in the list, that it may run beside in a process of its own, as it needs nothing of
            that one or those between; it then sees none of the folder's files. "" for none.
        objection: why nothing can be made of what it made, in words with numbers; None if it may go on.
    """

    name: str
    needs: tuple[str, ...]
    makes: tuple[str, ...]
    run: Callable[[Job, State, Progress], State]
    summary: Callable[[State], str]
    artefact: Callable[[State], bytes] | None
    restore: Callable[[Job, State, tuple[str, ...]], State]
    reads: tuple[str, ...] = ()
    told: tuple[str, ...] = ()
    draw: Callable[[Job, State], None] = lambda job, state: None
    beside: str = ""
    objection: Callable[[State], str | None] = lambda state: None


def from_artefact(field: str, kind: type, name: str = "") -> Callable[[Job, State, tuple[str, ...]], State]:
    """Restores ``field`` of a state from the artefact of that name (by default, the field's)."""

    def restore(job: Job, state: State, files: tuple[str, ...]) -> State:
        return replace(state, **{field: load(job.folder, f"{name or field}.json", kind)})

    return restore


def check_order(steps: Sequence[Step]) -> None:
    """Every step's needs are made before it.

    Raises:
        ValueError: names the step and what it lacks.
    """
    made: set[str] = set()
    before: dict[str, set[str]] = {}
    for step in steps:
        before[step.name] = set(made)
        lacking = {*step.needs, *step.told} - (before.get(step.beside, set()) if step.beside else made)
        if lacking:
            raise ValueError(f"step {step.name} needs {sorted(lacking)}, which no earlier step makes")
        made |= set(step.makes)
