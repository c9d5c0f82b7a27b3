"""Runs Yosys once, in a child process: Verilog on stdin, JSON files in the current (empty, temporary) folder.

A child process because Yosys ends its process on an error and keeps global state. It is started by path, so it must
not import anything of mdlcad. The Verilog is read by slang, which knows SystemVerilog whole, reports every error it
finds and says exactly where; its one argument is the edition of the language. Yosys reports on stdout (log) and stderr
(errors); the parent reads both.

    findings.json   what slang has to say
    raw.json        processes lowered and modules flattened, nothing optimised: what the checks look at
    reference.json  plain gates straight from the RTL, no logic optimisation: what the proof's reference evaluates
    netlist.json    plain gates after word-level optimisation: what is mapped

Both of the last two are made from one set of registers, so that a state bit means the same in both.
"""

import resource
import sys
from pathlib import Path

PROGRAM = "program.v"
DIVISION = "narrow.v"
# A program that never ends, or wants a continent of memory, must not take the machine with it. Elaborating 10,000
# registers takes about a second.
ELABORATION_CPU_SECONDS = 20
CPU_SECONDS = 300
MEMORY_BYTES = 6 << 30

READ = (
    "read_slang -j 1 --std {edition} --diag-json findings.json --error-limit 100 --unroll-limit 4000 "
    "--max-constexpr-steps 1000000 --allow-use-before-declare --allow-merging-ansi-ports --relax-enum-conversions "
    "-Wport-width-expand -Wport-width-trunc -Wimplicit-net -Wunconnected-input-port "
    "-Wempty-input-connection -Wstatic-init-value -Wdivide-by-zero " + PROGRAM
)
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
    "opt_clean",
    "memory -nordff",
    "setundef -zero -undriven -init",
    "opt_expr",
    f"techmap -map {DIVISION}",
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


def main(edition: str) -> int:
    """Read stdin, run the passes; the exit code is 0 if all of them ran."""
    from pyosys import libyosys

    Path(PROGRAM).write_text(sys.stdin.read(), encoding="utf-8")
    # beside the program, for Yosys takes no paths with spaces
    Path(DIVISION).write_bytes(Path(__file__).with_name(DIVISION).read_bytes())
    design = libyosys.Design()
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
    resource.setrlimit(resource.RLIMIT_CPU, (ELABORATION_CPU_SECONDS, CPU_SECONDS))
    for command in (READ.format(edition=edition), *ELABORATE):
        libyosys.run_pass(command, design)
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS))
    for command in (*REGISTERS, *REFERENCE, *NETLIST):
        libyosys.run_pass(command, design)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
