"""The Mechanical Description Language: from a program's text to a checked ``Device``."""

from mdlcad.language.anchor import anchored, placed
from mdlcad.language.device import Actuator, Device, Line, Place, Sensor, Value, Where
from mdlcad.language.read import parse_device, read_device

__all__ = [
    "Actuator",
    "Device",
    "Line",
    "Place",
    "Sensor",
    "Value",
    "Where",
    "anchored",
    "parse_device",
    "placed",
    "read_device",
]
