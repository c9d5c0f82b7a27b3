"""Devices as they come out of the machine: every parameter a little off."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mdlcad.network.model import Network


@dataclass(frozen=True, slots=True)
class Scatter:
    """Standard deviations of independent normal errors.

    Attributes:
        coupling: of a spring's strength and self stiffness together, relative.
        bias: of a mass's bias, relative.
        stiffness: of a mass's k0, absolute (dimensionless, as k0 itself): what compensation is off by.
    """

    coupling: float
    bias: float
    stiffness: float


def scatter_of(spread: float) -> Scatter:
    """The one-number scatter: ``spread`` on couplings, half of it on biases, twice of it (absolute) on stiffness."""
    return Scatter(spread, 0.5 * spread, 2.0 * spread)


def scattered(network: Network, scatter: Scatter, seed: int, sample: int) -> Network:
    """Sample number ``sample`` of the devices that ``network`` becomes; independent of all other samples."""
    rng = np.random.default_rng([seed, sample])
    masses = tuple(
        replace(
            mass,
            k0=mass.k0 + scatter.stiffness * float(rng.standard_normal()),
            bias=mass.bias * (1.0 + scatter.bias * float(rng.standard_normal())),
        )
        for mass in network.masses
    )
    couplings = []
    for coupling in network.couplings:
        factor = 1.0 + scatter.coupling * float(rng.standard_normal())
        couplings.append(
            replace(coupling, strength=coupling.strength * factor, self_stiffness=coupling.self_stiffness * factor)
        )
    return replace(network, masses=masses, couplings=tuple(couplings))
