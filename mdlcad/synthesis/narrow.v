// A Yosys techmap: unsigned division and remainder on as many bits as can be other than 0.
//
// A plain number in Verilog has 32 bits, so "a / 3" asks for a divider of 32 bits, however few bits a has: 60,000 gates.
(* techmap_celltype = "$div $mod" *)
module narrow_division (A, B, Y);
  parameter A_SIGNED = 0;
  parameter B_SIGNED = 0;
  parameter A_WIDTH = 1;
  parameter B_WIDTH = 1;
  parameter Y_WIDTH = 1;
  parameter _TECHMAP_CELLTYPE_ = "";
  parameter [A_WIDTH-1:0] _TECHMAP_CONSTMSK_A_ = 0;
  parameter [A_WIDTH-1:0] _TECHMAP_CONSTVAL_A_ = 0;
  parameter [B_WIDTH-1:0] _TECHMAP_CONSTMSK_B_ = 0;
  parameter [B_WIDTH-1:0] _TECHMAP_CONSTVAL_B_ = 0;

  (* force_downto *) input [A_WIDTH-1:0] A;
  (* force_downto *) input [B_WIDTH-1:0] B;
  (* force_downto *) output [Y_WIDTH-1:0] Y;

  // bits that are not constant, or constant and 1
  localparam [A_WIDTH-1:0] USED_A = ~_TECHMAP_CONSTMSK_A_ | _TECHMAP_CONSTVAL_A_;
  localparam [B_WIDTH-1:0] USED_B = ~_TECHMAP_CONSTMSK_B_ | _TECHMAP_CONSTVAL_B_;
  localparam BITS_A = USED_A == 0 ? 1 : $clog2({1'b0, USED_A} + 1);
  localparam BITS_B = USED_B == 0 ? 1 : $clog2({1'b0, USED_B} + 1);

  // of two signed operands the top bit is a sign
  wire _TECHMAP_FAIL_ = (A_SIGNED && B_SIGNED) || (BITS_A == A_WIDTH && BITS_B == B_WIDTH);

  wire [BITS_A-1:0] a = A[BITS_A-1:0];
  wire [BITS_B-1:0] b = B[BITS_B-1:0];
  // neither is ever larger than the dividend
  wire [BITS_A-1:0] y;
  generate
    if (_TECHMAP_CELLTYPE_ == "$div") assign y = a / b;
    else assign y = a % b;
  endgenerate
  assign Y = y;
endmodule
