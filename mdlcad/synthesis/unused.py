"""Sensors that the program declares and its behaviour does not use: not wrong, but seldom meant."""

from __future__ import annotations

from mdlcad.errors import Diagnostic, Severity
from mdlcad.language import Device
from mdlcad.synthesis.netlist import Netlist


def unused_sensors(device: Device, netlist: Netlist) -> list[Diagnostic]:
    """A warning for every sensor of which no bit, or not every bit, is read by a gate, register or actuator."""
    used = {net for gate in netlist.gates for net in gate.inputs}
    used |= {net for item in netlist.registers for net in (item.data, item.enable) if net is not None}
    used |= {item.net for item in netlist.outputs}
    found = []
    for sensor in device.sensors:
        idle = [f"{sensor.name}[{i}]" for i in range(len(sensor.places)) if f"{sensor.name}[{i}]" not in used]
        if not idle:
            continue
        whole = len(idle) == len(sensor.places)
        what = f"sensor '{sensor.name}'" if whole else f"{', '.join(idle)} of sensor '{sensor.name}'"
        found.append(
            Diagnostic(
                device.file,
                sensor.where.line,
                sensor.where.column,
                f"the behaviour does not use {what}, whose tab would decide nothing",
                "use it in the Verilog, or leave it out",
                severity=Severity.WARNING,
            )
        )
    return found
