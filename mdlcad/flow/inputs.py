"""What a step's result depends on, as a digest: equal digests, equal results.

A digest is over the bytes of the artefacts that the step needs, the settings it reads, and what makes the result of
them: this package's files and the versions of the libraries it calls. The package's files stand for its version, so
that whoever works on a checkout never gets what older code made.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Mapping
from functools import cache
from importlib import metadata
from pathlib import Path

import mdlcad
from mdlcad.artefact import checksum, to_json
from mdlcad.flow.state import Job, State
from mdlcad.flow.step import Step
from mdlcad.parts.store import records_of

_SETTINGS: dict[str, Callable[[Job], bytes]] = {
    # the name of the program's file goes into its artefact
    "source": lambda job: _program(job.source) if job.source else b"",
    "cells": lambda job: to_json(job.cells),
    "process": lambda job: to_json(job.process),
    "seed": lambda job: to_json(job.seed),
    "kerf_mm": lambda job: to_json(job.kerf_mm),
    "size": lambda job: to_json(job.size),
    "placer": lambda job: to_json([job.placer.name, job.placer]),
    "seeds": lambda job: to_json(job.seeds),
    "like": lambda job: to_json(job.like and job.like.checksum),
}
"""What a step may read of a ``Job`` beside the folder and the number of workers, which change no result."""


def _program(source: Path) -> bytes:
    try:
        return source.name.encode() + b"\0" + source.read_bytes()
    except OSError:
        return b""  # the step that reads it says what is wrong with it


def digests_of(fields: tuple[str, ...], state: State, folder: Path) -> dict[str, str]:
    """SHA-256 by name of fields of ``state``; of files, of their names and contents in ``folder``."""
    return {field: checksum(_bytes(field, state, folder)) for field in fields}


def _bytes(field: str, state: State, folder: Path) -> bytes:
    if field == "bodies":
        return to_json(records_of(state.bodies or ()))
    if field in ("guide", "files", "pictures"):
        names: tuple[str, ...] = getattr(state, field)
        return "".join(f"{name} {checksum((folder / name).read_bytes())}\n" for name in names).encode()
    return to_json(getattr(state, field))


def inputs_of(step: Step, job: Job, made: Mapping[str, str]) -> str:
    """The digest of everything that ``step`` would run on.

    Args:
        made: SHA-256 of the fields of the state so far.
    """
    lines = [f"step {step.name}", f"code {_code()}"]
    lines += [f"setting {name} {checksum(_SETTINGS[name](job))}" for name in step.reads]
    lines += [f"artefact {name} {made[name]}" for name in step.needs]
    return checksum("\n".join(lines).encode())


@cache
def _code() -> str:
    """SHA-256 over the files of this package and the versions of what it is built on."""
    root = Path(mdlcad.__file__).parent
    whole = hashlib.sha256(mdlcad.__version__.encode())
    for path in sorted(root.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            whole.update(path.relative_to(root).as_posix().encode() + b"\0" + path.read_bytes())
    try:
        asked = metadata.requires("mdlcad") or []
    except metadata.PackageNotFoundError:  # run from a checkout that is not installed
        asked = []
    for requirement in asked:
        name, extra = re.match(r"[\w.-]+", requirement), "extra ==" in requirement
        if name is not None and not extra:
            whole.update(f"{name[0]} {metadata.version(name[0])}\n".encode())
    return whole.hexdigest()
