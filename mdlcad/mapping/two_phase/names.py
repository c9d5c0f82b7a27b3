"""Names of cells: from the program's own nets, and from what a cell does, never from a running number."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable

from mdlcad.mapping.two_phase.logic import Logic
from mdlcad.synthesis.netlist import Netlist

_DIGITS = 4


class Names:
    """Hands out unique names."""

    def __init__(self, taken: Iterable[str]) -> None:
        self._taken = set(taken)

    def plain(self, wish: str) -> str:
        """``wish``, or with as many underscores behind it as make it unique."""
        while wish in self._taken:
            wish += "_"
        self._taken.add(wish)
        return wish

    def digested(self, stem: str, text: str) -> str:
        """``stem``, an underscore and the first digits of a digest of ``text``, at least four."""
        digest = hashlib.sha256(text.encode()).hexdigest()
        digits = _DIGITS
        while digits < len(digest) and f"{stem}_{digest[:digits]}" in self._taken:
            digits += 1
        return self.plain(f"{stem}_{digest[:digits]}")


def name_nodes(netlist: Netlist, logic: Logic, names: Names) -> dict[str, str]:
    """A name for every node of ``logic``: the output or register that it is for (the first, if several), its cell, and
    digits that depend on its function of the program's own nets."""
    nodes = {node.net: node for node in logic.nodes}
    roots = [(output.bit, literal) for output, literal in zip(netlist.outputs, logic.outputs, strict=True)]
    roots += [(register.bit, literal) for register, literal in zip(netlist.registers, logic.data, strict=True)]
    owner: dict[str, str] = {}
    for bit, literal in roots:
        stack = [literal.net]
        while stack:
            net = stack.pop()
            if net in nodes and net not in owner:
                owner[net] = bit
                stack += [item.net for item in nodes[net].inputs]
    digests: dict[str, str] = {}
    named: dict[str, str] = {}
    for node in logic.nodes:
        inputs = [f"{'!' * item.inverted}{digests.get(item.net, item.net)}" for item in node.inputs]
        text = "|".join([node.cell, *inputs])
        digests[node.net] = hashlib.sha256(text.encode()).hexdigest()
        named[node.net] = names.digested(f"{owner[node.net]}.{node.cell.lower()}", text)
    return named
