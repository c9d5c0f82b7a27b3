"""Every net has exactly one source, and no logic feeds back on itself: what Yosys' ``check`` found, at its place."""

from __future__ import annotations

import re
from typing import Any

from mdlcad.errors import Diagnostic
from mdlcad.language.device import Device
from mdlcad.synthesis.nets import Nets
from mdlcad.synthesis.spots import diagnostic, locate, source_position

_BLOCK = re.compile(
    r"^Warning: (?P<what>Wire .* is used but has no driver|multiple conflicting drivers for .*|found logic loop.*)\.?\n"
    r"(?P<details>(?: {4}.*\n)*)",
    re.M,
)
_NAME = re.compile(r"\\(\S+?)(?: \[\d+(?::\d+)?\])?(?: is used|:|$)")


def check_wiring(device: Device, module: dict[str, Any], log: str) -> list[Diagnostic]:
    """Findings about nets without a value, nets with several, and loops of logic."""
    nets = Nets(module)
    found: dict[tuple[str, str], Diagnostic] = {}
    for block in _BLOCK.finditer(log):
        what, details = block["what"], block["details"]
        if "logic loop" in what:
            item = _loop(device, nets, details)
            found["loop", item.message] = item
            continue
        match = _NAME.search(what)
        name = match[1] if match else "?"
        if "no driver" in what:
            found.setdefault(("undriven", name), _undriven(device, nets, name))
        else:
            found.setdefault(("drivers", name), _drivers(device, nets, name, details))
    for name in _unknowns(module, nets):
        found.setdefault(("undriven", name), _undriven(device, nets, name))
    return sorted(found.values())


def _unknowns(module: dict[str, Any], nets: Nets) -> list[str]:
    """Variables that something reads and nothing assigns: the reader of the Verilog feeds them an unknown."""
    used = {
        bit
        for cell in nets.cells
        for pin, bits in cell["connections"].items()
        if cell["port_directions"].get(pin) == "input"
        for bit in bits
    }
    used |= {bit for port in module["ports"].values() if port["direction"] == "output" for bit in port["bits"]}
    unknown = [
        late
        for cell in nets.cells
        if cell["type"] == "$buf"
        for late, early in zip(cell["connections"]["Y"], cell["connections"]["A"], strict=True)
        if early == "x" and late in used
    ]
    return sorted({nets.name([bit]) for bit in unknown} - {"?"})


def _place(device: Device, nets: Nets, name: str) -> tuple[int, int]:
    return nets.declared(name) or (device.where.line, device.where.column)


def _undriven(device: Device, nets: Nets, name: str) -> Diagnostic:
    line, column = _place(device, nets, name)
    message = f"'{name}' (or a bit of it) is read but never given a value"
    return diagnostic(device, line, column, message, "assign it, or take out what reads it")


def _drivers(device: Device, nets: Nets, name: str, details: str) -> Diagnostic:
    places = sorted(
        {
            place
            for cell_name in re.findall(r" of cell (\S+) \(", details)
            if (cell := nets.cell(cell_name.lstrip("\\"))) is not None
            and (place := source_position(cell["attributes"].get("src", ""))) is not None
        }
    )
    line, column = places[-1] if len(places) > 1 else _place(device, nets, name)
    lines = sorted({place[0] for place in places})
    words = f" (lines {' and '.join(map(str, lines))})" if len(lines) > 1 else ""
    hint = "assign it in one always block, or by one assign"
    return diagnostic(device, line, column, f"'{name}' is driven from several places{words}", hint)


def _loop(device: Device, nets: Nets, details: str) -> Diagnostic:
    cells = re.findall(r"cell (\S+) \((\$\w+)\)(?: source: (\S+))?", details)
    names = re.findall(r"wire \\(\S+) source: (\S+)", details)
    if cells and all(kind in ("$mux", "$pmux", "$buf") for _, kind, _ in cells) and _from_a_block(cells):
        # a block without edges that may leave a value as it was: it needs itself
        name, place = names[0] if names else ("?", "")
        line, column = source_position(place) or _place(device, nets, name)
        message = f"this makes a latch of '{name}': in some case it is not assigned"
        hint = "assign it in every case, or give it a default at the top of the block"
        return diagnostic(device, line, column, message, hint)
    through = " and ".join(f"'{name}'" for name in sorted({name for name, _ in names}))
    message = "the logic feeds back on itself without a register" + (f", through {through}" if through else "")
    hint = "break the loop with a register clocked by clk"
    spots = [spot for place in (*(p for _, p in names), *(p for _, _, p in cells)) if (spot := source_position(place))]
    if not spots:
        return locate(device, r"\balways\b|\bassign\b", message, hint)
    return diagnostic(device, *min(spots), message, hint)


def _from_a_block(cells: list[tuple[str, str, str]]) -> bool:
    return any(name.startswith("$procmux") for name, _, _ in cells)
