"""Runs the sweep of a library and draws its conclusions."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

from mdlcad.characterise.bench import Bench, Setting, is_right
from mdlcad.characterise.plan import Sweep
from mdlcad.mapping.characterisation import Choice
from mdlcad.network.model import Network

# part of the devices of every cell that must be right for a spread to count as borne
BORNE = 0.9

Trial = tuple[Bench, Setting]


@dataclass(frozen=True, slots=True)
class MapPoint:
    """Cells that are not right in the nominal device at clock period T and damping b."""

    period: float
    damping: float
    wrong: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class SpreadCount:
    """Right devices of one cell at one spread."""

    cell: str
    spread: float
    right: int
    samples: int


@dataclass(frozen=True, slots=True)
class LoadCount:
    """Right devices of a gate with ``load`` targets of total echo ``echo``."""

    cell: str
    load: int
    echo: int
    right: int
    samples: int


@dataclass(frozen=True, slots=True)
class Runner:
    """Tries devices on ``workers`` threads, and says how far it is; results do not depend on the threads."""

    seed: int
    workers: int
    progress: Callable[[str], None]
    _known: dict[tuple[Network, Setting], bool] = field(default_factory=dict)

    def run(self, what: str, trials: Sequence[Trial]) -> list[bool]:
        """Whether each trial's device is right, in order."""
        found: list[bool] = []
        with ThreadPoolExecutor(self.workers) as pool:
            for right in pool.map(self._try, trials):
                found.append(right)
                self.progress(f"{what}: {len(found)} of {len(trials)}")
        return found

    def _try(self, trial: Trial) -> bool:
        # the library's own numbers compete under every key; the networks are equal then, and need not run again
        network, setting = trial[0].network, trial[1]
        key = (network, setting)
        if key not in self._known:
            self._known[key] = is_right(trial[0], setting, self.seed)
        return self._known[key]


def map_window(benches: Sequence[Bench], sweep: Sweep, runner: Runner) -> tuple[MapPoint, ...]:
    """Every bench at every period and damping; periods outermost."""
    points = [(t, b) for t in sweep.periods for b in sweep.dampings]
    trials = [(bench, Setting(t, b)) for t, b in points for bench in benches]
    found = runner.run("periods and dampings", trials)
    made = []
    for place, (t, b) in enumerate(points):
        here = found[place * len(benches) : (place + 1) * len(benches)]
        made.append(MapPoint(t, b, tuple(bench.cell for bench, right in zip(benches, here, strict=True) if not right)))
    return tuple(made)


def rows_of(points: Iterable[MapPoint]) -> tuple[tuple[float, float, float], ...]:
    """(T, least, greatest damping) of the longest run of dampings at which nothing is wrong, for every T with one."""
    by_period: dict[float, list[MapPoint]] = {}
    for point in points:
        by_period.setdefault(point.period, []).append(point)
    rows = []
    for period, line in by_period.items():
        best: list[float] = []
        run: list[float] = []
        for point in line:
            run = [] if point.wrong else [*run, point.damping]
            best = run if len(run) > len(best) else best
        if best:
            rows.append((period, best[0], best[-1]))
    return tuple(rows)


def count_spreads(
    benches: Sequence[Bench], period: float, damping: float, sweep: Sweep, runner: Runner
) -> tuple[SpreadCount, ...]:
    """Sampled devices of every bench at every spread."""
    groups = [(bench, spread) for spread in sweep.spreads for bench in benches]
    trials = [
        (bench, Setting(period, damping, spread, sample)) for bench, spread in groups for sample in range(sweep.samples)
    ]
    found = runner.run("spread", trials)
    return tuple(
        SpreadCount(bench.cell, spread, sum(found[g * sweep.samples : (g + 1) * sweep.samples]), sweep.samples)
        for g, (bench, spread) in enumerate(groups)
    )


def borne_limits(counts: Iterable[LoadCount], load_limit: int, echo_limit: int) -> tuple[int, int]:
    """Greatest fan-out and greatest echo at which, as at all smaller ones tried, every device was right; 0 if none.

    Args:
        load_limit, echo_limit: the library's; the fan-out is judged at echoes up to that limit, the echo likewise.
    """
    counts = tuple(counts)
    loads = ((count.load, count) for count in counts if count.echo <= echo_limit)
    echoes = ((count.echo, count) for count in counts if count.load <= load_limit)
    return _borne(loads), _borne(echoes)


def _borne(counts: Iterable[tuple[int, LoadCount]]) -> int:
    worst: dict[int, bool] = {}
    for size, count in counts:
        worst[size] = worst.get(size, True) and count.right == count.samples
    borne = 0
    for size in sorted(worst):
        if not worst[size]:
            break
        borne = size
    return borne


def borne_spread(counts: Iterable[SpreadCount]) -> float:
    """The greatest spread up to which every cell is right in ``BORNE`` of its devices; 0 if there is none."""
    borne = 0.0
    worst: dict[float, bool] = {}
    for count in counts:
        worst[count.spread] = worst.get(count.spread, True) and count.right >= BORNE * count.samples
    for spread in sorted(worst):
        if not worst[spread]:
            break
        borne = spread
    return borne


def corners(period: float, damping: float) -> tuple[tuple[float, float], ...]:
    """(T, b) where candidates compete: half, twice and ten times the period, and a quarter of the damping.

    Ten times the period is almost quasi-static, as a device cranked by hand is.
    """
    return ((period / 2, damping), (2 * period, damping), (10 * period, damping), (period, damping / 4))


def compete(
    key: str,
    entries: Sequence[tuple[float | str, Sequence[Bench], float, float]],
    sweep: Sweep,
    runner: Runner,
) -> Choice:
    """Right devices of every candidate, over its cells and corners.

    Args:
        entries: candidate, its benches, its period and damping.
    """
    rights = []
    devices = 0
    for value, benches, period, damping in entries:
        trials = [
            (bench, Setting(t, b, sweep.choice_spread, sample))
            for bench in benches
            for t, b in corners(period, damping)
            for sample in range(sweep.choice_samples)
        ]
        rights.append(sum(runner.run(f"{key} = {value}", trials)))
        devices = len(trials)
    return Choice(key, tuple(entry[0] for entry in entries), tuple(rights), devices)


def chosen(choice: Choice, standing: float | str) -> float | str:
    """The rule: a number stands unless another has more right devices by over twice the standard error of that.

    With n devices, of which a part p is right, the standard error of a difference is sqrt(2 p (1 - p) n). If some are,
    the one with the most right devices is chosen.
    """
    own = choice.right[choice.candidates.index(standing)]
    best = max(range(len(choice.right)), key=lambda i: choice.right[i])
    part = (own + choice.right[best]) / (2 * choice.devices)
    error = math.sqrt(2 * part * (1 - part) * choice.devices)
    return choice.candidates[best] if choice.right[best] > own + 2 * error else standing
