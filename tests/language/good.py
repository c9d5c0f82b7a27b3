"""A small program without a mistake, which the tests then spoil."""

GOOD = """\
mechanicalmodule m();
boundary {
  line a {(0,0), (0,9)},
  line b {(0,9), (9,9)},
  line c {(9,9), (9,0)},
  line d {(9,0), (0,0)}
};
sensor s { location = {(a, 0.5)}, values = {"0b0": "off", "0b1": "on"} };
actuator t { type = "flag", location = {(c, 0.2), (c, 0.8)}, values = {"0b00": "x"} };
module v(input clk, input s, output reg [1:0] t);
  always @(posedge clk) t <= t + s;
endmodule
endmechanicalmodule
"""
