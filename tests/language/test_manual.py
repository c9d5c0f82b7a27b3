"""The manual's own program is right, and its table knows every finding that the tests provoke."""

from __future__ import annotations

import re
from pathlib import Path

from mdlcad.language import parse_device
from tests.language.test_diagnostics import CASES

MANUAL = (Path(__file__).parents[2] / "docs" / "language.md").read_text(encoding="utf-8")


def test_the_program_in_the_manual() -> None:
    program = MANUAL.split("```")[1]
    assert parse_device(program, "manual").name == "doorbell"


def plain(text: str) -> str:
    """One form for what the table gives in one form only."""
    return text.replace("actuator", "sensor").replace("digits", "digit")


def test_the_table_lists_every_finding() -> None:
    table = plain(MANUAL[MANUAL.index("| finding |") :])
    for _, _, expected in CASES.values():
        for finding in expected:
            message = finding.split(" ", 1)[1]
            if message.startswith("expected "):
                continue
            # names and numbers are the program's own; the longest piece between them is the finding's wording
            pieces = re.split(r"""'[^']*'|"[^"]*"|\([-0-9, ]*\)|U\+[0-9A-F]+|[a-z]?\[?[0-9]+\]?""", plain(message))
            wording = max(pieces, key=len).strip()
            assert wording in table, message
