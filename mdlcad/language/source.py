"""The text of a program: read from disk with care, and able to say where in it something stands."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from pathlib import Path

from mdlcad.errors import Diagnostic, InputError
from mdlcad.language.device import Where

LIMIT_BYTES = 500_000
# an excerpt that does not fit a terminal's width helps nobody
_EXCERPT_COLUMNS = 160


@dataclass(frozen=True, slots=True)
class Source:
    """A program's text with line ends made "\\n", and the offset at which every line starts.

    ``file`` is what messages call it.
    """

    file: str
    text: str
    starts: tuple[int, ...]

    def where(self, offset: int) -> Where:
        """The line and column of the character at ``offset``."""
        line = bisect_right(self.starts, offset)
        return Where(line, offset - self.starts[line - 1] + 1)

    def end(self) -> Where:
        """Just behind the last character that is not white space."""
        return self.where(len(self.text.rstrip()))

    def error(self, where: Where, message: str, hint: str = "") -> Diagnostic:
        """A finding at ``where``, with the line it is about (none if the spot is too far right to be shown)."""
        return Diagnostic(self.file, where.line, where.column, message, hint, self._excerpt(where))

    def _excerpt(self, where: Where) -> str:
        if where.column > _EXCERPT_COLUMNS:
            return ""
        start = self.starts[where.line - 1]
        stop = self.starts[where.line] - 1 if where.line < len(self.starts) else len(self.text)
        # one column a character, so that the caret below it stands right, and nothing a terminal would obey
        return "".join(
            char if char.isprintable() else " " for char in self.text[start : min(stop, start + _EXCERPT_COLUMNS)]
        ).rstrip()


def make_source(text: str, file: str) -> Source:
    """The text as a source; a byte-order mark is dropped, and every kind of line end becomes "\\n".

    Raises:
        InputError: the text is larger than ``LIMIT_BYTES``, or holds half a character pair.
    """
    try:
        size = len(text.encode("utf-8"))
    except UnicodeEncodeError as trouble:
        where = _lay_out(text[: trouble.start], file).end()
        raise InputError(
            [Diagnostic(file, where.line, where.column, "this character cannot be written as UTF-8", "take it out")]
        ) from None
    if size > LIMIT_BYTES:
        raise _too_large(file)
    return _lay_out(text, file)


def read_source(path: Path) -> Source:
    """Read an MDL file: UTF-8, with or without a byte-order mark, with any kind of line end.

    Raises:
        InputError: the file cannot be read, is larger than ``LIMIT_BYTES`` or is not UTF-8.
    """
    file = str(path)
    try:
        with path.open("rb") as stream:
            data = stream.read(LIMIT_BYTES + 1)
    except (OSError, ValueError) as trouble:
        reason = trouble.strerror if isinstance(trouble, OSError) and trouble.strerror else str(trouble)
        raise InputError(
            [Diagnostic(file, 1, 1, f"the file cannot be read: {reason}", "give the path of an MDL file")]
        ) from None
    if len(data) > LIMIT_BYTES:
        raise _too_large(file)
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as trouble:
        source = _lay_out(data[: trouble.start].decode("utf-8"), file)
        message = f"the byte 0x{data[trouble.start]:02x} is not UTF-8 text"
        hint = "save the file as UTF-8 text; is it an MDL program at all?"
        raise InputError([source.error(source.where(len(source.text)), message, hint)]) from None
    return make_source(text, file)


def _too_large(file: str) -> InputError:
    message = f"the file is larger than {LIMIT_BYTES // 1000} kB"
    return InputError([Diagnostic(file, 1, 1, message, "an MDL program is a few kB of text; is this the right file?")])


def _lay_out(text: str, file: str) -> Source:
    text = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
    starts = [0]
    for line in text.split("\n")[:-1]:
        starts.append(starts[-1] + len(line) + 1)
    return Source(file, text, tuple(starts))
