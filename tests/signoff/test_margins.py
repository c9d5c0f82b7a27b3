"""Margins of a whole build, and the proof of a device whose STEP file was changed."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from shapely import box

from mdlcad.artefact import load
from mdlcad.export.step import step_assembly
from mdlcad.language import Device
from mdlcad.mechanics import Process, Sizing
from mdlcad.network.model import Network
from mdlcad.parts.store import Parts, bodies_of
from mdlcad.proof.prove import prove
from mdlcad.proof.reference import build_reference
from mdlcad.report.report import Report
from mdlcad.signoff.extraction import Built, BuiltDevice
from mdlcad.signoff.margins import Margins, find_margins, grid_of
from mdlcad.signoff.measure_leaf import measure_leaf
from mdlcad.signoff.readback import read_step


def built_of(folder: Path, drawn=None, grid=(0.0,)) -> Built:
    drawn = drawn or load(folder, "built.json", BuiltDevice).drawn
    network, sizing = load(folder, "network.json", Network), load(folder, "sizing.json", Sizing)
    carriers, process = load(folder, "parts.json", Parts).carriers, load(folder, "process.json", Process)
    return Built(drawn, network, sizing, carriers, process, grid)


def holds(folder: Path, built: Built) -> bool:
    reference = build_reference(load(folder, "device.json", Device))
    return prove(built.network, reference, built=built.system).holds


def test_the_report_has_the_margins(voter_build: Path) -> None:
    margins, report = load(voter_build, "margins.json", Margins), load(voter_build, "report.json", Report)
    assert report.margins == margins
    assert margins.repeatability_um == 50.0
    assert 0.0 < margins.random_um <= margins.tried_um
    page = (voter_build / "report.html").read_text()
    assert f"±{margins.random_um:g} µm" in page


def test_devices_within_are_right_and_beyond_are_not(voter_build: Path) -> None:
    process = load(voter_build, "process.json", Process)
    margins = load(voter_build, "margins.json", Margins)
    built = built_of(voter_build, grid=grid_of(process))
    reference = build_reference(load(voter_build, "device.json", Device))
    assert find_margins(built, reference, process, 0, workers=2) == margins  # whatever the number of workers
    assert margins.random_um < margins.tried_um and margins.weakest
    # twice as far out, another draw of devices has some that go wrong in the whole proof
    rng, wrong = np.random.default_rng(5), 0
    for _ in range(6):
        errors = built.errors(1)
        for values in (errors.beams, errors.leaves, errors.pins, errors.couplers, errors.biases, errors.posts):
            values[:] = 2e-3 * margins.random_um * rng.uniform(-1.0, 1.0, values.shape)
        wrong += not prove(built.network, reference, built=built.with_errors(errors)).holds
    assert wrong > 0


@pytest.mark.parametrize(("thicker", "right"), [(0.02, True), (0.3, False)])
def test_a_coupler_thickened_in_the_step_file(voter_build: Path, tmp_path: Path, thicker: float, right: bool) -> None:
    """By 20 um the voter still votes; by 300 um (c times 2.9) one vote outweighs the other two."""
    drawn = load(voter_build, "built.json", BuiltDevice).drawn
    name, hub = "base_vote[0]->verdict[0]", drawn.units["verdict[0]"]
    seen = next(item for item in drawn.couplers if item.name == name)
    bodies = bodies_of(load(voter_build, "parts.json", Parts).bodies)
    body = next(item for item in bodies if item.name == f"coupler.{name}")
    low, _, high, _ = body.section.bounds
    face = seen.leaf.halves[0].face
    block = box(min(hub.x, face), -1e3, max(hub.x, face), 1e3)
    flexure = body.section.difference(block).buffer(thicker / 2, join_style="mitre")
    section = flexure.intersection(box(low, -1e3, high, 1e3)).difference(block).union(body.section)
    path = tmp_path / "coupler.step"
    path.write_bytes(step_assembly("coupler", [replace(body, section=section)]))
    leaf = measure_leaf(body.name, read_step(path)[0].section, hub.x, None)
    wall = seen.leaf.halves[0].walls[1]
    assert leaf.halves[0].walls[1] == pytest.approx(wall + thicker, abs=1e-3)
    couplers = tuple(replace(item, leaf=leaf) if item.name == name else item for item in drawn.couplers)
    built = built_of(voter_build, replace(drawn, couplers=couplers))
    strength = {item.name: item.strength for item in built.network.couplings}[name]
    assert strength == pytest.approx(0.2 * ((wall + thicker) / wall) ** 3, rel=0.1)
    assert holds(voter_build, built) is right


def test_the_device_as_drawn_holds(voter_build: Path) -> None:
    assert holds(voter_build, built_of(voter_build))
