"""Yield: of devices whose parameters are a little off, how many still behave, and which masses give way first."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mdlcad.network.model import Network
from mdlcad.proof.behaviour import Behaviour
from mdlcad.proof.compare import compare, stimulus_of
from mdlcad.proof.itinerary import Itinerary, make_itinerary
from mdlcad.proof.prove import SENSOR_FORCE, check_names
from mdlcad.proof.timing import Timing, find_timing
from mdlcad.simulation.decode import UNDECIDED, decode, instants
from mdlcad.simulation.run import Watch, simulate, steps_for
from mdlcad.simulation.scatter import Scatter, scattered
from mdlcad.simulation.system import System, system_of

_LANES = 16

# Two-sided 95 %.
_NORMAL_QUANTILE = 1.959963984540054


@dataclass(frozen=True, slots=True)
class Weakness:
    """A mass that was the first to read otherwise than in the nominal device, in ``count`` of the failed samples."""

    mass: str
    count: int


@dataclass(frozen=True, slots=True)
class Yield:
    """How many of the sampled devices behave.

    Attributes:
        scatter: the standard deviations of the errors.
        samples, right: devices simulated, devices with every decision right.
        low, high: Wilson interval of the yield at 95 %.
        decisions: decisions simulated of each device.
        seed: of samples and inputs.
        weaknesses: first masses to give way, most frequent first; together the failed samples whose first slip could
            be seen.
    """

    scatter: Scatter
    samples: int
    right: int
    low: float
    high: float
    decisions: int
    seed: int
    weaknesses: tuple[Weakness, ...]


def wilson(right: int, samples: int) -> tuple[float, float]:
    """Wilson's score interval for a proportion at 95 % (E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209)."""
    if not 0 <= right <= samples or samples < 1:
        raise ValueError("need 0 <= right <= samples and at least one sample")
    z2 = _NORMAL_QUANTILE**2
    share = right / samples
    middle = (share + z2 / (2 * samples)) / (1 + z2 / samples)
    half = math.sqrt(share * (1 - share) * z2 / samples + z2**2 / (4 * samples**2)) / (1 + z2 / samples)
    low = 0.0 if right == 0 else middle - half
    high = 1.0 if right == samples else middle + half
    return low, high


def estimate_yield(
    network: Network,
    reference: Behaviour,
    scatter: Scatter,
    *,
    samples: int = 40,
    decisions: int = 400,
    seed: int = 0,
    workers: int = 2,
    progress: Callable[[int], None] = lambda done: None,
) -> Yield:
    """Sample devices and walk each through the same ``decisions`` (or somewhat more) from power-up.

    ``workers`` threads share the samples; the result does not depend on them. ``progress`` hears how many are done.

    Raises:
        UsageError: the bits of the network are not those of the reference.
        NoTick: the nominal network does not tick.
    """
    check_names(network, reference)
    system = system_of(network)
    steps = steps_for(system)
    itinerary = make_itinerary(reference, decisions, seed, exhaustive=False, lanes=_LANES)
    length, lanes, _ = itinerary.inputs.shape
    timing = find_timing(network, system, steps)
    nominal = _all_bits(network, reference, system, itinerary, timing, steps)

    def try_sample(sample: int) -> tuple[bool, str | None]:
        device = scattered(network, scatter, seed, sample)
        built = system_of(device)
        if _behaves(device, reference, built, itinerary, timing, steps):
            return True, None
        return False, first_slip(nominal, _all_bits(device, reference, built, itinerary, timing, steps), system)

    with ThreadPoolExecutor(workers) as pool:
        outcomes = []
        for outcome in pool.map(try_sample, range(samples)):
            outcomes.append(outcome)
            progress(len(outcomes))
    right = sum(behaves for behaves, _ in outcomes)
    first = Counter(slip for _, slip in outcomes if slip is not None)
    low, high = wilson(right, samples)
    ranked = sorted(first.items(), key=lambda item: (-item[1], item[0]))
    weaknesses = tuple(Weakness(mass, count) for mass, count in ranked)
    return Yield(scatter, samples, right, low, high, length * lanes, seed, weaknesses)


def _behaves(
    network: Network,
    reference: Behaviour,
    system: System,
    itinerary: Itinerary,
    timing: Timing,
    steps: int,
) -> bool:
    """Whether every decision of every lane is right, the tick where the nominal device has it."""
    comparison = compare(
        network,
        reference,
        system,
        itinerary,
        timing,
        sensor_force=SENSOR_FORCE,
        steps_per_period=steps,
        workers=1,
    )
    return bool((comparison.wrong == len(itinerary.inputs)).all())


def _all_bits(
    network: Network,
    reference: Behaviour,
    system: System,
    itinerary: Itinerary,
    timing: Timing,
    steps: int,
) -> NDArray[np.uint8]:
    """uint8[cycles, n, L], the bit of every mass in every cycle."""
    masses = np.arange(len(system.names))
    run = simulate(
        system,
        stimulus_of(network, reference, system, itinerary, timing, SENSOR_FORCE, steps),
        len(itinerary.inputs) * timing.period * steps,
        watch=Watch(masses, instants(system, masses, steps)),
        steps_per_period=steps,
        workers=1,
    )
    return decode(system, masses, run.readings)


def first_slip(nominal: NDArray[np.uint8], found: NDArray[np.uint8], system: System) -> str | None:
    """The mass that first reads otherwise than a decided nominal one; ties in a cycle go to the earlier phase."""
    masses = np.arange(len(system.names))
    slipped = ((nominal != found) & (nominal != UNDECIDED)).any(axis=2)
    if not slipped.any():
        return None
    cycle = int(np.argmax(slipped.any(axis=1)))
    candidates = masses[slipped[cycle]]
    order = instants(system, candidates, 1 << 20)
    return system.names[int(candidates[np.lexsort((candidates, order))[0]])]
