"""Cut a program into its declarations and its Verilog, knowing comments, texts and Verilog's escaped names."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

from mdlcad.errors import Diagnostic
from mdlcad.language.source import Source

_LEXEME = re.compile(
    r"""
      (?P<comment> //[^\n]* | /\*(?s:.*?)\*/ )
    | (?P<open_comment> /\* )
    | (?P<text> "(?:[^"\\\n]|\\[^\n])*" )
    | (?P<open_text> "[^\n]* )
    | (?P<escaped> \\\S+ )
    | (?P<directive> `+[A-Za-z0-9_$]* )
    | (?P<system> \$[A-Za-z0-9_$]* )
    | (?P<word> [A-Za-z_][A-Za-z0-9_$]* )
    | (?P<number> [0-9][A-Za-z0-9_$]* )
    | (?P<attribute> \(\*(?!\)) )
    | (?P<semicolon> ; )
    | (?P<other> (?: [^\s\w"/\\`$(;] | \((?!\*) )+ | \S )
    """,
    re.VERBOSE,
)


class LexemeKind(StrEnum):
    """What a lexeme is, as far as cutting and refusing need to know."""

    COMMENT = "comment"
    OPEN_COMMENT = "open_comment"
    TEXT = "text"
    OPEN_TEXT = "open_text"
    ESCAPED = "escaped"
    DIRECTIVE = "directive"
    SYSTEM = "system"
    WORD = "word"
    NUMBER = "number"
    ATTRIBUTE = "attribute"
    SEMICOLON = "semicolon"
    OTHER = "other"


_KINDS: dict[str | None, LexemeKind] = {kind.value: kind for kind in LexemeKind}


@dataclass(frozen=True, slots=True)
class Lexeme:
    """A piece of the source and the offset at which it starts."""

    kind: LexemeKind
    text: str
    offset: int


@dataclass(frozen=True, slots=True)
class Sections:
    """Where the parts of a program are.

    Attributes:
        declarations_end: offset behind the declarations.
        verilog_end: offset behind the Verilog (``declarations_end`` if there is none).
        verilog: the lexemes of the Verilog, comments left out.
        complete: False if an open comment swallowed the rest, so that nothing can be said to be missing from it.
        findings: what is wrong with the cut itself.
    """

    declarations_end: int
    verilog_end: int
    verilog: tuple[Lexeme, ...]
    complete: bool
    findings: tuple[Diagnostic, ...]


def cut(source: Source) -> Sections:
    """Find the Verilog: from the first ``module``, package, type, directive or attribute to ``endmechanicalmodule``."""
    verilog: list[Lexeme] = []
    before: Lexeme | None = None
    lexemes = _lexemes(source.text)
    for lexeme in lexemes:
        if lexeme.kind is LexemeKind.OPEN_COMMENT:
            return _sections(verilog, lexeme.offset, False, (_open_comment(source, lexeme),))
        if lexeme.kind is LexemeKind.WORD and lexeme.text == "endmechanicalmodule":
            return _sections(verilog, lexeme.offset, True, _tail_findings(source, lexemes))
        if verilog or _starts_verilog(lexeme, before):
            verilog.append(lexeme)
        before = lexeme
    missing = source.error(
        source.end(), "'endmechanicalmodule' is missing", "write it behind the last Verilog module, as the last word"
    )
    return _sections(verilog, len(source.text), True, (missing,))


def _lexemes(text: str) -> Iterator[Lexeme]:
    for match in _LEXEME.finditer(text):
        kind = _KINDS[match.lastgroup]
        if kind is not LexemeKind.COMMENT:
            yield Lexeme(kind, match.group(), match.start())


def _starts_verilog(lexeme: Lexeme, before: Lexeme | None) -> bool:
    if lexeme.kind is LexemeKind.WORD:
        # the two further words may be names in a declaration, but never behind its end
        behind = before is not None and before.text.endswith((";", "}"))
        return lexeme.text in ("module", "macromodule") or (behind and lexeme.text in ("package", "typedef"))
    return lexeme.kind in (LexemeKind.DIRECTIVE, LexemeKind.ATTRIBUTE)


def _sections(verilog: list[Lexeme], end: int, complete: bool, findings: tuple[Diagnostic, ...]) -> Sections:
    return Sections(verilog[0].offset if verilog else end, end, tuple(verilog), complete, findings)


def _open_comment(source: Source, lexeme: Lexeme) -> Diagnostic:
    return source.error(source.where(lexeme.offset), "this comment is never closed", "close it with '*/'")


def _tail_findings(source: Source, rest: Iterator[Lexeme]) -> tuple[Diagnostic, ...]:
    for lexeme in rest:
        if lexeme.kind is LexemeKind.OPEN_COMMENT:
            return (_open_comment(source, lexeme),)
        if lexeme.kind is not LexemeKind.SEMICOLON:
            message = "there is text behind 'endmechanicalmodule'"
            return (source.error(source.where(lexeme.offset), message, "a file holds one mechanical module"),)
    return ()
