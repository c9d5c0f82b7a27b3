"""Between the two proofs of a device as drawn: plates hold some of its shuttles from tilting, and others tilt.

In ``extracted`` plates hold all shuttles, in ``tilting`` none. Which they hold in a device that is made is not known:
it hangs on gaps of a few hundredths. A *mixture* says it for every shuttle, and inputs of one mass may be thrown off
against each other, and against its bias, more in a mixture than at either end. There are 2^n of them; where those are
more than ``SAMPLES`` they are sampled:

* two for each phase, in which its shuttles alone are held, or alone tilt. What a mass decides by is worst where it is
  held and keeps all of its bias, while all that drive it tilt and lose most; these are of the phase before its own.
* the rest by chance, every shuttle held or tilting with even odds.

All of them go through the same walk, all transitions of the program where that is short enough. Plates brake shuttles
as in the proof ``tilting``, whether they are held or not.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mdlcad.network.model import Network
from mdlcad.proof.behaviour import Behaviour
from mdlcad.proof.itinerary import Itinerary, make_itinerary
from mdlcad.proof.prove import transitions_met
from mdlcad.signoff.extraction import Built
from mdlcad.signoff.trial import Trial
from mdlcad.simulation.system import System

MIXTURES = "mixtures.json"

SAMPLES = 48

_MOST_WORK = 10_000
"""Decisions of a mixture times masses, at the most: 20 to 25 s for all of them on two cores."""

_LEAST_DECISIONS = 24


@dataclass(frozen=True, slots=True)
class WrongMixture:
    """A mixture in which the device goes wrong.

    Attributes:
        decision: the first wrong one; slip: the mass that is the first to read otherwise than in a device all of whose
            shuttles tilt, "" if none did until then.
        held, tilting: masses whose shuttles plates hold, and those that tilt.
    """

    decision: int
    slip: str
    held: tuple[str, ...]
    tilting: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Mixtures:
    """The artefact mixtures.json.

    Attributes:
        tried, by_phase: mixtures, and how many of them go by phase; the others are by chance.
        exhaustive: they are all that there are.
        transitions_total: of the program; transitions_checked: in each mixture; decisions: of each; seed: of all.
        found: those that are wrong.
        weakest: the mass that is most often the first to read wrong, "" if none is wrong; weakest_count: how often.
        weakest_words: how it and its inputs are in the first of those.
    """

    tried: int
    by_phase: int
    exhaustive: bool
    transitions_total: int
    transitions_checked: int
    decisions: int
    seed: int
    found: tuple[WrongMixture, ...]
    weakest: str
    weakest_count: int
    weakest_words: str

    @property
    def wrong(self) -> int:
        """How many are wrong."""
        return len(self.found)

    def words(self) -> str:
        """What came out, with the numbers."""
        share = f"{self.transitions_checked} of {self.transitions_total} transitions"
        tried = f"{'all ' if self.exhaustive else ''}{self.tried} mixtures of held and tilting shuttles"
        if not self.found:
            return f"0 of {tried} wrong, {share} each"
        who = f"; {self.weakest} is the first to read wrong in {self.weakest_count}" if self.weakest else ""
        how = f": {self.weakest_words}" if self.weakest_words else ""
        return f"{self.wrong} of {tried} wrong, {share} each{who}{how}"


def find_mixtures(built: Built, reference: Behaviour, seed: int, workers: int) -> Mixtures:
    """Try mixtures of ``built``, whose shuttles all tilt; ``workers`` change no result."""
    system = built.system
    tilting = drawn_mixtures(system, seed)
    walks = bounded_walks(reference, len(system.names), seed)
    decisions, count, _ = walks.inputs.shape
    trial = Trial(built.network, reference, system, walks, workers)
    tried = tilting.shape[1]
    exhaustive = tried == 2 ** len(system.names)
    taken = np.repeat(np.arange(count), tried)
    wrong = trial.first_wrong(mixed(system, np.tile(tilting, count)), taken).reshape(count, tried)
    earliest, first = wrong.argmin(axis=0), wrong.min(axis=0)
    bad = np.flatnonzero(first < decisions)
    slips: list[str | None] = []
    if len(bad):
        slips = trial.slips(mixed(system, tilting[:, bad]), earliest[bad], int(first[bad].max()) + 1)
    found = tuple(
        WrongMixture(
            int(first[lane]),
            slip or "",
            tuple(name for name, tilts in zip(system.names, tilting[:, lane], strict=True) if not tilts),
            tuple(name for name, tilts in zip(system.names, tilting[:, lane], strict=True) if tilts),
        )
        for lane, slip in zip(bad, slips, strict=True)
    )
    often = Counter(item.slip for item in found if item.slip)
    weakest, times = min(often.items(), key=lambda item: (-item[1], item[0])) if often else ("", 0)
    return Mixtures(
        tried=tried,
        by_phase=0 if exhaustive else 2 * system.phases,
        exhaustive=exhaustive,
        transitions_total=walks.total,
        transitions_checked=transitions_met(walks),
        decisions=decisions * count,
        seed=seed,
        found=found,
        weakest=weakest,
        weakest_count=times,
        weakest_words=_how(built.network, next(item for item in found if item.slip == weakest)) if weakest else "",
    )


def drawn_mixtures(system: System, seed: int) -> NDArray[np.bool_]:
    """bool[n, tried]: which shuttles tilt; all mixtures if there are few, otherwise the first go by phase."""
    masses = len(system.names)
    if 2**masses <= SAMPLES:
        return np.asarray((np.arange(2**masses) >> np.arange(masses)[:, None]) % 2 == 1)
    tilting = np.random.default_rng([seed, 11]).random((masses, SAMPLES)) < 0.5
    for phase in range(system.phases):
        tilting[:, 2 * phase] = system.phase != phase
        tilting[:, 2 * phase + 1] = system.phase == phase
    return tilting


def mixed(system: System, tilting: NDArray[np.bool_]) -> System:
    """Devices like ``system``, in each of which the shuttles of ``tilting`` (bool[n, L]) tilt and others are held.

    Raises:
        ValueError: the shuttles of ``system`` are all held.
    """
    devices = system.devices
    if devices is None or devices.tilts is None:
        raise ValueError("shuttles that are held have no stops to tilt between")
    tilts = devices.tilts
    stops = replace(tilts, low=np.where(tilting, tilts.low, 0.0), high=np.where(tilting, tilts.high, 0.0))
    return replace(system, devices=replace(devices, tilts=stops))


def bounded_walks(reference: Behaviour, masses: int, seed: int) -> Itinerary:
    """Walks through all transitions, one alone if that can be, cut off where they take too long."""
    every = make_itinerary(reference, _MOST_WORK, seed, lanes=1)
    length, count, _ = every.inputs.shape
    allowed = max(_LEAST_DECISIONS, _MOST_WORK // masses)
    count = min(count, max(1, allowed // _LEAST_DECISIONS))
    length = min(length, max(_LEAST_DECISIONS, allowed // count))
    return replace(
        every,
        inputs=every.inputs[:length, :count],
        states=every.states[: length + 1, :count],
        outputs=every.outputs[:length, :count],
    )


def _how(network: Network, wrong: WrongMixture) -> str:
    """In words, which of the mass that slips and its inputs tilt."""
    inputs = [item.source for item in network.couplings if item.target == wrong.slip]
    tilting = set(wrong.tilting)
    lists = [sorted(name for name in inputs if (name in tilting) is tilts) for tilts in (True, False)]
    own = "it tilts" if wrong.slip in tilting else "it is held"
    words = [f"{', '.join(names)} {how}" for names, how in zip(lists, ("tilting", "held"), strict=True) if names]
    return f"{own}, {'; '.join(words)}" if words else own
