"""Diagnostics at places in a device's Verilog."""

from __future__ import annotations

import re

from mdlcad.errors import Diagnostic
from mdlcad.language.device import Device


def locate(device: Device, pattern: str, message: str, hint: str = "") -> Diagnostic:
    """A diagnostic at the first match of ``pattern`` in the Verilog, or at its first line of text."""
    match = re.search(pattern, device.verilog) or re.search(r"\S", device.verilog)
    at = match.start() if match else 0
    line = device.verilog.count("\n", 0, at) + 1
    column = at - (device.verilog.rfind("\n", 0, at) + 1) + 1
    return diagnostic(device, line, column, message, hint)


def diagnostic(device: Device, line: int, column: int, message: str, hint: str = "") -> Diagnostic:
    """A diagnostic at a line and column of the program."""
    lines = device.verilog.split("\n")
    excerpt = lines[line - 1] if 0 < line <= len(lines) else ""
    # one column a character, so that the caret stands right under tabs too
    excerpt = "".join(char if char.isprintable() else " " for char in excerpt)
    return Diagnostic(device.file, line, column, message, hint, excerpt.rstrip())


def source_position(src: str) -> tuple[int, int] | None:
    """Line and column of the first place in a ``src`` attribute of Yosys."""
    match = re.match(r"program\.v:(\d+)\.(\d+)", src)
    return (int(match[1]), int(match[2])) if match else None
