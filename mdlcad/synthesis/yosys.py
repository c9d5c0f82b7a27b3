"""Starts the Yosys worker and collects what it makes and says."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mdlcad.errors import Diagnostic, InputError
from mdlcad.language.device import Device
from mdlcad.synthesis.slang import SYNTAX_CODES, Finding, read_findings
from mdlcad.synthesis.spots import diagnostic, locate

# by the clock on the wall, for a machine that is busy; the worker limits its own processor time
TIMEOUT_SECONDS = 600.0

_FORBIDDEN = re.compile(
    r"`\s*include\b|\$(?:readmem[bh]|writemem[bh]|fopen|fclose|fdisplay[bho]?|fwrite[bho]?|fstrobe|fmonitor|fscanf|"
    r"fgets|fgetc|fread|fflush|dumpfile|dumpvars|system|value\$plusargs|test\$plusargs)(?![\w$])|\bimport\s*\"|\bbind\b"
)
_TOPS = re.compile(r"^Top level design units:\n((?:    .*\n)*)", re.M)
_LATEST, _VERILOG_2005 = "latest", "1364-2005"


@dataclass(frozen=True, slots=True)
class YosysRun:
    """One run, as far as it came.

    Attributes:
        raw, reference, netlist: the JSON designs (see ``worker``).
        tops: the modules that no other module uses.
        log: what Yosys said about the elaborated design.
        findings: what slang had to say against the program without giving up.
    """

    raw: dict[str, Any]
    reference: dict[str, Any]
    netlist: dict[str, Any]
    tops: tuple[str, ...]
    log: str
    findings: tuple[Finding, ...]


@dataclass(frozen=True, slots=True)
class _Outcome:
    """A finished worker: exit code (negative: the signal that ended it), log, slang's findings, the designs."""

    code: int
    log: str
    findings: tuple[Finding, ...]
    designs: dict[str, dict[str, Any]]


def run_yosys(device: Device) -> YosysRun:
    """Elaborate ``device.verilog``.

    The text is the user's: it cannot include or open files, and Yosys works in an empty temporary folder with limits on
    processor time and memory. Words that only SystemVerilog reserves may be names: a program that is wrong as
    SystemVerilog but right as Verilog-2005 is taken as the latter.

    Raises:
        InputError: the Verilog is so wrong that there is no design to check, at its line and column in the file.
    """
    _refuse_files(device)
    outcome = _run(device, _LATEST)
    if any(finding.fatal and finding.code in SYNTAX_CODES for finding in outcome.findings):
        older = _run(device, _VERILOG_2005)
        if "raw" in older.designs:
            outcome = older
    if "raw" not in outcome.designs:
        raise InputError(_why(device, outcome))
    if not outcome.designs["raw"]["modules"]:
        raise InputError([_no_top(device)])
    tops = _TOPS.search(outcome.log)
    return YosysRun(
        outcome.designs["raw"],
        outcome.designs.get("reference", {}),
        outcome.designs.get("netlist", {}),
        tuple(tops[1].split()) if tops else (),
        outcome.log,
        outcome.findings,
    )


def _run(device: Device, edition: str) -> _Outcome:
    worker = Path(__file__).with_name("worker.py")
    with tempfile.TemporaryDirectory(prefix="mdlcad-") as folder:
        try:
            done = subprocess.run(
                [sys.executable, "-P", str(worker), edition],
                input=_plain(device.verilog),
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
            return _Outcome(-signal.SIGXCPU, "", (), {})
        path = Path(folder)
        designs = {
            name: json.loads((path / f"{name}.json").read_bytes())
            for name in ("raw", "reference", "netlist")
            if (path / f"{name}.json").exists()
        }
        return _Outcome(
            done.returncode, done.stdout + "\n" + done.stderr, read_findings(path / "findings.json"), designs
        )


def _plain(verilog: str) -> str:
    """The text with one byte and one column a character, so that the columns of Yosys and slang are ours.

    A tab, for which slang counts up to eight columns, becomes a space; not in a text, which would be another one.
    """
    ascii_only = verilog.encode("ascii", "replace").decode("ascii")
    return re.sub(r'"(?:\\.|[^"\\\n])*"|\t', lambda match: " " if match[0] == "\t" else match[0], ascii_only)


def _why(device: Device, outcome: _Outcome) -> list[Diagnostic]:
    """Why there is no design."""
    found = [
        diagnostic(device, finding.line, finding.column, finding.message, finding.hint) for finding in outcome.findings
    ]
    if found:
        return sorted(set(found))
    if outcome.code == -signal.SIGXCPU or "bad_alloc" in outcome.log or outcome.code == -signal.SIGKILL:
        wrong, hint = "the behaviour takes too long, or too much memory, to elaborate", "make loops and vectors smaller"
        culprit = r"\b(?:for|while)\b" if re.search(r"\b(?:for|while)\b", device.verilog) else r"\bmodule\b"
        return [locate(device, culprit, wrong, hint)]
    if outcome.code == -signal.SIGSEGV:
        wrong = "the behaviour calls itself without end"
        hint = "a function, task or module must not use itself; use a loop with a constant count"
        culprit = r"\b(?:function|task)\b" if re.search(r"\b(?:function|task)\b", device.verilog) else r"\bmodule\b"
        return [locate(device, culprit, wrong, hint)]
    texts = re.findall(r"^ERROR: (.*)$", outcome.log, re.M)
    words = texts[0].replace("`\\", "'").replace("`", "'").rstrip(".!") if texts else ""
    if not words or "/" in words:
        # an assertion of Yosys itself, which would tell the user about Yosys' source
        words = "the behaviour uses something that cannot be turned into gates"
    name = re.search(r"'\\?([A-Za-z_]\w*)'", words)
    pattern = rf"\b{re.escape(name[1])}\b" if name else r"\bmodule\b"
    return [locate(device, pattern, words, "write it with registers, wires, if, case and for")]


def _no_top(device: Device) -> Diagnostic:
    """Modules that use themselves, or each other: none is left that no other uses. At the first use of one."""
    names = "|".join(re.findall(r"\bmodule\s+(?:automatic\s+)?(\w+)", device.verilog))
    return locate(
        device,
        rf"(?<!module )\b(?:{names})\b(?=\s*#?\s*\w*\s*\()",
        "every module is used by a module, so none of them is the behaviour",
        "take out the instance of a module within itself; exactly one module is used by no other",
    )


def _refuse_files(device: Device) -> None:
    text = re.sub(
        r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"", lambda m: re.sub(r'[^\n"]', " ", m[0]), device.verilog, flags=re.S
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
