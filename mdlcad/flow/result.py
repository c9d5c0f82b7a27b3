"""From the state of a build to its report, and the verdict on it."""

from __future__ import annotations

from mdlcad.flow.state import Job, State
from mdlcad.mechanics import Process
from mdlcad.parts.body import Body
from mdlcad.parts.bom import bill_of_materials
from mdlcad.parts.plates import plates_of
from mdlcad.parts.tiles import tiles_of
from mdlcad.report.make import behaviour_of, extent_of, hashes_of, mechanics_of, tilts_of
from mdlcad.report.report import Lvs, Report, StageRecord, Stopped
from mdlcad.routing.decks import process_of, units_of


def make_report(
    state: State, job: Job, records: tuple[StageRecord, ...], stopped: Stopped | None, version: str
) -> Report:
    """The report of what has been made so far in ``job.folder``."""
    network, bodies = state.network, state.bodies
    process = job.process if state.placement is None else process_of(job.process, state.placement)
    return Report(
        design=state.device.name if state.device else "",
        cells=job.cells.name,
        process=job.process.name,
        seed=job.seed,
        version=version,
        masses=len(network.masses) if network else None,
        couplings=len(network.couplings) if network else None,
        gates=len(state.netlist.gates) if state.netlist else None,
        cycles_per_tick=network.cycles_per_tick if network else None,
        period=network.dynamics.period if network else None,
        behaviour=behaviour_of(state.proof),
        extracted=behaviour_of(state.extracted),
        tilting=behaviour_of(state.tilting.proof if state.tilting else None),
        tilts=tilts_of(state.tilting),
        lvs=Lvs(state.lvs.matched, state.lvs.differences) if state.lvs else None,
        drc=state.rules.counts if state.rules else None,
        mechanics=mechanics_of(state.sizing, state.carriers, state.compensation),
        drive=state.drive,
        mixtures=state.mixtures,
        margins=state.margins,
        extent_mm=extent_of(bodies) if bodies else None,
        plates=tuple(plates_of(bodies)) if bodies else (),
        tiles=_tiles(bodies, process) if bodies else None,
        bom=bill_of_materials(bodies, process) if bodies else None,
        stages=records,
        stopped=stopped,
        failures=tuple(failures(state, stopped)),
        files=hashes_of(job.folder),
        placer=None if state.search is None else state.search.placer,
        seeds=None if state.search is None else state.search.seeds,
        like=None if state.search is None else state.search.like,
        unit_plates=None if state.placement is None else 1 if units_of(state.placement) is None else 2,
        second_plate=(state.search.second_plate or None) if state.search is not None else None,
    )


def _tiles(bodies: tuple[Body, ...], process: Process) -> int:
    """How many pieces of work the plates are for the machine's bed."""
    return sum(len(tiles_of(plate, members, process).tiles) for plate, members in plates_of(bodies).items())


def failures(state: State, stopped: Stopped | None) -> list[str]:
    """What does not hold in a build, in words; empty if all that was checked holds."""
    found = [] if stopped is None else [f"{stopped.stage}: {stopped.reason}"]
    if state.rules is not None:
        for item in state.rules.errors[:20]:
            found.append(f"{item.rule} at ({item.x:.2f}, {item.y:.2f}): {', '.join(item.bodies)}: {item.message}")
        if len(state.rules.errors) > 20:
            found.append(f"and {len(state.rules.errors) - 20} more findings, see drc.json")
    if state.lvs is not None and not state.lvs.matched:
        found += [f"layout versus network: {words}" for words in state.lvs.differences[:20]]
    if state.extracted is not None and not state.extracted.holds:
        words = "; ".join(str(item) for item in state.extracted.first_mismatches[:3]) or "nothing was checked"
        found.append(f"the device as drawn does not behave as the program says: {words}")
    if state.tilting is not None and not state.tilting.proof.holds:
        words = "; ".join(str(item) for item in state.tilting.proof.first_mismatches[:3]) or "nothing was checked"
        found.append(f"the device as drawn, its shuttles tilting, does not behave as the program says: {words}")
    return found
