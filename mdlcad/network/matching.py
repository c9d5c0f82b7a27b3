"""Which mass of B is which mass of A: by name, and where names went, by what the masses are joined to.

Masses of one name are one mass. The rest are matched twice. First exactly: colours are refined over the graph
(Weisfeiler-Leman) until they settle, with the matched masses as fixed points, and masses that share a colour are the
same; masses that no walk can tell apart are paired in the order of their names, since any pairing is right. Then by
likeness, for a mass that was both renamed and rewired: an assignment that maximises shared neighbours, of which only
pairs that share at least half are kept.
"""

from __future__ import annotations

import hashlib
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import linear_sum_assignment

from mdlcad.network.model import Coupling, Mass, Network

LIKE_ENOUGH = 0.5
_MOST_ROUNDS = 32
# a neighbour as it is seen from a mass: direction, sign and kind of the coupling, and who it is
_Neighbour = tuple[str, str]


def renamed_masses(a: Network, b: Network) -> dict[str, str]:
    """Mass of A -> mass of B, for those whose names differ."""
    names_a, names_b = {mass.name for mass in a.masses}, {mass.name for mass in b.masses}
    fixed = {name: name for name in sorted(names_a & names_b)}
    lost = [mass for mass in a.masses if mass.name not in names_b]
    new = [mass for mass in b.masses if mass.name not in names_a]
    if not lost or not new:
        return {}
    found = _exact(a, b, fixed, lost, new)
    lost = [mass for mass in lost if mass.name not in found]
    taken = set(found.values())
    new = [mass for mass in new if mass.name not in taken]
    return found | _alike(a, b, fixed | found, lost, new)


def renamed(network: Network, names: Mapping[str, str]) -> Network:
    """``network`` with masses called anew: old name -> new name."""
    return replace(
        network,
        masses=tuple(replace(mass, name=names.get(mass.name, mass.name)) for mass in network.masses),
        couplings=tuple(
            replace(item, source=names.get(item.source, item.source), target=names.get(item.target, item.target))
            for item in network.couplings
        ),
    )


def changed_masses(a: Network, b: Network) -> frozenset[str]:
    """Masses of B that A has under the same name, but of another kind or phase, another bias or other inputs.

    Which way up a mass is used does not count: it computes the same.
    """
    before, after = _recipes(a), _recipes(b)
    return frozenset(name for name, recipe in after.items() if name in before and before[name] != recipe)


def _recipes(network: Network) -> dict[str, tuple[object, ...]]:
    """By mass what it computes: kind, phase, bias and inputs, all as if every mass were upright."""
    upright = {mass.name: mass.polarity for mass in network.masses}
    inputs: dict[str, list[tuple[str, str, float]]] = {name: [] for name in upright}
    for item in network.couplings:
        strength = item.strength * upright.get(item.source, 1) * upright[item.target]
        inputs[item.target].append((item.source, item.kind, round(strength, 9)))
    return {
        mass.name: (mass.kind, mass.phase, round(mass.bias * mass.polarity, 9), tuple(sorted(inputs[mass.name])))
        for mass in network.masses
    }


def _edges(network: Network) -> dict[str, list[tuple[str, str]]]:
    """For each mass, (how, neighbour) of its couplings; ends outside of the network are left out."""
    known = {mass.name for mass in network.masses}
    edges: dict[str, list[tuple[str, str]]] = {name: [] for name in known}
    for item in network.couplings:
        if item.source in known and item.target in known:
            how = _how(item)
            edges[item.source].append((f"to {how}", item.target))
            edges[item.target].append((f"from {how}", item.source))
    return edges


def _how(item: Coupling) -> str:
    return f"{item.kind} {'+' if item.strength > 0 else '-'}"


def _nature(mass: Mass) -> str:
    return f"{mass.kind} {mass.phase} {mass.port} {np.sign(mass.bias):.0f}"


def _exact(
    a: Network, b: Network, fixed: Mapping[str, str], lost: Sequence[Mass], new: Sequence[Mass]
) -> dict[str, str]:
    rounds = min(max(len(lost), len(new)), _MOST_ROUNDS)  # the same for both, for colours to mean the same
    colours_a, colours_b = _colours(a, fixed, rounds), _colours(b, {name: name for name in fixed.values()}, rounds)
    classes_a, classes_b = _classes(lost, colours_a), _classes(new, colours_b)
    found: dict[str, str] = {}
    for colour, members in classes_a.items():
        others = classes_b.get(colour, [])
        if len(others) == len(members):
            found.update(zip(members, others, strict=True))
    return found


def _classes(masses: Sequence[Mass], colours: Mapping[str, str]) -> dict[str, list[str]]:
    classes: dict[str, list[str]] = defaultdict(list)
    for name in sorted(mass.name for mass in masses):
        classes[colours[name]].append(name)
    return classes


def _colours(network: Network, fixed: Mapping[str, str], rounds: int) -> dict[str, str]:
    """A colour for every mass: its name where that is fixed, else what can be told from its surroundings."""
    edges = _edges(network)
    colours = {mass.name: fixed.get(mass.name, "?" + _nature(mass)) for mass in network.masses}
    loose = [mass for mass in network.masses if mass.name not in fixed]
    for _ in range(rounds):
        fresh = dict(colours)
        for mass in loose:
            around = sorted(f"{how} {colours[other]}" for how, other in edges[mass.name])
            text = "\n".join([colours[mass.name], *around])
            fresh[mass.name] = "?" + hashlib.sha256(text.encode()).hexdigest()
        colours = fresh
    return colours


def _alike(
    a: Network, b: Network, known: Mapping[str, str], lost: Sequence[Mass], new: Sequence[Mass]
) -> dict[str, str]:
    if not lost or not new:
        return {}
    seen_a = _surroundings(a, known)
    seen_b = _surroundings(b, {name: name for name in known.values()})
    likeness = np.zeros((len(lost), len(new)))
    for row, one in enumerate(lost):
        for column, other in enumerate(new):
            if one.kind == other.kind and one.port == other.port:
                likeness[row, column] = _share(seen_a[one.name], seen_b[other.name])
    rows, columns = linear_sum_assignment(-likeness)
    return {lost[r].name: new[c].name for r, c in zip(rows, columns, strict=True) if likeness[r, c] >= LIKE_ENOUGH}


def _surroundings(network: Network, known: Mapping[str, str]) -> dict[str, frozenset[_Neighbour]]:
    return {
        name: frozenset((how, known[other]) for how, other in around if other in known)
        for name, around in _edges(network).items()
    }


def _share(a: frozenset[_Neighbour], b: frozenset[_Neighbour]) -> float:
    return len(a & b) / len(a | b) if a or b else 0.0
