"""Synthetic networks with the statistics of compiled programs, and rules like those of a POM device."""

from __future__ import annotations

import random

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Coupling, Dynamics, Mass, MassKind, Network, PortBit
from mdlcad.placement.ports import PortPlace

SQUARE = ((0, 0), (0, 39), (39, 39), (39, 0))
HOUSE = ((0, 35), (20, 49), (39, 35), (39, 0), (0, 0))


def synthetic(
    masses: int, couplings: int, ring: int, fan_out: int, negative: int, sensors: int, actuators: int, seed: int
):
    """A layered random network: a tick ring that drives registers, gates of at most three inputs near in depth."""
    rng = random.Random(seed)
    names = [f"tick[{i}]" for i in range(ring)] + [f"g{i}" for i in range(masses - ring - sensors)]
    ins = [f"s{i}" for i in range(sensors)]
    gates = names[ring:]
    edges = {(names[i], names[(i + 1) % ring]) for i in range(ring)}
    degree: dict[str, int] = {}
    for _, target in sorted(edges):
        degree[target] = degree.get(target, 0) + 1
    for gate in rng.sample(gates, fan_out - 1):
        edges.add((names[0], gate))
        degree[gate] = degree.get(gate, 0) + 1
    out: dict[str, int] = {}
    for i, sensor in enumerate(ins):
        for gate in rng.sample(gates[: len(gates) // 2], 2 if i % 2 else 1):
            edges.add((sensor, gate))
            degree[gate] = degree.get(gate, 0) + 1
    while len(edges) < couplings:
        starved = [i for i, gate in enumerate(gates) if degree.get(gate, 0) == 0]
        at = starved[0] if starved else rng.randrange(len(gates))
        target = gates[at]
        source = gates[(at - rng.choice((1, 1, 1, 2, 2, 3, 4, 5, 7))) % len(gates)]
        if source == target or (source, target) in edges or (target, source) in edges:
            continue
        if degree.get(target, 0) >= 3 or out.get(source, 0) >= 3:
            continue
        edges.add((source, target))
        degree[target] = degree.get(target, 0) + 1
        out[source] = out.get(source, 0) + 1
    order = sorted(edges)
    minus = set(rng.sample([e for e in order if e[1] in gates], negative))
    seen: set[str] = set()
    minus = {e for e in sorted(minus) if not (e[1] in seen or seen.add(e[1]))}
    biased = {gate for gate in gates if degree.get(gate, 0) == 2 and rng.random() < 0.8}

    def mass(name: str) -> Mass:
        kind = MassKind.SENSOR if name in ins else MassKind.TICK if name.startswith("tick") else MassKind.GATE
        return Mass(name, kind, 0, 3.0, -2.75, 0.0, 0.5 if name in biased else 0.0, 0.0)

    return Network(
        design="synthetic",
        cells="parametron",
        dynamics=Dynamics(0.05, 0.25, 1.0, 10.0, 3),
        masses=tuple(mass(name) for name in names + ins),
        couplings=tuple(Coupling(a, b, -0.3 if (a, b) in minus else 0.3, 0.3) for a, b in order),
        sensors=tuple(PortBit(f"S{i}[0]", name) for i, name in enumerate(ins)),
        actuators=tuple(PortBit(f"A[{i}]", gates[-1 - i]) for i in range(actuators)),
        registers=(),
        tick=names[0],
        cycles_per_tick=4,
    )


def maze(seed: int = 1) -> Network:
    return synthetic(53, 73, 12, 5, 8, 4, 2, seed)


def lock(seed: int = 1) -> Network:
    return synthetic(82, 124, 12, 10, 14, 6, 1, seed)


MAZE_PORTS = (
    PortPlace("S0[0]", "left", 0, 19.5, (-1.0, 0.0)),
    PortPlace("S1[0]", "top", 19.5, 39, (0.0, 1.0)),
    PortPlace("S2[0]", "right", 39, 19.5, (1.0, 0.0)),
    PortPlace("S3[0]", "bottom", 19.5, 0, (0.0, -1.0)),
    PortPlace("A[0]", "bottom", 35.1, 0, (0.0, -1.0)),
    PortPlace("A[1]", "bottom", 39, 0, (0.0, -1.0)),
)
LOCK_PORTS = (
    *(PortPlace(f"S{i}[0]", "leftline", 0, 35 * (i + 1) / 5, (-1.0, 0.0)) for i in range(4)),
    PortPlace("S4[0]", "downline", 3.9, 0, (0.0, -1.0)),
    PortPlace("S5[0]", "downline", 11.7, 0, (0.0, -1.0)),
    PortPlace("A[0]", "rightline", 39, 17.5, (1.0, 0.0)),
)


def pom_rules(network: Network) -> LayoutRules:
    """About what mechanics makes of POM."""
    negative = [c.name for c in network.couplings if c.strength < 0]
    return LayoutRules(
        unit_left=23.0,
        unit_right=24.0,
        column_pitch=50.0,
        row_pitch=13.2,
        frame_width=5.0,
        gap=0.6,
        throw=3.0,
        clock_throw=1.5,
        bar_width=4.0,
        pin=2.0,
        hub_pin_offset=2.7,
        hub_half=5.0,
        hub_gap=0.6,
        hub_height=6.5,
        track_pitch=4.6,
        couplers={c.name: 24.0 if c.strength < 0 else 19.0 for c in network.couplings},
        biases={m.name: 19.0 for m in network.masses if m.bias != 0},
        post_radius=1.0,
        post_offset=dict.fromkeys(negative, 12.0),
        link_plates=("H0", "H1", "H2", "H3"),
    )


def small(seed: int = 1) -> tuple[Network, tuple[PortPlace, ...], LayoutRules]:
    """Sixteen masses, two sensors, one actuator (in the corner of the square)."""
    network = synthetic(16, 22, 3, 3, 3, 2, 1, seed)
    ports = (MAZE_PORTS[0], MAZE_PORTS[1], PortPlace("A[0]", "bottom", 39, 0, (0.0, -1.0)))
    return network, ports, pom_rules(network)
