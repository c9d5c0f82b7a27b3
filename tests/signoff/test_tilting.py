"""The proof with tilting shuttles on a whole build, and devices that it must refuse."""

from dataclasses import replace
from pathlib import Path

import pytest

from mdlcad.artefact import load
from mdlcad.flow.result import failures
from mdlcad.flow.state import State
from mdlcad.language import Device
from mdlcad.mechanics import Process, Sizing
from mdlcad.network.model import Network
from mdlcad.parts.store import Parts
from mdlcad.proof.outcome import Proof
from mdlcad.proof.prove import prove
from mdlcad.proof.reference import build_reference
from mdlcad.report.report import Report
from mdlcad.signoff.extraction import Built, BuiltDevice
from mdlcad.signoff.stops import Stop
from mdlcad.signoff.tilting import TILTING, TiltingProof, rubbing, tilting_proof


def proved(folder: Path, gap: float, softer: float = 1.0) -> Proof:
    """With shuttles that can tilt by a gap of so many mm at 30 mm from their hub, on softer beams, without friction."""
    network, sizing = load(folder, "network.json", Network), load(folder, "sizing.json", Sizing)
    carriers, process = load(folder, "parts.json", Parts).carriers, load(folder, "process.json", Process)
    process = replace(process, stack=replace(process.stack, friction=0.0))
    sizing = replace(sizing, law=replace(sizing.law, shuttle_tilt=sizing.law.shuttle_tilt / softer))
    drawn = load(folder, "built.json", BuiltDevice).drawn
    stops = {mass.name: Stop(-gap / 30.0, gap / 30.0) for mass in network.masses}
    built = Built(drawn, network, sizing, carriers, process, stops=stops)
    return prove(built.network, build_reference(load(folder, "device.json", Device)), built=built.system)


def test_it_is_in_the_build(voter_build: Path) -> None:
    found, report = load(voter_build, TILTING, TiltingProof), load(voter_build, "report.json", Report)
    assert found.proof.holds and found.proof.tilts
    process, sizing = load(voter_build, "process.json", Process), load(voter_build, "sizing.json", Sizing)
    assert report.tilting is not None and report.tilting.mismatches == 0
    assert report.tilts is not None
    assert report.tilts.largest_rad == max(item.largest for item in found.shuttles)
    for item in found.shuttles:
        assert item.low < 0.0 < item.high
        # N = (M - K g / L) / L is most where L = 2 K g / M, which is M^2 / (4 K g)
        stiff, gap = sizing.law.shuttle_tilt, process.stack.z_gap
        moment = stiff * item.largest
        lever = 2.0 * stiff * gap / moment
        pressed = max((moment - stiff * gap / at) / at for at in (0.8 * lever, lever, 1.2 * lever))
        assert item.rub * sizing.law.force_unit == pytest.approx(process.stack.friction * pressed, rel=1e-6)


@pytest.mark.parametrize(("gap", "right"), [(0.3, True), (12.0, False)])
def test_shuttles_that_gaps_let_tilt_too_far_are_refused(voter_build: Path, gap: float, right: bool) -> None:
    """On beams that are 300 times as soft it is the plates that hold them: with gaps that are too wide they do not."""
    assert proved(voter_build, gap, softer=300.0).holds is right


def test_a_device_that_is_wrong_when_tilting_fails(voter_build: Path) -> None:
    wrong = proved(voter_build, 12.0, softer=300.0)
    process, sizing = load(voter_build, "process.json", Process), load(voter_build, "sizing.json", Sizing)
    stops = {mass: Stop(-0.2, 0.2) for mass in wrong.peaks}
    (words,) = failures(State(tilting=tilting_proof(wrong, stops, process, sizing.law)), None)
    assert words.startswith("the device as drawn, its shuttles tilting, does not behave as the program says")
    assert rubbing(process, sizing.law) > 0.0
    with pytest.raises(ValueError, match="were held"):
        tilting_proof(load(voter_build, "proof.json", Proof), stops, process, sizing.law)
