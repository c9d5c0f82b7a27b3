"""What the last steps run: rules, files, and the device that the files draw."""

from __future__ import annotations

from dataclasses import replace

from mdlcad.artefact import load, to_json, write_atomic
from mdlcad.flow.state import Job, State, need, stacked
from mdlcad.flow.step import Progress
from mdlcad.proof.outcome import Proof
from mdlcad.proof.reference import build_reference
from mdlcad.signoff.device import prove_device
from mdlcad.signoff.extraction import Built, BuiltDevice
from mdlcad.signoff.geometry import check_geometry
from mdlcad.signoff.lvs import LvsResult, compare, recover
from mdlcad.signoff.margins import find_margins, grid_of
from mdlcad.signoff.mixtures import find_mixtures
from mdlcad.signoff.readback import read_step
from mdlcad.signoff.tilting import TILTING, TiltingProof, stops_found


def checked(job: Job, state: State, progress: Progress) -> State:
    """What the design rules find."""
    rules = check_geometry(
        need(state.network),
        need(state.sizing),
        need(state.placement),
        need(state.layout),
        need(state.bodies),
        state.carriers,
        stacked(job.process, state),
        need(state.drive).moments,
    )
    return replace(state, rules=rules)


def write_guide(job: Job, state: State, progress: Progress) -> State:
    """Write how it is made, put together and started."""
    from mdlcad.report.guide import GUIDE, guide  # the templates are not needed by early stages

    text = guide(
        need(state.network),
        need(state.sizing),
        need(state.placement),
        stacked(job.process, state),
        need(state.bodies),
        need(state.drive),
    )
    write_atomic(job.folder / GUIDE, text.encode())
    return replace(state, guide=(GUIDE,))


def export(job: Job, state: State, progress: Progress) -> State:
    """Write the files for other programs."""
    from mdlcad.export.files import write_files  # the CAD kernel takes seconds to load; early stages need not wait

    name, bodies = need(state.network).design, need(state.bodies)
    process = stacked(job.process, state)
    files = write_files(name, bodies, process, job.kerf_mm, job.folder, job.workers, progress)
    return replace(state, files=files)


def extract(job: Job, state: State, progress: Progress) -> State:
    """Read the files back: the network that they draw, and the proof of it."""
    network = need(state.network)
    found = read_step(job.folder / f"{network.design}.step")
    recovered = recover(found)
    result = compare(recovered, network)
    device = prove_device(
        job.folder,
        found,
        recovered,
        network,
        need(state.sizing),
        state.carriers,
        stacked(job.process, state),
        build_reference(need(state.device)),
        job.seed,
        job.workers,
    )
    return replace(state, lvs=result, extracted=device.extracted, tilting=device.tilting, built=device.built)


def restore_extraction(job: Job, state: State, files: tuple[str, ...]) -> State:
    """What ``extract`` made, from its files."""
    lvs, extracted = load(job.folder, "extraction.json", tuple[LvsResult, Proof])
    tilting, built = load(job.folder, TILTING, TiltingProof), load(job.folder, "built.json", BuiltDevice)
    return replace(state, lvs=lvs, extracted=extracted, tilting=tilting, built=built)


def write_built(job: Job, state: State) -> None:
    """Write built.json, the device as the files draw it, and tilting.json, its proof with shuttles that tilt."""
    write_atomic(job.folder / "built.json", to_json(state.built))
    write_atomic(job.folder / TILTING, to_json(state.tilting))


def find_the_mixtures(job: Job, state: State, progress: Progress) -> State:
    """Whether the device as drawn is right if plates hold some of its shuttles from tilting."""
    stops = stops_found(need(state.tilting))
    drawn, network, process = need(state.built).drawn, need(state.network), stacked(job.process, state)
    built = Built(drawn, network, need(state.sizing), state.carriers, process, stops=stops)
    reference = build_reference(need(state.device))
    return replace(state, mixtures=find_mixtures(built, reference, job.seed, job.workers))


def find_the_margins(job: Job, state: State, progress: Progress) -> State:
    """How far dimensions may be off."""
    drawn, process = need(state.built).drawn, job.process
    built = Built(drawn, need(state.network), need(state.sizing), state.carriers, process, grid_of(process))
    reference = build_reference(need(state.device))
    return replace(state, margins=find_margins(built, reference, process, job.seed, job.workers))


def write_pictures(job: Job, state: State, progress: Progress) -> State:
    """Write the pictures."""
    from mdlcad.view.views import write_views  # VTK takes seconds to load

    return replace(state, pictures=write_views(need(state.bodies), job.folder, progress))
