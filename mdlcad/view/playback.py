"""A simulation, ready to be played on the geometry."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlcad.errors import UsageError
from mdlcad.proof.reference import build_reference
from mdlcad.proof.timing import NoTick
from mdlcad.scenario.loop import FRAMES_PER_CYCLE, trace, travel
from mdlcad.scenario.result import Decision, decisions_of
from mdlcad.scenario.run import chosen_world
from mdlcad.simulation.system import wave_table
from mdlcad.view.built import Built
from mdlcad.view.motion import Floats


@dataclass(frozen=True, slots=True, eq=False)
class Playback:
    """A run of a scenario.

    Attributes:
        x: float[f, n], displacements of the masses, FRAMES_PER_CYCLE frames a clock cycle from power-up on.
        waves: float[FRAMES_PER_CYCLE, P], the clock waves; they repeat every cycle.
        cycles: clock cycles of a decision.
        words: what each decision is about: what is felt, and what is answered in its last cycle.
    """

    scenario: str
    x: Floats
    waves: Floats
    cycles: int
    words: tuple[str, ...]

    @property
    def length(self) -> float:
        """Clock cycles in all."""
        return (len(self.x) - 1) / FRAMES_PER_CYCLE

    def frame(self, time: float) -> int:
        """The frame at ``time`` (clock cycles), or the nearest there is."""
        return min(max(round(time * FRAMES_PER_CYCLE), 0), len(self.x) - 1)

    def at(self, frame: int) -> tuple[Floats, Floats]:
        """Displacements float[n] and clock waves float[P] at a frame."""
        return self.x[frame], self.waves[frame % FRAMES_PER_CYCLE]

    def title(self, frame: int) -> str:
        """What is going on at a frame."""
        cycle = frame / FRAMES_PER_CYCLE
        decision = min(int(cycle // self.cycles), len(self.words) - 1)
        return f"{self.scenario}, cycle {cycle:.1f}, decision {decision}: {self.words[decision]}"


def play(built: Built, scenario: str | None) -> Playback:
    """Run a scenario (a name or a path; None: the design's own) on the network of a build.

    Raises:
        UsageError: there is no such scenario, it does not fit the device, or the network has no running clock ring.
    """
    name, world = chosen_world(scenario, built.device)
    try:
        journey = travel(built.network, build_reference(built.device), world)
    except NoTick as problem:
        raise UsageError(f"{built.report.design} cannot be played: {problem}") from None
    _, x = trace(built.network, journey)
    words = tuple(_words(decision) for decision in decisions_of(journey))
    waves = wave_table(built.network.dynamics.phases, FRAMES_PER_CYCLE)
    return Playback(name, x, waves, journey.timing.period, words)


def at_rest(built: Built) -> tuple[Floats, Floats]:
    """Displacements and clock waves of the device as drawn: nothing displaced, every clock plate in its middle."""
    return np.zeros(len(built.network.masses)), np.ones(built.network.dynamics.phases)


def _words(decision: Decision) -> str:
    felt = " ".join(f"{value.port}={value.label}" for value in decision.sensors)
    answer = " ".join(f"{value.port}={value.label}" for value in decision.actuators)
    return f"{decision.words + ': ' if decision.words else ''}{felt} -> {answer}"
