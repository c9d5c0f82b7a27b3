"""What every stage hands on: typed, frozen, and written as canonical JSON.

An artefact is a frozen dataclass. Its JSON form is canonical (keys in the order of the class, floats in
Python's shortest form, two-space indent, one newline at the end), so equal artefacts are equal bytes and
the checksum of a stage is the SHA-256 of those bytes.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from mdlcad.errors import UsageError

T = TypeVar("T")


class ShapeError(UsageError):
    """A file of a build is whole JSON, but not of the shape that this version gives it."""


def to_json(artefact: Any) -> bytes:
    """Canonical JSON bytes of a dataclass, list or dict artefact."""
    return msgspec.json.format(msgspec.json.encode(artefact), indent=2) + b"\n"


def from_json(data: bytes, kind: type[T]) -> T:
    """Decode and validate ``data`` as ``kind``.

    Raises:
        msgspec.ValidationError: the JSON does not have the shape of ``kind``.
        msgspec.DecodeError: the bytes are not JSON.
    """
    return msgspec.json.decode(data, type=kind)


def load(folder: Path, name: str, kind: type[T]) -> T:
    """The artefact ``name`` (a file name) of a build folder.

    Raises:
        ShapeError: it is JSON, but not of the shape of ``kind``.
        UsageError: the file is missing or truncated. Either message names it.
    """
    path = folder / name
    try:
        return from_json(path.read_bytes(), kind)
    except FileNotFoundError:
        raise UsageError(f"{path}: is missing from the build; build it again") from None
    except IsADirectoryError:
        raise UsageError(f"{path}: is a folder where a file should be; build it again") from None
    except OSError as problem:
        raise UsageError(f"{path}: cannot be read: {problem.strerror}") from None
    except msgspec.ValidationError as problem:
        raise ShapeError(f"{path}: does not have the shape of this artefact ({problem}); build it again") from None
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as problem:
        raise UsageError(f"{path}: is not whole JSON ({problem}); build it again") from None


def checksum(data: bytes) -> str:
    """SHA-256 of ``data`` in hexadecimal."""
    return hashlib.sha256(data).hexdigest()


def write_atomic(path: Path, data: bytes) -> None:
    """Write beside ``path`` and rename, so that a reader sees the old file or the new one, never a part.

    If it cannot be written (OSError), nothing is left.
    """
    partial = path.with_name(path.name + ".partial")
    try:
        with partial.open("wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        partial.replace(path)
    except OSError:
        with contextlib.suppress(OSError):
            partial.unlink()
        raise
