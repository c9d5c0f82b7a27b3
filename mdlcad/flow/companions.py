"""Steps run beside others, in processes of their own; their results are taken when their turn comes."""

from __future__ import annotations

import shutil
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import TracebackType

from mdlcad.aside import Aside
from mdlcad.flow.state import Job, State, narrowed
from mdlcad.flow.step import Step


@dataclass(frozen=True, slots=True)
class _Begun:
    """A step under way, and the folder that it writes to."""

    aside: Aside[tuple[State, float]]
    place: Path


class Companions:
    """The steps under way beside others; leaving its context ends those whose turn did not come."""

    def __init__(self) -> None:
        self._begun: dict[str, _Begun] = {}

    def __enter__(self) -> Companions:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        for begun in self._begun.values():
            begun.aside.stop()
            shutil.rmtree(begun.place, ignore_errors=True)

    def begin(self, steps: Sequence[Step], job: Job, state: State) -> None:
        """Begin ``steps``, if there is more than one processor."""
        for step in steps if job.workers > 1 else ():
            # what it writes is nothing to the steps before it
            place = hidden(job.folder, step)
            place.mkdir()
            own = replace(job, folder=place, workers=1)
            aside = Aside(_perform, step.name, own, narrowed(state, (*step.needs, *step.told)))
            self._begun[step.name] = _Begun(aside, place)

    def take(self, step: Step, job: Job) -> tuple[State, float] | None:
        """What ``step`` made, and in how many seconds, with its files in the job's folder; None if it was not begun.

        Raises:
            as the step.
        """
        begun = self._begun.get(step.name)
        if begun is None:
            return None
        found = begun.aside.result()
        for path in sorted(path for path in begun.place.rglob("*") if path.is_file()):
            target = job.folder / path.relative_to(begun.place)
            target.parent.mkdir(parents=True, exist_ok=True)
            path.replace(target)
        return found


def hidden(folder: Path, step: Step) -> Path:
    """Where in a build folder ``step`` writes until its turn."""
    return folder / f".{step.name}"


def _perform(name: str, job: Job, state: State) -> tuple[State, float]:
    from mdlcad.flow.steps import STEPS  # a step cannot be sent to another process, its name can

    began = time.perf_counter()
    step = next(step for step in STEPS if step.name == name)
    made = step.run(job, state, lambda words: None)
    return narrowed(made, step.makes), time.perf_counter() - began
