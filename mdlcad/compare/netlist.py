"""The netlist: gates, registers and what drives the outputs; by name, then by function for those that changed names."""

from __future__ import annotations

import hashlib
from collections import Counter
from dataclasses import replace

from mdlcad.compare.change import Change, Sort
from mdlcad.compare.fields import keyed_changes
from mdlcad.compare.pair import Findings, Pair
from mdlcad.synthesis.netlist import Netlist


def netlist_changes(pair: Pair) -> Findings:
    """Changes of the netlist, and remarks."""
    a, b = pair.both("netlist.json", Netlist)
    renamed = _renamed(a, b)
    changes = [
        Change("gate", new, Sort.RENAMED, f"was {old}: the same function of the same inputs")
        for old, new in renamed.items()
    ]

    def net(name: str) -> str:
        return renamed.get(name, name)

    gates_a = {
        net(gate.net): replace(gate, net=net(gate.net), inputs=tuple(net(name) for name in gate.inputs))
        for gate in a.gates
    }
    gates_b = {gate.net: gate for gate in b.gates}
    changes += keyed_changes("gate", gates_a, gates_b, lambda gate: f"{gate.kind} of {', '.join(gate.inputs)}")
    registers_a = {
        bit.bit: replace(bit, data=net(bit.data), enable=None if bit.enable is None else net(bit.enable))
        for bit in a.registers
    }
    changes += keyed_changes("register", registers_a, {bit.bit: bit for bit in b.registers})
    changes += keyed_changes("input", dict.fromkeys(a.inputs, ""), dict.fromkeys(b.inputs, ""))
    changes += keyed_changes(
        "output", {bit.bit: net(bit.net) for bit in a.outputs}, {bit.bit: bit.net for bit in b.outputs}
    )
    return Findings(changes)


def _renamed(a: Netlist, b: Netlist) -> dict[str, str]:
    """Nets of gates that only one side knows, whose function of inputs and registers is the same and nobody else's."""
    lost = {gate.net for gate in a.gates} - {gate.net for gate in b.gates}
    new = {gate.net for gate in b.gates} - {gate.net for gate in a.gates}
    functions_a, functions_b = _functions(a), _functions(b)
    only_a = Counter(functions_a[net] for net in sorted(lost))
    only_b = Counter(functions_b[net] for net in sorted(new))
    by_function = {functions_b[net]: net for net in sorted(new)}
    return {
        net: by_function[functions_a[net]]
        for net in sorted(lost)
        if only_a[functions_a[net]] == 1 and only_b[functions_a[net]] == 1
    }


def _functions(netlist: Netlist) -> dict[str, str]:
    """A digest of the logic behind every gate, in terms of inputs and registers."""
    digests: dict[str, str] = {}
    for gate in netlist.gates:
        inputs = [digests.get(net, net) for net in gate.inputs]
        digests[gate.net] = hashlib.sha256("|".join([gate.kind, *inputs]).encode()).hexdigest()
    return digests
