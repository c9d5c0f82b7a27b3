"""Which deck every unit of a device with two unit plates is in, and what each deck is by itself.

A net belongs to the deck of its unit. One that drives masses of the other deck *crosses*: its source takes the same
slot there with a *bare hub*, the hub's pins without a unit. So each deck is a network of its own, in which a bare hub
is a mass that nothing drives.
"""

from __future__ import annotations

import math
import random
from collections.abc import Mapping
from dataclasses import dataclass, replace

from ortools.sat.python import cp_model

from mdlcad.mechanics.decks import Deck, plate_in
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.solver import solver_with

LIMIT = 3.0
"""CP-SAT's deterministic time for the choice of decks."""
LEAST = 3
"""Each deck has at least one of so many units."""
TASTE = 100
"""How much a crossing counts; to each seed, up to a quarter more."""
FILLED = (0.7, 0.8, 0.9, 1.0)
"""Shares of a deck's slots that units and bare hubs may take: the first at which a choice is found."""

Units = Mapping[str, Deck]
"""The deck of every mass's unit, by mass."""


@dataclass(frozen=True, slots=True)
class Lean:
    """By what share of its limit one coupling tilts its source's shuttle, if its target is in the source's deck
    (``own``) or in the other (``across``)."""

    own: float
    across: float


def choose_decks(network: Network, slots: int, leans: Mapping[str, Lean], seed: int) -> dict[str, Deck] | None:
    """The deck of every mass: few nets that cross, both decks with room to spare; None if two decks are too small.

    Args:
        slots: how many each deck has. leans: by coupling; the sum over a net is at most 1.
    """
    for share in FILLED:
        found = _choose(network, math.floor(share * slots), leans, seed)
        if found is not None:
            return found
    return None


def _choose(network: Network, most: int, leans: Mapping[str, Lean], seed: int) -> dict[str, Deck] | None:
    model = cp_model.CpModel()
    upper = {mass.name: model.new_bool_var(f"upper.{mass.name}") for mass in network.masses}
    crosses = {source: model.new_bool_var(f"crosses.{source}") for source in _sources(network)}
    apart: dict[str, list[tuple[Lean, cp_model.IntVar]]] = {source: [] for source in crosses}
    for coupling in network.couplings:
        one, other = upper[coupling.source], upper[coupling.target]
        differ = model.new_bool_var(f"apart.{coupling.name}")
        model.add(one != other).only_enforce_if(differ)
        model.add(one == other).only_enforce_if(~differ)
        model.add_implication(differ, crosses[coupling.source])
        if coupling.name in leans:
            apart[coupling.source].append((leans[coupling.name], differ))
    for terms in apart.values():
        # in thousandths, since the solver counts
        own = sum(round(1000 * lean.own) for lean, _ in terms)
        model.add(own + sum(round(1000 * (lean.across - lean.own)) * differ for lean, differ in terms) <= 1000)
    above: list[cp_model.IntVar] = []
    below: list[cp_model.IntVar] = []
    for source, cross in crosses.items():
        # a bare hub is in the deck that its unit is not in
        for found, there in ((above, 1 - upper[source]), (below, upper[source])):
            found.append(model.new_bool_var(f"bare.{source}.{len(found)}"))
            model.add(found[-1] >= cross + there - 1)
    count = sum(upper.values())
    least = max(1, len(upper) // LEAST)
    model.add(count >= least)
    model.add(len(upper) - count >= least)
    model.add(count + sum(above) <= most)
    model.add(len(upper) - count + sum(below) <= most)
    # the two decks are alike: fix one mass
    model.add(upper[network.masses[0].name] == 0)
    # of choices with as few crossings, each seed has its own favourite
    tastes = random.Random(seed)
    model.minimize(sum((TASTE + tastes.randrange(TASTE // 4)) * cross for cross in crosses.values()))
    solver = solver_with(seed, LIMIT)
    if solver.solve(model) not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None
    return {name: Deck.UPPER if solver.boolean_value(literal) else Deck.LOWER for name, literal in upper.items()}


def _sources(network: Network) -> tuple[str, ...]:
    return tuple(dict.fromkeys(coupling.source for coupling in network.couplings))


def crossing(network: Network, units: Units) -> tuple[str, ...]:
    """The masses whose nets cross, in the network's order: each has a bare hub in the other deck."""
    across = {item.source for item in network.couplings if units[item.source] is not units[item.target]}
    return tuple(mass.name for mass in network.masses if mass.name in across)


def network_in(network: Network, units: Units, deck: Deck) -> Network:
    """What a deck realises: its units, the bare hubs of the other's nets, and the couplings that end at its units."""
    bare = {name for name in crossing(network, units) if units[name] is not deck}
    here = {name for name, where in units.items() if where is deck}
    return replace(
        network,
        masses=tuple(
            mass if mass.name in here else replace(mass, bias=0.0, port=None)
            for mass in network.masses
            if mass.name in here or mass.name in bare
        ),
        couplings=tuple(coupling for coupling in network.couplings if coupling.target in here),
        sensors=tuple(port for port in network.sensors if port.mass in here),
        actuators=tuple(port for port in network.actuators if port.mass in here),
        registers=tuple(register for register in network.registers if register.mass in here),
        tick=network.tick if network.tick in here else None,
    )


def rules_in(rules: LayoutRules, network: Network, units: Units, deck: Deck) -> LayoutRules:
    """The rules of a deck: the bias leaves of its own units, and the names of its own plates.

    The pins of a bare hub are longer, and so softer, than those of a unit: what it drives is to stand in its column.
    """
    across = (coupling for coupling in network.couplings if units[coupling.source] is not units[coupling.target])
    return replace(
        rules,
        biases=_here(rules.biases, units, deck),
        bias_offsets=_here(rules.bias_offsets, units, deck),
        bias_ends=_here(rules.bias_ends, units, deck),
        link_plates=tuple(plate_in(deck, plate) for plate in rules.link_plates),
        near=tuple(dict.fromkeys((*rules.near, *(coupling.name for coupling in across)))),
    )


def _here(by_mass: Mapping[str, float], units: Units, deck: Deck) -> dict[str, float]:
    return {mass: value for mass, value in by_mass.items() if units[mass] is deck}
