"""Starts the Yosys worker and turns what Yosys says into diagnostics at the program's own lines and columns."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mdlcad.errors import Diagnostic, InputError
from mdlcad.language.device import Device

TIMEOUT_SECONDS = 300.0

_FORBIDDEN = re.compile(
    r"`\s*include\b|\$(?:readmem[bh]|writemem[bh]|fopen|fclose|fdisplay[bho]?|fwrite[bho]?|fstrobe|fmonitor|fscanf|"
    r"fgets|fgetc|fread|fflush|dumpfile|dumpvars|system|value\$plusargs|test\$plusargs)(?![\w$])|\bimport\b|\bbind\b"
)
_LOCATED = re.compile(r"^program\.v:(\d+)(?:\.(\d+))?(?:-[\d.]+)?: (ERROR|Warning): (.*)$", re.M)
_ERROR = re.compile(r"^ERROR: (.*)$", re.M)
_UNUSED = re.compile(r"^Removing unused module `\\(.*)'\.$", re.M)
_CHECK = re.compile(
    r"^Warning: (Wire .* is used but has no driver|multiple conflicting drivers for .*|.*found logic loop.*)", re.M
)
# Warnings that Yosys survives but that never mean what the author wanted.
_FATAL_WARNINGS = ("is implicitly declared", "out of bounds", "Range select")


@dataclass(frozen=True, slots=True)
class YosysRun:
    """One run, as far as it came.

    Attributes:
        raw, reference, netlist: the JSON designs (see ``worker``); the last two are empty if there was trouble.
        unused_modules: modules that were left out as unused.
        trouble: what Yosys had to say against the program.
    """

    raw: dict[str, Any]
    reference: dict[str, Any]
    netlist: dict[str, Any]
    unused_modules: tuple[str, ...]
    trouble: tuple[Diagnostic, ...]


def run_yosys(device: Device) -> YosysRun:
    """Elaborate ``device.verilog``.

    The text is the user's: it cannot include or open files, and Yosys works in an empty temporary folder.

    Raises:
        InputError: the Verilog is so wrong that there is no design to check, at its line and column in the file.
    """
    _refuse_files(device)
    worker = Path(__file__).with_name("worker.py")
    with tempfile.TemporaryDirectory(prefix="mdlcad-") as folder:
        try:
            done = subprocess.run(
                [sys.executable, "-P", str(worker)],
                # one byte a character, so that the columns of Yosys are ours
                input=device.verilog.encode("ascii", "replace").decode("ascii"),
                capture_output=True,
                text=True,
                encoding="utf-8",
                errors="replace",
                cwd=folder,
                env={**os.environ, "YOSYS_MAX_THREADS": "1"},
                timeout=TIMEOUT_SECONDS,
                check=False,
            )
        except subprocess.TimeoutExpired:
            raise InputError(
                [
                    locate(
                        device,
                        r"\bmodule\b",
                        "the behaviour takes too long to elaborate",
                        "make loops and vectors smaller",
                    )
                ]
            ) from None
        found = _diagnostics(device, done.stdout + "\n" + done.stderr, done.returncode)
        path = Path(folder)
        raw = path / "raw.json"
        if not raw.exists():
            raise InputError(found)
        names = () if found else ("reference", "netlist")
        designs = {name: json.loads((path / f"{name}.json").read_bytes()) for name in names}
        return YosysRun(
            json.loads(raw.read_bytes()),
            designs.get("reference", {}),
            designs.get("netlist", {}),
            tuple(sorted(_UNUSED.findall(done.stdout))),
            tuple(found),
        )


def locate(device: Device, pattern: str, message: str, hint: str = "") -> Diagnostic:
    """A diagnostic at the first match of ``pattern`` in the Verilog, or at its first line of text."""
    match = re.search(pattern, device.verilog) or re.search(r"\S", device.verilog)
    at = match.start() if match else 0
    line = device.verilog.count("\n", 0, at) + 1
    column = at - (device.verilog.rfind("\n", 0, at) + 1) + 1
    return diagnostic(device, line, column, message, hint)


def diagnostic(device: Device, line: int, column: int | None, message: str, hint: str = "") -> Diagnostic:
    """A diagnostic at a line of the program; without a column, at the line's first word."""
    lines = device.verilog.splitlines()
    excerpt = lines[line - 1] if 0 < line <= len(lines) else ""
    if column is None:
        column = len(excerpt) - len(excerpt.lstrip()) + 1
    return Diagnostic(device.file, line, column, message, hint, excerpt.rstrip())


def source_position(src: str) -> tuple[int, int] | None:
    """Line and column of the first place in a ``src`` attribute of Yosys."""
    match = re.match(r"program\.v:(\d+)\.(\d+)", src)
    return (int(match[1]), int(match[2])) if match else None


def _refuse_files(device: Device) -> None:
    text = re.sub(
        r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"", lambda m: re.sub(r"[^\n]", " ", m[0]), device.verilog, flags=re.S
    )
    found = []
    for match in _FORBIDDEN.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        column = match.start() - (text.rfind("\n", 0, match.start()) + 1) + 1
        found.append(
            diagnostic(
                device,
                line,
                column,
                f"'{match[0]}' is not allowed in a behaviour",
                "a device is one file and cannot open others; remove it",
            )
        )
    if found:
        raise InputError(found)


def _diagnostics(device: Device, log: str, code: int) -> list[Diagnostic]:
    found = []
    for line, column, severity, text in _LOCATED.findall(log):
        if severity == "ERROR" or any(word in text for word in _FATAL_WARNINGS):
            hint = "declare it" if "implicitly declared" in text else ""
            found.append(diagnostic(device, int(line), int(column) if column else None, _plain(text), hint))
    for text in _CHECK.findall(log):
        found.append(_from_check(device, text))
    if code and not found:
        texts = [text for text in _ERROR.findall(log) if not text.startswith("Assert")]
        texts = texts or ["the behaviour uses something that cannot be turned into gates"]
        names = re.search(r"cell `\\?([^']*)'", texts[0]) or re.search(r"`\\?([^']*)'", texts[0])
        pattern = rf"\b{re.escape(names[1])}\b" if names else r"\bmodule\b"
        found.append(locate(device, pattern, _plain(texts[0])))
    return sorted(set(found))


def _from_check(device: Device, text: str) -> Diagnostic:
    name = re.search(r"\\?([A-Za-z_]\w*)(?: \[\d+\])? is used", text)
    if name:
        return locate(
            device,
            rf"\b{name[1]}\b",
            f"'{name[1]}' is read but never given a value",
            "assign it, or remove what reads it",
        )
    name = re.search(r"drivers for (?:.*?\.)?\\?([A-Za-z_]\w*)", text)
    if name:
        return locate(
            device,
            rf"\b{name[1]}\b",
            f"'{name[1]}' is driven from several places",
            "assign it in one always block or one assign",
        )
    return locate(
        device,
        r"\balways\b|\bassign\b",
        "the logic feeds back on itself without a register",
        "break the loop with a register clocked by clk",
    )


def _plain(text: str) -> str:
    return text.replace("`\\", "'").replace("`", "'").rstrip(".")
