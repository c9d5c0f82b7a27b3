"""The netlist means what the Verilog says, is named by the program, and what a device cannot do is refused by name."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from mdlcad.artefact import from_json, to_json
from mdlcad.errors import InputError
from mdlcad.synthesis import GateKind, Netlist, StateBit, synthesise
from tests.synthesis.verilog_device import device_of

COUNTER = """module counter(input clk, input up, output reg [1:0] n);
  always @(posedge clk) if (up) n <= n + 1;
endmodule
"""


def refusal(verilog: str, sensors: dict[str, int], actuators: dict[str, int]) -> list[str]:
    with pytest.raises(InputError) as caught:
        synthesise(device_of(verilog, sensors, actuators))
    return [str(item) for item in caught.value.diagnostics]


def test_a_counter_has_its_bits_enable_and_ports() -> None:
    netlist = synthesise(device_of(COUNTER, {"up": 1}, {"n": 2}))
    assert netlist.inputs == ("up[0]",)
    assert [(o.bit, o.net) for o in netlist.outputs] == [("n[0]", "n[0]"), ("n[1]", "n[1]")]
    assert [r.bit for r in netlist.registers] == ["n[0]", "n[1]"]
    assert {r.enable for r in netlist.registers} == {"up[0]"}
    assert not any("$" in gate.net for gate in netlist.gates)


def test_initial_values_come_from_declarations_and_initial_blocks_and_are_0_without() -> None:
    netlist = synthesise(
        device_of(
            "module m(input clk, input a, output x, output y, output z);\n"
            "  reg p = 1'b1; reg q; reg r; initial q = 1;\n"
            "  always @(posedge clk) begin p <= a; q <= p; r <= q; end\n"
            "  assign x = p; assign y = q; assign z = r;\nendmodule",
            {"a": 1},
            {"x": 1, "y": 1, "z": 1},
        )
    )
    assert [r.initial for r in sorted(netlist.registers, key=lambda r: r.bit)] == [True, True, False]


def test_registers_that_reach_no_output_disappear() -> None:
    netlist = synthesise(
        device_of(
            "module m(input clk, input a, output reg q); reg lost, more;\n"
            "always @(posedge clk) begin q <= a; lost <= a ^ more; more <= lost; end endmodule",
            {"a": 1},
            {"q": 1},
        )
    )
    assert netlist.registers == (StateBit("q[0]", "a[0]", None, False),)
    assert netlist.gates == ()


def test_constants_wires_and_shared_nets_are_outputs_like_any_other() -> None:
    netlist = synthesise(
        device_of(
            "module m(input a, input b, output [1:0] k, output w, output x, output y);\n"
            "assign k = 2'b10; assign w = a; assign x = a & b; assign y = a & b; endmodule",
            {"a": 1, "b": 1},
            {"k": 2, "w": 1, "x": 1, "y": 1},
        )
    )
    nets = {o.bit: o.net for o in netlist.outputs}
    assert (nets["k[0]"], nets["k[1]"], nets["w[0]"]) == ("0", "1", "a[0]")
    assert nets["x[0]"] == nets["y[0]"]
    assert [g.kind for g in netlist.gates] == [GateKind.AND]


def test_unused_sensors_stay_inputs() -> None:
    netlist = synthesise(
        device_of("module m(input a, input [2:0] v, output q); assign q = a; endmodule", {"a": 1, "v": 3}, {"q": 1})
    )
    assert netlist.inputs == ("a[0]", "v[0]", "v[1]", "v[2]")


def test_the_netlist_survives_its_json() -> None:
    netlist = synthesise(device_of(COUNTER, {"up": 1}, {"n": 2}))
    assert from_json(to_json(netlist), Netlist) == netlist


TWO_CONES = """module m(input clk, input a, input b, input c, output reg x, output reg y);
  always @(posedge clk) begin
    x <= (a & b) ^ x;
    y <= {Y};
  end
endmodule
"""


def test_gate_names_outlive_comments_and_edits_of_another_cone() -> None:
    def names(y: str, comment: str = "") -> set[str]:
        text = comment + TWO_CONES.replace("{Y}", y)
        netlist = synthesise(device_of(text, {"a": 1, "b": 1, "c": 1}, {"x": 1, "y": 1}))
        return {gate.net for gate in netlist.gates if gate.net.startswith("x[0]")}

    before = names("c | y")
    assert before
    assert names("c | y", "// a remark\n\n") == before
    assert names("(c ^ y) | (c & a)") == before


def test_the_same_bytes_under_any_hash_seed() -> None:
    program = (
        "import sys; sys.path.insert(0, sys.argv[1])\n"
        "from tests.synthesis.verilog_device import device_of\n"
        "from mdlcad.artefact import to_json\n"
        "from mdlcad.synthesis import synthesise\n"
        "sys.stdout.buffer.write(to_json(synthesise(device_of(sys.argv[2], {'up': 1}, {'n': 2}))))"
    )
    outputs = {
        subprocess.run(
            [sys.executable, "-c", program, str(Path(__file__).parents[2]), COUNTER],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            check=True,
        ).stdout
        for seed in ("0", "7")
    }
    assert len(outputs) == 1


# body of the module, from line 2 on: every finding, with its line and column
REFUSED: dict[str, tuple[str, list[str]]] = {
    "operand": ("always @(posedge clk) q <= a +;", ["2:31: error: expected expression; an operand or a value"]),
    "semicolon": ("always @(posedge clk) q <= a\nwire z = a;", ["2:29: error: expected ';'; write ';' here"]),
    "undeclared": ("always @(posedge clk) q <= a & ghost;", ["2:32: error: use of undeclared identifier 'ghost'"]),
    "undeclared target": ("assign r = a; always @(posedge clk) q <= a;", ["2:8: error: 'r' is used but not declared"]),
    "two in one run": (
        "always @(posedge clk) q <= a & ghost;\nassign b = ;\nfoo f(a);",
        ["2:32: error: use of undeclared", "3:12: error: expected expression", "4:1: error: unknown module 'foo'"],
    ),
    "undriven wire": ("wire w; always @(posedge clk) q <= a & w;", ["2:6: error: 'w' (or a bit of it) is read but"]),
    "undriven reg": ("reg w; always @(posedge clk) q <= a & w;", ["2:5: error: 'w' (or a bit of it) is read but"]),
    "undriven bit": ("wire [1:0] w; assign w[0] = a; always @(posedge clk) q <= ^w;", ["2:12: error: 'w' (or a bit"]),
    "asynchronous reset": (
        "always @(posedge clk or posedge b) if (b) q <= 0; else q <= a;",
        ["2:1: error: the register 'q' is set or reset asynchronously, which a device cannot do; react to 'clk' alone"],
    ),
    "asynchronous reset, low": (
        "always @(posedge clk or negedge b) if (!b) q <= 1; else q <= a;",
        ["2:1: error: the register 'q' is set or reset asynchronously"],
    ),
    "second clock": ("always @(posedge b) q <= a;", ["2:1: error: the register 'q' is clocked by 'b', not by 'clk'"]),
    "gated clock": (
        "wire g = clk & b; always @(posedge g) q <= a;",
        ["2:10: error: 'clk' is used as a value", "2:19: error: the register 'q' is clocked by 'g', not by 'clk'"],
    ),
    "clock as a value": ("always @(posedge clk) q <= clk;", ["2:1: error: 'clk' is used as a value"]),
    "falling edge": ("always @(negedge clk) q <= a;", ["2:1: error: the register 'q' is clocked by the falling edge"]),
    "latch": ("always @* if (a) q = b;", ["2:1: error: this makes a latch of 'q': in some case it is not assigned"]),
    "latch, case": (
        "always_comb case ({a, b}) 0: q = 1; 1: q = 0; endcase",
        ["1:50: error: this makes a latch of 'q': in some case it is not assigned; assign it in every case, or give"],
    ),
    "loop of logic": (
        "wire u, v; assign u = v & a; assign v = u | b; always @(posedge clk) q <= u;",
        ["2:6: error: the logic feeds back on itself without a register, through 'u' and 'v'; break the loop"],
    ),
    "two drivers": (
        "wire w; assign w = a; assign w = b; always @(posedge clk) q <= w;",
        ["2:6: error: 'w' is driven from several places; assign it in one"],
    ),
    "two blocks": (
        "always @(posedge clk) q <= a;\nalways @(posedge clk) q <= b;",
        ["3:1: error: 'q' is driven from several places (lines 2 and 3); assign it in one"],
    ),
    "block and assign": ("always @(posedge clk) q <= a;\nassign q = b;", ["1:50: error: 'q' is driven from several"]),
    "assigned input": ("assign a = b; always @(posedge clk) q <= a;", ["1:27: error: 'a' is driven from several"]),
    "wire in a block": (
        "wire w; always @* w = a; always @(posedge clk) q <= w;",
        ["2:19: error: cannot assign to a net"],
    ),
    "unknown module": ("other o(.x(a)); always @(posedge clk) q <= a;", ["2:1: error: unknown module 'other'; write"]),
    "unknown function": ("always @(posedge clk) q <= f(a);", ["2:28: error: use of undeclared identifier 'f'"]),
    "unknown macro": ("always @(posedge clk) q <= `F;", ["2:28: error: unknown macro or compiler directive '`F'"]),
    "index": ("wire [1:0] w = {a, b}; always @(posedge clk) q <= w[2];", ["2:53: error: cannot refer to element 2"]),
    "reversed range": (
        "wire [1:0] w = {a, b}; always @(posedge clk) q <= ^w[0:1];",
        ["2:54: error: range of selection"],
    ),
    "declared twice": ("wire w;\nwire w; always @(posedge clk) q <= a;", ["3:6: error: redefinition of 'w' (previous"]),
    "division by zero": ("always @(posedge clk) q <= a / 0;", ["2:32: error: division by constant zero; divide by"]),
    "initial input": ("initial q = a;", ["2:13: error: an initial value that is not a constant; a register starts"]),
    "initial wait": ("initial begin @(posedge clk); q = 1; end", ["2:17: error: a delay or a wait for an event"]),
    "delay": (
        "always @(posedge clk) q <= #5 a;",
        ["2:28: error: a delay or a wait for an event, which a device cannot"],
    ),
    "own clock": (
        "always #5 q = ~q;",
        ["2:8: error: a delay or a wait for an event, which a device cannot do; take it"],
    ),
    "tri-state": (
        "wire w = a ? b : 1'bz; always @(posedge clk) q <= w;",
        ["2:18: error: the value z, which a device cannot do: a rod"],
    ),
    "z": ("wire w = 1'bz; always @(posedge clk) q <= w;", ["2:10: error: the value z, which a device cannot do"]),
    "endless loop": (
        "integer i; always @(posedge clk) for (i = 0; i < 4; i = i) q <= ~q;",
        ["2:34: error: this loop never ends, or has more than 4000 rounds; give it a constant limit"],
    ),
    "long loop": (
        "integer i; always @(posedge clk) for (i = 0; i < 100000000; i = i + 1) q <= ~q;",
        ["2:34: error: this loop never ends, or has more than 4000 rounds"],
    ),
    "large vector": ("reg [100000000:0] v; always @(posedge clk) q <= v[a];", ["2:6: error: packed type of 100000001"]),
    "recursion": (
        "function f(input x); f = f(x); endfunction always @(posedge clk) q <= f(a);",
        ["2:1: error: the behaviour calls itself without end; a function, task or module must not use itself"],
    ),
    "two kinds of assignment": (
        "always @(posedge clk) begin q = a; q <= b; end",
        ["2:36: error: one block assigns a variable both by '=' and by '<='; use '<=' for registers"],
    ),
    "power": ("always @(posedge clk) q <= a ** b;", ["2:28: error: '**' with a variable exponent"]),
    "file": (
        'initial $readmemh("secret", q); always @(posedge clk) q <= a;',
        ["2:9: error: '$readmemh' is not allowed"],
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_a_device_cannot_do_is_refused_at_its_place(case: str) -> None:
    body, expected = REFUSED[case]
    text = f"module m(input clk, input a, input b, output reg q);\n{body}\nendmodule\n"
    found = refusal(text, {"a": 1, "b": 1}, {"q": 1})
    assert len(found) == len(expected), found
    for item, words in zip(found, expected, strict=True):
        assert item.startswith(f"d.mdl:{words}")
        message, source, caret = item.split("\n")
        assert "; " in message, "every finding says what to do"
        assert source.strip() in text.split("\n")
        assert len(caret) == 2 + int(words.split(":")[1])
        assert not any(word in item for word in ("/tmp", "program.v", "yosys", "Yosys", "slang", "$proc", "$driver"))


SUB = "module sub #(parameter N = 1)(input [3:0] x, output [3:0] y); assign y = ~x + N; endmodule\n"


@pytest.mark.parametrize(
    ("use", "expected"),
    [
        ("sub s(.xx(a), .y(q));", ["3:5: error: input port 'x' has no", "3:8: error: port 'xx' does not exist in"]),
        ("sub s(a, q, a);", ["3:13: error: too many port connections given to instantiation of 'sub'"]),
        ("sub s(a[1:0], q);", ["3:7: error: the two sides of this port connection differ: 2 and 4 bits"]),
        ("wire [5:0] w; sub s(a, w); assign q = w[3:0];", ["3:24: error: the two sides of this port connection"]),
        ("sub s(.x(), .y(q));", ["3:8: error: input port 'x' is explicitly connected to nothing; connect it"]),
        ("sub #(.M(2)) s(a, q);", ["3:8: error: parameter 'M' does not exist in 'sub'"]),
        ("sub s(a, q); sub s(a, q);", ["3:18: error: redefinition of 's' (previous definition here, line 3)"]),
    ],
)
def test_instances_must_fit_their_modules(use: str, expected: list[str]) -> None:
    found = refusal(SUB + f"module m(input [3:0] a, output [3:0] q);\n{use}\nendmodule", {"a": 4}, {"q": 4})
    assert [item.startswith(f"d.mdl:{words}") for item, words in zip(found, expected, strict=True)] == [True] * len(
        expected
    ), found


def test_names_that_only_later_editions_of_verilog_reserve() -> None:
    text = (
        "module m(input clk, input do, input bit, output reg final); always @(posedge clk) final <= do & bit; endmodule"
    )
    netlist = synthesise(device_of(text, {"do": 1, "bit": 1}, {"final": 1}))
    assert [register.bit for register in netlist.registers] == ["final[0]"]


def test_an_include_is_refused_even_if_the_file_exists() -> None:
    found = refusal('`include "/etc/passwd"\nmodule m(input a, output q); assign q = a; endmodule', {"a": 1}, {"q": 1})
    assert found[0].startswith("d.mdl:1:1: error: '`include' is not allowed")


def test_words_in_comments_and_strings_are_not_refused() -> None:
    text = "// `include and $fopen\nmodule m(input a, output q); /* $system */ assign q = a; endmodule"
    assert synthesise(device_of(text, {"a": 1}, {"q": 1})).outputs[0].net == "a[0]"


@pytest.mark.parametrize(
    ("sensors", "actuators", "expected"),
    [
        ({"a": 1}, {"q": 1}, "the port 'b' has no sensor or actuator"),
        ({"a": 1, "b": 1, "c": 1}, {"q": 1}, "the sensor 'c' is not a port of the top module; add 'input c'"),
        ({"a": 2, "b": 1}, {"q": 1}, "'a' has 1 bit in the module, but the sensor has 2 places; write 'input [1:0] a'"),
        ({"a": 1, "b": 1, "q": 1}, {}, "the sensor 'q' is an output of the top module; make the port an input"),
    ],
)
def test_ports_must_be_the_sensors_and_actuators(
    sensors: dict[str, int], actuators: dict[str, int], expected: str
) -> None:
    found = refusal("module m(input a, input b, output q); assign q = a & b; endmodule", sensors, actuators)
    assert any(expected in item for item in found), found


def test_two_top_modules_are_refused() -> None:
    text = (
        "module m(input a, output q); assign q = a; endmodule\nmodule n(input a, output q); assign q = a; endmodule\n"
    )
    assert any("there are two behaviours" in item for item in refusal(text, {"a": 1}, {"q": 1}))


def test_a_column_counts_characters_tabs_and_others_alike() -> None:
    text = "module m(input a, output q);\n\tassign\tq = /* é */\ta & ghost;\nendmodule\n"
    assert [item.split(";")[0] for item in refusal(text, {"a": 1}, {"q": 1})] == [
        f"d.mdl:2:{text.splitlines()[1].index('ghost') + 1}: error: use of undeclared identifier 'ghost'"
    ]


def test_a_tab_in_a_text_stays_a_tab() -> None:
    written, meant, space = (
        synthesise(
            device_of(f"module m(input [7:0] a, output q);\tassign q = a == {code};\nendmodule\n", {"a": 8}, {"q": 1})
        )
        for code in ('"\t"', "8'd9", "8'd32")
    )
    assert written.gates == meant.gates != space.gates


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("module m(input a, output q);\n  m again(a, q);\nendmodule\n", "2:3"),
        (
            "module m(input a, output q); n x(a, q); endmodule\nmodule n(input a, output q); m x(a, q); endmodule\n",
            "1:30",
        ),
    ],
)
def test_modules_that_use_themselves_or_each_other_are_refused(text: str, place: str) -> None:
    (found,) = refusal(text, {"a": 1}, {"q": 1})
    assert found.startswith(
        f"d.mdl:{place}: error: every module is used by a module, so none of them is the behaviour;"
    )


def test_modules_in_modules_and_characters_outside_ascii_are_fine() -> None:
    text = (
        "module half(input a, input b, output s); assign s = a ^ b; endmodule // Übertrag\n"
        "module m(input a, input b, input c, output s); wire t; half h(a, b, t); half g(t, c, s); endmodule\n"
    )
    netlist = synthesise(device_of(text, {"a": 1, "b": 1, "c": 1}, {"s": 1}))
    assert [gate.kind for gate in netlist.gates] == [GateKind.XOR, GateKind.XOR]
