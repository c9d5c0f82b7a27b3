"""The nets of an elaborated design: the program's name of a bit, and what plain buffers pass on."""

from __future__ import annotations

from typing import Any

from mdlcad.synthesis.cells import Bit
from mdlcad.synthesis.spots import source_position


class Nets:
    """A flat module of Yosys' JSON. ``cells`` are in the order of their names."""

    def __init__(self, module: dict[str, Any]) -> None:
        self.cells: list[dict[str, Any]] = [module["cells"][name] for name in sorted(module["cells"])]
        self._by_name: dict[str, dict[str, Any]] = module["cells"]
        self._netnames: dict[str, Any] = module["netnames"]
        self._before: dict[Bit, Bit] = {}
        for cell in self.cells:
            if cell["type"] == "$buf":
                self._before |= dict(zip(cell["connections"]["Y"], cell["connections"]["A"], strict=True))
        self._names: dict[Bit, str] = {}
        for name in sorted(self._netnames, key=lambda n: (n.count("."), n)):
            net = self._netnames[name]
            for bit in net["bits"]:
                if not net["hide_name"] and isinstance(bit, int):
                    self._names.setdefault(bit, name)

    def root(self, bit: Bit) -> Bit:
        """The bit that buffers pass on as ``bit``."""
        seen = {bit}
        while bit in self._before and self._before[bit] not in seen:
            bit = self._before[bit]
            seen.add(bit)
        return bit

    def name(self, bits: list[Bit]) -> str:
        """The program's name for the net that drives, or is, the first named of ``bits``."""
        for bit in bits:
            for known in (bit, self.root(bit), *(late for late, early in self._before.items() if early == bit)):
                if known in self._names:
                    return self._names[known]
        return "?"

    def declared(self, name: str) -> tuple[int, int] | None:
        """Line and column of a net's declaration."""
        return source_position(self._netnames.get(name, {}).get("attributes", {}).get("src", ""))

    def position(self, cell: dict[str, Any], otherwise: tuple[int, int]) -> tuple[int, int]:
        """Where the program makes ``cell``: its own place, else the declaration of what it drives."""
        return (
            source_position(cell["attributes"].get("src", ""))
            or self.declared(self.name(cell["connections"].get("Q", cell["connections"].get("Y", []))))
            or otherwise
        )

    def cell(self, name: str) -> dict[str, Any] | None:
        """The cell of that name, if there is one."""
        return self._by_name.get(name)
