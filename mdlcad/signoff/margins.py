"""How far a device's dimensions may be off before it goes wrong: found by simulating devices with such errors.

Two questions. *Uniform*: all walls thicker, or all thinner, by one amount, as by a kerf that is not what it was taken
for. *Random*: every unit's beams, series spring and clock pin, every coupler, rocker and bias leaf and every post off
by an amount of its own, drawn evenly from -d to +d, in ``SAMPLES`` devices, all of which must be right. Each device
walks through the same decisions from power-up, and every state, output and tick of the walk is checked; a device is a
lane of one run. The work is bounded: ``_ROUNDS_UNIFORM`` + ``_ROUNDS_RANDOM`` + 1 runs.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from mdlcad.mechanics import Process
from mdlcad.proof.behaviour import Behaviour
from mdlcad.proof.itinerary import make_itinerary
from mdlcad.signoff.extraction import Built, Errors
from mdlcad.signoff.trial import Trial

SAMPLES = 16
_ROUNDS_UNIFORM = 3
_ROUNDS_RANDOM = 7
_MOST_DECISIONS, _LEAST_DECISIONS = 64, 24
_CHEAP = 60  # masses of a device that may take the most decisions

MOST_SHARE = 0.3
"""Errors are tried up to this share of the beams' wall."""


@dataclass(frozen=True, slots=True)
class Margins:
    """Largest errors of dimensions, um, at which the device still proved right; at most ``tried_um``.

    Attributes:
        thicker_um, thinner_um: of all walls together.
        random_um: of every dimension by itself, either way, in all of ``samples`` devices.
        samples, decisions: devices of a run, decisions of each; seed: of both.
        repeatability_um: plus or minus of the machine.
        weakest: the mass that most often was the first to read wrong in devices just beyond ``random_um``, "" if none
            went wrong; weakest_share: of those devices.
        throw_unit_mm: X0 with which, all of a unit scaled alike, ``random_um`` would be the machine's repeatability.
    """

    thicker_um: float
    thinner_um: float
    random_um: float
    tried_um: float
    samples: int
    decisions: int
    seed: int
    repeatability_um: float
    weakest: str
    weakest_share: float
    throw_unit_mm: float

    @property
    def uniform_um(self) -> float:
        """The smaller of thicker and thinner."""
        return min(self.thicker_um, self.thinner_um)

    @property
    def machine_holds(self) -> bool:
        """Whether the machine's repeatability is within both margins."""
        return self.repeatability_um <= min(self.uniform_um, self.random_um)

    def words(self) -> str:
        """What the machine can or cannot hold."""
        found = (
            f"the device proves right with all walls up to {self.thicker_um:.0f} um thicker or "
            f"{self.thinner_um:.0f} um thinner, and with every dimension off by up to {self.random_um:.0f} um at random"
        )
        if self.machine_holds:
            return f"{found}; the machine repeats to {self.repeatability_um:.0f} um"
        who = f"; {self.weakest} gives way first" if self.weakest else ""
        size = (
            f"; throw_unit {self.throw_unit_mm:.1f} mm, with the whole unit scaled alike, would do"
            if self.throw_unit_mm
            else ""
        )
        return f"{found}, but the machine repeats to {self.repeatability_um:.0f} um only{who}{size}"


def grid_of(process: Process) -> tuple[float, ...]:
    """Errors (mm) at which ``Built`` has to be tabulated for margins."""
    most = MOST_SHARE * process.unit.beam_wall
    return (-most, -0.5 * most, 0.0, 0.5 * most, most)


def find_margins(built: Built, reference: Behaviour, process: Process, seed: int, workers: int) -> Margins:
    """Search the margins of ``built``, tabulated over ``grid_of`` the process; ``workers`` change no result."""
    decisions = max(_LEAST_DECISIONS, min(_MOST_DECISIONS, _MOST_DECISIONS * _CHEAP // len(built.network.masses)))
    trial = _Trial(built, reference, decisions, seed, workers)
    most = MOST_SHARE * process.unit.beam_wall
    thicker, thinner = _uniform(trial, built, most)
    random, slips = _random(trial, built, most, seed)
    weakest, count = min(slips.items(), key=lambda item: (-item[1], item[0])) if slips else ("", 0)
    repeatability = process.machine.repeatability
    return Margins(
        thicker_um=_um(thicker),
        thinner_um=_um(thinner),
        random_um=_um(random),
        tried_um=_um(most),
        samples=SAMPLES,
        decisions=trial.decisions,
        seed=seed,
        repeatability_um=_um(repeatability),
        weakest=weakest,
        weakest_share=round(count / sum(slips.values()), 3) if slips else 0.0,
        throw_unit_mm=round(process.unit.throw_unit * max(1.0, repeatability / random), 2) if random > 0.0 else 0.0,
    )


def _um(length: float) -> float:
    return round(1000.0 * length, 1)


class _Trial:
    """The walk that every device is put through."""

    def __init__(self, built: Built, reference: Behaviour, decisions: int, seed: int, workers: int) -> None:
        self._built = built
        walks = make_itinerary(reference, decisions, seed, exhaustive=False, lanes=1)  # several, where no walk reaches
        self._trial = Trial(built.network, reference, built.system, walks, workers)  # all states: the first is taken
        self.decisions = self._trial.decisions

    def right(self, errors: Errors) -> NDArray[np.bool_]:
        """bool[L]: which of the devices with these errors make every decision right."""
        first = np.zeros(errors.beams.shape[1], dtype=np.int64)
        return np.asarray(self._trial.first_wrong(self._built.with_errors(errors), first) == self.decisions)

    def slips(self, errors: Errors, wrong: NDArray[np.bool_]) -> Counter[str]:
        """Of the devices that go wrong, how often each mass is the first to read otherwise than as drawn."""
        found = self._trial.slips(self._built.with_errors(errors), np.zeros(len(wrong), dtype=np.int64), self.decisions)
        return Counter(slip for slip, bad in zip(found, wrong, strict=True) if bad and slip is not None)


def _uniform(trial: _Trial, built: Built, most: float) -> tuple[float, float]:
    """Largest error of all walls, thicker and thinner, such that no smaller one that was tried goes wrong, mm."""
    half = SAMPLES // 2
    low, high = np.zeros(2), np.full(2, most)
    for _ in range(_ROUNDS_UNIFORM):
        tried = low[:, None] + (high - low)[:, None] * np.arange(1, half + 1) / half
        errors = built.errors(SAMPLES)
        for walls in (errors.beams, errors.leaves, errors.couplers, errors.biases):
            walls[:] = np.concatenate([tried[0], -tried[1]])
        right = trial.right(errors).reshape(2, half)
        for way in (0, 1):
            good = half if right[way].all() else int(np.argmin(right[way]))
            steps = np.concatenate([low[[way]], tried[way]])
            low[way], high[way] = steps[good], steps[min(good + 1, half)]
    return float(low[0]), float(low[1])


def _random(trial: _Trial, built: Built, most: float, seed: int) -> tuple[float, Counter[str]]:
    """Largest random error at which all samples are right, mm, and who gives way first just beyond it."""
    rng = np.random.default_rng([seed, 7])
    none = built.errors(SAMPLES)
    drawn = {field.name: rng.uniform(-1.0, 1.0, getattr(none, field.name).shape) for field in fields(Errors)}

    def errors(scale: float) -> Errors:
        return Errors(**{name: scale * values for name, values in drawn.items()})

    low, high, slips = 0.0, most, Counter[str]()
    for turn in range(_ROUNDS_RANDOM):
        scale = most if turn == 0 else (low + high) / 2.0
        right = trial.right(errors(scale))
        if right.all():
            low = scale
            if turn == 0:
                return low, slips
        else:
            high, wrong = scale, ~right
    return low, trial.slips(errors(high), wrong)
