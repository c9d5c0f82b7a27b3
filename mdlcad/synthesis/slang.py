"""What slang, which reads the Verilog, has to say about it: in its words or in ours, each with the mend."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

SYNTAX_CODES = frozenset(
    {
        "ExpectedToken", "ExpectedExpression", "ExpectedStatement", "ExpectedMember", "ExpectedIdentifier",
        "ExpectedDeclarator", "ExpectedDataType", "ExpectedAnsiPort", "ExpectedNonAnsiPort", "ExpectedPortList",
        "ExpectedModuleInstance", "ExpectedVariableAssignment", "ExpectedVariableName", "MisplacedTrailingSeparator",
        "ExpectedParameterPort", "ExpectedFunctionPort", "UnexpectedEndDelim", "ExpectedCaseItem",
    }
)  # fmt: skip
"""Codes of errors that a word of SystemVerilog used as a name can cause."""

# code of slang: the mend
_HINTS = {
    "AssignToNet": "declare it as 'reg' or 'logic' instead of 'wire'",
    "AssignmentToConst": "assign something that is not a constant",
    "CaseDup": "keep one of the two",
    "ConstEvalNonConstVariable": "use a constant, a parameter or a genvar here",
    "DivisionByZero": "divide by something else",
    "EmptyInputPortConn": "connect it, or give it a constant",
    "ExpectedExpression": "an operand or a value is missing here",
    "ImplicitNamedPortNotFound": "declare it, or connect the port with .PORT(NET)",
    "IndexOOB": "mend the index, or declare more bits",
    "InputPortAssign": "an input cannot be assigned; use a wire or a register of your own",
    "MissingEndIfDirective": "close it with `endif",
    "NotAType": "declare the type before its use",
    "ParameterDoesNotExist": "use the parameter names of that module",
    "PortDoesNotExist": "use the port names of that module",
    "PortWidthExpand": "give the port exactly its bits, for instance by {1'b0, ...}",
    "PortWidthTruncate": "give the port exactly its bits, for instance by a part-select",
    "RangeOOB": "mend the range, or declare more bits",
    "RangeSelectReversed": "write the two bits in the order of the declaration",
    "Redefinition": "give one of the two another name, or take it out",
    "StaticInitValue": "an initial value is a constant; for a value that follows others write 'wire' or 'assign'",
    "TooManyPortConnections": "connect only the ports that the module has",
    "UnconnectedInputPort": "connect it, or give it a constant",
    "UndeclaredIdentifier": "declare it",
    "UndeclaredButFoundPackage": "import it, or write PACKAGE::NAME",
    "UnknownDirective": "define the macro before its use, or write the value itself",
    "UnknownModule": "write that module in this file, or correct the name",
    "UnknownSystemName": "take it out",
    "UsedBeforeDeclared": "move the declaration up",
}
# what the synthesis part of the reader says, which has no codes: its words, ours, the mend
_USER = (
    (
        "unsynthesizable timing control",
        "a delay or a wait for an event, which a device cannot do",
        "take it out; a device knows ticks only, so count them in a register",
    ),
    (
        "wait statement",
        "'wait', which a device cannot do",
        "test the signal with 'if' in a block clocked by clk",
    ),
    (
        "unsupported language feature",
        "this statement cannot be made into a device",
        "write it with if, case and for",
    ),
    (
        "reading net state during design initialization",
        "an initial value that is not a constant",
        "a register starts at a constant; for a value that follows others write 'wire' or 'assign'",
    ),
    (
        "unroll limit of",
        "this loop never ends, or has more than 4000 rounds",
        "give it a constant limit, and let every round come nearer to it",
    ),
    (
        "high-impedance state",
        "the value z, which a device cannot do: a rod is never let go",
        "choose between the sources with ?: or a case",
    ),
    (
        "on a flip-flop",
        "this block reacts to several edges in a form that is no register",
        "react to clk alone: always @(posedge clk), with everything else tested inside",
    ),
    (
        "asynchronous",
        "a register is set or reset asynchronously, which a device cannot do",
        "react to clk alone: always @(posedge clk), with the reset tested inside",
    ),
    (
        "is not supported after previous",
        "one block assigns a variable both by '=' and by '<='",
        "use '<=' for registers, and '=' for values used only inside the block",
    ),
    (
        "is unsupported for conversion to bits",
        "a real number or a text, which a device cannot hold",
        "use bits: reg [N-1:0]",
    ),
)
# warnings that never mean what the author wanted
_GRAVE = frozenset(
    {
        "ImplicitNet", "PortWidthExpand", "PortWidthTruncate", "UnconnectedInputPort", "EmptyInputPortConn",
        "StaticInitValue", "DivisionByZero", "IndexOOB", "RangeOOB",
    }
)  # fmt: skip
_HARMLESS = ("non-edge sensitivity",)


@dataclass(frozen=True, slots=True)
class Finding:
    """One finding; ``fatal``: there is no design after it."""

    line: int
    column: int
    code: str
    message: str
    hint: str
    fatal: bool


def read_findings(path: Path) -> tuple[Finding, ...]:
    """The errors, and the warnings that count as errors, of the file that slang writes; none without the file."""
    try:
        written = json.loads(path.read_bytes())
    except (OSError, ValueError):
        return ()
    found = [finding for item in written if (finding := _finding(item)) is not None]
    # one mistake seen from two sides: an initial value that is not constant, a macro that leaves a gap
    placed = {(item.line, item.column): item for item in found}
    gaps = {item.line for item in found if item.code == "UnknownDirective"}
    return tuple(
        placed[key] for key in sorted(placed) if placed[key].code not in SYNTAX_CODES or placed[key].line not in gaps
    )


def _finding(item: dict[str, Any]) -> Finding | None:
    code = item["code"]
    user = code == "<user-diag>"
    message: str = item["message"]
    fatal = item["severity"] in ("error", "fatal")
    if not fatal and (code not in _GRAVE if not user else any(word in message for word in _HARMLESS)):
        return None
    where = re.search(r":(\d+):(\d+)$", item.get("location", ""))
    line, column = (int(where[1]), int(where[2])) if where else (1, 1)
    hint = _HINTS.get(code, "")
    if user:
        for words, ours, mend in _USER:
            if words in message:
                message, hint = ours, mend
                break
    elif code == "ImplicitNet":
        name = message.split("'")[1]
        message, hint = f"'{name}' is used but not declared", f"declare it, for instance: wire {name};"
    elif code in ("PortWidthExpand", "PortWidthTruncate"):
        bits = re.search(r"from (\d+) to (\d+) bits", message)
        if bits:
            message = f"the two sides of this port connection differ: {bits[1]} and {bits[2]} bits"
    return Finding(line, column, code, message + _notes(item), hint or _otherwise(message), fatal)


def _otherwise(message: str) -> str:
    """A mend for what has none of its own."""
    if message.startswith("expected "):
        return f"write {message.removeprefix('expected ')} here, or mend what stands before it"
    return "mend it; docs/language.md lists what a behaviour may hold"


def _notes(item: dict[str, Any]) -> str:
    """What slang adds, with the lines that it speaks of."""
    words = []
    for note in item.get("notes", ()):
        where = re.search(r":(\d+):\d+$", note.get("location", ""))
        if where and note["code"] in ("NotePreviousDefinition", "NoteToMatchThis", "NoteDeclarationHere"):
            words.append(f"{note['message']}, line {where[1]}")
    return f" ({'; '.join(words)})" if words else ""
