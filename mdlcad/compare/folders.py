"""Build folders as a comparison meets them: of any version, finished or not, perhaps edited, perhaps damaged."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import TypeVar

from mdlcad.artefact import ShapeError, checksum, load
from mdlcad.compare.facts import Facts
from mdlcad.errors import UsageError

T = TypeVar("T")
REPORT = "report.json"


class NotComparable(Exception):
    """A level has nothing to compare on one side, and that is as it should be (a build that was stopped before it).

    ``file`` is what it would have read.
    """

    def __init__(self, words: str, file: str) -> None:
        self.file = file
        super().__init__(words)


@dataclass(frozen=True, slots=True)
class Build:
    """A build folder.

    Attributes:
        facts: what its report says.
        hashes: SHA-256 of the files that the report vouches for, as they are now; sorted by path.
        missing: vouched for and not there.
    """

    folder: Path
    facts: Facts
    hashes: dict[str, str]
    missing: tuple[str, ...]
    label: str = field(default="")

    @property
    def edited(self) -> tuple[str, ...]:
        """Files that are not the ones the report vouches for."""
        return tuple(name for name, digest in self.hashes.items() if digest != self.facts.files[name])

    def has(self, name: str) -> bool:
        """The file is there."""
        return (self.folder / name).is_file()


def open_build(folder: Path) -> Build:
    """Read the report of a build and take the hashes of its files.

    Raises:
        UsageError: there is no such folder, or no readable report in it.
    """
    if not folder.is_dir():
        raise UsageError(f"{folder}: no such build folder")
    facts = load(folder, REPORT, Facts)
    hashes, missing = {}, []
    for name in sorted(facts.files):
        if PurePosixPath(name).is_absolute() or ".." in PurePosixPath(name).parts:
            raise UsageError(f"{folder / REPORT}: lists the file {name}, which is outside of the build")
        try:
            hashes[name] = checksum((folder / name).read_bytes())
        except OSError:
            missing.append(name)
    return Build(folder, facts, hashes, tuple(missing), folder.resolve().name)


def read(build: Build, name: str, kind: type[T]) -> T:
    """The artefact ``name`` of a build.

    Raises:
        NotComparable: the build was stopped before it was made, or another version wrote it in another shape.
        UsageError: it is missing, truncated or garbled; the message names it.
    """
    path = build.folder / name
    if not path.exists() and name not in build.facts.files:
        raise NotComparable(f"{build.label} has no {name}", name)
    try:
        return load(build.folder, name, kind)
    except ShapeError as problem:
        if build.hashes.get(name, "?") == build.facts.files.get(name):
            # nobody touched it, so it is whole: only its shape is not this version's
            raise NotComparable(
                f"{build.label}: {name} was written by another version ({build.facts.version or 'unknown'}) "
                "in a shape that this one does not read",
                name,
            ) from problem
        raise
