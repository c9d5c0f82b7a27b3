"""Stages taken over from the build that stands where the new one goes, when nothing that they depend on has changed."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path, PurePosixPath

from mdlcad.artefact import checksum, load, write_atomic
from mdlcad.errors import UsageError
from mdlcad.flow.folder import REPORT
from mdlcad.report.report import Report, StageRecord


class Reuse(StrEnum):
    """Whether a build takes over what it can from the one before it in its place, or makes all of it anew."""

    KEEP = "keep"
    FRESH = "fresh"


@dataclass(frozen=True, slots=True)
class Standing:
    """The build in a place: its stages by name, and the SHA-256 of its files."""

    folder: Path
    stages: dict[str, StageRecord]
    files: dict[str, str]

    def copy(self, name: str, inputs: str, into: Path) -> StageRecord | None:
        """Copy the files of the stage ``name`` if it ran on ``inputs`` and every one is as it was written.

        Returns:
            the stage's record; None if there is nothing to take over (``into`` is then as it was).
        """
        record = self.stages.get(name)
        if record is None or record.inputs != inputs:
            return None
        found: dict[str, bytes] = {}
        for file in record.files:
            data = self._whole(file)
            if data is None:
                return None
            found[file] = data
        for file, data in found.items():
            (into / file).parent.mkdir(parents=True, exist_ok=True)
            write_atomic(into / file, data)
        return record

    def _whole(self, file: str) -> bytes | None:
        """A file's bytes; None if it is missing, changed, or not one of the build's."""
        path = PurePosixPath(file)
        if file not in self.files or path.is_absolute() or ".." in path.parts:
            return None
        try:
            data = (self.folder / file).read_bytes()
        except OSError:
            return None
        return data if checksum(data) == self.files[file] else None


def standing_build(place: Path, reuse: Reuse) -> Standing | None:
    """The build at ``place``; None if there is none, if its report cannot be read, or if all is to be made anew."""
    if reuse is Reuse.FRESH:
        return None
    try:
        report = load(place, REPORT, Report)
    except UsageError:
        return None
    return Standing(place, {record.name: record for record in report.stages}, report.files)
