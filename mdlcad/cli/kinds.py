"""Kinds of argument, what every command says with, and what its exit code means."""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mdlcad.errors import Diagnostic

HOLDS, FAILS, UNUSABLE = 0, 1, 2

Commands = argparse._SubParsersAction  # the only name argparse gives what add_subparsers returns


def seed(text: str) -> int:
    """A seed."""
    if not text.isdecimal() or not 0 <= (value := int(text)) < 2**31:
        raise argparse.ArgumentTypeError("a seed is a whole number from 0 to 2147483647")
    return value


def length(text: str) -> float:
    """A length in mm."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < value < 1e5:
        raise argparse.ArgumentTypeError(f"{text!r} is not a length in mm")
    return value


def bed(text: str) -> tuple[float, float]:
    """A width and a height in mm, like 250x200."""
    width, cross, height = text.lower().partition("x")
    if not cross:
        raise argparse.ArgumentTypeError(f"{text!r} is not WxH in mm, like 250x200")
    return length(width), length(height)


def jobs(text: str) -> int:
    """A number of processors."""
    if not text.isdecimal() or (value := int(text)) < 1:
        raise argparse.ArgumentTypeError("a number of processors, 1 or more")
    return value


def count(text: str) -> int:
    """A number of times."""
    if not text.isdecimal() or not 1 <= (value := int(text)) <= 10**9:
        raise argparse.ArgumentTypeError("a whole number from 1 to 1000000000")
    return value


def say(line: str) -> None:
    """One line to the user, at once."""
    print(line, flush=True)


def warn(found: Sequence[Diagnostic]) -> None:
    """What is seldom meant in a user's file, though it can be used."""
    for item in found:
        print(item, file=sys.stderr)


def progress(words: str) -> None:
    """How far long work is, on one line that the next overwrites; nothing if nobody watches."""
    if sys.stderr.isatty():
        sys.stderr.write(f"\r\033[K  {words}" if words else "\r\033[K")
        sys.stderr.flush()


def show(artefact: object) -> None:
    """An artefact as its JSON."""
    from mdlcad.artefact import to_json

    sys.stdout.write(to_json(artefact).decode())


def write_output(path: Path, data: bytes) -> None:
    """A file that the user asked for.

    Raises:
        UsageError: it cannot be written there.
    """
    from mdlcad.artefact import write_atomic
    from mdlcad.errors import UsageError

    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomic(path, data)
    except OSError as problem:
        raise UsageError(f"{path}: cannot be written: {problem.strerror}") from None


def verdict(broken: list[str]) -> int:
    """Say what does not hold; the exit code."""
    for words in broken:
        print(f"mdlcad: does not hold: {words}", file=sys.stderr)
    return FAILS if broken else HOLDS
