"""What a proof asks of the program's own meaning."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Bits = NDArray[np.uint8]


class Behaviour(Protocol):
    """A synchronous machine, one step a decision.

    Attributes:
        inputs, outputs: sensor and actuator bits, as "NAME[i]".
        states: register bits, named as ``Register.bit`` of the network; empty for a device without state.
        initial: uint8[S], the state at power-up.
    """

    @property
    def inputs(self) -> tuple[str, ...]: ...
    @property
    def outputs(self) -> tuple[str, ...]: ...
    @property
    def states(self) -> tuple[str, ...]: ...
    @property
    def initial(self) -> Bits: ...

    def step(self, states: Bits, inputs: Bits) -> tuple[Bits, Bits]:
        """One decision of n machines at once.

        Args:
            states: uint8[n, S], the registers before the tick.
            inputs: uint8[n, I].

        Returns:
            uint8[n, S], the registers after the tick, and uint8[n, O], the outputs then: what the logic makes of the
            new state and of the inputs, which are still held.
        """
        ...
