"""Which column every mass of two decks stands in: both decks at once, because a bare hub stands where its unit does."""

from __future__ import annotations

from collections.abc import Mapping

from ortools.sat.python import cp_model

from mdlcad.mechanics.decks import Deck
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.columns import PASSED
from mdlcad.placement.decks import Units, network_in, rules_in
from mdlcad.placement.grid import way
from mdlcad.placement.lattice import Lattice
from mdlcad.solver import solver_with

LIMIT = 0.6
"""CP-SAT's deterministic time."""
FULL = 0.8
"""A column with more of its slots taken leaves annealing little room; each slot beyond costs as much as ``CROWDED``
trunks."""
CROWDED = 3


def choose_deck_columns(
    network: Network,
    units: Units,
    lattices: Mapping[Deck, Lattice],
    rules: LayoutRules,
    seed: int,
) -> dict[str, int] | None:
    """A column for every mass, the same in both decks; None if there is no way or none was found in the limit."""
    count = len(lattices[Deck.LOWER].column_x)
    model = cp_model.CpModel()
    at = {mass.name: [model.new_bool_var(f"at.{mass.name}.{c}") for c in range(count)] for mass in network.masses}
    for row in at.values():
        model.add_exactly_one(row)
    costs: list[cp_model.LinearExprT] = []
    for deck in Deck:
        lattice, inside = lattices[deck], network_in(network, units, deck)
        near = rules_in(rules, network, units, deck).near
        for column in range(count):
            room = sum(1 for slot in lattice.slots if slot[0] == column)
            taken = sum(at[mass.name][column] for mass in inside.masses)
            crowd = model.new_int_var(0, room, f"crowd.{deck}.{column}")
            model.add(taken <= room)
            model.add(crowd >= taken - int(FULL * room))
            costs.append(CROWDED * crowd)
        sources = dict.fromkeys([item.source for item in inside.couplings] + [tab.mass for tab in lattice.tabs])
        trunk = {m: [model.new_bool_var(f"trunk.{deck}.{m}.{k}") for k in range(count + 1)] for m in sources}
        for coupling in inside.couplings:
            reach = int(coupling.name not in near)
            for a in range(count):
                for b in range(count):
                    apart = [~at[coupling.source][a], ~at[coupling.target][b]]
                    if a == b:
                        model.add_bool_or([*apart, trunk[coupling.source][a], trunk[coupling.source][a + 1]])
                    elif abs(a - b) <= reach:
                        model.add_bool_or([*apart, trunk[coupling.source][max(a, b)]])
                    else:
                        model.add_bool_or(apart)
        for tab in lattice.tabs:
            for column in range(count):
                found = way(tab, column)
                if found is None:
                    model.add(at[tab.mass][column] == 0)
                    continue
                model.add_implication(at[tab.mass][column], trunk[tab.mass][found.channel])
                costs.append(PASSED * max(0, found.last - found.first + 1) * at[tab.mass][column])
        most = model.new_int_var(0, len(at), f"most.{deck}")
        for k in range(count + 1):
            load = sum(row[k] for row in trunk.values())
            model.add(load <= most)
            costs.append(load)
        costs.append(2 * most)
    model.minimize(sum(costs))
    solver = solver_with(seed, LIMIT)
    if solver.solve(model) not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None
    return {
        name: next(column for column, literal in enumerate(row) if solver.boolean_value(literal))
        for name, row in at.items()
    }
