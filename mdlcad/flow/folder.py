"""Build folders: filled beside their place, then moved there in one step."""

from __future__ import annotations

import ctypes
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from mdlcad.artefact import load
from mdlcad.errors import UsageError
from mdlcad.report.report import Report

REPORT = "report.json"
_AT_FDCWD = -100
_RENAME_EXCHANGE = 2


@contextmanager
def new_folder(place: Path) -> Iterator[Path]:
    """A fresh folder beside ``place``; when the block ends well it takes its ``resting_place``, else it is removed.

    Whoever looks at ``place``, also after a kill, sees the old folder or the new one, never a part. What a killed
    build left beside it is removed by the next.

    Raises:
        UsageError: ``place`` is something that must not be replaced (a file, or a folder that is no build), or no
            folder can be made there.
    """
    given, place = place, place.absolute()
    fresh = place.parent / f".{place.name}.building-{os.getpid()}"
    try:
        _refuse_what_is_no_build(place)
        place.parent.mkdir(parents=True, exist_ok=True)
        _remove_abandoned(place)
        shutil.rmtree(fresh, ignore_errors=True)
        fresh.mkdir()
    except OSError as problem:
        raise UsageError(f"{given}: no folder can be made there: {problem.strerror}; give another with -o") from problem
    try:
        yield fresh
        rest = resting_place(fresh, place)
        _refuse_what_is_no_build(rest)
        _take_place(fresh, rest)
    finally:
        shutil.rmtree(fresh, ignore_errors=True)


def resting_place(fresh: Path, place: Path) -> Path:
    """Where a finished build goes: ``place``, but if it does not hold and the one there does, NAME.failed beside it."""
    if not _holds(fresh) and _holds(place):
        return place.with_name(f"{place.name}.failed")
    return place


def _holds(folder: Path) -> bool:
    """Whether the folder has a build of which all that was asked for was made, and all that was checked holds."""
    try:
        report = load(folder, REPORT, Report)
    except UsageError:
        return False
    return report.stopped is None and not report.failures


def _refuse_what_is_no_build(place: Path) -> None:
    if place.exists() and not place.is_dir():
        raise UsageError(f"{place.name}: is a file; give a folder with -o")
    if place.is_symlink() and not place.exists():
        raise UsageError(f"{place.name}: is a link that leads nowhere; give a folder with -o, or remove it")
    if place.is_dir() and any(place.iterdir()) and not (place / REPORT).exists():
        raise UsageError(f"{place.name}: is a folder that holds no build; give another with -o, or empty it")


def _remove_abandoned(place: Path) -> None:
    for left in place.parent.glob(f".{place.name}.building-*"):
        owner = left.name.rpartition("-")[2]
        if owner.isdigit() and not Path(f"/proc/{owner}").exists():
            shutil.rmtree(left, ignore_errors=True)


def _take_place(fresh: Path, place: Path) -> None:
    if not place.exists():
        fresh.rename(place)
        return
    if _exchange(fresh, place):
        return  # the old folder is now where the fresh one was, and goes with it
    old = fresh.with_name(fresh.name + ".old")
    place.rename(old)
    fresh.rename(place)
    shutil.rmtree(old, ignore_errors=True)


def _exchange(a: Path, b: Path) -> bool:
    """Swap two folders in one system call; False where the system has no such call."""
    call = getattr(ctypes.CDLL(None, use_errno=True), "renameat2", None)
    if call is None:
        return False
    return bool(call(_AT_FDCWD, os.fsencode(a), _AT_FDCWD, os.fsencode(b), _RENAME_EXCHANGE) == 0)
