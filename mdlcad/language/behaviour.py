"""Check the Verilog as far as the language must: whole modules, and nothing that reads files or runs code.

Everything else about it is for Yosys to say. The refusals matter because Yosys, while it elaborates a program, will
read files for some system tasks and call functions of its own process through DPI; a device description from a
stranger must not be able to ask for that. Macros could spell a refused word in parts, so the ways to glue words
together are refused as well.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from mdlcad.errors import Diagnostic
from mdlcad.language.explain import shown
from mdlcad.language.sections import Lexeme, LexemeKind, Sections
from mdlcad.language.source import Source
from mdlcad.language.unbuildable import UNBUILDABLE

# system functions that only compute
_HARMLESS_FUNCTIONS = (
    "$bits", "$clog2", "$countones", "$high", "$left", "$low", "$onehot", "$onehot0", "$right", "$signed", "$size",
    "$unsigned",
)  # fmt: skip
_FILE_TASKS = (
    "$readmem", "$writemem", "$sreadmem", "$fopen", "$fclose", "$fscanf", "$fread", "$fwrite", "$fdisplay", "$fmonitor",
    "$fstrobe", "$fget", "$fseek", "$ftell", "$feof", "$fflush", "$ferror", "$rewind", "$ungetc", "$sdf", "$dump",
)  # fmt: skip
_REFUSED_DIRECTIVES = {
    "`include": ("would read another file", "put everything the device needs into this file"),
    "`file_push": ("would make messages point at another file", "take it out"),
    "`file_pop": ("would make messages point at another file", "take it out"),
    "`line": ("would make messages point at the wrong line", "take it out"),
}
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0e-\x1f\x7f]")
_DECLARATIONS = ("boundary", "sensor", "actuator")


def check_verilog(source: Source, sections: Sections) -> Iterator[Diagnostic]:
    """Findings about the Verilog text, in its order."""
    yield from _check_modules(source, sections)
    for match in _CONTROL.finditer(source.text, sections.declarations_end, sections.verilog_end):
        message = f"the control character U+{ord(match.group()):04X} in the Verilog"
        yield source.error(source.where(match.start()), message, "take it out")
    before: Lexeme | None = None
    for index, lexeme in enumerate(sections.verilog):
        trouble = _refusal(lexeme) or _word(sections.verilog, index) or _glue(source, sections.verilog, index, before)
        if trouble:
            yield source.error(source.where(lexeme.offset), *trouble)
        before = lexeme


def _check_modules(source: Source, sections: Sections) -> Iterator[Diagnostic]:
    opened: Lexeme | None = None
    hint = "close every Verilog module with 'endmodule'"
    for lexeme in sections.verilog:
        if lexeme.kind is not LexemeKind.WORD:
            continue
        if lexeme.text in ("module", "macromodule"):
            if opened:
                yield source.error(source.where(opened.offset), "this module has no 'endmodule'", hint)
            opened = lexeme
        elif lexeme.text == "endmodule":
            if not opened:
                message = "'endmodule' without a module"
                yield source.error(source.where(lexeme.offset), message, "begin the module with 'module NAME(...);'")
            opened = None
        elif lexeme.text == "mechanicalmodule":
            message = "'mechanicalmodule' inside the Verilog"
            yield source.error(source.where(lexeme.offset), message, "a file holds one mechanical module")
        elif not opened and lexeme.text in _DECLARATIONS:
            message = f"'{lexeme.text}' behind the Verilog"
            yield source.error(source.where(lexeme.offset), message, "move it before the first Verilog module")
    if opened and sections.complete:
        yield source.error(source.where(opened.offset), "this module has no 'endmodule'", hint)


def _refusal(lexeme: Lexeme) -> tuple[str, str] | None:
    """Message and hint if the lexeme alone is not allowed."""
    name = shown(lexeme.text)
    match lexeme.kind:
        case LexemeKind.SYSTEM if lexeme.text.startswith(_FILE_TASKS):
            return f"'{name}' reads or writes files, which a device cannot do", "write the values into the program"
        case LexemeKind.SYSTEM if lexeme.text not in _HARMLESS_FUNCTIONS:
            allowed = ", ".join(_HARMLESS_FUNCTIONS)
            return f"'{name}' is nothing a device can do", f"take it out; allowed are {allowed}"
        case LexemeKind.DIRECTIVE if lexeme.text in _REFUSED_DIRECTIVES:
            consequence, hint = _REFUSED_DIRECTIVES[lexeme.text]
            return f"'{name}' {consequence}", hint
        case LexemeKind.DIRECTIVE if lexeme.text == "`":
            return "a '`' without a word", "write the directive or macro right behind it"
        case LexemeKind.DIRECTIVE if lexeme.text.startswith("``"):
            return "'``' would join two words", "write the joined word itself"
        case LexemeKind.ESCAPED if any(char in lexeme.text for char in '$`"/'):
            return f"the escaped name '{name}' holds one of $ ` \" /", "use letters, digits and '_'"
        case LexemeKind.OPEN_TEXT:
            return "a text that does not end on its line", 'close it with "'
    return None


def _word(verilog: tuple[Lexeme, ...], index: int) -> tuple[str, str] | None:
    """Message and hint if a word asks for what a device cannot do."""
    lexeme = verilog[index]
    if lexeme.kind is not LexemeKind.WORD:
        return None
    if lexeme.text == "import":
        # a package of the same file; anything else is DPI, or could become it through a macro
        if index + 1 < len(verilog) and verilog[index + 1].kind is LexemeKind.WORD:
            return None
        return "'import' would run code from outside the program", "write the function in Verilog"
    if lexeme.text not in UNBUILDABLE or (index and verilog[index - 1].text.endswith(".")):
        return None
    wrong, mend = UNBUILDABLE[lexeme.text]
    return f"'{lexeme.text}' {wrong}", mend


def _glue(source: Source, verilog: tuple[Lexeme, ...], index: int, before: Lexeme | None) -> tuple[str, str] | None:
    """Message and hint if a macro here could build a word that is not in the text."""
    lexeme = verilog[index]
    if lexeme.kind is not LexemeKind.DIRECTIVE:
        return None
    # a lone '`' and a lone '$' are refused already, so what can be glued ends in a letter, digit, '_' or '$'
    touches = before is not None and before.offset + len(before.text) == lexeme.offset
    if before and touches and (before.text[-1].isalnum() or before.text[-1] in "_$"):
        return f"'{shown(lexeme.text)}' would be joined to the word before it", "write a space between them"
    if lexeme.text == "`define" and index + 1 < len(verilog):
        name = verilog[index + 1]
        if source.text.startswith("(", name.offset + len(name.text)):
            return (
                f"the macro '{shown(name.text)}' takes arguments",
                "use a Verilog function",
            )
    return None
