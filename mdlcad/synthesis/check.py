"""What a behaviour must be before it can become a device: its ports are the device's, its state obeys one clock."""

from __future__ import annotations

import re
from typing import Any

from mdlcad.errors import Diagnostic, InputError
from mdlcad.language.device import Actuator, Device, Sensor
from mdlcad.synthesis.cells import GATE_TYPES, REGISTER_TYPES, top_module
from mdlcad.synthesis.spots import diagnostic, locate, source_position
from mdlcad.synthesis.storage import check_storage
from mdlcad.synthesis.wiring import check_wiring
from mdlcad.synthesis.yosys import YosysRun

CLOCK = "clk"

_OPERATORS = {"$pow": "'**' with a variable exponent and a base other than 2"}


def check_design(device: Device, run: YosysRun) -> None:
    """Check the elaborated behaviour against the device.

    Raises:
        InputError: several top modules; ports that are not the device's sensors and actuators; a second clock, the
            falling edge, an asynchronous reset or a latch; wires without a value or with several; what else was found.
    """
    module = top_module(run.raw)
    found = [diagnostic(device, item.line, item.column, item.message, item.hint) for item in run.findings]
    if len(run.tops) > 1:
        # the rest was looked at for one of them, and not necessarily the one that is meant
        raise InputError(found + _modules(device, run.tops))
    found += _ports(device, module)
    found += check_storage(device, module, CLOCK)
    if not run.findings:
        # what slang found is often why a net has no value
        found += check_wiring(device, module, run.log)
    found = found or _no_gates(device, run)
    if found:
        raise InputError(_once_a_place(found))


def _once_a_place(found: list[Diagnostic]) -> list[Diagnostic]:
    """The first finding at every place: one mistake shows in several ways, and the earlier checks know it better."""
    placed: dict[tuple[int, int], Diagnostic] = {}
    for item in found:
        placed.setdefault((item.line, item.column), item)
    return list(placed.values())


def _no_gates(device: Device, run: YosysRun) -> list[Diagnostic]:
    """Findings about operators that Yosys has no gates for."""
    hint = "write it with registers, wires, if, case, for and simpler operators"
    if not run.netlist:
        return [locate(device, r"\bmodule\b", "the behaviour uses something that cannot be turned into gates", hint)]
    found = []
    for _, cell in sorted(top_module(run.netlist)["cells"].items()):
        if cell["type"] in (*GATE_TYPES, *REGISTER_TYPES, "$scopeinfo"):
            continue
        line, column = source_position(cell["attributes"].get("src", "")) or (device.where.line, device.where.column)
        operator = _OPERATORS.get(cell["type"], f"the operation '{cell['type'].strip('$_')}'")
        found.append(diagnostic(device, line, column, f"{operator} cannot be turned into gates", hint))
    return found


def _modules(device: Device, tops: tuple[str, ...]) -> list[Diagnostic]:
    names = {sensor.name for sensor in device.sensors} | {actuator.name for actuator in device.actuators}

    def fits(module: str) -> int:
        text = re.search(rf"\bmodule\s+{re.escape(module)}\b.*?\bendmodule\b", device.verilog, re.S)
        return len(names & set(re.findall(r"\w+", text[0]))) if text else 0

    wanted = max(tops, key=lambda module: (fits(module), module))
    return [
        locate(
            device,
            rf"(?<=module )\s*{re.escape(name)}\b|\bmodule\s+{re.escape(name)}\b",
            f"module '{name}' is used nowhere, so there are two behaviours: it and '{wanted}'",
            "keep one top module: take this one out, or use it in the other",
        )
        for name in tops
        if name != wanted
    ]


def _ports(device: Device, module: dict[str, Any]) -> list[Diagnostic]:
    found = []
    ports = module["ports"]
    wanted: dict[str, tuple[str, str, Sensor | Actuator]] = {s.name: ("sensor", "input", s) for s in device.sensors}
    wanted.update({a.name: ("actuator", "output", a) for a in device.actuators})
    for name, (role, direction, port) in wanted.items():
        where = port.where
        if name not in ports:
            declaration = f"{direction} {_range(len(port.places))}{name}"
            hint = f"add '{declaration}' to the top module's ports, or take out the {role}"
            message = f"the {role} '{name}' is not a port of the top module"
            found.append(diagnostic(device, where.line, where.column, message, hint))
            continue
        line, column = _declared(module, name) or (where.line, where.column)
        bits = len(ports[name]["bits"])
        if ports[name]["direction"] != direction:
            message = f"the {role} '{name}' is an {ports[name]['direction']} of the top module"
            other = "an actuator" if role == "sensor" else "a sensor"
            hint = f"make the port an {direction}, or declare '{name}' as {other}"
            found.append(diagnostic(device, line, column, message, hint))
        elif bits != len(port.places):
            places = "1 place" if len(port.places) == 1 else f"{len(port.places)} places"
            message = f"'{name}' has {bits} bit{'s'[: bits != 1]} in the module, but the {role} has {places}"
            hint = f"write '{direction} {_range(len(port.places))}{name}', or give the {role} one place for every bit"
            found.append(diagnostic(device, line, column, message, hint))
    for name in ports:
        if name in wanted:
            continue
        line, column = _declared(module, name) or (device.where.line, device.where.column)
        if name != CLOCK:
            kind = "a sensor" if ports[name]["direction"] == "input" else "an actuator"
            message = f"the port '{name}' has no sensor or actuator"
            hint = f"declare {kind} '{name}', or take out the port; the clock is called '{CLOCK}'"
            found.append(diagnostic(device, line, column, message, hint))
        elif ports[name]["direction"] != "input" or len(ports[name]["bits"]) != 1:
            message = f"'{CLOCK}' must be an input of one bit"
            found.append(diagnostic(device, line, column, message, f"write 'input {CLOCK}'"))
    return found


def _range(width: int) -> str:
    return f"[{width - 1}:0] " if width > 1 else ""


def _declared(module: dict[str, Any], name: str) -> tuple[int, int] | None:
    return source_position(module["netnames"].get(name, {}).get("attributes", {}).get("src", ""))
