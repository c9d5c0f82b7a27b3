"""The network as ideal threshold logic: every mass is -1 or +1 and follows the sign of its inputs, phase after phase.

What the dynamics must do if every decision is made well; used to find the power-up state, and to check the mapping.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array

from mdlcad.network.model import Network

Signs = NDArray[np.int8]


class DiscreteNetwork:
    """A network's threshold logic, for many runs side by side.

    Attributes:
        index: row of every mass.
    """

    def __init__(self, network: Network, unit_strength: float, unit_bias: float) -> None:
        """Strengths and biases are taken in units of an input and a bias of weight one."""
        self.index = {mass.name: row for row, mass in enumerate(network.masses)}
        self.phases = network.dynamics.phases
        size = len(network.masses)
        rows = [self.index[coupling.target] for coupling in network.couplings]
        columns = [self.index[coupling.source] for coupling in network.couplings]
        values = [coupling.strength / unit_strength for coupling in network.couplings]
        weights = csr_array(coo_array((values, (rows, columns)), shape=(size, size)))
        self._bias = np.array([[-mass.bias / unit_bias] for mass in network.masses])
        driven = {bit.mass for bit in network.sensors}
        self._rows = [
            np.array(
                [row for row, m in enumerate(network.masses) if m.phase == phase and m.name not in driven],
                dtype=np.intp,
            )
            for phase in range(self.phases)
        ]
        self._weights = [weights[rows] for rows in self._rows]

    def cycle(self, state: Signs) -> Signs:
        """int8[masses, runs] one power-clock cycle later; sensor masses keep their values.

        Raises:
            ValueError: the inputs of a mass cancel, so that it has no value.
        """
        state = state.copy()
        for rows, weights in zip(self._rows, self._weights, strict=True):
            if len(rows):
                total = weights @ state + self._bias[rows]
                if np.any(np.abs(total) < 0.5):
                    raise ValueError("the inputs of a mass cancel")
                state[rows] = np.where(total > 0, 1, -1)
        return state
