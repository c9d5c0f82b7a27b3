"""A device around a piece of Verilog, for tests that do not care where its ports stand."""

from __future__ import annotations

from mdlcad.language.device import Actuator, Device, Place, Sensor, Where


def device_of(verilog: str, sensors: dict[str, int], actuators: dict[str, int], name: str = "d") -> Device:
    """The device with sensors and actuators of those widths."""

    def places(width: int) -> tuple[Place, ...]:
        return tuple(Place("side", (bit + 1) / (width + 1)) for bit in range(width))

    return Device(
        name=name,
        boundary=(),
        sensors=tuple(Sensor(port, places(width), (), where=Where(1, 1)) for port, width in sensors.items()),
        actuators=tuple(Actuator(port, "", places(width), (), where=Where(1, 1)) for port, width in actuators.items()),
        verilog=verilog,
        file="d.mdl",
    )
