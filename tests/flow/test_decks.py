"""A whole build on two unit plates: from the program to a STEP file that is read back."""

from dataclasses import replace
from pathlib import Path

import pytest

from mdlcad.artefact import load
from mdlcad.cli import HOLDS, main
from mdlcad.mechanics import Process
from mdlcad.mechanics.decks import two_decks
from mdlcad.network.model import Network
from mdlcad.parts.store import Parts, bodies_of
from mdlcad.report.report import Report
from mdlcad.signoff.drc import check_motion
from mdlcad.signoff.lvs import compare, recover
from mdlcad.signoff.readback import read_step
from mdlcad.signoff.trapped import check_order

ROOT = Path(__file__).parents[2]


@pytest.mark.long
def test_a_program_on_two_unit_plates_holds_and_what_is_wrong_with_it_is_found(tmp_path):
    folder = tmp_path / "voter"
    assert main(["build", str(ROOT / "examples" / "voter.mdl"), "--unit-plates", "2", "-o", str(folder)]) == HOLDS
    report = load(folder, "report.json", Report)
    assert report.unit_plates == 2 and report.second_plate and {"unit", "upper-unit"} <= set(report.plates)
    assert report.lvs is not None and report.lvs.matched and report.drc is not None and not any(report.drc.values())
    assert main(["verify", str(folder)]) == HOLDS

    process = two_decks(load(folder, "process.json", Process))
    bodies = bodies_of(load(folder, "parts.json", Parts).bodies)
    middle = process.z_of("upper-cover")
    pin = next(
        body for body in bodies if body.name.startswith("pin.hub.") and body.z < middle < body.z + body.thickness
    )
    assert check_motion(bodies, 0.6) == [] and check_order(bodies, process) == []
    # a cover without the slot that the crossing pin sweeps
    solid = [replace(b, section=b.section.union(pin.section.buffer(4.0))) if b.name == "cover" else b for b in bodies]
    assert any({"cover", pin.name} <= set(item.bodies) for item in check_motion(solid, 0.6))
    assert any(pin.name in item.bodies for item in check_order(solid, process))
    # without it, the net's pieces in the other deck hang on no shuttle
    found = [body for body in read_step(folder / "voter.step") if body.name != pin.name]
    result = compare(recover(found), load(folder, "network.json", Network))
    assert not result.matched and any("coupling missing" in words or "loose" in words for words in result.differences)
