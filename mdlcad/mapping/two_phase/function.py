"""Boolean functions of cells, written as in Liberty: ``!``, ``&``, ``|``, ``^``, parentheses, pins, 0 and 1."""

from __future__ import annotations

import re

_TOKEN = re.compile(r"\s*([A-Za-z_]\w*|[01()!&|^])")
_LEVELS = ("|", "^", "&")


def truth_table(text: str, pins: tuple[str, ...]) -> int:
    """Bit m of the result is the function's value where pin i is bit i of m.

    Raises:
        ValueError: not a function of ``pins``; says what is wrong.
    """
    tokens = _tokens(text)
    full = (1 << (1 << len(pins))) - 1
    values = {"0": 0, "1": full}
    for index, pin in enumerate(pins):
        values[pin] = sum(1 << m for m in range(1 << len(pins)) if m >> index & 1)

    def level(depth: int) -> int:
        if depth == len(_LEVELS):
            return atom()
        value = level(depth + 1)
        while tokens and tokens[-1] == _LEVELS[depth]:
            operator = tokens.pop()
            right = level(depth + 1)
            value = value | right if operator == "|" else value ^ right if operator == "^" else value & right
        return value

    def atom() -> int:
        if not tokens:
            raise ValueError(f"'{text}' ends too early")
        token = tokens.pop()
        if token == "!":
            return full ^ atom()
        if token == "(":
            value = level(0)
            if not tokens or tokens.pop() != ")":
                raise ValueError(f"'{text}' lacks a ')'")
            return value
        if token not in values:
            raise ValueError(f"'{token}' in '{text}' is not one of its pins")
        return values[token]

    result = level(0)
    if tokens:
        raise ValueError(f"'{tokens[-1]}' in '{text}' is one too many")
    return result


def _tokens(text: str) -> list[str]:
    """The tokens, last first."""
    found, at = [], 0
    text = text.rstrip()
    while at < len(text):
        match = _TOKEN.match(text, at)
        if match is None:
            raise ValueError(f"'{text[at]}' in '{text}' means nothing here")
        found.append(match[1])
        at = match.end()
    return found[::-1]
