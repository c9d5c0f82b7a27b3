"""Everything that remembers must be a register that takes its value at the rising edge of the device's one clock."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from mdlcad.errors import Diagnostic
from mdlcad.language.device import Device
from mdlcad.synthesis.nets import Nets
from mdlcad.synthesis.spots import diagnostic

_ASYNCHRONOUS = ("$adff", "$adffe", "$aldff", "$aldffe", "$dffsr", "$dffsre", "$sr")
_LATCHES = ("$dlatch", "$adlatch", "$dlatchsr")
_SYNCHRONOUS = ("$dff", "$dffe", "$sdff", "$sdffe", "$sdffce")
_CLOCK_PINS = ("CLK", "RD_CLK", "WR_CLK")


def check_storage(device: Device, module: dict[str, Any], clock_name: str) -> list[Diagnostic]:
    """Findings about latches, asynchronous resets, other clocks, and the clock used as a value."""
    nets = Nets(module)
    clock = module["ports"].get(clock_name, {}).get("bits", [None])[0]
    found = []
    for cell in nets.cells:
        trouble = _trouble(cell, nets, clock, clock_name)
        if trouble:
            line, column = nets.position(cell, (device.where.line, device.where.column))
            found.append(diagnostic(device, line, column, *trouble))
    for name, port in module["ports"].items():
        if port["direction"] != "input" and clock is not None and clock in map(nets.root, port["bits"]):
            line, column = nets.declared(name) or (device.where.line, device.where.column)
            found.append(diagnostic(device, line, column, *_clock_as_value(clock_name)))
    return sorted(set(found))


def _trouble(cell: dict[str, Any], nets: Nets, clock: int | None, clock_name: str) -> tuple[str, str] | None:
    kind = cell["type"]
    pins = cell["connections"]
    if kind in _LATCHES:
        return (
            f"this makes a latch of '{nets.name(pins['Q'])}': in some case it is not assigned",
            "assign it in every case, or give it a default at the top of the block",
        )
    if kind in _ASYNCHRONOUS:
        return (
            f"the register '{nets.name(pins['Q'])}' is set or reset asynchronously, which a device cannot do",
            f"react to '{clock_name}' alone: always @(posedge {clock_name}), with the reset tested inside",
        )
    if kind in ("$tribuf", "$_TBUF_"):
        return (
            f"'{nets.name(pins['Y'])}' is let go (the value z), which a device cannot do",
            "choose between the sources with ?: or a case",
        )
    if kind in _SYNCHRONOUS:
        if [nets.root(bit) for bit in pins["CLK"]] != [clock]:
            by = nets.name(pins["CLK"])
            return (
                f"the register '{nets.name(pins['Q'])}' is clocked by '{by}', not by '{clock_name}'",
                f"the device has one clock: use always @(posedge {clock_name}), and test '{by}' inside",
            )
        if int(cell["parameters"]["CLK_POLARITY"], 2) != 1:
            return (
                f"the register '{nets.name(pins['Q'])}' is clocked by the falling edge",
                f"a tick has one edge: use always @(posedge {clock_name})",
            )
    if _clocked_otherwise(cell, nets, clock):
        return (
            f"a memory is clocked by something other than '{clock_name}'",
            f"the device has one clock: use always @(posedge {clock_name})",
        )
    if kind != "$buf" and clock is not None and any(clock == nets.root(bit) for bit in _data_bits(cell)):
        return _clock_as_value(clock_name)
    return None


def _clock_as_value(clock_name: str) -> tuple[str, str]:
    return (
        f"'{clock_name}' is used as a value",
        f"use it only in @(posedge {clock_name}); a register that flips at every tick shows the ticks",
    )


def _clocked_otherwise(cell: dict[str, Any], nets: Nets, clock: int | None) -> bool:
    """Of a memory; a read port without a clock is combinational and has a constant or unknown on its clock pin."""
    if not cell["type"].startswith("$mem"):
        return False
    pins = [bit for pin in _CLOCK_PINS for bit in cell["connections"].get(pin, [])]
    return any(isinstance(nets.root(bit), int) and nets.root(bit) != clock for bit in pins)


def _data_bits(cell: dict[str, Any]) -> Iterator[int | str]:
    for pin, bits in cell["connections"].items():
        if pin not in _CLOCK_PINS and cell["port_directions"].get(pin) == "input":
            yield from bits
