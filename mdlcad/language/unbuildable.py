"""The words of Verilog for what no device can do, each with what it would do and how to write it instead."""

from __future__ import annotations

from collections.abc import Iterator

_TRISTATE = "lets go of a wire, which a device cannot do: a rod is always pushed or pulled"
_CHOOSE = "choose between the sources with ?: or a case"
_SWITCH = "is a transistor that conducts both ways, which a device does not have"
_TIME = "waits, which a device cannot do: it knows ticks only"
_COUNT = "count ticks in a register"
_PARALLEL = "runs statements side by side, which means something only in a simulation"
_OVERRIDE = "overrides another assignment, which means something only in a simulation"
_REAL = "is not made of bits"
_BITS = "use bits: reg [N-1:0], or 'integer' for a count in a loop"

_GROUPS: tuple[tuple[str, str, str], ...] = (
    ("bufif0 bufif1 notif0 notif1 trireg tri0 tri1 pullup pulldown highz0 highz1", _TRISTATE, _CHOOSE),
    ("nmos pmos cmos rnmos rpmos rcmos", _TRISTATE, _CHOOSE),
    ("tran tranif0 tranif1 rtran rtranif0 rtranif1", _SWITCH, _CHOOSE),
    ("wait event", _TIME, _COUNT),
    ("forever", "never ends", "a block with @(posedge clk) runs at every tick by itself"),
    ("repeat", "is not supported", "write for (i = 0; i < COUNT; i = i + 1) with 'integer i'"),
    ("fork join", _PARALLEL, "write begin ... end; assignments with '<=' happen together anyway"),
    ("force release deassign", _OVERRIDE, "choose with 'if' in the block that assigns the signal"),
    ("disable", "jumps out of a block, which is not supported", "use 'if', or 'break' and 'continue' in a loop"),
    ("real realtime shortreal", _REAL, _BITS),
    ("time", "is the time of a simulation, which a device does not know", _COUNT),
    ("specify", "describes delays; a device knows ticks only", "take out the block up to 'endspecify'"),
    ("primitive table", "defines a truth table of its own kind", "write a module with a 'case'"),
    ("supply0", "is a supply", "write the constant 1'b0"),
    ("supply1", "is a supply", "write the constant 1'b1"),
    ("inout", "goes both ways; a sensor is an input and an actuator an output", "use an input and an output"),
    ("config library incdir", "chooses between files, and a device is one file", "take it out"),
    ("bind", "changes a module from outside", "write the instance into the module itself"),
)
UNBUILDABLE: dict[str, tuple[str, str]] = {
    word: (wrong, mend) for words, wrong, mend in _GROUPS for word in words.split()
}
"""The word: what is wrong with it, what to write instead."""


def refused_words() -> Iterator[tuple[tuple[str, ...], str, str]]:
    """The words in groups, with what is wrong and the mend; for the manual."""
    for words, wrong, mend in _GROUPS:
        yield tuple(words.split()), wrong, mend
