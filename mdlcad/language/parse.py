"""Parse the declarations with the grammar, one at a time, and say in the user's words what was expected."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from itertools import groupby, islice
from pathlib import Path

from lark import Lark, Token, Tree, UnexpectedToken

from mdlcad.errors import Diagnostic
from mdlcad.language.declarations import (
    Program,
    Word,
    WrittenBoundary,
    WrittenLine,
    WrittenPlace,
    WrittenPort,
    WrittenValue,
)
from mdlcad.language.device import Where
from mdlcad.language.explain import explain
from mdlcad.language.source import Source

_STARTS = {"MECHANICALMODULE": "header", "BOUNDARY": "boundary", "SENSOR": "sensor", "ACTUATOR": "actuator"}
# a file with more words or more mistakes than this is not MDL, and reading on would only take time
_MOST_TOKENS = 50_000
_MOST_ERRORS = 50


@cache
def _grammar() -> Lark:
    text = Path(__file__).with_name("grammar.lark").read_text(encoding="utf-8")
    return Lark(
        text,
        parser="lalr",
        lexer="basic",
        start=[*_STARTS.values(), "refused"],
        maybe_placeholders=False,
        propagate_positions=True,
    )


def parse_declarations(source: Source, end: int) -> tuple[Program, list[Diagnostic]]:
    """Parse the text before ``end``: the header, the boundary, the sensors and the actuators.

    Returns:
        What could be read, and a finding for each declaration that could not.
    """
    findings: list[Diagnostic] = []
    trees: list[Tree[Token]] = []
    stop = _stop_token(source, end)
    tokens = list(islice(_grammar().lex(source.text[:end]), _MOST_TOKENS + 1))
    if len(tokens) > _MOST_TOKENS:
        message = f"the declarations hold more than {_MOST_TOKENS} words and signs"
        hint = "an MDL program has a few hundred; is this the right file?"
        last = Where(tokens[-1].line or 1, tokens[-1].column or 1)
        return Program((), (), (), broken=True), [source.error(last, message, hint)]
    chunks = list(_chunks(tokens))
    if not chunks or chunks[0][0].type != "MECHANICALMODULE":
        findings.append(explain(source, chunks[0][0] if chunks else stop, "file", ["MECHANICALMODULE"]))
    for number, chunk in enumerate(chunks):
        if chunk[0].type not in _STARTS:
            continue
        following = chunks[number + 1][0] if number + 1 < len(chunks) else stop
        outcome = _parse_chunk(chunk, following)
        if isinstance(outcome, Tree):
            trees.append(outcome)
        else:
            findings.append(explain(source, outcome[0], _STARTS[chunk[0].type], outcome[1]))
            if len(findings) == _MOST_ERRORS:
                break
    return _program(trees, bool(findings)), findings


def _stop_token(source: Source, end: int) -> Token:
    """Stands for whatever follows the declarations: the Verilog, the end of the module or the end of the file."""
    text = source.text[end:].split(maxsplit=1)
    where = source.where(end) if text else source.end()
    return Token("STOP", text[0] if text else "", line=where.line, column=where.column)


def _chunks(tokens: list[Token]) -> Iterator[list[Token]]:
    """Cut before every keyword that begins a declaration (these words are reserved, so they begin nothing else)."""
    number = 0

    def declaration(token: Token) -> int:
        nonlocal number
        number += token.type in _STARTS
        return number

    for _, chunk in groupby(tokens, key=declaration):
        yield list(chunk)


def _parse_chunk(chunk: list[Token], following: Token) -> Tree[Token] | tuple[Token, list[str]]:
    """The tree of one declaration, or the token that does not fit and what would have fitted."""
    parser = _grammar().parse_interactive(start=_STARTS[chunk[0].type])
    for token in chunk:
        try:
            parser.feed_token(token)
        except UnexpectedToken:
            return token, sorted(parser.accepts())
    try:
        tree: Tree[Token] = parser.feed_eof()
    except UnexpectedToken:
        return following, sorted(parser.accepts())
    return tree


def _program(trees: list[Tree[Token]], broken: bool) -> Program:
    return Program(
        names=tuple(_name(tree.children[0]) for tree in trees if tree.data == "header"),
        boundaries=tuple(_boundary(tree) for tree in trees if tree.data == "boundary"),
        ports=tuple(_port(tree) for tree in trees if tree.data in ("sensor", "actuator")),
        broken=broken,
    )


def _boundary(tree: Tree[Token]) -> WrittenBoundary:
    return WrittenBoundary(_where(tree), tuple(_line(line) for line in tree.children))


def _line(tree: Tree[Token]) -> WrittenLine:
    name, start, end = tree.children
    return WrittenLine(_name(name), _point(start), _point(end), _where(start), _where(end))


def _point(tree: Tree[Token]) -> tuple[Word, Word]:
    x, y = tree.children
    return _word(x), _word(y)


def _port(tree: Tree[Token]) -> WrittenPort:
    name, *fields = tree.children
    # the first child of a field is its keyword
    return WrittenPort(
        kind=tree.data,
        name=_name(name),
        types=tuple((_where(field), _word(field.children[1])) for field in fields if field.data == "type"),
        locations=tuple(
            (_where(field), tuple(_place(place) for place in field.children[1:]))
            for field in fields
            if field.data == "location"
        ),
        values=tuple(
            (_where(field), tuple(_value(value) for value in field.children[1:]))
            for field in fields
            if field.data == "values"
        ),
    )


def _place(tree: Tree[Token]) -> WrittenPlace:
    line, position = tree.children
    return WrittenPlace(_where(tree), _name(line), _word(position))


def _value(tree: Tree[Token]) -> WrittenValue:
    key, label = tree.children
    return WrittenValue(_word(key), _word(label))


def _name(tree: Tree[Token]) -> Word:
    return _word(tree.children[0])


def _word(token: Token) -> Word:
    """A token; a text loses its quotes, and its place stays that of the opening quote."""
    return Word(token.strip('"') if token.type == "STRING" else str(token), Where(token.line, token.column))


def _where(tree: Tree[Token]) -> Where:
    return Where(tree.meta.line, tree.meta.column)
