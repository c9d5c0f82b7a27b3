"""``mdlcad simulate DIR --spread S``: of devices a little off, how many behave, and what gives way first."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import matplotlib.style

from mdlcad.artefact import load, to_json, write_atomic
from mdlcad.characterise.figures import yield_picture
from mdlcad.errors import SignoffError
from mdlcad.language import Device
from mdlcad.network.model import Network
from mdlcad.proof.reference import build_reference
from mdlcad.proof.spread import Yield, estimate_yield
from mdlcad.proof.timing import NoTick
from mdlcad.simulation.scatter import Scatter, scatter_of

FOLDER = "spread"
RESULT = "result.json"
PICTURE = "yield.png"

_TOLD = 5


@dataclass(frozen=True, slots=True)
class WeakCell:
    """A mass that was the first to decide wrongly in ``count`` of the failed devices.

    Attributes:
        mass: its name in the network.
        cell: what it is made of, in words.
        count, share: failed devices in which it was the first, and as a part of all that failed.
    """

    mass: str
    cell: str
    count: int
    share: float


@dataclass(frozen=True, slots=True)
class SpreadPoint:
    """The yield at one spread.

    Attributes:
        spread: the number asked for.
        scatter: the standard deviations that it stands for.
        samples, right: devices simulated, devices with every decision right.
        low, high: 95 % confidence interval of the yield.
        weak_cells: most frequent first; a failed device of which no mass reads otherwise than in the nominal one
            (its tick alone came late, say) counts for none.
    """

    spread: float
    scatter: Scatter
    samples: int
    right: int
    low: float
    high: float
    weak_cells: tuple[WeakCell, ...]


@dataclass(frozen=True, slots=True)
class SpreadResult:
    """The artefact ``spread/result.json`` of a build.

    Attributes:
        confidence, interval: level and name of the interval.
        decisions: decisions that every device was walked through from power-up.
    """

    design: str
    cells: str
    seed: int
    confidence: float
    interval: str
    decisions: int
    points: tuple[SpreadPoint, ...]


def run_spread(
    folder: Path,
    spreads: tuple[float, ...],
    samples: int,
    seed: int,
    workers: int,
    say: Callable[[str], None],
    progress: Callable[[str], None],
) -> None:
    """Estimate the yield of the build in ``folder`` at every spread; write ``folder``/spread/.

    ``say`` takes what came out, ``progress`` how far it is. The build needs device.json and network.json, and keeps
    all its own files as they are. Two spreads see the same random numbers, scaled, and the result depends on neither
    ``workers`` nor the order of things.

    Raises:
        UsageError: the build cannot be used; nothing was written.
        SignoffError: the nominal network does not even tick.
    """
    device = load(folder, "device.json", Device)
    network = load(folder, "network.json", Network)
    reference = build_reference(device)
    points = []
    decisions = 0
    for spread in sorted(set(spreads)):

        def told(done: int, at: float = spread) -> None:
            progress(f"spread {at:g}: {done} of {samples} devices")

        try:
            found = estimate_yield(
                network,
                reference,
                scatter_of(spread),
                samples=samples,
                seed=seed,
                workers=workers,
                progress=told,
            )
        except NoTick as problem:
            raise SignoffError(str(problem)) from None
        decisions = found.decisions
        points.append(_point(network, spread, found))
        for line in _telling(points[-1]):
            say(line)
    result = SpreadResult(network.design, network.cells, seed, 0.95, "Wilson", decisions, tuple(points))
    with matplotlib.style.context("default"):
        picture = yield_picture(
            network.design,
            [(p.spread, p.right / p.samples, p.low, p.high) for p in points],
            [(f"{cell.mass}  ({cell.cell})", cell.count) for cell in _all_weak(points)],
            samples,
        )
    place = folder / FOLDER
    if place.is_dir():
        shutil.rmtree(place)
    place.mkdir()
    write_atomic(place / PICTURE, picture)
    write_atomic(place / RESULT, to_json(result))
    say(f"written to {place}: {PICTURE}, {RESULT}")


def _point(network: Network, spread: float, found: Yield) -> SpreadPoint:
    failed = found.samples - found.right
    weak = tuple(
        WeakCell(item.mass, describe_cell(network, item.mass), item.count, item.count / failed)
        for item in found.weaknesses
    )
    return SpreadPoint(spread, found.scatter, found.samples, found.right, found.low, found.high, weak)


def _telling(point: SpreadPoint) -> list[str]:
    scatter = point.scatter
    share = point.right / point.samples
    lines = [
        f"spread {point.spread:g} (springs {scatter.coupling:.1%}, biases {scatter.bias:.1%}, stiffness "
        f"{scatter.stiffness:g}): {point.right} of {point.samples} devices right, yield {share:.1%}, "
        f"95 % (Wilson) {point.low:.1%} to {point.high:.1%}"
    ]
    for cell in point.weak_cells[:_TOLD]:
        lines.append(f"  fails first in {cell.count:3d}: {cell.mass}  ({cell.cell})")
    more = len(point.weak_cells) - _TOLD
    if more > 0:
        lines.append(f"  and {more} other masses; all are in {RESULT}")
    return lines


def _all_weak(points: list[SpreadPoint]) -> list[WeakCell]:
    """The weak cells over all spreads together, most frequent first."""
    merged: dict[str, WeakCell] = {}
    for point in points:
        for cell in point.weak_cells:
            before = merged[cell.mass].count if cell.mass in merged else 0
            merged[cell.mass] = WeakCell(cell.mass, cell.cell, before + cell.count, 0.0)
    return sorted(merged.values(), key=lambda cell: (-cell.count, cell.mass))


def describe_cell(network: Network, name: str) -> str:
    """What the mass called ``name`` is made of: its kind, its inputs and their weights (as logic, in units
    of the softest spring), whether it has a bias, and how many it drives."""
    (mass,) = (mass for mass in network.masses if mass.name == name)
    unit = min((abs(c.strength) for c in network.couplings if c.strength), default=1.0)
    polarity = {other.name: other.polarity for other in network.masses}
    inputs = [c.strength / unit * polarity[c.source] * mass.polarity for c in network.couplings if c.target == name]
    driven = sum(c.source == name for c in network.couplings)
    words = [str(mass.kind)]
    if inputs:
        words.append("weights " + " ".join(f"{weight:+.2g}" for weight in inputs))
    if mass.bias:
        words.append("biased")
    words.append(f"drives {driven}")
    return ", ".join(words)
