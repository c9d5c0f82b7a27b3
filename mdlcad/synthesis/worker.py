"""Runs Yosys once, in a child process: Verilog on stdin, JSON files in the current (empty, temporary) folder.

A child process because Yosys ends its process on an error and keeps global state. It is started by path, so it must
not import anything of mdlcad. Yosys reports on stdout (log) and stderr (errors); the parent reads both.

    raw.json        processes lowered and modules flattened, nothing optimised: what the checks look at
    reference.json  plain gates straight from the RTL, no logic optimisation: what the proof's reference evaluates
    netlist.json    plain gates after word-level optimisation: what is mapped

Both of the last two are made from one set of registers, so that a state bit means the same in both.
"""

import sys
from pathlib import Path

PROGRAM = "program.v"

ELABORATE = (
    "hierarchy -check -auto-top",
    "proc",
    "flatten",
    "setattr -unset keep",
    "check",
    "write_json raw.json",
)
# Memories first, for their cells have pins that must stay unknown. Unknowns are 0, everywhere and before any optimiser
# may choose otherwise. No synchronous-reset cells: a reset is logic here. Enables are kept, for a register with an
# enable needs no multiplexer.
REGISTERS = (
    "memory -nordff",
    "setundef -zero -undriven -init",
    "opt_expr",
    "opt_clean",
    "opt -nosdff",
    "setundef -zero -undriven -init",
    "design -save registers",
)
GATES = (
    "techmap",
    "simplemap",
    "dfflegalize -cell $_DFF_P_ 01 -cell $_DFFE_PP_ 01",
    "opt_clean",
)
REFERENCE = (*GATES, "write_json reference.json")
# Combinational passes only: the registers stay what they are.
NETLIST = (
    "design -load registers",
    "opt_expr -full",
    "opt_muxtree",
    "opt_reduce -full",
    "wreduce",
    "opt_expr -full",
    "alumacc",
    "opt_expr -full",
    "opt_clean",
    *GATES,
    "opt_expr",
    "opt_clean",
    "write_json netlist.json",
)


def main() -> int:
    """Read stdin, run the passes; the exit code is 0 if all of them ran."""
    from pyosys import libyosys

    Path(PROGRAM).write_text(sys.stdin.read(), encoding="utf-8")
    design = libyosys.Design()
    for command in (f"read_verilog -nodpi {PROGRAM}", *ELABORATE, *REGISTERS, *REFERENCE, *NETLIST):
        libyosys.run_pass(command, design)
    return 0


if __name__ == "__main__":
    sys.exit(main())
