"""The reference does what an independent simulator makes of the same Verilog, and knows nothing of the mapping."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from mdlcad.proof.reference import Reference, build_reference
from tests.synthesis.verilog_device import device_of

PROGRAMS = {
    "arithmetic": (
        "wire [3:0] s = a + b; wire [3:0] d = a - b;\n"
        "always @(posedge clk) begin y <= (a < b) ? s ^ y : d * 3; z <= ^y | &a; end",
        True,
    ),
    "case": (
        "reg [1:0] st; always @(posedge clk) begin case (st) 0: st <= a[0] ? 1 : 2; 1: st <= 3; 2: if (b[1]) st <= 0;\n"
        "default: st <= b[1:0]; endcase z <= st == 2; y <= {st, a[3:2]}; end",
        True,
    ),
    "blocking": (
        "reg [3:0] t; reg f; always @(posedge clk) begin t = a; f = t[0]; if (b[0]) begin t = t >> 1; f = ~f; end\n"
        "y <= t + y; z <= f; end",
        True,
    ),
    "enable": (
        "reg [3:0] m = 4'b1010; always @(posedge clk) begin if (a[0] && !b[0]) m <= b; if (a[1]) z <= m == b;\n"
        "y <= m; end",
        True,
    ),
    "reset": (
        "always @(posedge clk) if (b == 0) begin y <= 4'd9; z <= 1; end else begin y <= y - 1; z <= y[a[1:0]]; end",
        True,
    ),
    "memory": (
        "reg [1:0] mem [0:3]; integer i; initial for (i = 0; i < 4; i = i + 1) mem[i] = i;\n"
        "always @(posedge clk) begin if (a[3]) mem[a[1:0]] <= b[1:0]; y <= {mem[b[1:0]], mem[0]}; z <= mem[1][0]; end",
        True,
    ),
    "mealy": ("reg [3:0] q = 3; always @(posedge clk) q <= q + a; always @* begin y = q & b; z = q > b; end", True),
    "combinational": ("always @* begin y = a * b; z = a == b; end", False),
}


def reference_of(name: str) -> tuple[Reference, str]:
    body, clocked = PROGRAMS[name]
    clk = "input clk, " if clocked else ""
    text = f"module m({clk}input [3:0] a, input [3:0] b, output reg [3:0] y, output reg z);\n{body}\nendmodule\n"
    return build_reference(device_of(text, {"a": 4, "b": 4}, {"y": 4, "z": 1})), text


def run(reference: Reference, inputs: np.ndarray) -> np.ndarray:
    state = reference.initial[None]
    outputs = []
    for row in inputs:
        state, out = reference.step(state, row[None])
        outputs.append(out[0])
    return np.array(outputs)


def icarus(text: str, inputs: np.ndarray, folder: Path) -> np.ndarray:
    """The same ticks by Icarus Verilog, registers without an initial value starting at 0."""
    clocked = "input clk" in text
    lines = ["module bench; reg clk = 0; reg [3:0] a, b; wire [3:0] y; wire z;"]
    lines.append(f"m dut({'.clk(clk), ' if clocked else ''}.a(a), .b(b), .y(y), .z(z)); initial begin #1;")
    for row in inputs:
        a, b = (int(sum(int(bit) << i for i, bit in enumerate(part))) for part in (row[:4], row[4:]))
        lines.append(f'a = {a}; b = {b}; #1 clk = 1; #1 $display("%b%b", z, y); clk = 0; #1;')
    lines.append("$finish; end endmodule")
    # Icarus starts registers unknown where the device starts them at 0
    zero = text.replace("reg [1:0] st;", "reg [1:0] st = 0;")
    zero = zero.replace("reg [3:0] y, output reg z", "reg [3:0] y = 0, output reg z = 0") if clocked else zero
    if "always @* begin y" in text:
        zero = text
    (folder / "bench.v").write_text(zero + "\n".join(lines) + "\n")
    subprocess.run(["iverilog", "-g2005-sv", "-o", "bench", "bench.v"], cwd=folder, check=True, timeout=60)
    out = subprocess.run(["vvp", "bench"], cwd=folder, check=True, timeout=60, capture_output=True, text=True).stdout
    words = [line for line in out.splitlines() if set(line) <= set("01x") and len(line) == 5]
    return np.array([[int(bit) for bit in word[::-1]] for word in words])


@pytest.mark.skipif(
    shutil.which("iverilog") is None, reason="Icarus Verilog is not installed: apt-get install iverilog"
)
@pytest.mark.parametrize("name", sorted(PROGRAMS))
def test_the_reference_agrees_with_icarus_verilog(name: str, tmp_path: Path) -> None:
    reference, text = reference_of(name)
    inputs = np.random.default_rng(7).integers(0, 2, (300, 8)).astype(np.uint8)
    ours, theirs = run(reference, inputs), icarus(text, inputs, tmp_path)
    np.testing.assert_array_equal(ours, theirs)
    assert len({tuple(row) for row in ours}) > 3


def test_the_comparison_would_notice_a_difference() -> None:
    reference, _ = reference_of("arithmetic")
    inputs = np.random.default_rng(7).integers(0, 2, (300, 8)).astype(np.uint8)
    assert not np.array_equal(run(reference, inputs), run(reference, inputs[:, ::-1].copy()))


def test_names_and_shapes() -> None:
    reference, _ = reference_of("enable")
    assert reference.inputs == tuple(f"{n}[{i}]" for n in "ab" for i in range(4))
    assert reference.outputs == ("y[0]", "y[1]", "y[2]", "y[3]", "z[0]")
    assert {"m[0]", "m[3]", "y[0]", "z[0]"} <= set(reference.states)
    initial = dict(zip(reference.states, reference.initial, strict=True))
    assert [initial[f"m[{i}]"] for i in range(4)] == [0, 1, 0, 1]
    states, outputs = reference.step(np.zeros((5, len(reference.states)), np.uint8), np.zeros((5, 8), np.uint8))
    assert states.shape == (5, len(reference.states)) and outputs.shape == (5, 5)
    with pytest.raises(ValueError, match="expected states"):
        reference.step(np.zeros((5, 1), np.uint8), np.zeros((5, 8), np.uint8))


def test_registers_with_equal_contents_are_one_state_bit() -> None:
    text = (
        "module m(input clk, input a, output reg x, output y); reg h;\n"
        "always @(posedge clk) begin x <= a ^ h; h <= a ^ h; end assign y = h; endmodule"
    )
    reference = build_reference(device_of(text, {"a": 1}, {"x": 1, "y": 1}))
    assert reference.states == ("x[0]",)
    states, outputs = reference.step(np.array([[0], [1]], np.uint8), np.array([[1], [1]], np.uint8))
    assert states.tolist() == [[1], [0]] and outputs.tolist() == [[1, 1], [0, 0]]


def test_a_combinational_output_shows_the_state_after_the_tick() -> None:
    text = "module m(input clk, input a, output y); reg q; always @(posedge clk) q <= ~q; assign y = q & a; endmodule"
    reference = build_reference(device_of(text, {"a": 1}, {"y": 1}))
    states, outputs = reference.step(np.array([[0]], np.uint8), np.array([[1]], np.uint8))
    assert (states.tolist(), outputs.tolist()) == ([[1]], [[1]])
    assert reference.settle(np.array([[0]], np.uint8), np.array([[1]], np.uint8)).tolist() == [[0]]
