"""The pipeline as one flat list: every producer is followed by its checker.

A step takes the state so far and returns a new one. It declares the artefacts it needs and the ones it makes; a test
holds the list to that.
"""

from __future__ import annotations

from dataclasses import replace

from shapely import Polygon

from mdlcad.artefact import load, to_json, write_atomic
from mdlcad.errors import Diagnostic, InputError, SignoffError, UsageError
from mdlcad.flow.outline import outline_of, place_of
from mdlcad.flow.placing import Placed, Work, best_of
from mdlcad.flow.state import Job, State, need
from mdlcad.flow.step import Progress, Step, from_artefact
from mdlcad.language import Device, read_device
from mdlcad.mapping import map_netlist
from mdlcad.mechanics import Process, Sizing, size
from mdlcad.mechanics.compensation import COMPENSATION_FILE, Compensation, compensate, compensated
from mdlcad.mechanics.drive import DriveLoads
from mdlcad.network.model import CouplingKind, Network
from mdlcad.parts import build_parts
from mdlcad.parts.clock import device_loads
from mdlcad.parts.stiffness import CarrierStiffness, carrier_stiffnesses
from mdlcad.parts.store import Parts, bodies_of, records_of
from mdlcad.placement.placement import Placement
from mdlcad.proof.outcome import Proof
from mdlcad.proof.prove import prove
from mdlcad.proof.reference import build_reference
from mdlcad.report.report import Search
from mdlcad.routing import find_lack
from mdlcad.routing.decks import process_of
from mdlcad.routing.drawing import draw_layout
from mdlcad.routing.layout import Layout
from mdlcad.signoff.drawn import measure_device
from mdlcad.signoff.extraction import Built, BuiltDevice
from mdlcad.signoff.geometry import check_geometry
from mdlcad.signoff.lvs import LvsResult, compare, recover
from mdlcad.signoff.margins import Margins, find_margins, grid_of
from mdlcad.signoff.readback import read_step
from mdlcad.signoff.sections import read_cut
from mdlcad.signoff.summary import DesignRules
from mdlcad.synthesis import synthesise
from mdlcad.synthesis.netlist import Netlist

SEARCH_FILE = "search.json"
"""In a build folder: how its placement was found."""


def _read(job: Job, state: State, progress: Progress) -> State:
    if job.source is None:
        raise SignoffError("there is no program to read")
    return _with_device(state, read_device(job.source))


def _with_device(state: State, device: Device) -> State:
    return replace(state, device=device, outline=outline_of(device))


def _synthesise(job: Job, state: State, progress: Progress) -> State:
    return replace(state, netlist=synthesise(need(state.device)))


def _map(job: Job, state: State, progress: Progress) -> State:
    like, netlist = job.like, need(state.netlist)
    if like is not None and like.netlist == netlist:
        return replace(state, network=like.network)
    before = None if like is None else like.before()
    return replace(state, network=map_netlist(netlist, job.cells, before=before))


def _prove(job: Job, state: State, progress: Progress) -> State:
    proof = prove(need(state.network), build_reference(need(state.device)), seed=job.seed, workers=job.workers)
    return replace(state, proof=proof)


def _refuted(state: State) -> str | None:
    proof = need(state.proof)
    if proof.holds:
        return None
    words = "; ".join(str(item) for item in proof.first_mismatches[:3]) or "nothing was checked"
    return f"the network does not behave as the program says: {words}"


def _size(job: Job, state: State, progress: Progress) -> State:
    network = need(state.network)
    clocked = [item.name for item in network.couplings if item.kind is not CouplingKind.LINEAR or item.d1]
    if clocked:
        raise UsageError(
            f"the cell library {network.cells} couples {len(clocked)} pairs of masses by clocked or latching springs "
            f"(the first is {clocked[0]}), for which there are no parts yet; build with --to proof, or with --cells "
            "parametron"
        )
    return replace(state, sizing=size(network, job.process, need(state.proof).peaks))


def _place_and_route(job: Job, state: State, progress: Progress) -> State:
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


def _stacked(process: Process, state: State) -> Process:
    """The process with as many decks as the device has."""
    return process_of(process, need(state.placement))


def _carriers(state: State, process: Process) -> tuple[CarrierStiffness, ...]:
    network, placement, layout = need(state.network), need(state.placement), need(state.layout)
    return carrier_stiffnesses(network, placement, layout, need(state.sizing), process)


def _compensate(job: Job, state: State, progress: Progress) -> State:
    sizing, carriers = need(state.sizing), _carriers(state, _stacked(job.process, state))
    try:
        found = compensate(
            need(state.network), job.process, sizing, {item.coupling: item.stiffness for item in carriers}
        )
    except ArithmeticError as problem:
        raise SignoffError(f"the units cannot make up for their springs: {problem}") from problem
    return replace(state, compensation=found, sizing=compensated(sizing, found), carriers=carriers)


def _compensation_words(state: State) -> str:
    units = need(state.compensation).units
    left = max(abs(value) for unit in units for value in unit.left)
    return (
        f"preloads {min(unit.preload for unit in units):.2f} to {max(unit.preload for unit in units):.2f} mm leave "
        f"{max(abs(unit.left[1]) for unit in units):.3f} of k at the clock's middle, {left:.2f} at its ends"
    )


def _drive(job: Job, state: State, progress: Progress) -> State:
    process, force = _stacked(job.process, state), need(state.proof).sensor_force
    loads = device_loads(need(state.network), need(state.placement), need(state.sizing), process, force, job.seed)
    return replace(state, drive=loads)


def _build_parts(job: Job, state: State, progress: Progress) -> State:
    network, placement, layout, sizing = (
        need(state.network),
        need(state.placement),
        need(state.layout),
        need(state.sizing),
    )
    boundary, turning = Polygon(placement.boundary), need(state.drive).moments
    bodies = build_parts(network, placement, layout, sizing, _stacked(job.process, state), boundary, turning)
    return replace(state, bodies=bodies)


def _check_geometry(job: Job, state: State, progress: Progress) -> State:
    rules = check_geometry(
        need(state.network),
        need(state.sizing),
        need(state.placement),
        need(state.layout),
        need(state.bodies),
        state.carriers,
        _stacked(job.process, state),
        need(state.drive).moments,
    )
    return replace(state, rules=rules)


def _guide(job: Job, state: State, progress: Progress) -> State:
    from mdlcad.report.guide import GUIDE, guide  # the templates are not needed by early stages

    text = guide(
        need(state.network),
        need(state.sizing),
        need(state.placement),
        _stacked(job.process, state),
        need(state.bodies),
        need(state.drive),
    )
    write_atomic(job.folder / GUIDE, text.encode())
    return replace(state, guide=(GUIDE,))


def _export(job: Job, state: State, progress: Progress) -> State:
    from mdlcad.export.files import write_files  # the CAD kernel takes seconds to load; early stages need not wait

    name, bodies = need(state.network).design, need(state.bodies)
    process = _stacked(job.process, state)
    files = write_files(name, bodies, process, job.kerf_mm, job.folder, job.workers, progress)
    return replace(state, files=files)


def _lvs(job: Job, state: State, progress: Progress) -> State:
    network = need(state.network)
    found = read_step(job.folder / f"{network.design}.step")
    recovered = recover(found)
    result = compare(recovered, network)
    process = _stacked(job.process, state)
    drawn = measure_device(found, read_cut(job.folder, process), recovered, process)
    built = Built(drawn, network, need(state.sizing), state.carriers, process)
    reference = build_reference(need(state.device))
    extracted = prove(built.network, reference, seed=job.seed, workers=job.workers, built=built.system)
    return replace(state, lvs=result, extracted=extracted, built=built.record())


def _keep_built(job: Job, state: State) -> None:
    write_atomic(job.folder / "built.json", to_json(state.built))


def _margins(job: Job, state: State, progress: Progress) -> State:
    drawn, process = need(state.built).drawn, job.process
    built = Built(drawn, need(state.network), need(state.sizing), state.carriers, process, grid_of(process))
    reference = build_reference(need(state.device))
    return replace(state, margins=find_margins(built, reference, process, job.seed, job.workers))


def _picture(job: Job, state: State, progress: Progress) -> State:
    from mdlcad.view.views import write_views  # VTK takes seconds to load

    return replace(state, pictures=write_views(need(state.bodies), job.folder, progress))


def _draw_placed(job: Job, state: State) -> None:
    # placement and layout are made together: one without the other is no result
    write_atomic(job.folder / "layout.json", to_json(state.layout))
    draw_placement(job, state)


def draw_placement(job: Job, state: State) -> None:
    """Write how the placement was found, and views/placement.svg and .png."""
    from mdlcad.view.placement import write_placement_views  # the plotting library takes a second to load

    write_atomic(job.folder / SEARCH_FILE, to_json(state.search))
    write_placement_views(need(state.network), job.folder)


def _draw_layout(job: Job, state: State) -> None:
    picture = draw_layout(need(state.network), need(state.placement), need(state.layout), need(state.sizing).rules)
    views = job.folder / "views"
    views.mkdir(exist_ok=True)
    write_atomic(views / "layout.svg", picture)


def _behaviour_words(state: State) -> str:
    proof = need(state.proof)
    kind = "exhaustive" if proof.exhaustive else "sampled"
    return (
        f"{proof.transitions_checked} of {proof.transitions_total} transitions right ({kind}), "
        f"{proof.decisions} decisions, margin {proof.margin:.2f}"
    )


def _restore_placed(job: Job, state: State, files: tuple[str, ...]) -> State:
    placement = load(job.folder, "placement.json", Placement)
    layout, search = load(job.folder, "layout.json", Layout), load(job.folder, SEARCH_FILE, Search)
    return replace(state, placement=placement, layout=layout, search=search)


def _restore_compensation(job: Job, state: State, files: tuple[str, ...]) -> State:
    found, sizing = load(job.folder, COMPENSATION_FILE, Compensation), need(state.sizing)
    return replace(
        state,
        compensation=found,
        sizing=compensated(sizing, found),
        carriers=_carriers(state, _stacked(job.process, state)),
    )


def _restore_parts(job: Job, state: State, files: tuple[str, ...]) -> State:
    parts = load(job.folder, "parts.json", Parts)
    return replace(state, bodies=bodies_of(parts.bodies))


def _restore_extraction(job: Job, state: State, files: tuple[str, ...]) -> State:
    lvs, extracted = load(job.folder, "extraction.json", tuple[LvsResult, Proof])
    return replace(state, lvs=lvs, extracted=extracted, built=load(job.folder, "built.json", BuiltDevice))


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


STEPS: tuple[Step, ...] = (
    Step(
        "device",
        (),
        ("device", "outline"),
        _read,
        lambda s: f"{len(need(s.device).sensors)} sensors, {len(need(s.device).actuators)} actuators",
        lambda s: to_json(s.device),
        lambda job, state, files: _with_device(state, load(job.folder, "device.json", Device)),
        ("source",),
    ),
    Step(
        "netlist",
        ("device",),
        ("netlist",),
        _synthesise,
        lambda s: f"{len(need(s.netlist).gates)} gates, {len(need(s.netlist).registers)} registers",
        lambda s: to_json(s.netlist),
        from_artefact("netlist", Netlist),
    ),
    Step(
        "network",
        ("netlist",),
        ("network",),
        _map,
        lambda s: (
            f"{len(need(s.network).masses)} masses, {len(need(s.network).couplings)} couplings, "
            f"{need(s.network).cycles_per_tick} cycles a tick"
        ),
        lambda s: to_json(s.network),
        from_artefact("network", Network),
        ("cells", "like"),
    ),
    Step(
        "proof",
        ("device", "network"),
        ("proof",),
        _prove,
        _behaviour_words,
        lambda s: to_json(s.proof),
        from_artefact("proof", Proof),
        ("seed",),
        objection=_refuted,
    ),
    Step(
        "sizing",
        ("network", "proof"),
        ("sizing",),
        _size,
        lambda s: f"throw {need(s.sizing).rules.throw:.2f} mm, row pitch {need(s.sizing).rules.row_pitch:.2f} mm",
        lambda s: to_json(s.sizing),
        from_artefact("sizing", Sizing),
        ("process",),
    ),
    Step(
        "placement",
        ("outline", "network", "sizing"),
        ("placement", "layout", "search"),
        _place_and_route,
        lambda s: f"{len(need(s.placement).column_x)} columns x {len(need(s.placement).row_y)} rows{how_placed(s)}",
        lambda s: to_json(s.placement),
        _restore_placed,
        ("process", "seed", "size", "placer", "seeds", "like"),
        ("device",),
        _draw_placed,
    ),
    Step(
        "layout",
        ("network", "placement", "layout", "sizing"),
        (),
        lambda job, state, progress: state,
        lambda s: (
            f"{len(need(s.layout).rungs)} rungs, {len(need(s.layout).trunks)} trunks, "
            f"{len(need(s.layout).couplers)} couplers"
        ),
        lambda s: to_json(s.layout),
        lambda job, state, files: state,
        draw=_draw_layout,
    ),
    Step(
        "compensation",
        ("network", "placement", "layout", "sizing"),
        ("compensation", "sizing", "carriers"),
        _compensate,
        _compensation_words,
        lambda s: to_json(s.compensation),
        _restore_compensation,
        ("process",),
    ),
    Step(
        "drive",
        ("network", "proof", "sizing", "placement"),
        ("drive",),
        _drive,
        lambda s: (
            f"clock plates up to {max(p.force_most_n for p in need(s.drive).plates):.0f} N, shaft up to "
            f"{need(s.drive).torque_most_nmm:.0f} N mm"
        ),
        lambda s: to_json(s.drive),
        from_artefact("drive", DriveLoads),
        ("process", "seed"),
    ),
    Step(
        "parts",
        ("network", "placement", "layout", "sizing", "carriers", "drive"),
        ("bodies",),
        _build_parts,
        lambda s: f"{len(need(s.bodies))} bodies",
        lambda s: to_json(Parts(records_of(need(s.bodies)), s.carriers)),
        _restore_parts,
        ("process",),
    ),
    Step(
        "drc",
        ("network", "placement", "layout", "sizing", "bodies", "carriers", "drive"),
        ("rules",),
        _check_geometry,
        lambda s: f"{len(need(s.rules).errors)} errors, {len(need(s.rules).findings)} findings",
        lambda s: to_json(s.rules),
        from_artefact("rules", DesignRules, "drc"),
        ("process",),
    ),
    Step(
        "guide",
        ("network", "sizing", "placement", "bodies", "drive"),
        ("guide",),
        _guide,
        lambda s: "how to make it, put it together and start it",
        None,
        lambda job, state, files: replace(state, guide=files),
        ("process",),
    ),
    Step(
        "files",
        ("network", "placement", "bodies"),
        ("files",),
        _export,
        lambda s: f"{len(s.files)} files",
        None,
        lambda job, state, files: replace(state, files=files),
        ("process", "kerf_mm"),
    ),
    Step(
        "extraction",
        ("device", "network", "sizing", "placement", "carriers", "files"),
        ("lvs", "extracted", "built"),
        _lvs,
        lambda s: (
            f"layout {'matches' if need(s.lvs).matched else 'DIFFERS FROM'} the network; as built "
            f"{need(s.extracted).transitions_checked} transitions, {need(s.extracted).mismatches} mismatches"
        ),
        lambda s: to_json([s.lvs, s.extracted]),
        _restore_extraction,
        ("process", "seed"),
        draw=_keep_built,
    ),
    Step(
        "margins",
        ("device", "network", "sizing", "carriers", "built"),
        ("margins",),
        _margins,
        lambda s: (
            f"walls +{need(s.margins).thicker_um:.0f} -{need(s.margins).thinner_um:.0f} um, at random "
            f"{need(s.margins).random_um:.0f} um; the machine repeats to {need(s.margins).repeatability_um:.0f} um"
        ),
        lambda s: to_json(s.margins),
        from_artefact("margins", Margins),
        ("process", "seed"),
    ),
    Step(
        "views",
        ("bodies",),
        ("pictures",),
        _picture,
        lambda s: "pictures",
        None,
        lambda job, state, files: replace(state, pictures=files),
    ),
)
