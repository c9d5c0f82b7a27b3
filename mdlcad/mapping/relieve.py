"""Twins for masses whose targets pull back too hard.

A passive spring works both ways. While mass i decides, its targets are reset and soft but not rigid: each is pulled
aside by its own targets, which still hold their old values, and by its other sources, which decide together with i;
and it pushes i. The push grows with the *echo* of i, the sum over its targets t of (weight of i -> t) times (total
weight of all other couplings of t), and too much of it outweighs an input of weight one. So no mass may echo more than
the library allows. A twin computes the same from the same sources and takes over some of the targets. Sensors are held
by their drive and need no relief.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace

from mdlcad.errors import UsageError
from mdlcad.mapping.plan import Key, PlannedMass, Role


class _Web:
    """The masses while twins are added: weights of all couplings, by source."""

    def __init__(self, masses: tuple[PlannedMass, ...]) -> None:
        self.masses = {mass.key: mass for mass in masses}
        self.targets: dict[Key, dict[Key, int]] = defaultdict(dict)
        for mass in masses:
            for source, weight in zip(mass.sources, mass.function.weights, strict=True):
                self.targets[source][mass.key] = abs(weight)

    def load(self, key: Key) -> int:
        return sum(self.targets[key].values())

    def echoes(self, key: Key) -> dict[Key, int]:
        """What each target of ``key`` adds to its echo."""
        return {
            target: weight * (self.load(target) + self.masses[target].function.inputs - weight)
            for target, weight in self.targets[key].items()
        }

    def split(self, key: Key, price: dict[Key, int]) -> None:
        """Add a twin of ``key`` and give it targets of about half the price."""
        twin = key._replace(twin=1 + max(other.twin for other in self.masses if other._replace(twin=key.twin) == key))
        mass = self.masses[key]
        self.masses[twin] = replace(mass, key=twin)
        for source, weight in zip(mass.sources, mass.function.weights, strict=True):
            self.targets[source][twin] = abs(weight)
        kept = moved = 0
        for target in sorted(price, key=lambda t: (-price[t], t)):
            if kept <= moved:
                kept += price[target]
                continue
            moved += price[target]
            self.targets[twin][target] = self.targets[key].pop(target)
            other = self.masses[target]
            self.masses[target] = replace(
                other, sources=tuple(twin if source == key else source for source in other.sources)
            )


def relieve(masses: tuple[PlannedMass, ...], load_limit: int, echo_limit: int) -> tuple[PlannedMass, ...]:
    """The masses with twins added until none has a load or an echo beyond its limit.

    Raises:
        UsageError: a sensor feeds more than ``load_limit``, or twins do not help.
    """
    web = _Web(masses)
    for _ in range(20 * len(masses) + 100):
        change = _worst(web, load_limit, echo_limit)
        if change is None:
            return tuple(web.masses.values())
        key, price = change
        web.split(key, price)
    raise UsageError("the library's fan-out and echo limits are too tight for this device; raise them")


def _worst(web: _Web, load_limit: int, echo_limit: int) -> tuple[Key, dict[Key, int]] | None:
    """The mass to split next and the price of each of its targets."""
    for key in sorted(web.masses):
        if key.role is Role.SENSOR:
            continue
        targets = web.targets[key]
        if len(targets) > 1 and web.load(key) > load_limit:
            return key, dict(targets)
    for key in sorted(web.masses):
        echoes = {} if key.role is Role.SENSOR else web.echoes(key)
        if sum(echoes.values()) <= echo_limit:
            continue
        if len(echoes) > 1:
            return key, echoes
        (target,) = echoes
        if len(web.targets[target]) > 1:
            return target, dict(web.targets[target])
    return None
