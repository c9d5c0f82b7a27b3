"""Syntax errors in the user's words: what was found, what was expected, and how the construct is written."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches

from lark import Token

from mdlcad.errors import Diagnostic
from mdlcad.language.device import Where
from mdlcad.language.source import Source

_WORDS = {
    "MECHANICALMODULE": "'mechanicalmodule'",
    "BOUNDARY": "'boundary'",
    "SENSOR": "'sensor'",
    "ACTUATOR": "'actuator'",
    "LINE": "'line'",
    "TYPE": "'type'",
    "LOCATION": "'location'",
    "VALUES": "'values'",
    "NAME": "a name",
    "NUMBER": "a number",
    "STRING": 'a text in "quotes"',
    "LBRACE": "'{'",
    "RBRACE": "'}'",
    "LPAR": "'('",
    "RPAR": "')'",
    "COMMA": "','",
    "SEMICOLON": "';'",
    "EQUAL": "'='",
    "COLON": "':'",
}
# what may follow a finished declaration
_NEXT = ["'boundary'", "'sensor'", "'actuator'", "'module'"]
_NAME_LIKE = {"NAME", "LINE", "TYPE", "LOCATION", "VALUES"}

_FORMS = {
    "file": "a program is written: mechanicalmodule NAME(); boundary {...} sensor ... actuator ... "
    "module ... endmodule endmechanicalmodule",
    "header": "a program begins: mechanicalmodule NAME();",
    "boundary": "a boundary is written: boundary { line NAME {(x, y), (x, y)}, ... };",
    "sensor": 'a sensor is written: sensor NAME { location = {(LINE, 0.5), ...}, values = {"0b0": "LABEL", ...} };',
    "actuator": 'an actuator is written: actuator NAME { type = "KIND", location = {(LINE, 0.5), ...}, '
    'values = {"0b0": "LABEL", ...} };',
}


def explain(source: Source, found: Token, construct: str, accepted: Sequence[str]) -> Diagnostic:
    """The finding that ``found`` stands in a ``construct`` where only the terminals ``accepted`` may."""
    expected = _expected(accepted)
    message = f"expected {_either(expected)}, found {_describe(found)}"
    return source.error(Where(found.line or 1, found.column or 1), message, _hint(found, construct, expected))


def shown(text: str) -> str:
    """``text`` as a message may quote it: short, and without characters that a terminal would obey, told by number."""
    clean = "".join(char if char.isprintable() else f"<U+{ord(char):04X}>" for char in text)
    return clean if len(clean) <= 40 else clean[:37] + "..."


def nearest(word: str, known: Sequence[str], otherwise: str) -> str:
    """A hint: the known word that ``word`` was probably meant to be, or ``otherwise``."""
    # long words make the comparison slow, and are no misspellings
    close = get_close_matches(word[:80], known, n=1)
    return f"did you mean '{close[0]}'?" if close else otherwise


def _expected(accepted: Sequence[str]) -> list[str]:
    """The accepted terminals in words; separators are named only if nothing else is accepted."""
    finished = "$END" in accepted
    terminals = [item for item in accepted if item != "$END"]
    if set(terminals) >= _NAME_LIKE:
        terminals = [item for item in terminals if item not in _NAME_LIKE] + ["NAME"]
    needed = [item for item in terminals if item != "SEMICOLON"]
    # "a list entry or a separator" is confusing: a separator helps only where an entry cannot come next
    if set(needed) & {"LINE", "LOCATION"} or finished:
        needed = [item for item in needed if item != "COMMA"]
    words = [_WORDS[item] for item in _WORDS if item in needed]
    return words + _NEXT if finished else words


def _either(words: list[str]) -> str:
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " or " + words[-1]


def _describe(found: Token) -> str:
    if found.type == "OPEN_STRING":
        return "a text that does not end on its line"
    if not found:
        return "the end of the file"
    return shown(found) if found.type == "STRING" and len(found) < 40 else f"'{shown(found)}'"


def _hint(found: Token, construct: str, expected: list[str]) -> str:
    if found.type == "OPEN_STRING":
        return 'a text is closed by " on the line where it begins, and holds no backslash'
    if found.type == "STRAY" and found in "\u201c\u201d\u201e'\u2018\u2019`":
        return 'texts take straight double quotes: "..."'
    if found.type == "STRAY" and not found.isascii():
        return "outside comments and texts only plain ASCII characters are allowed"
    if found.startswith("-") and not {"a name", "a number"} & set(expected):
        return "names are made of letters, digits and '_'"
    if found.type == "NAME":
        keywords = [word.strip("'") for word in expected if word.startswith("'") and word[1].isalpha()]
        close = nearest(found, [*keywords, "endmechanicalmodule"], "")
        if close:
            return close
    return _FORMS[construct]
