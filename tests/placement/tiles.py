"""Large networks with the statistics of a compiled one: copies of it, with some couplings swapped between copies."""

from __future__ import annotations

import random
from dataclasses import replace

from mdlcad.network.model import Coupling, MassKind, Network


def tiled(network: Network, copies: int, share: float, reach: int, seed: int) -> Network:
    """``copies`` of ``network`` in a chain, of whose couplings ``share`` have changed their sources.

    Two couplings of one strength in copies at most ``reach`` apart swap their sources, so that every mass keeps its
    numbers of inputs and outputs. Only the first copy keeps its sensors and actuators: no boundary has room for all.
    """
    rng = random.Random(seed)
    couplings = [
        [(f"{copy}.{item.source}", f"{copy}.{item.target}", item) for item in network.couplings]
        for copy in range(copies)
    ]
    masses = tuple(
        replace(mass, name=f"{copy}.{mass.name}", kind=mass.kind if copy == 0 else MassKind.GATE)
        for copy in range(copies)
        for mass in network.masses
    )
    taken = {(source, target) for copy in couplings for source, target, _ in copy}
    wanted, swapped = round(share * len(taken) / 2), 0
    while swapped < wanted:
        here = rng.randrange(copies)
        there = rng.randint(max(0, here - reach), min(copies - 1, here + reach))
        i, j = rng.randrange(len(network.couplings)), rng.randrange(len(network.couplings))
        (a, b, one), (c, d, two) = couplings[here][i], couplings[there][j]
        pairs = {(c, b), (a, d)}
        mirrored = {(y, x) for x, y in pairs}
        if one.strength != two.strength or len({a, b, c, d}) < 4 or (pairs | mirrored) & taken:
            continue
        taken -= {(a, b), (c, d)}
        taken |= pairs
        couplings[here][i], couplings[there][j] = (c, b, one), (a, d, two)
        swapped += 1
    return replace(
        network,
        design=f"{network.design} x {copies}",
        masses=masses,
        couplings=tuple(
            Coupling(a, b, item.strength, item.self_stiffness) for copy in couplings for a, b, item in copy
        ),
        sensors=tuple(replace(bit, mass=f"0.{bit.mass}") for bit in network.sensors),
        actuators=tuple(replace(bit, mass=f"0.{bit.mass}") for bit in network.actuators),
        registers=(),
        tick=None if network.tick is None else f"0.{network.tick}",
    )
