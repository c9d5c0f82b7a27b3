"""Benches of a library of kind ``parametron``: every gate that a mass can make, at the limits of load and echo.

A gate of phase 2 stands between copies of the inputs (phase 1, behind the sensors) and targets of phase 0, which have
inputs of their own (sensors of phase 2) and targets of their own (sinks of phase 1). These hold old values while the
gate decides, and are what pushes back. A decision takes two cycles; the gate and all of its targets are read.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from mdlcad.characterise.bench import Bench, Gates, make_bench
from mdlcad.mapping.build import coupling_of
from mdlcad.mapping.cell_library import Library
from mdlcad.mapping.threshold import Threshold
from mdlcad.network.model import Mass, MassKind, Network, PortBit
from mdlcad.proof.behaviour import Bits

GATES = {
    "copy": Threshold((1,), 0),
    "not": Threshold((-1,), 0),
    "and of 2": Threshold((1, 1), -1),
    "or of 2": Threshold((1, 1), 1),
    "majority of 3": Threshold((1, 1, 1), 0),
    "and of 3": Threshold((1, 1, 1), -2),
    "or of 3": Threshold((1, 1, 1), 2),
    "a and (b or c)": Threshold((2, 1, 1), -1),
    "a or (b and c)": Threshold((2, 1, 1), 1),
    "a unless b, c, d agree against it": Threshold((2, 1, 1, 1), 0),
    "3 of 4": Threshold((1, 1, 1, 1), -1),
    "2 of 4": Threshold((1, 1, 1, 1), 1),
    "majority of 5": Threshold((1, 1, 1, 1, 1), 0),
}

# what hangs at a gate whose echo, not its fan-out, is tried: targets as heavy as the weight limit allows
_HEAVY = 2


@dataclass
class _Draft:
    """A bench under construction."""

    cells: Library
    masses: list[tuple[str, MassKind, int, int]] = field(default_factory=list)  # name, kind, phase, bias weight
    springs: list[tuple[str, str, int]] = field(default_factory=list)
    sensors: list[str] = field(default_factory=list)
    outputs: dict[str, tuple[tuple[str, int], ...]] = field(default_factory=dict)  # mass -> (sensor or gate, weight)

    def sensor(self, name: str, phase: int) -> str:
        self.masses.append((name, MassKind.SENSOR, phase, 0))
        self.sensors.append(name)
        return name

    def gate(self, name: str, phase: int, sources: tuple[tuple[str, int], ...], bias: int = 0) -> str:
        self.masses.append((name, MassKind.GATE, phase, bias))
        self.springs += [(source, name, weight) for source, weight in sources]
        return name

    def network(self, cell: str, watched: tuple[str, ...]) -> Network:
        library = self.cells
        couplings = tuple(coupling_of(library, *spring) for spring in self.springs)
        load = dict.fromkeys((name for name, *_ in self.masses), 0.0)
        for coupling in couplings:
            load[coupling.source] += coupling.self_stiffness
            load[coupling.target] += coupling.self_stiffness
        masses = tuple(
            Mass(
                name=name,
                kind=kind,
                phase=phase,
                k0=library.mass.k0,
                k1=library.mass.k1,
                compensation=-load[name] if library.coupling.compensated else 0.0,
                bias=-bias * library.bias.force,
                initial=-library.power_up.well if phase == 2 else 0.0,
            )
            for name, kind, phase, bias in self.masses
        )
        return Network(
            design=cell,
            cells=library.name,
            dynamics=library.network_dynamics(),
            masses=masses,
            couplings=couplings,
            sensors=tuple(PortBit(name, name) for name in self.sensors),
            actuators=tuple(PortBit(name, name) for name in watched),
            registers=(),
            tick=None,
            cycles_per_tick=2,
        )


def gate_bench(
    library: Library, cell: str, function: Threshold, targets: tuple[tuple[int, int], ...], seed: int
) -> Bench:
    """A bench of ``function``; it drives ``targets``: (weight of its spring, weight of their other springs)."""
    draft = _Draft(library)
    count = len(function.weights)
    sources = []
    for i, weight in enumerate(function.weights):
        draft.sensor(f"in{i}", 0)
        sources.append((draft.gate(f"copy{i}", 1, ((f"in{i}", 1),)), weight))
    draft.gate("gate", 2, tuple(sources), function.bias)
    shown: list[tuple[str, tuple[tuple[int, int], ...], int]] = []  # mass, (column of its side inputs, weight), bias
    column = count
    for t, (weight, others) in enumerate(targets):
        sides = min(max(0, others - 1), library.gates.weight_limit - weight)
        names = [draft.sensor(f"side{t}.{s}", 2) for s in range(sides)]
        bias = (weight + sides + 1) % 2
        draft.gate(f"target{t}", 0, (("gate", weight), *((name, 1) for name in names)), bias)
        if others > sides:
            draft.gate(f"sink{t}", 1, ((f"target{t}", others - sides),))
        shown.append((f"target{t}", tuple((column + s, 1) for s in range(sides)), bias))
        column += sides

    def rule(inputs: Bits) -> Bits:
        sign = 2 * inputs.astype(np.int64) - 1
        out = np.sign(sign[:, :count] @ np.array(function.weights) + function.bias)
        read = [out]
        for (_, sides, bias), (weight, _) in zip(shown, targets, strict=True):
            read.append(np.sign(weight * out + bias + sum(sign[:, place] * w for place, w in sides)))
        return (np.stack(read, axis=1) > 0).astype(np.uint8)

    watched = ("gate", *(name for name, _, _ in shown))
    network = draft.network(cell, watched)
    return make_bench(cell, network, Gates(tuple(draft.sensors), watched, rule), seed)


def many_targets(load: int, echo: int) -> tuple[tuple[int, int], ...]:
    """``load`` targets of weight one that together echo ``echo``, as evenly as it goes."""
    return tuple((1, echo // load + (t < echo % load)) for t in range(load))


def heavy_targets(echo: int, weight_limit: int) -> tuple[tuple[int, int], ...]:
    """As few targets of weight two as can echo ``echo`` together (or one less)."""
    most = weight_limit - _HEAVY + 1
    targets = []
    while echo >= _HEAVY:
        others = min(most, echo // _HEAVY)
        targets.append((_HEAVY, others))
        echo -= _HEAVY * others
    return tuple(targets)


def gate_benches(library: Library, seed: int) -> Iterator[Bench]:
    """Every gate within the weight limit at the echo limit, and two at the fan-out limit."""
    limits = library.gates
    for cell, function in GATES.items():
        if function.total <= limits.weight_limit:
            yield gate_bench(library, cell, function, heavy_targets(limits.echo_limit, limits.weight_limit), seed)
    fan_out = many_targets(limits.load_limit, limits.echo_limit)
    for cell in ("copy", "and of 2"):
        yield gate_bench(library, f"{cell}, fan-out {limits.load_limit}", GATES[cell], fan_out, seed)
