"""Register bits as words: those of one name together, as the program's author thinks of them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from mdlcad.scenario.ports import Bits
from mdlcad.simulation.decode import UNDECIDED


@dataclass(frozen=True, slots=True)
class RegisterValue:
    """A register: digits, the highest bit first, "?" where undecided. Bits that stand alone are called "NAME[i]"."""

    register: str
    digits: str

    def __str__(self) -> str:
        return f"{self.register}={self.digits}"


def register_values(names: Sequence[str], bits: Bits) -> tuple[RegisterValue, ...]:
    """The registers in the vector ``bits`` (uint8[r]) of the bits called ``names``, sorted by name.

    Bits "NAME[0]" to "NAME[n]" are one value if none is missing, else (synthesis may have merged some) each its own.
    """
    digit = {name: "01?"[min(int(bit), UNDECIDED)] for name, bit in zip(names, bits, strict=True)}
    groups: dict[str, list[int]] = {}
    values = []
    for name in sorted(names):
        found = re.fullmatch(r"(.+)\[(\d+)\]", name)
        if found:
            groups.setdefault(found[1], []).append(int(found[2]))
        else:
            values.append(RegisterValue(name, digit[name]))
    for stem, places in groups.items():
        if sorted(places) == list(range(len(places))):
            values.append(RegisterValue(stem, "".join(digit[f"{stem}[{i}]"] for i in sorted(places, reverse=True))))
        else:
            values += [RegisterValue(f"{stem}[{i}]", digit[f"{stem}[{i}]"]) for i in sorted(places)]
    return tuple(sorted(values, key=lambda value: value.register))
