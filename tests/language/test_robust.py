"""Whatever the input is, it ends in a device or in an ``InputError``, and soon."""

from __future__ import annotations

import contextlib
import random
import re
import time
from pathlib import Path

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from mdlcad.artefact import from_json, to_json
from mdlcad.errors import InputError
from mdlcad.language import Device, parse_device, read_device
from mdlcad.language.source import LIMIT_BYTES
from mdlcad.synthesis import synthesise
from tests.language.good import GOOD

PIECES = [
    "mechanicalmodule", "endmechanicalmodule", "boundary", "sensor", "actuator", "module", "endmodule", "line", "type",
    "location", "values", "{", "}", "(", ")", ",", ";", ":", "=", '"', "//", "/*", "*/", "\n", "\\", "`", "$", "0b1",
    "1e999", "-", "0.5", "é", "\0", "\u2028", "\r", "(*", "`define X(", "`define", "`include", "import", "$readmemh",
    "a", "clk", "9" * 30,
]  # fmt: skip


def parse_or_refuse(text: str) -> None:
    try:
        device = parse_device(text, "x.mdl")
    except InputError as error:
        assert error.diagnostics
        lines = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n").split("\n")
        for finding in error.diagnostics:
            assert 1 <= finding.line <= len(lines)
            assert 1 <= finding.column <= len(lines[finding.line - 1]) + 1
            assert all(line.isprintable() for line in str(finding).split("\n"))
    else:
        assert from_json(to_json(device), Device) == device


@settings(max_examples=300, deadline=None)
@given(st.text(alphabet=st.characters(), max_size=200))
def test_any_text(text: str) -> None:
    parse_or_refuse(text)


@settings(max_examples=300, deadline=None)
@given(st.lists(st.sampled_from(PIECES), max_size=60), st.sampled_from(["", " "]))
@example(['"', "\0", '"'], "")
def test_pieces_of_the_language_in_any_order(pieces: list[str], joint: str) -> None:
    parse_or_refuse(joint.join(pieces))


@settings(max_examples=500, deadline=None)
@given(
    st.lists(
        st.tuples(st.integers(0, len(GOOD)), st.integers(0, 12), st.sampled_from(["", *PIECES]) | st.text(max_size=3)),
        min_size=1,
        max_size=3,
    )
)
def test_a_right_program_with_mistakes(edits: list[tuple[int, int, str]]) -> None:
    text = GOOD
    for start, length, piece in edits:
        text = text[:start] + piece + text[start + length :]
    parse_or_refuse(text)


def test_a_character_that_cannot_be_shown_is_told_by_its_number() -> None:
    """Found by the mutated examples: a NUL for the first slash of a comment was shown as a question mark."""
    with pytest.raises(InputError, match=r"x\.mdl:1:1: error: expected 'mechanicalmodule', found '<U\+0000>'"):
        parse_device("\0/ a comment\n" + GOOD, "x.mdl")


def test_half_of_a_character_pair() -> None:
    with pytest.raises(InputError) as caught:
        parse_device(GOOD.replace('"off"', '"o\ud800"'), "x.mdl")
    assert [(item.line, item.column) for item in caught.value.diagnostics] == [(8, 54)]


@pytest.mark.parametrize("size", [0, 1, 1000, LIMIT_BYTES, 5_000_000])
def test_random_bytes(size: int, tmp_path: Path) -> None:
    path = tmp_path / "x.mdl"
    path.write_bytes(random.Random(size).randbytes(size))
    started = time.process_time()
    with pytest.raises(InputError):
        read_device(path)
    assert time.process_time() - started < 5


def test_the_size_limit(tmp_path: Path) -> None:
    path = tmp_path / "x.mdl"
    path.write_text(GOOD + " " * (LIMIT_BYTES - len(GOOD)))
    assert read_device(path).name == "m"
    path.write_text(GOOD + " " * (LIMIT_BYTES - len(GOOD) + 1))
    for read in (lambda: read_device(path), lambda: parse_device(path.read_text(), "x.mdl")):
        with pytest.raises(InputError, match="the file is larger than 500 kB"):
            read()


HEADER = "mechanicalmodule m();"


BEGINNINGS = {
    "": ["x", "{", "(", "/*", "\\", "`", "$x ", "\n", "module ", "sensor ", "(*", "endmodule ", '"', '"0b1":'],
    "/*": ["*"],
    HEADER: ["boundary {", "sensor s {};", "module m; $fopen `X ", "endmechanicalmodule "],
    HEADER + "boundary {": ["line a {(0,0),(0,1)},"],
    HEADER + "sensor s {": ["location = {(a, 0.1)},"],
    HEADER + "sensor s { location = {": ["(a, 0.1),"],
    HEADER + "sensor s { values = {": ['"0b1": "x",'],
}


@pytest.mark.parametrize(("start", "piece"), [(start, piece) for start in BEGINNINGS for piece in BEGINNINGS[start]])
def test_long_and_deep_input_ends_soon(start: str, piece: str) -> None:
    text = start + piece * ((LIMIT_BYTES - len(start)) // len(piece))
    started = time.process_time()
    with pytest.raises(InputError) as caught:
        parse_device(text, "x.mdl")
    assert time.process_time() - started < 5
    assert len(caught.value.diagnostics) <= 101


def test_a_boundary_of_many_lines_ends_soon() -> None:
    # a comb of 1000 teeth, whose every pair of lines is looked at
    points = [(x, 9 if x % 2 else 8) for x in range(0, 999)] + [(998, 0)]
    lines = ",".join(
        f"line l{index} {{{first},{second}}}"
        for index, (first, second) in enumerate(zip(points, points[1:] + points[:1], strict=True))
    )
    text = GOOD[: GOOD.index("{") + 1] + lines + GOOD[GOOD.index("\n};\nsensor") :]
    started = time.process_time()
    with contextlib.suppress(InputError):
        parse_device(text.replace("(a,", "(l0,").replace("(c,", "(l1,"), "x.mdl")
    assert time.process_time() - started < 5


EXAMPLES = [path.read_text(encoding="utf-8") for path in sorted((Path(__file__).parents[2] / "examples").glob("*.mdl"))]
# words with the space before them, so that put together they are the program again
WORDS = [re.findall(r"\s*(?:\w+|[^\w\s])", text) for text in (*EXAMPLES, GOOD)]
VERILOG = [
    " always @(posedge clk)", " assign", "<=", " begin", " end", " 1'bz", " 4'b1x0?", " reg", " logic", "[3:0]",
    "**", "/", " negedge", " initial", " #5", "@*", " typedef enum", " package", " clk", " input", " output",
    " case", " struct", "'0", " for", " 99999999999", "'", " function", " generate", " while",
]  # fmt: skip


@st.composite
def mutated(draw: st.DrawFn) -> str:
    """An example with up to four words dropped, doubled, swapped, replaced, or borrowed from another example."""
    words = list(draw(st.sampled_from(WORDS)))
    for _ in range(draw(st.integers(1, 4))):
        at, other = draw(st.integers(0, len(words) - 1)), draw(st.integers(0, len(words) - 1))
        match draw(st.integers(0, 4)):
            case 0:
                words[at] = ""
            case 1:
                words[at] += words[other]
            case 2:
                words[at], words[other] = words[other], words[at]
            case 3:
                words[at] = draw(st.sampled_from([*PIECES, *VERILOG]))
            case _:
                lender = draw(st.sampled_from(WORDS))
                start = draw(st.integers(0, len(lender) - 1))
                words[at:at] = lender[start : start + draw(st.integers(1, 12))]
    return "".join(words)


@settings(max_examples=200, deadline=None)
@given(mutated())
def test_examples_with_mistakes(text: str) -> None:
    parse_or_refuse(text)


def synthesise_or_refuse(text: str) -> None:
    try:
        device = parse_device(text, "x.mdl")
        synthesise(device)
    except InputError as error:
        for finding in error.diagnostics:
            assert finding.hint
            assert finding.line <= text.count("\n") + 1
            assert not re.search(r"/tmp|program\.v|[Yy]osys|slang|\$proc|\$driver", str(finding)), str(finding)
            # a name that was lost on the way is a '?', unless that is what stands there
            there = text.split("\n")[finding.line - 1][finding.column - 1 :]
            assert "'?'" not in finding.message + finding.hint or there.startswith("?"), str(finding)


@pytest.mark.long
@settings(max_examples=600, deadline=None, suppress_health_check=list(HealthCheck))
@given(mutated())
@example(" ?/ a program that begins with what a lost name is written as")
def test_examples_with_mistakes_through_the_synthesis(text: str) -> None:
    synthesise_or_refuse(text)
