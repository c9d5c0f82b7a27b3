"""What the middle steps run: from a sized network to every body of the device."""

from __future__ import annotations

from dataclasses import replace

from shapely import Polygon

from mdlcad.artefact import load, to_json, write_atomic
from mdlcad.errors import Diagnostic, InputError, SignoffError
from mdlcad.flow.outline import place_of
from mdlcad.flow.placing import Placed, Work, best_of
from mdlcad.flow.state import Job, State, need, stacked
from mdlcad.flow.step import Progress
from mdlcad.mechanics import Process
from mdlcad.mechanics.compensation import COMPENSATION_FILE, Compensation, compensate, compensated
from mdlcad.parts import build_parts
from mdlcad.parts.clock import device_loads
from mdlcad.parts.stiffness import CarrierStiffness, carrier_stiffnesses, lifts_of
from mdlcad.parts.store import Parts, bodies_of, records_of
from mdlcad.placement.placement import Placement
from mdlcad.report.report import Search
from mdlcad.routing import find_lack
from mdlcad.routing.drawing import draw_layout
from mdlcad.routing.layout import Layout

SEARCH_FILE = "search.json"
"""In a build folder: how its placement was found."""


def placed(job: Job, state: State, progress: Progress) -> State:
    """Who stands where, and the carriers between them."""
    device, network, sizing = need(state.device), need(state.network), need(state.sizing)
    boundary, ports = need(state.outline).boundary, need(state.outline).ports
    lack = find_lack(network, boundary, ports, sizing.rules)
    if lack is not None:
        where = place_of(device, lack.bit) if lack.bit else device.boundary[0].where
        raise InputError([Diagnostic(device.file, where.line, where.column, lack.what, lack.mend)])
    work = Work(network, boundary, ports, job.placer, (sizing, job.process), job.size, job.like)
    best = best_of(work, job.seed, job.seeds, job.workers, progress)
    assert isinstance(best.result, Placed)
    return replace(state, placement=best.result.placement, layout=best.result.layout, search=best.search)


def restore_placed(job: Job, state: State, files: tuple[str, ...]) -> State:
    """What ``placed`` made, from its files."""
    placement = load(job.folder, "placement.json", Placement)
    layout, search = load(job.folder, "layout.json", Layout), load(job.folder, SEARCH_FILE, Search)
    return replace(state, placement=placement, layout=layout, search=search)


def draw_placed(job: Job, state: State) -> None:
    """Write the layout, how the placement was found, and its pictures."""
    # placement and layout are made together: one without the other is no result
    write_atomic(job.folder / "layout.json", to_json(state.layout))
    draw_placement(job, state)


def draw_placement(job: Job, state: State) -> None:
    """Write how the placement was found, and views/placement.svg and .png."""
    from mdlcad.view.placement import write_placement_views  # the plotting library takes a second to load

    write_atomic(job.folder / SEARCH_FILE, to_json(state.search))
    write_placement_views(need(state.network), job.folder)


def how_placed(state: State) -> str:
    """How the placement was found, to follow what it is; nothing if with one seed and like no other."""
    words, search = "", need(state.search)
    if search.second_plate:
        words += f" on two unit plates ({search.second_plate})"
    if search.like is not None:
        firm = search.like.kept - search.like.changed
        words += f", {firm - search.like.moved} of {firm} unchanged masses in place"
    if search.seeds is not None:
        words += f", seed {search.seeds.won} of {len(search.seeds.tried)}"
    return words


def write_layout(job: Job, state: State) -> None:
    """Write views/layout.svg."""
    picture = draw_layout(need(state.network), need(state.placement), need(state.layout), need(state.sizing).rules)
    views = job.folder / "views"
    views.mkdir(exist_ok=True)
    write_atomic(views / "layout.svg", picture)


def _carriers(state: State, process: Process) -> tuple[CarrierStiffness, ...]:
    """How stiff every carrier is."""
    network, placement, layout = need(state.network), need(state.placement), need(state.layout)
    return carrier_stiffnesses(network, placement, layout, need(state.sizing), process)


def compensated_units(job: Job, state: State, progress: Progress) -> State:
    """Preloads that make up for springs and parasitics."""
    process = stacked(job.process, state)
    sizing, carriers = need(state.sizing), _carriers(state, process)
    stiffness = {item.coupling: item.stiffness for item in carriers}
    lifts = lifts_of(need(state.placement), need(state.layout), process)
    try:
        found = compensate(need(state.network), job.process, sizing, stiffness, lifts)
    except ArithmeticError as problem:
        raise SignoffError(f"the units cannot make up for their springs: {problem}") from problem
    return replace(state, compensation=found, sizing=compensated(sizing, found), carriers=carriers)


def restore_compensation(job: Job, state: State, files: tuple[str, ...]) -> State:
    """What ``compensated_units`` made, from its file."""
    found, sizing = load(job.folder, COMPENSATION_FILE, Compensation), need(state.sizing)
    return replace(
        state,
        compensation=found,
        sizing=compensated(sizing, found),
        carriers=_carriers(state, stacked(job.process, state)),
    )


def compensation_words(state: State) -> str:
    """The preloads and what they leave, in words."""
    units = need(state.compensation).units
    left = max(abs(value) for unit in units for value in unit.left)
    return (
        f"preloads {min(unit.preload for unit in units):.2f} to {max(unit.preload for unit in units):.2f} mm leave "
        f"{max(abs(unit.left[1]) for unit in units):.3f} of k at the clock's middle, {left:.2f} at its ends"
    )


def driven(job: Job, state: State, progress: Progress) -> State:
    """Forces and moments of the clock plates over a cycle."""
    process, force = stacked(job.process, state), need(state.proof).sensor_force
    loads = device_loads(need(state.network), need(state.placement), need(state.sizing), process, force, job.seed)
    return replace(state, drive=loads)


def built_parts(job: Job, state: State, progress: Progress) -> State:
    """Every body of the device."""
    network, placement, layout, sizing = (
        need(state.network),
        need(state.placement),
        need(state.layout),
        need(state.sizing),
    )
    boundary, turning = Polygon(placement.boundary), need(state.drive).moments
    bodies = build_parts(network, placement, layout, sizing, stacked(job.process, state), boundary, turning)
    # as parts.json gives them back: shapes on a grid, of which other shapes inherit the grid, come back without it
    return replace(state, bodies=bodies_of(records_of(bodies)))


def restore_parts(job: Job, state: State, files: tuple[str, ...]) -> State:
    """The bodies, from their file."""
    parts = load(job.folder, "parts.json", Parts)
    return replace(state, bodies=bodies_of(parts.bodies))
