"""Devices that are not quite the drawn one, each walked through the same decisions from power-up."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mdlcad.network.model import Network
from mdlcad.proof.behaviour import Behaviour
from mdlcad.proof.compare import compare, stimulus_of
from mdlcad.proof.itinerary import Itinerary
from mdlcad.proof.prove import SENSOR_FORCE
from mdlcad.proof.spread import first_slip
from mdlcad.proof.timing import NoTick, Timing, find_timing
from mdlcad.simulation.decode import decode, instants
from mdlcad.simulation.run import Watch, simulate, steps_for
from mdlcad.simulation.system import System

Ints = NDArray[np.int64]


class Trial:
    """The walks that devices are put through; the drawn device says when a decision is read."""

    def __init__(self, network: Network, reference: Behaviour, drawn: System, walks: Itinerary, workers: int) -> None:
        """``walks`` of the reference; ``workers`` change no result."""
        self._network, self._reference, self._drawn, self._workers = network, reference, drawn, workers
        self._walks = walks
        self._steps = steps_for(drawn)
        self.decisions = len(walks.inputs)
        try:
            self._timing: Timing | None = find_timing(network, drawn, self._steps)
        except NoTick:
            self._timing = None

    def first_wrong(self, devices: System, walks: Ints) -> Ints:
        """int[L]: the first wrong decision of each device on its walk (int[L]), ``decisions`` if all are right."""
        if self._timing is None:
            return np.zeros(len(walks), dtype=np.int64)
        comparison = compare(
            self._network,
            self._reference,
            devices,
            self._taken(walks, self.decisions),
            self._timing,
            sensor_force=SENSOR_FORCE,
            steps_per_period=self._steps,
            workers=self._workers,
        )
        return comparison.wrong

    def slips(self, devices: System, walks: Ints, decisions: int) -> list[str | None]:
        """The mass that first reads otherwise than in the drawn device, of each; None if none does in so many."""
        if self._timing is None:
            return [None] * len(walks)
        different, which = np.unique(walks, return_inverse=True)
        read, drawn = self._bits(devices, walks, decisions), self._bits(self._drawn, different, decisions)
        return [first_slip(drawn[:, :, [walk]], read[:, :, [lane]], devices) for lane, walk in enumerate(which)]

    def _bits(self, system: System, walks: Ints, decisions: int) -> NDArray[np.uint8]:
        if self._timing is None:
            raise AssertionError("a device without a tick has no bits")
        masses, taken = np.arange(len(system.names)), self._taken(walks, decisions)
        run = simulate(
            system,
            stimulus_of(self._network, self._reference, system, taken, self._timing, SENSOR_FORCE, self._steps),
            decisions * self._timing.period * self._steps,
            watch=Watch(masses, instants(system, masses, self._steps)),
            steps_per_period=self._steps,
            workers=self._workers,
        )
        return decode(system, masses, run.readings)

    def _taken(self, walks: Ints, decisions: int) -> Itinerary:
        every = self._walks
        return replace(
            every,
            inputs=every.inputs[:decisions, walks],
            states=every.states[: decisions + 1, walks],
            outputs=every.outputs[:decisions, walks],
        )
