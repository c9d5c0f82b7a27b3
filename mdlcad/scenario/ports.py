"""The values of a device's ports in people's words, and their places in the vectors of bits that a proof uses."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mdlcad.language import Actuator, Sensor
from mdlcad.simulation.decode import UNDECIDED

Bits = NDArray[np.uint8]
Port = Sensor | Actuator


def read_value(port: Port, text: str) -> str:
    """``text`` as digits, the highest bit first: either those digits, or a label that the program gives a value.

    Raises:
        ValueError: it is neither; the message says what would be.
    """
    width = len(port.places)
    if len(text) == width and set(text) <= {"0", "1"}:
        return text
    # labels of single digits name the states of each bit, and so a value only if there is one bit
    named = [value for value in port.values if len(value.bits) == width]
    for value in named:
        if value.label == text:
            return value.bits
    words = f"{width} digits 0 or 1" if width > 1 else "0 or 1"
    labels = "".join(f', "{value.label}"' for value in named)
    raise ValueError(f'"{text}" is no value of {port.name}; give {words}{labels}')


def label_of(port: Port, digits: str) -> str:
    """The program's label of a value (``digits``, the highest bit first), or the digits if it has none."""
    for value in port.values:
        if value.bits == digits and len(digits) == len(port.places):
            return value.label
    return digits


def digits_of(port: Port, names: Sequence[str], bits: Bits) -> str:
    """The digits of ``port`` in the vector ``bits`` (uint8[len(names)]), the highest first, "?" if undecided.

    Args:
        names: "NAME[i]" of every place in the vector.
    """
    order = [names.index(f"{port.name}[{i}]") for i in reversed(range(len(port.places)))]
    return "".join("01?"[min(int(bits[place]), UNDECIDED)] for place in order)


def set_digits(port: Port, digits: str, names: Sequence[str], bits: Bits) -> None:
    """Write ``digits`` (the highest first) into the vector ``bits``, in place."""
    for i, digit in enumerate(reversed(digits)):
        bits[names.index(f"{port.name}[{i}]")] = int(digit)
