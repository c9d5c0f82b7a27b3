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


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("always @(posedge clk) q <= a +;", "d.mdl:2:1: error: syntax error"),
        ("always @(posedge clk) q <= a & ghost;", "d.mdl:2:1: error: Identifier 'ghost' is implicitly declared"),
        ("wire w; always @(posedge clk) q <= a & w;", "'w' is read but never given a value"),
        ("always @(posedge clk or posedge b) if (b) q <= 0; else q <= a;", "reset asynchronously"),
        ("always @(posedge b) q <= a;", "clocked by something other than 'clk'"),
        ("always @(negedge clk) q <= a;", "clocked by the falling edge"),
        ("always @* if (a) q = b;", "infers a latch"),
        ("wire u, v; assign u = v & a; assign v = u | b; always @(posedge clk) q <= u;", "feeds back on itself"),
        ("wire w; assign w = a; assign w = b; always @(posedge clk) q <= w;", "driven from several places"),
        ("other o(.x(a)); always @(posedge clk) q <= a;", "other"),
        ('initial $readmemh("secret", q); always @(posedge clk) q <= a;', "'$readmemh' is not allowed"),
    ],
)
def test_what_a_device_cannot_do_is_refused_at_its_line(body: str, expected: str) -> None:
    text = f"module m(input clk, input a, input b, output reg q);\n{body}\nendmodule\n"
    found = refusal(text, {"a": 1, "b": 1}, {"q": 1})
    assert any(expected in item for item in found), found
    assert all(item.startswith("d.mdl:") and "/tmp" not in item and "program.v" not in item for item in found)


def test_an_include_is_refused_even_if_the_file_exists() -> None:
    found = refusal('`include "/etc/passwd"\nmodule m(input a, output q); assign q = a; endmodule', {"a": 1}, {"q": 1})
    assert found[0].startswith("d.mdl:1:1: error: '`include' is not allowed")


def test_words_in_comments_and_strings_are_not_refused() -> None:
    text = "// `include and $fopen\nmodule m(input a, output q); /* $system */ assign q = a; endmodule"
    assert synthesise(device_of(text, {"a": 1}, {"q": 1})).outputs[0].net == "a[0]"


@pytest.mark.parametrize(
    ("sensors", "actuators", "expected"),
    [
        ({"a": 1}, {"q": 1}, "port 'b' has no sensor or actuator"),
        ({"a": 1, "b": 1, "c": 1}, {"q": 1}, "sensor 'c' is not a port of the module"),
        ({"a": 2, "b": 1}, {"q": 1}, "'a' has 1 bit(s) in the module but 2 place(s)"),
        ({"a": 1, "b": 1, "q": 1}, {}, "sensor 'q' is an output of the module"),
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


def test_modules_in_modules_and_characters_outside_ascii_are_fine() -> None:
    text = (
        "module half(input a, input b, output s); assign s = a ^ b; endmodule // Übertrag\n"
        "module m(input a, input b, input c, output s); wire t; half h(a, b, t); half g(t, c, s); endmodule\n"
    )
    netlist = synthesise(device_of(text, {"a": 1, "b": 1, "c": 1}, {"s": 1}))
    assert [gate.kind for gate in netlist.gates] == [GateKind.XOR, GateKind.XOR]
