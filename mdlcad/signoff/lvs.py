"""Layout versus schematic: the connections recovered from geometry alone, held against the network.

Only the names of units are taken from the file (they pin the two graphs to each other; without them permuted twins
would match). Everything else, which carrier is pinned to which shuttle, which coupler joins which, which coupler is a
rocker, follows from bodies that touch.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import networkx as nx
import shapely
from shapely import Polygon

from mdlcad.network.model import Network
from mdlcad.signoff.readback import ReadBody

# Two bodies that come this close are in contact; far above rounding, far below any clearance.
CONTACT_MM = 2e-3


@dataclass(frozen=True, slots=True)
class Connection:
    """A coupling found in the geometry, from a unit's carrier to another unit's shuttle; negative if it is a rocker.

    Attributes:
        body: name of the flexure that it is; post: name of the post that it turns on, if any.
    """

    source: str
    target: str
    negative: bool
    body: str = ""
    post: str | None = None


@dataclass(frozen=True, slots=True)
class BiasFound:
    """A bias leaf found in the geometry: the unit whose shuttle it pulls, its name and that of its post."""

    mass: str
    body: str
    post: str


@dataclass(frozen=True, slots=True)
class LvsResult:
    """Differences between geometry and network, in words; ``matched`` if there are none and something was compared."""

    matched: bool
    units: int
    connections: int
    biases: int
    differences: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Recovered:
    """What the geometry is: units by name, connections, bias leaves, and what could not be understood.

    Attributes:
        carriers: by unit, the names of the rigid bodies that move with its shuttle.
    """

    units: tuple[str, ...]
    connections: tuple[Connection, ...]
    biases: tuple[BiasFound, ...]
    problems: tuple[str, ...]
    carriers: dict[str, tuple[str, ...]]

    @property
    def biased(self) -> tuple[str, ...]:
        """The units that a bias leaf pulls, one entry a leaf."""
        return tuple(item.mass for item in self.biases)


def contacts(bodies: Sequence[ReadBody]) -> list[tuple[int, int]]:
    """Pairs of bodies that touch: sections within CONTACT_MM where their extents in z overlap."""
    if not bodies:
        return []
    tree = shapely.STRtree([body.section for body in bodies])
    left, right = tree.query([body.section for body in bodies], predicate="dwithin", distance=CONTACT_MM)
    pairs = []
    for a, b in sorted(zip(left.tolist(), right.tolist(), strict=True)):
        if a < b and _overlap_in_z(bodies[a], bodies[b]):
            pairs.append((a, b))
    return pairs


def _overlap_in_z(a: ReadBody, b: ReadBody) -> bool:
    return min(a.z + a.thickness, b.z + b.thickness) - max(a.z, b.z) > 1e-6


def _kind(name: str) -> str:
    return name.partition(".")[0]


_RIGID = ("rung", "trunk", "tab", "pin")
_FLEXURES = ("coupler", "rocker", "bias")
_CARRIED = ("rung", "trunk", "tab", "pin", "coupler", "rocker", "bias")
"""What moves with a shuttle, clock pins apart."""


def recover(bodies: Sequence[ReadBody]) -> Recovered:
    """Units, connections and biases from contacts between bodies."""
    pairs = contacts(bodies)
    kinds = [_kind(body.name) for body in bodies]
    rigid = nx.Graph()
    rigid.add_nodes_from(index for index, kind in enumerate(kinds) if kind in _RIGID)
    rigid.add_edges_from((a, b) for a, b in pairs if kinds[a] in _RIGID and kinds[b] in _RIGID)
    group = {index: number for number, part in enumerate(nx.connected_components(rigid)) for index in part}
    problems = _jams(bodies, pairs) + _unguided(bodies, pairs)
    owner: dict[int, set[str]] = {}
    clock_groups: set[int] = set()
    for a, b in pairs:
        for one, other in ((a, b), (b, a)):
            if kinds[one] in _RIGID and kinds[other] == "unit" and not bodies[one].name.startswith("pin.clock."):
                owner.setdefault(group[one], set()).add(bodies[other].name.removeprefix("unit."))
            if kinds[one] == "pin" and bodies[one].name.startswith("pin.clock."):
                clock_groups.add(group[one])
    for _, joined in sorted(owner.items()):
        if len(joined) > 1:
            problems.append(f"short: the shuttles of {', '.join(sorted(joined))} are joined by one carrier")
    shuttle = {number: min(joined) for number, joined in owner.items()}
    for number in sorted(set(group.values()) - set(shuttle) - clock_groups):
        names = sorted(bodies[index].name for index, part in group.items() if part == number)
        problems.append(f"loose: {names[0]} and {len(names) - 1} more bodies are pinned to no shuttle")
    connections, biases = _flexures(bodies, pairs, kinds, group, shuttle, problems)
    units = tuple(
        sorted(body.name.removeprefix("unit.") for body, kind in zip(bodies, kinds, strict=True) if kind == "unit")
    )
    # the pins of a hub's two sides are joined by the shuttle alone: one mass may carry two groups
    carried = {
        mass: tuple(sorted(bodies[index].name for index, part in group.items() if shuttle.get(part) == mass))
        for mass in shuttle.values()
    }
    return Recovered(units, tuple(connections), tuple(biases), tuple(problems), carried)


def _jams(bodies: Sequence[ReadBody], pairs: list[tuple[int, int]]) -> list[str]:
    """What moves and touches what stands still or moves another way: a slot or notch is missing, or a pin misplaced."""
    clocks = {body.name.removeprefix("handle.") for body in bodies if body.name.startswith("handle.")}
    driven: dict[str, list[str]] = {}
    found = []
    for a, b in pairs:
        for one, other in ((bodies[a].name, bodies[b].name), (bodies[b].name, bodies[a].name)):
            still = _kind(other) == "frame" or ("." not in other and other not in clocks)
            if one.startswith("pin.clock."):
                if other in clocks:
                    driven.setdefault(one, []).append(other)
                elif still or _kind(other) in _CARRIED:
                    found.append(f"jam: {one} meets {other}")
            elif _kind(one) in _CARRIED and (still or other in clocks or _kind(other) == "handle"):
                found.append(f"jam: {one} meets {other}")
            elif _kind(one) == "post" and _kind(other) in _RIGID:
                found.append(f"jam: {other} meets {one}")
            elif one in clocks and _kind(other) in ("spacer", "frame"):
                found.append(f"jam: {one} meets {other}")
            elif _kind(one) == "post" and other in clocks:
                found.append(f"jam: {one} meets {other}, where a slot should be")
    for pin, plates in sorted(driven.items()):
        if len(plates) > 1:
            found.append(f"jam: {pin} meets {' and '.join(sorted(plates))}: one of them lacks its slot")
    loose = sorted(
        body.name for body in bodies if clocks and body.name.startswith("pin.clock.") and body.name not in driven
    )
    return found + [f"open: {name} meets no clock plate" for name in loose]


_GUIDES = 2
"""Guides of a clock plate: with one it can turn."""


def _unguided(bodies: Sequence[ReadBody], pairs: list[tuple[int, int]]) -> list[str]:
    """Guides that do not join a clock plate to its rim, and clock plates that they do not keep from turning."""
    clocks = {body.name.removeprefix("handle."): 0 for body in bodies if body.name.startswith("handle.")}
    joined: dict[str, set[str]] = {body.name: set() for body in bodies if _kind(body.name) == "guide"}
    for a, b in pairs:
        for one, other in ((bodies[a].name, bodies[b].name), (bodies[b].name, bodies[a].name)):
            if one in joined:
                joined[one].add(other)
    found = []
    for name, others in joined.items():
        plates, rims = others & set(clocks), {other for other in others if _kind(other) == "spacer"}
        if len(plates) != 1 or len(rims) != 1 or len(others) != 2:
            found.append(f"open: {name} joins {', '.join(sorted(others)) or 'nothing'}, not a clock plate and its rim")
        else:
            clocks[plates.pop()] += 1
    return found + [
        f"open: {count} guides hold {plate}, {_GUIDES} are needed"
        for plate, count in clocks.items()
        if count != _GUIDES
    ]


def _flexures(
    bodies: Sequence[ReadBody],
    pairs: list[tuple[int, int]],
    kinds: list[str],
    group: dict[int, int],
    shuttle: dict[int, str],
    problems: list[str],
) -> tuple[list[Connection], list[BiasFound]]:
    touching: dict[int, list[int]] = {index: [] for index, kind in enumerate(kinds) if kind in _FLEXURES}
    for a, b in pairs:
        if a in touching:
            touching[a].append(b)
        if b in touching:
            touching[b].append(a)
    posts_at = [index for index, kind in enumerate(kinds) if kind == "post"]
    connections, biases = [], []
    for index, others in touching.items():
        bars = {shuttle.get(group[o], "?") for o in others if kinds[o] in ("rung", "trunk", "tab")}
        hubs = {shuttle.get(group[o], "?") for o in others if kinds[o] == "pin"}
        held = [bodies[post].name for post in posts_at if _surrounds(bodies[index], bodies[post])]
        posts = len(held)
        name = bodies[index].name
        if len(hubs) != 1 or len(bars) > 1 or (not bars and posts != 1) or posts > 1:
            problems.append(
                f"open: {name} touches carriers of {sorted(bars)}, shuttles of {sorted(hubs)}, {posts} posts"
            )
        elif bars:
            connections.append(Connection(bars.pop(), hubs.pop(), posts == 1, name, held[0] if held else None))
        else:
            biases.append(BiasFound(hubs.pop(), name, held[0]))
    connections.sort(key=lambda item: (item.source, item.target))
    biases.sort(key=lambda item: item.mass)
    return connections, biases


def _surrounds(flexure: ReadBody, post: ReadBody) -> bool:
    """Whether the post stands in an eye or slot of the flexure (with play, so they need not touch)."""
    outline = Polygon(flexure.section.exterior)
    return _overlap_in_z(flexure, post) and bool(outline.contains(post.section.centroid))


def compare(recovered: Recovered, network: Network) -> LvsResult:
    """Hold what the geometry is against what the network says."""
    differences = list(recovered.problems)
    wanted_units = {mass.name for mass in network.masses}
    differences += [f"unit missing: {name}" for name in sorted(wanted_units - set(recovered.units))]
    differences += [f"unit not in the network: {name}" for name in sorted(set(recovered.units) - wanted_units)]
    wanted = sorted((c.source, c.target, c.strength < 0) for c in network.couplings)
    found = sorted((c.source, c.target, c.negative) for c in recovered.connections)
    differences += [f"coupling missing: {_words(item)}" for item in _minus(wanted, found)]
    differences += [f"coupling not in the network: {_words(item)}" for item in _minus(found, wanted)]
    wanted_biases = sorted(mass.name for mass in network.masses if mass.bias)
    differences += [f"bias missing: {name}" for name in _minus(wanted_biases, list(recovered.biased))]
    differences += [f"bias not in the network: {name}" for name in _minus(list(recovered.biased), wanted_biases)]
    compared = len(recovered.units) + len(recovered.connections)
    if not compared:
        differences.append("nothing to compare: no units and no couplings were found in the geometry")
    return LvsResult(
        matched=not differences,
        units=len(recovered.units),
        connections=len(recovered.connections),
        biases=len(recovered.biased),
        differences=tuple(differences),
    )


def _words(item: tuple[str, str, bool]) -> str:
    return f"{item[0]}->{item[1]} ({'negative' if item[2] else 'positive'})"


def _minus(left: list, right: list) -> list:  # type: ignore[type-arg]
    """Multiset difference, in order."""
    rest = list(right)
    missing = []
    for item in left:
        if item in rest:
            rest.remove(item)
        else:
            missing.append(item)
    return missing
