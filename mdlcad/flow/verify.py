"""Sign a finished build off again, from its files alone: nothing of the run that made it is trusted."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from shapely import Polygon

from mdlcad.artefact import checksum, load
from mdlcad.errors import InputError, SignoffError, UsageError
from mdlcad.export.mesh import check_stl
from mdlcad.export.solid import plate_section
from mdlcad.flow.folder import REPORT
from mdlcad.flow.outline import port_places
from mdlcad.flow.plans import GRID_STEPS
from mdlcad.language import Device
from mdlcad.mapping import CELLS_FILE, map_netlist, recorded_library
from mdlcad.mapping.two_phase import TwoPhaseLibrary
from mdlcad.mechanics import Process, Sizing
from mdlcad.mechanics.compensation import COMPENSATION_FILE, Compensation, compensate, compensated
from mdlcad.mechanics.drive import DriveLoads
from mdlcad.network.model import Network
from mdlcad.parts import build_parts
from mdlcad.parts.clock import device_loads
from mdlcad.parts.plates import plates_of
from mdlcad.parts.stiffness import carrier_stiffnesses, lifts_of
from mdlcad.parts.store import Parts, bodies_of, records_of
from mdlcad.placement.check_grid import check_grid
from mdlcad.placement.placement import Placement
from mdlcad.placement.unit_grid import GridPlacement
from mdlcad.proof.outcome import Proof
from mdlcad.proof.prove import prove
from mdlcad.proof.reference import build_reference
from mdlcad.report.guide import GUIDE, guide
from mdlcad.report.report import Report
from mdlcad.routing.decks import process_of
from mdlcad.routing.layout import Layout
from mdlcad.signoff.device import prove_device
from mdlcad.signoff.extraction import BuiltDevice
from mdlcad.signoff.files import check_bodies
from mdlcad.signoff.geometry import check_geometry
from mdlcad.signoff.lvs import compare, recover
from mdlcad.signoff.mixtures import MIXTURES, Mixtures, find_mixtures
from mdlcad.signoff.readback import read_step
from mdlcad.signoff.tilting import TILTING, TiltingProof
from mdlcad.synthesis.netlist import Netlist


def verify(folder: Path, workers: int, say: Callable[[str], None]) -> list[str]:
    """What does not hold in the build, in words; empty if all holds.

    Raises:
        UsageError: the folder is not a whole build (a file missing, truncated or of another shape: which one).
    """
    if not folder.is_dir():
        raise UsageError(f"{folder}: no such build folder")
    report = load(folder, REPORT, Report)
    try:
        return _verify(folder, report, workers, say)
    except (UsageError, InputError, SignoffError):
        raise
    # Files of the right shape that a report vouches for may still contradict each other in ways that no build makes,
    # and all that reads them relies on a build. Whatever that leads to, it is the folder's fault, and a traceback would
    # not say so.
    except Exception as problem:
        raise UsageError(
            f"{folder}: its files contradict each other or hold what no build makes ({type(problem).__name__}: "
            f"{problem}); was one edited, and report.json with it? build it again"
        ) from problem


def _verify(folder: Path, report: Report, workers: int, say: Callable[[str], None]) -> list[str]:
    if report.stopped is not None:
        raise UsageError(f"{folder}: its build ended at {report.stopped.stage}: {report.stopped.reason}")
    placed_only = _is_placed_only(folder, report)
    if report.extracted is None and not placed_only:
        raise UsageError(f"{folder}: was stopped before its sign-off (--to); build it whole to verify it")
    broken: list[str] = []

    def step(name: str, found: list[str]) -> None:
        say(f"{name:<11} {'holds' if not found else f'{len(found)} findings'}")
        broken.extend(f"{name}: {words}" for words in found)

    step("hashes", _check_hashes(folder, report))
    if broken:
        return broken
    device, network = load(folder, "device.json", Device), load(folder, "network.json", Network)
    reference = build_reference(device)
    proof = prove(network, reference, seed=report.seed, workers=workers)
    step("behaviour", _wrong(proof))
    if placed_only:
        mapped = map_netlist(load(folder, "netlist.json", Netlist), recorded_library(folder))
        step("mapping", [] if mapped == network else [f"network.json: not what {CELLS_FILE} makes of netlist.json"])
        grid = load(folder, "placement.json", GridPlacement)
        boundary = tuple(line.start for line in device.boundary)
        step("placement", check_grid(network, grid, boundary, port_places(device)))
        step("page", _check_page(folder))
        return broken
    sizing, process = load(folder, "sizing.json", Sizing), load(folder, "process.json", Process)
    placement, layout = load(folder, "placement.json", Placement), load(folder, "layout.json", Layout)
    process = process_of(process, placement)
    carriers = carrier_stiffnesses(network, placement, layout, sizing, process)
    stiffness = {item.coupling: item.stiffness for item in carriers}
    lifts = lifts_of(placement, layout, process)
    solved = load(folder, COMPENSATION_FILE, Compensation)
    step(
        "compensation",
        []
        if compensate(network, process, sizing, stiffness, lifts) == solved
        else [f"{COMPENSATION_FILE}: not what the carriers ask for"],
    )
    sizing = compensated(sizing, solved)
    drive = load(folder, "drive.json", DriveLoads)
    boundary = Polygon(placement.boundary)
    loads = device_loads(network, placement, sizing, process, proof.sensor_force, report.seed)
    step("drive", [] if drive == loads else ["drive.json: not what the device's simulation gives"])
    records = records_of(build_parts(network, placement, layout, sizing, process, boundary, drive.moments))
    bodies = bodies_of(records)
    stored = load(folder, "parts.json", Parts)
    step("parts", [] if stored == Parts(records, carriers) else ["parts.json: not what the layout makes"])
    rules = check_geometry(network, sizing, placement, layout, bodies, carriers, process, drive.moments)
    step("drc", [f"{item.rule}: {', '.join(item.bodies)}: {item.message}" for item in rules.errors])
    again = guide(network, sizing, placement, process, bodies, drive).encode()
    step("guide", [] if (folder / GUIDE).read_bytes() == again else [f"{GUIDE}: is not the guide that the files make"])
    found = read_step(folder / f"{device.name}.step")
    step("step", check_bodies(bodies, found))
    stl = []
    for plate, members in plates_of(bodies).items():
        data = (folder / "plates" / f"{plate}.stl").read_bytes()
        try:
            check_stl(plate, data, plate_section(members), members[0].thickness)
        except SignoffError as problem:
            stl.append(str(problem))
    step("stl", stl)
    recovered = recover(found)
    lvs = compare(recovered, network)
    step("lvs", list(lvs.differences))
    if lvs.matched:
        proved = prove_device(
            folder, found, recovered, network, sizing, carriers, process, reference, report.seed, workers
        )
        kept = load(folder, "built.json", BuiltDevice) == proved.built
        step("extracted", _wrong(proved.extracted) + ([] if kept else ["built.json: not what the files draw"]))
        kept = load(folder, TILTING, TiltingProof) == proved.tilting
        step("tilting", _wrong(proved.tilting.proof) + ([] if kept else [f"{TILTING}: not what the files draw"]))
        mixtures = find_mixtures(proved.loose, reference, report.seed, workers)
        say(f"{'mixtures':<11} {mixtures.words()}")
        same = load(folder, MIXTURES, Mixtures) == mixtures
        broken += [] if same else [f"mixtures: {MIXTURES}: not what the files draw"]
    step("page", _check_page(folder))
    return broken


def _wrong(proof: Proof) -> list[str]:
    """What does not hold in a proof, in words."""
    return [] if proof.holds else [str(item) for item in proof.first_mismatches] or ["nothing was checked"]


def _is_placed_only(folder: Path, report: Report) -> bool:
    """Whether the build is as whole as its cell library allows: placed on the grid, without parts."""
    last = report.stages[-1].name if report.stages else ""
    return last == GRID_STEPS[-1].name and isinstance(recorded_library(folder), TwoPhaseLibrary)


def _check_page(folder: Path) -> list[str]:
    """The page has no hash, because it shows the stages' seconds; but the other files make it anew to the byte."""
    from mdlcad.report.make import PAGE
    from mdlcad.report.page import page  # the templates are not needed where hashes differ

    path = folder / PAGE
    if not path.is_file():
        raise UsageError(f"{path}: is missing from the build; build it again")
    if path.read_bytes() != page(folder).encode():
        return [f"{PAGE}: is not the page that the build's files make"]
    return []


def _check_hashes(folder: Path, report: Report) -> list[str]:
    found = []
    for name, expected in sorted(report.files.items()):
        path = folder / name
        if not path.is_file():
            raise UsageError(f"{path}: is missing from the build; build it again")
        if checksum(path.read_bytes()) != expected:
            found.append(f"{name}: is not the file that was built (its SHA-256 differs from report.json)")
    return found
