"""Every finding, with its exact place, on a program that is right but for one mistake."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from mdlcad.errors import Diagnostic, InputError
from mdlcad.language import anchored, parse_device
from mdlcad.language.unbuildable import UNBUILDABLE
from tests.language.good import GOOD

BOUNDARY = GOOD[GOOD.index("boundary") : GOOD.index("sensor")]
SENSOR = next(line for line in GOOD.splitlines() if line.startswith("sensor"))
ACTUATOR = next(line for line in GOOD.splitlines() if line.startswith("actuator"))
VERILOG = GOOD[GOOD.index("module v") : GOOD.index("endmechanicalmodule")]


def findings(text: str) -> list[str]:
    """ "line:column message" of every finding."""
    with pytest.raises(InputError) as caught:
        parse_device(text, "x.mdl")
    lines = text.split("\n")
    for finding in caught.value.diagnostics:
        assert finding.file == "x.mdl"
        quoted = re.search(r"found '([^'.]+)'", finding.message)
        if quoted:
            assert lines[finding.line - 1].startswith(quoted.group(1), finding.column - 1)
        assert finding.hint, "every finding says what to do"
    return [f"{item.line}:{item.column} {item.message}" for item in caught.value.diagnostics]


def test_the_good_program_is_good() -> None:
    parse_device(GOOD, "x.mdl")


# name of the case: (what to replace, by what, every finding expected)
CASES: dict[str, tuple[str, str, list[str]]] = {
    # syntax
    "no header": ("mechanicalmodule m();\n", "", ["1:1 expected 'mechanicalmodule', found 'boundary'"]),
    "no brackets": ("m();", "m;", ["1:19 expected '(', found ';'"]),
    "no name": ("mechanicalmodule m", "mechanicalmodule ", ["1:18 expected a name, found '('"]),
    "misspelt declaration": (
        "sensor s",
        "senser s",
        ["8:1 expected 'boundary', 'sensor', 'actuator' or 'module', found 'senser'"],
    ),
    "misspelt field": (
        "{ location = {(a",
        "{ locaton = {(a",
        ["8:12 expected 'type', 'location', 'values' or '}', found 'locaton'"],
    ),
    "misspelt module": (
        "module v",
        "modul v",
        ["10:1 expected 'boundary', 'sensor', 'actuator' or 'module', found 'modul'"],
    ),
    "colon for equals": ("location = {(a", "location : {(a", ["8:21 expected '=', found ':'"]),
    "equals for colon": ('"0b00": ', '"0b00"= ', ["9:78 expected ':', found '='"]),
    "place without brackets": ("{(a, 0.5)}", "{a, 0.5}", ["8:24 expected '}' or '(', found 'a'"]),
    "no comma in a point": ("(9,9), (9,0)", "(9,9), (9 0)", ["5:21 expected ',', found '0'"]),
    "no comma in a list": (
        "(c, 0.2), (c, 0.8)",
        "(c, 0.2) (c, 0.8)",
        ["9:50 expected '}' or ',', found '('"],
    ),
    "bare key": ('"0b00": ', "0b00: ", ["9:72 expected a text in \"quotes\" or '}', found '0b00'"]),
    "name with a hyphen": ("line b", "line b-x", ["4:9 expected '{', found '-'"]),
    "name with a hyphen and a digit": ("line b", "line b-2", ["4:9 expected '{', found '-2'"]),
    "name with an accent": ("line b", "line é", ["4:8 expected a name, found 'é'"]),
    "curly quotes": ('"flag"', "“flag”", ["9:21 expected a text in \"quotes\", found '“'"]),
    "open text": (
        '"x"} };',
        '"x} };',
        ['9:80 expected a text in "quotes", found a text that does not end on its line'],
    ),
    "brace not closed": (
        '"on"} };',
        '"on"};',
        ["9:1 expected 'type', 'location', 'values' or '}', found 'actuator'"],
    ),
    "two in one run": (
        SENSOR + "\n" + ACTUATOR,
        "sensor s { location };\nactuator t { type };",
        ["8:21 expected '=', found '}'", "9:19 expected '=', found '}'"],
    ),
    "open comment": ("sensor s", "/* sensor s", ["8:1 this comment is never closed"]),
    "stops early": (
        GOOD[GOOD.index("sensor s") + 8 :],
        "",
        ["8:9 'endmechanicalmodule' is missing", "8:9 expected '{', found the end of the file"],
    ),
    # parts
    "no boundary": (
        BOUNDARY,
        "",
        ["4:1 the device has no boundary"],
    ),
    "two boundaries": (SENSOR, BOUNDARY + SENSOR, ["8:1 a second boundary"]),
    "no actuator": (ACTUATOR, "", ["10:1 the device has no actuator"]),
    "no Verilog": (VERILOG, "", ["10:1 the program has no Verilog module"]),
    "second header": (SENSOR, "mechanicalmodule n();\n" + SENSOR, ["8:18 a second 'mechanicalmodule'"]),
    "no endmechanicalmodule": ("endmechanicalmodule", "", ["12:10 'endmechanicalmodule' is missing"]),
    "text behind": (
        "endmechanicalmodule",
        "endmechanicalmodule; x",
        ["13:22 there is text behind 'endmechanicalmodule'"],
    ),
    "open comment behind": ("endmechanicalmodule", "endmechanicalmodule /*", ["13:21 this comment is never closed"]),
    # boundary
    "empty boundary": (
        BOUNDARY,
        "boundary { };\n",
        ["2:1 the boundary has no line"],
    ),
    "two lines": (
        "  line b {(0,9), (9,9)},\n  line c {(9,9), (9,0)},\n  line d {(9,0), (0,0)}",
        "  line c {(0,9), (0,0)}",
        ["2:1 the boundary has only 2 of the lines it needs"],
    ),
    "fraction": ("(9,9), (9,0)", "(9,9), (9.5,0)", ["5:19 the coordinate '9.5' is not a whole number"]),
    "exponent": ("(9,9), (9,0)", "(9,9), (9e0,0)", ["5:19 the coordinate '9e0' is not a whole number"]),
    "far away": ("(9,9), (9,0)", "(9,9), (9000000,0)", ["5:19 the coordinate '9000000' is too large"]),
    "very long number": (
        "(9,9), (9,0)",
        f"(9,9), ({'9' * 5000},0)",
        [f"5:19 the coordinate '{'9' * 37}...' is not a whole number"],
    ),
    "open": (
        "line c {(9,9)",
        "line c {(9,8)",
        ["5:11 the boundary is open: 'b' ends at (9, 9), 'c' starts at (9, 8)"],
    ),
    "open at the end": (
        "(9,0), (0,0)",
        "(9,0), (1,0)",
        ["6:18 the boundary is open: 'd' ends at (1, 0), 'a' starts at (0, 0)"],
    ),
    "no length": (
        "line b {(0,9), (9,9)}",
        "line b {(0,9), (0,9)}, line e {(0,9), (9,9)}",
        ["4:8 the line 'b' has no length"],
    ),
    "anticlockwise": (
        BOUNDARY,
        "boundary { line a {(0,0),(9,0)}, line b {(9,0),(9,9)}, line c {(9,9),(0,0)} };\n",
        ["2:17 the boundary runs anticlockwise"],
    ),
    "crossing": (
        BOUNDARY,
        "boundary { line a {(0,0),(9,9)}, line b {(9,9),(0,9)}, line c {(0,9),(9,0)}, line d {(9,0),(0,0)} };\n",
        ["2:61 the line 'c' runs into the line 'a'"],
    ),
    "touching": (
        BOUNDARY,
        "boundary { line a {(0,0),(0,9)}, line b {(0,9),(5,0)}, line c {(5,0),(9,9)}, line e {(9,9),(9,0)},\n"
        "line d {(9,0),(0,0)} };\n",
        ["3:6 the line 'd' runs into the line 'b'"],
    ),
    "folding back": (
        "line c {(9,9), (9,0)},\n  line d {(9,0), (0,0)}",
        "line c {(9,9), (4,9)},\n  line d {(4,9), (0,0)}",
        ["5:8 the line 'c' runs into the line 'b'", "6:8 the line 'd' runs into the line 'b'"],
    ),
    "folding back at the end": (
        "line d {(9,0), (0,0)}",
        "line d {(9,0), (0,4)}, line e {(0,4), (0,0)}",
        ["6:8 the line 'd' runs into the line 'a'", "6:31 the line 'e' runs into the line 'a'"],
    ),
    "overlap": (
        BOUNDARY,
        "boundary { line a {(0,0),(0,9)}, line b {(0,9),(9,9)}, line c {(9,9),(9,3)}, line e {(9,3),(0,3)},\n"
        "line f {(0,3),(0,6)}, line g {(0,6),(-2,6)}, line h {(-2,6),(-2,0)}, line d {(-2,0),(0,0)} };\n",
        [
            "2:83 the line 'e' runs into the line 'a'",
            "3:6 the line 'f' runs into the line 'a'",
            "3:28 the line 'g' runs into the line 'a'",
        ],
    ),
    "line name twice": (
        "line d",
        "line a",
        ["6:8 a second line is called 'a'"],
    ),
    # ports
    "unknown line": ("{(a, 0.5)}", "{(e, 0.5)}", ["8:25 the boundary has no line 'e'"]),
    "beyond the line": ("0.5)", "1.01)", ["8:28 the position '1.01' is not a number from 0 to 1"]),
    "before the line": ("0.5)", "-0.1)", ["8:28 the position '-0.1' is not a number from 0 to 1"]),
    "two points in a number": ("0.5)", "0.5.1)", ["8:28 the position '0.5.1' is not a number from 0 to 1"]),
    "endless": ("0.5)", "1e999)", ["8:28 the position '1e999' is not a number from 0 to 1"]),
    "same spot": ("(c, 0.2), (c, 0.8)", "(c, 0.2), (c, 0.20)", ["9:51 this spot is already taken by t[0]"]),
    "same spot as another": ("(c, 0.2)", "(a, 0.5)", ["9:41 this spot is already taken by s[0]"]),
    "same corner": (
        "(c, 0.2), (c, 0.8)",
        "(c, 1.0), (d, 0)",
        ["9:51 this spot (the corner of two lines) is already taken by t[0]"],
    ),
    "same last corner": (
        "(c, 0.2), (c, 0.8)",
        "(a, 0), (d, 1)",
        ["9:49 this spot (the corner of two lines) is already taken by t[0]"],
    ),
    "key too short": (
        '{"0b00": "x"}',
        '{"0b00": "x", "0b1": "y"}',
        ['9:85 the key "0b1" has 1 digit, but the actuator has 2 places'],
    ),
    "key too long": ('"0b1": "on"', '"0b10": "on"', ['8:59 the key "0b10" has 2 digits, but the sensor has 1 place']),
    "mixed keys": (
        '{"0b00": "x"}',
        '{"0b0": "x", "0b11": "y"}',
        ['9:84 the key "0b11" has 2 digits, but the keys before it have 1'],
    ),
    "key not binary": ('"0b1"', '"0b2"', ['8:59 the key "0b2" is not a binary number']),
    "key without 0b": ('"0b1"', '"1"', ['8:59 the key "1" is not a binary number']),
    "key twice": ('"0b1"', '"0B0"', ['8:59 the key "0B0" is given twice']),
    "control character in a label": ('"on"', '"o\tn"', ["8:66 this text holds a control character"]),
    "no location": ("location = {(a, 0.5)}, ", "", ["8:8 the sensor 's' has no place on the boundary"]),
    "empty location": ("{(a, 0.5)}", "{}", ["8:12 the sensor 's' has no place on the boundary"]),
    "field twice": (
        'type = "flag"',
        'type = "flag", type = "pole"',
        ["9:29 a second 'type' in the actuator 't'"],
    ),
    "called clk": ("sensor s", "sensor clk", ["8:8 the sensor is called 'clk', which is the clock of the device"]),
    "called as Verilog": ("sensor s", "sensor reg", ["8:8 the sensor is called 'reg', which is a word of Verilog"]),
    "name twice": ("actuator t", "actuator s", ["9:10 a second sensor or actuator is called 's'"]),
    "long name": ("module m(", f"module {'m' * 65}(", [f"1:18 the name '{'m' * 37}...' is longer than 64 characters"]),
    # Verilog
    "no endmodule": ("\nendmodule", "\n", ["10:1 this module has no 'endmodule'"]),
    "no endmodule before the next": (
        "module v",
        "module w(input x);\nmodule v",
        ["10:1 this module has no 'endmodule'"],
    ),
    "endmodule too many": ("\nendmodule", "\nendmodule\nendmodule", ["13:1 'endmodule' without a module"]),
    "declaration behind": (
        "endmechanicalmodule",
        "sensor z {}\nendmechanicalmodule",
        ["13:1 'sensor' behind the Verilog"],
    ),
    "header in the Verilog": (
        "endmechanicalmodule",
        "mechanicalmodule n();\nendmechanicalmodule",
        ["13:1 'mechanicalmodule' inside the Verilog"],
    ),
    "include": ("module v", '`include "x.v"\nmodule v', ["10:1 '`include' would read another file"]),
    "line directive": (
        "module v",
        '`line 1 "x.v" 0\nmodule v',
        ["10:1 '`line' would make messages point at the wrong line"],
    ),
    "file_push": (
        "module v",
        '`file_push "x"\nmodule v',
        ["10:1 '`file_push' would make messages point at another file"],
    ),
    "import": (
        "module v",
        'module w; endmodule import "DPI-C" function int f(); module v',
        ["10:21 'import' would run code from outside the program"],
    ),
    "lone grave": ("t + s", "t ` s", ["11:32 a '`' without a word"]),
    "pasted": ("t + s", "t``s", ["11:31 '``' would join two words"]),
    "joined": (
        "module v",
        "module w; endmodule im`X module v",
        ["10:23 '`X' would be joined to the word before it"],
    ),
    "macro with arguments": ("module v", "`define F(x) x\nmodule v", ["10:1 the macro 'F' takes arguments"]),
    "open text in Verilog": ("t + s", 't + "s', ["11:34 a text that does not end on its line"]),
    "control character": ("t + s", "t + \0 s", ["11:34 the control character U+0000 in the Verilog"]),
    "control character in a comment": (
        "t + s",
        "t + /*\x1b*/ s",
        ["11:36 the control character U+001B in the Verilog"],
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_finding(case: str) -> None:
    old, new, expected = CASES[case]
    assert GOOD.count(old) == 1, "the case must change one thing"
    assert findings(GOOD.replace(old, new)) == expected


def with_verilog(statement: str) -> str:
    return GOOD.replace("  always", f"  {statement}\n  always")


@pytest.mark.parametrize(
    "task", ["$readmemh", "$readmemb", "$fopen", "$fscanf", "$fwrite", "$writememh", "$dumpfile", "$sdf_annotate"]
)
def test_file_tasks_are_refused(task: str) -> None:
    expected = [f"11:11 '{task}' reads or writes files, which a device cannot do"]
    assert findings(with_verilog(f'initial {task}("secret", t);')) == expected


@pytest.mark.parametrize("task", ["$system", "$display", "$finish", "$random", "$", "$$"])
def test_other_tasks_are_refused(task: str) -> None:
    assert findings(with_verilog(f"initial {task} (t);")) == [f"11:11 '{task}' is nothing a device can do"]


@pytest.mark.parametrize("name", ["\\$readmemh", '\\a"b', "\\a/*b", "\\a`b"])
def test_escaped_names_that_could_hide_something_are_refused(name: str) -> None:
    assert findings(with_verilog(f"wire {name} ;")) == [f"11:8 the escaped name '{name}' holds one of $ ` \" /"]


@pytest.mark.parametrize(
    "statement",
    [
        '// `include "x" $readmemh',
        '/* $fopen("x") import */',
        'wire [63:0] x = "`include $readmemh";',
        "localparam N = $clog2(16) + $signed(1'b1);",
        "wire \\a.b[0] ;",
        "`define WIDTH 2\n  wire [`WIDTH-1:0] w;",
        "`ifdef FAST\n  wire w;\n`endif",
        "wire importance, a$b;",
        "always @(*) begin end",
        "(* keep *) wire w;",
    ],
)
def test_harmless_verilog_is_let_through(statement: str) -> None:
    assert statement in parse_device(with_verilog(statement), "x.mdl").verilog


def test_findings_of_different_kinds_come_in_one_run_in_the_order_of_the_file() -> None:
    text = GOOD.replace("(0,9), (9,9)", "(0,9), (9,8)").replace('"0b1"', '"0b2"').replace("t + s", "$random")
    assert findings(text) == [
        "5:11 the boundary is open: 'b' ends at (9, 8), 'c' starts at (9, 9)",
        '8:59 the key "0b2" is not a binary number',
        "11:30 '$random' is nothing a device can do",
    ]


def test_a_syntax_error_hides_no_sense_error_elsewhere() -> None:
    text = GOOD.replace("sensor s {", "sensor s [").replace("0.8", "8")
    assert findings(text) == ["8:10 expected '{', found '['", "9:55 the position '8' is not a number from 0 to 1"]


def test_excerpt_and_hint() -> None:
    with pytest.raises(InputError) as caught:
        parse_device(GOOD.replace("sensor s", "\tsenser s"), "dir/x.mdl")
    assert str(caught.value).split("\n") == [
        "dir/x.mdl:8:2: error: expected 'boundary', 'sensor', 'actuator' or 'module', found 'senser'; "
        "did you mean 'sensor'?",
        '   senser s { location = {(a, 0.5)}, values = {"0b0": "off", "0b1": "on"} };',
        "   ^",
    ]


@pytest.mark.parametrize("word", ["line", "type", "location", "values", "left_2", "_"])
def test_words_of_fields_may_be_names(word: str) -> None:
    device = parse_device(GOOD.replace("line a", f"line {word}").replace("(a,", f"({word},"), "x.mdl")
    assert device.boundary[0].name == word


@pytest.mark.parametrize("word", sorted(UNBUILDABLE))
def test_words_for_what_no_device_can_do_are_refused_with_the_mend(word: str) -> None:
    wrong, mend = UNBUILDABLE[word]
    text = with_verilog(f"{word} w;")
    assert findings(text) == [f"11:3 '{word}' {wrong}"]
    assert mend
    parse_device(with_verilog(f"wire a_{word}; // {word}"), "x.mdl")


def test_a_package_before_the_first_module_belongs_to_the_verilog() -> None:
    package = "package p; localparam N = 1; endpackage\n"
    device = parse_device(GOOD.replace("module v(input clk", package + "module v import p::*; (input clk"), "x.mdl")
    assert package in device.verilog
    # and yet the word may name a line or a port
    assert parse_device(GOOD.replace("sensor s", "sensor package").replace("input s", "input package"), "x.mdl")


def test_findings_of_later_stages_get_the_path_and_the_line_of_the_file(tmp_path: Path) -> None:
    path = tmp_path / "x.mdl"
    path.write_text(GOOD.replace("sensor s", "\tsensor s"))
    late = InputError([Diagnostic("x.mdl", 8, 9, "wrong", "mend it"), Diagnostic("y.mdl", 1, 1, "other")])
    first, second = anchored(late, path).diagnostics
    assert str(first).split("\n")[0] == f"{path}:8:9: error: wrong; mend it"
    assert first.excerpt.startswith(" sensor s {")
    assert second == late.diagnostics[1]
