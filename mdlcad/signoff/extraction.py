"""The mass-spring network that the geometry is: connections and signs from the file, stiffnesses from the parts.

Which carrier drives which shuttle, and whether through a rocker, is taken from bodies that touch in the STEP file. What
a coupler of that shape weighs (c, s, the bias of a leaf, the preload of a unit) is what the sizing computed for the
shape that was drawn; it is not yet measured on the drawn outline.
"""

from __future__ import annotations

from dataclasses import replace

from mdlcad.mechanics import Sizing
from mdlcad.network.model import Coupling, Network
from mdlcad.signoff.lvs import Recovered


def extract(recovered: Recovered, network: Network, sizing: Sizing) -> Network:
    """``network`` as built: couplings that were found in the geometry with the numbers of their parts.

    A coupling that is not in the geometry is missing here too; one that the network does not have is taken with the
    numbers of a part of its sign.
    """
    parts = {item.coupling: item for item in sizing.couplers}
    biases = {item.mass: item for item in sizing.biases}
    units = {item.mass: item for item in sizing.units}
    biased = set(recovered.biased)
    masses = []
    for mass in network.masses:
        has_leaf = mass.name in biased and mass.name in biases
        own = biases[mass.name].self_stiffness if has_leaf else 0.0
        masses.append(
            replace(
                mass,
                compensation=units[mass.name].compensation + own,
                bias=biases[mass.name].bias if has_leaf else 0.0,
            )
        )
    couplings = []
    for found in recovered.connections:
        name = f"{found.source}->{found.target}"
        part = parts.get(name) or next(
            (item for item in sizing.couplers if (item.strength < 0) == found.negative), sizing.couplers[0]
        )
        sign = -1.0 if found.negative else 1.0
        couplings.append(Coupling(found.source, found.target, sign * abs(part.strength), part.self_stiffness))
    return replace(network, masses=tuple(masses), couplings=tuple(couplings))
