"""Findings of later stages, about a device, put back into the file that the user gave."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from mdlcad.errors import Diagnostic, InputError
from mdlcad.language.device import Where
from mdlcad.language.source import read_source


def anchored(problem: InputError, path: Path) -> InputError:
    """The same findings with the path as the user wrote it, and the line of the file that each is about."""
    return InputError(placed(problem.diagnostics, path))


def placed(found: Sequence[Diagnostic], path: Path) -> list[Diagnostic]:
    """The same findings with the path as the user wrote it, and the line of the file that each is about.

    A device knows its file's name alone, and of its text only the Verilog.
    """
    try:
        source = read_source(path)
    except InputError:
        return list(found)
    lines = len(source.starts)
    return [
        replace(source.error(Where(item.line, item.column), item.message, item.hint), severity=item.severity)
        if item.file == path.name and item.line <= lines
        else item
        for item in found
    ]
