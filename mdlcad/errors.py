"""The two ways a run can end badly, and the one form of a message about a user's file."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Severity(StrEnum):
    """Whether a finding about a user's file ends the run."""

    ERROR = "error"
    WARNING = "warning"


@dataclass(frozen=True, slots=True, order=True)
class Diagnostic:
    """One finding about a source file: where (1-based), what is wrong, what to do."""

    file: str
    line: int
    column: int
    message: str
    hint: str = ""
    excerpt: str = ""
    severity: Severity = Severity.ERROR

    def __str__(self) -> str:
        text = f"{self.file}:{self.line}:{self.column}: {self.severity}: {self.message}"
        if self.hint:
            text += f"; {self.hint}"
        if self.excerpt:
            text += f"\n  {self.excerpt}\n  {' ' * (self.column - 1)}^"
        return text


class InputError(Exception):
    """The user's input cannot be used. Exit code 2, no traceback."""

    def __init__(self, diagnostics: list[Diagnostic]) -> None:
        self.diagnostics = sorted(diagnostics)
        super().__init__("\n".join(str(item) for item in self.diagnostics))


class UsageError(Exception):
    """A command line, data file or build folder that cannot be used. Exit code 2, no traceback."""


@dataclass(frozen=True, slots=True)
class Picture:
    """A file that shows what went wrong: the end of its name ("jam.svg") and its bytes."""

    name: str
    data: bytes


class SignoffError(Exception):
    """The input is fine, but what was made of it does not hold (wrong behaviour, illegal layout). Exit code 1."""

    def __init__(self, message: str, picture: Picture | None = None) -> None:
        self.picture = picture
        super().__init__(message)
