"""The network: masses and couplings that came, went or changed; by name, then by structure."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from mdlcad.compare.change import Change, Sort
from mdlcad.compare.fields import keyed_changes, largest_first
from mdlcad.compare.pair import Findings, Pair
from mdlcad.network.model import Coupling, Mass, Network


def network_changes(pair: Pair) -> Findings:
    """Changes of the network, and remarks."""
    a, b = pair.both("network.json", Network)
    changes = [
        Change("mass", new, Sort.RENAMED, f"was {old}: joined to the same masses") for old, new in pair.renamed.items()
    ]
    masses_a = {pair.mass(mass.name): replace(mass, name=pair.mass(mass.name)) for mass in a.masses}
    changes += keyed_changes("mass", masses_a, {mass.name: mass for mass in b.masses}, _mass_words)
    couplings = [replace(item, source=pair.mass(item.source), target=pair.mass(item.target)) for item in a.couplings]
    changes += keyed_changes("coupling", _named(couplings), _named(b.couplings), _coupling_words)
    for what, before, after in (
        ("network", {"design": a.design, "cells": a.cells}, {"design": b.design, "cells": b.cells}),
        ("dynamics", {"dynamics": a.dynamics}, {"dynamics": b.dynamics}),
        ("tick", {"cycles per tick": a.cycles_per_tick}, {"cycles per tick": b.cycles_per_tick}),
        ("tick", {"tick mass": pair.mass(a.tick or "")}, {"tick mass": b.tick or ""}),
    ):
        changes += keyed_changes(what, before, after)
    for what, one, other in (
        ("sensor", a.sensors, b.sensors),
        ("actuator", a.actuators, b.actuators),
    ):
        changes += keyed_changes(
            what, {port.bit: pair.mass(port.mass) for port in one}, {port.bit: port.mass for port in other}
        )
    changes += keyed_changes(
        "register",
        {item.bit: replace(item, mass=pair.mass(item.mass)) for item in a.registers},
        {item.bit: item for item in b.registers},
    )
    notes = [
        f"{len(one)} -> {len(other)} {what}"
        for what, one, other in (("masses", a.masses, b.masses), ("couplings", a.couplings, b.couplings))
        if len(one) != len(other)
    ]
    return Findings(largest_first(changes), notes)


def _named(couplings: Iterable[Coupling]) -> dict[str, Coupling]:
    """By name; parallel couplings of one pair are numbered from the second on."""
    found: dict[str, Coupling] = {}
    for item in couplings:
        name, number = item.name, 2
        while name in found:
            name, number = f"{item.name} ({number})", number + 1
        found[name] = item
    return found


def _mass_words(mass: Mass) -> str:
    return f"{mass.kind}, phase {mass.phase}, bias {mass.bias:g}"


def _coupling_words(item: Coupling) -> str:
    return f"{item.kind}, strength {item.strength:g}"
