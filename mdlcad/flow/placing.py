"""Places and routes: with several seeds side by side, like an earlier build, by the placer that was asked for.

Of several seeds the best is kept by one total order: a sound layout before one that the checker finds fault with, then
fewer unchanged masses moved (of a build like another), then the smaller area, then the shorter carriers, then the lower
seed. On the program's grid, where there is no area, it is: fewer moved, fewer crossings, shorter lines, lower seed.
"""

from __future__ import annotations

import multiprocessing
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass

from msgspec import UNSET, UnsetType
from shapely import Polygon

from mdlcad.errors import Picture, SignoffError, UsageError
from mdlcad.flow.earlier import EarlierBuild
from mdlcad.mechanics import Process, Sizing
from mdlcad.mechanics.decks import two_decks
from mdlcad.network.matching import changed_masses, renamed, renamed_masses
from mdlcad.network.model import Network
from mdlcad.parts.stiffness import carrier_faults, carrier_stiffnesses, leans
from mdlcad.placement.keep_grid import place_on_grid_like
from mdlcad.placement.lattice import outline_at
from mdlcad.placement.names import PlacerName
from mdlcad.placement.placement import Placement
from mdlcad.placement.placers import Placer
from mdlcad.placement.ports import PortPlace
from mdlcad.placement.unit_grid import GridPlacement, Seating, place_on_grid
from mdlcad.report.report import Likeness, Search, Seeds
from mdlcad.routing import place_and_route
from mdlcad.routing.check import check_layout
from mdlcad.routing.deck_search import place_and_route_decks
from mdlcad.routing.decks import process_of, units_of
from mdlcad.routing.driver import Size, UnitPlates
from mdlcad.routing.judge import Objection
from mdlcad.routing.layout import Layout
from mdlcad.routing.like import place_and_route_like

Progress = Callable[[str], None]
Key = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Placed:
    """A device with parts, placed and routed; ``second_plate``: why on two unit plates."""

    placement: Placement
    layout: Layout
    second_plate: str | UnsetType = UNSET


@dataclass(frozen=True, slots=True)
class Work:
    """What every seed is tried on.

    Attributes:
        boundary: vertices on the grid, clockwise. ports: places in grid units.
        parts: sizing and process of a device with parts; None for masses on the program's grid.
    """

    network: Network
    boundary: tuple[tuple[int, int], ...]
    ports: tuple[PortPlace, ...]
    placer: Placer
    parts: tuple[Sizing, Process] | None
    size: Size
    earlier: EarlierBuild | None


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a seed came to: the ``result`` and its place in the order, or why there is none."""

    seed: int
    result: Placed | GridPlacement | None
    key: Key = ()
    reason: str = ""
    picture: Picture | None = None


@dataclass(frozen=True, slots=True)
class Best:
    """The best of the seeds, and how it was found."""

    result: Placed | GridPlacement
    search: Search


def best_of(work: Work, first: int, count: int, workers: int, progress: Progress) -> Best:
    """Place (and route) with ``count`` seeds from ``first`` on, and keep the best: the same one for any ``workers``.

    Raises:
        SignoffError: no seed leads to a layout; says why of the first.
    """
    seeds = range(first, first + count)
    outcomes = (
        [try_seed(work, first, workers, progress)] if count == 1 else _side_by_side(work, seeds, workers, progress)
    )
    good = [item for item in outcomes if item.result is not None]
    if not good:
        words = outcomes[0].reason
        if count > 1:
            words += f" (and the other {count - 1} seeds fail too)"
        raise SignoffError(words, outcomes[0].picture)
    best = min(good, key=lambda item: (*item.key, item.seed))
    assert best.result is not None
    failed = tuple(item.seed for item in outcomes if item.result is None)
    return Best(
        best.result,
        Search(
            str(work.placer.name),
            None if count == 1 else Seeds(tuple(seeds), best.seed, failed),
            None if work.earlier is None else likeness(work, best.result),
            best.result.second_plate if isinstance(best.result, Placed) else UNSET,
        ),
    )


def _side_by_side(work: Work, seeds: range, workers: int, progress: Progress) -> list[Outcome]:
    """The outcome of every seed, in their order."""
    if workers == 1:
        return [try_seed(work, seed, 1, _labelled(seed, seeds, progress)) for seed in seeds]
    # a child that was forked would share the threads of this one's solvers
    with ProcessPoolExecutor(min(workers, len(seeds)), multiprocessing.get_context("spawn")) as pool:
        waiting = [pool.submit(try_seed, work, seed) for seed in seeds]
        for done, future in enumerate(as_completed(waiting), 1):
            found = future.result()
            words = "placed" if found.result is not None else "failed"
            progress(f"{done} of {len(seeds)} seeds tried; seed {found.seed} {words}")
        return [future.result() for future in waiting]


def _labelled(seed: int, seeds: range, progress: Progress) -> Progress:
    return lambda words: progress(f"seed {seed} ({seed - seeds.start + 1} of {len(seeds)}): {words}")


def _silent(words: str) -> None:
    """A child has nobody to tell."""


def try_seed(work: Work, seed: int, workers: int = 1, progress: Progress = _silent) -> Outcome:
    """Place (and route) with one seed; the outcome is the same for any number of ``workers``."""
    if work.parts is None:
        grid = _on_grid(work, seed)
        moved = 0 if work.earlier is None else likeness(work, grid).moved
        return Outcome(seed, grid, (moved, grid.crossings, grid.length))
    sizing, _ = work.parts
    try:
        found = _device(work, seed, workers, progress)
    except SignoffError as problem:
        return Outcome(seed, None, (), str(problem), problem.picture)
    findings = check_layout(work.network, found.placement, found.layout, sizing.rules)
    moved = 0 if work.earlier is None else likeness(work, found).moved
    area = round(Polygon(found.placement.boundary).area, 3)
    return Outcome(seed, found, (len(findings), moved, area, round(carrier_length(found.layout), 3)))


def carrier_length(layout: Layout) -> float:
    """Length in mm of all rungs and trunks."""
    return sum(rung.right.x - rung.left.x for rung in layout.rungs) + sum(
        trunk.y_high - trunk.y_low for trunk in layout.trunks
    )


def _on_grid(work: Work, seed: int) -> GridPlacement:
    network, boundary, ports, placer = work.network, work.boundary, work.ports, work.placer
    if work.earlier is None or work.earlier.grid is None:
        return place_on_grid(network, boundary, ports, placer, Seating.ON_BOUNDARY, seed)
    earlier = work.earlier
    return place_on_grid_like(
        network, boundary, ports, placer, Seating.ON_BOUNDARY, seed, earlier.network, work.earlier.grid
    )


def _device(work: Work, seed: int, workers: int, progress: Progress) -> Placed:
    assert work.parts is not None
    sizing, process = work.parts
    network, rules = work.network, sizing.rules
    sources = {coupling.name: coupling.source for coupling in network.couplings}

    def judge(placement: Placement, layout: Layout) -> tuple[Objection, ...]:
        stiffnesses = carrier_stiffnesses(network, placement, layout, sizing, process_of(process, placement))
        faults = carrier_faults(stiffnesses, sizing, process)
        return tuple(Objection(sources[fault.coupling], fault.coupling, fault.message) for fault in faults)

    if work.earlier is not None and work.earlier.device is not None:
        before = work.earlier.device
        if work.earlier.network == network and work.earlier.rules == rules and _same_frame(work, before.placement):
            decks = UNSET if units_of(before.placement) is None else "as in the build that this is like"
            return Placed(before.placement, before.layout, decks)
        if work.size.unit_plates is UnitPlates.TWO or units_of(before.placement) is not None:
            raise UsageError(
                "--like: on two unit plates only a program with the same network can be like an earlier build; "
                "build without --like"
            )
        found = place_and_route_like(
            network, work.boundary, work.ports, rules, seed, before, progress, judge, work.size
        )
        if found is not None:
            return Placed(*found)

    def on_two(why: str) -> Placed:
        leaning = leans(network, sizing, two_decks(process))
        placement, layout = place_and_route_decks(
            network, work.boundary, work.ports, rules, seed, leaning, progress, judge, work.size, workers
        )
        return Placed(placement, layout, why)

    if work.size.unit_plates is UnitPlates.TWO:
        if work.placer.name is PlacerName.PAPER:
            raise UsageError("--unit-plates 2: the paper's placer knows one plate only; leave out --placer paper")
        return on_two("asked for")
    try:
        return Placed(
            *place_and_route(
                network, work.boundary, work.ports, rules, seed, progress, judge, work.size, work.placer, workers
            )
        )
    except SignoffError as problem:
        if work.placer.name is not PlacerName.PAPER:
            if work.size.unit_plates is not UnitPlates.AUTO:
                raise
            progress(f"one unit plate cannot do it: {problem}")
            try:
                return on_two(str(problem))
            except SignoffError as other:
                raise SignoffError(f"{problem}; and {other}", other.picture or problem.picture) from None
        words = f"{problem}. The paper's placer sees no channels, so what it places may not route; --placer anneal does"
        raise SignoffError(words, problem.picture) from None


def _same_frame(work: Work, placement: Placement) -> bool:
    """Whether boundary, ports and scale are those of ``placement``."""
    scale = placement.mm_per_grid
    places = {place.bit: place for place in work.ports}
    ports = all(
        (port.x, port.y) == (round(places[port.bit].x * scale, 6), round(places[port.bit].y * scale, 6))
        for port in placement.ports
        if port.bit in places
    )
    wanted = work.size.pitch in (None, scale) and scale <= work.size.most(work.boundary) + 1e-9
    plates = UnitPlates.ONE if units_of(placement) is None else UnitPlates.TWO
    wanted = wanted and work.size.unit_plates in (UnitPlates.AUTO, plates)
    return wanted and ports and outline_at(work.boundary, scale) == placement.boundary


def likeness(work: Work, result: Placed | GridPlacement) -> Likeness:
    """What became of the masses of the earlier build: by slot on a device, by place on the grid."""
    earlier = work.earlier
    assert earlier is not None
    names = renamed_masses(earlier.network, work.network)
    device = None if earlier.device is None else earlier.device.placement
    before, after = (
        _seats(earlier.grid if earlier.grid is not None else device),
        _seats(result if isinstance(result, GridPlacement) else result.placement),
    )
    old = {names.get(mass, mass): seat for mass, seat in before.items()}
    changed = changed_masses(renamed(earlier.network, names), work.network)
    kept = [mass for mass in after if mass in old]
    firm = [mass for mass in kept if mass not in changed]
    shifts = Counter((after[mass][0] - old[mass][0], after[mass][1] - old[mass][1]) for mass in firm)
    # on another lattice all may stand some rows further, which moves none against another
    shift, stayed = min(shifts.items(), key=lambda item: (-item[1], item[0]), default=((0.0, 0.0), 0))
    if isinstance(result, GridPlacement):
        shift, stayed = (0.0, 0.0), shifts[0.0, 0.0]
    return Likeness(
        earlier.checksum,
        kept=len(kept),
        changed=len(kept) - len(firm),
        moved=len(firm) - stayed,
        new=len(after) - len(kept),
        gone=len(before) - len(kept),
        shift=shift,
    )


def _seats(placement: Placement | GridPlacement | None) -> dict[str, tuple[float, float]]:
    if isinstance(placement, GridPlacement):
        return {item.mass: (item.x, item.y) for item in placement.masses}
    return {} if placement is None else {unit.mass: (unit.column, unit.row) for unit in placement.masses}
