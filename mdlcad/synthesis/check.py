"""What a behaviour must be before it can become a device: its ports are the device's, its state obeys one clock."""

from __future__ import annotations

import re
from typing import Any

from mdlcad.errors import Diagnostic, InputError
from mdlcad.language.device import Actuator, Device, Sensor
from mdlcad.synthesis.cells import top_module
from mdlcad.synthesis.yosys import YosysRun, diagnostic, locate, source_position

CLOCK = "clk"

_ASYNCHRONOUS = ("$adff", "$adffe", "$aldff", "$aldffe", "$dffsr", "$dffsre", "$sr")
_LATCHES = ("$dlatch", "$adlatch", "$dlatchsr")
_SYNCHRONOUS = ("$dff", "$dffe", "$sdff", "$sdffe", "$sdffce")


def check_design(device: Device, run: YosysRun) -> None:
    """Check the elaborated behaviour against the device.

    Raises:
        InputError: several top modules; ports that are not the device's sensors and actuators; a second clock, the
            falling edge, an asynchronous reset or a latch; or what else Yosys found.
    """
    module = top_module(run.raw)
    found = _modules(device, run)
    found += _ports(device, module)
    found += _storage(device, module)
    # our own words first: Yosys stumbles over the same things later, in words about its cells
    found = found or list(run.trouble)
    if found:
        raise InputError(found)


def _modules(device: Device, run: YosysRun) -> list[Diagnostic]:
    return [
        locate(
            device,
            rf"\bmodule\s+{re.escape(name)}\b",
            f"module '{name}' is used nowhere, so there are two behaviours",
            "keep one top module, or instantiate this one in it",
        )
        for name in run.unused_modules
    ]


def _ports(device: Device, module: dict[str, Any]) -> list[Diagnostic]:
    found = []
    ports = module["ports"]
    wanted: dict[str, tuple[str, str, Sensor | Actuator]] = {s.name: ("sensor", "input", s) for s in device.sensors}
    wanted.update({a.name: ("actuator", "output", a) for a in device.actuators})
    for name, (role, direction, port) in wanted.items():
        where = port.where
        if name not in ports:
            hint = f"add '{direction}' {name} to the module's ports, or remove the {role}"
            found.append(
                diagnostic(device, where.line, where.column, f"{role} '{name}' is not a port of the module", hint)
            )
            continue
        line, column = _declared(module, name) or (where.line, where.column)
        if ports[name]["direction"] != direction:
            message = f"{role} '{name}' is an {ports[name]['direction']} of the module"
            found.append(diagnostic(device, line, column, message, f"make it an {direction}"))
        elif len(ports[name]["bits"]) != len(port.places):
            message = f"'{name}' has {len(ports[name]['bits'])} bit(s) in the module but {len(port.places)} place(s)"
            found.append(diagnostic(device, line, column, message, "give one place for every bit"))
    for name in ports:
        if name in wanted:
            continue
        line, column = _declared(module, name) or (device.where.line, device.where.column)
        if name != CLOCK:
            hint = f"declare a sensor or actuator '{name}', or remove the port"
            found.append(diagnostic(device, line, column, f"port '{name}' has no sensor or actuator", hint))
        elif ports[name]["direction"] != "input" or len(ports[name]["bits"]) != 1:
            found.append(
                diagnostic(
                    device, line, column, f"'{CLOCK}' must be an input of one bit", f"write 'input wire {CLOCK}'"
                )
            )
    return found


def _storage(device: Device, module: dict[str, Any]) -> list[Diagnostic]:
    clock = module["ports"].get(CLOCK, {}).get("bits", [None])[0]
    found = []
    for _, cell in sorted(module["cells"].items()):
        trouble = _cell_trouble(cell, clock)
        if trouble:
            line, column = source_position(cell["attributes"].get("src", "")) or (
                device.where.line,
                device.where.column,
            )
            found.append(diagnostic(device, line, column, *trouble))
    return sorted(set(found))


def _cell_trouble(cell: dict[str, Any], clock: int | None) -> tuple[str, str] | None:
    kind = cell["type"]
    if kind in _LATCHES:
        return (
            "this infers a latch: in some case an output of the block is not assigned",
            "assign it in every case, or give it a default at the top of the block",
        )
    if kind in _ASYNCHRONOUS:
        return (
            "a register is set or reset asynchronously, which a device cannot do",
            f"react to '{CLOCK}' alone: always @(posedge {CLOCK}), with the reset tested inside",
        )
    if kind in _SYNCHRONOUS and cell["connections"]["CLK"] != [clock]:
        return (
            f"a register is clocked by something other than '{CLOCK}'",
            f"the device has one clock: use always @(posedge {CLOCK}) and an enable",
        )
    if kind in _SYNCHRONOUS and int(cell["parameters"]["CLK_POLARITY"], 2) != 1:
        return ("a register is clocked by the falling edge", f"a tick has one edge: use always @(posedge {CLOCK})")
    if kind == "$mem_v2" and _clocked_otherwise(cell, clock):
        return (f"a memory is clocked by something other than '{CLOCK}'", f"use always @(posedge {CLOCK})")
    return None


def _clocked_otherwise(cell: dict[str, Any], clock: int | None) -> bool:
    # a read port without a clock is combinational and has a constant or unknown on its clock pin
    pins = cell["connections"]["RD_CLK"] + cell["connections"]["WR_CLK"]
    return any(isinstance(bit, int) and bit != clock for bit in pins)


def _declared(module: dict[str, Any], name: str) -> tuple[int, int] | None:
    return source_position(module["netnames"].get(name, {}).get("attributes", {}).get("src", ""))
