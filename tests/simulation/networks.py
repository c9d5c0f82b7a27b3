"""Networks for tests of the kernel."""

from __future__ import annotations

import numpy as np

from mdlcad.network.model import Coupling, CouplingKind, Dynamics, Mass, MassKind, Network


def random_network(seed: int, n: int = 9, couplings: int = 14, latches: int = 3, damping: float = 0.25) -> Network:
    """Signed, clocked and latch couplings between masses of all phases and random numbers."""
    rng = np.random.default_rng(seed)
    masses = tuple(
        Mass(
            f"m{i}",
            MassKind.GATE,
            phase=int(rng.integers(3)),
            k0=float(rng.uniform(1, 3)),
            k1=float(rng.uniform(-3, -1)),
            compensation=float(rng.uniform(-0.5, 0)),
            bias=float(rng.uniform(-0.5, 0.5)),
            initial=float(rng.uniform(-1.5, 1.5)),
        )
        for i in range(n)
    )
    pairs = []
    for index in range(couplings + latches):
        a, b = (int(i) for i in rng.choice(n, 2, replace=False))
        latch = index >= couplings
        pairs.append(
            Coupling(
                f"m{a}",
                f"m{b}",
                strength=float(rng.uniform(-0.2, 0.2) if latch else rng.uniform(-0.5, 0.5)),
                self_stiffness=0.0 if latch else float(rng.uniform(0, 0.5)),
                kind=CouplingKind.LATCH if latch else CouplingKind.LINEAR,
                d0=float(rng.uniform(0, 1)),
                d1=float(rng.uniform(0, 1)),
            )
        )
    dynamics = Dynamics(inertia=0.05, damping=damping, quartic=1.0, period=4.0, phases=3)
    return Network("random", "none", dynamics, masses, tuple(pairs), (), (), (), None, 1)
