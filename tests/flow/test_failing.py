"""A build that does not hold ends there, exits 1, and leaves a folder that says what and why."""

import json
from pathlib import Path

import pytest

from mdlcad.cli import FAILS, HOLDS, UNUSABLE, main
from mdlcad.errors import SignoffError
from mdlcad.flow import placing

VOTER = Path(__file__).resolve().parents[2] / "examples" / "voter.mdl"


@pytest.fixture(scope="module")
def sized(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("build") / "voter"
    assert main(["build", str(VOTER), "-o", str(folder), "--to", "sizing"]) == HOLDS
    return folder


def report(folder: Path) -> dict:
    return json.loads((folder / "report.json").read_text())


def test_a_part_of_a_build_says_in_its_page_what_is_not_known(sized):
    page = (sized / "report.html").read_text()
    assert "Stopped after its stage “sizing”, as asked" in page
    assert "design rules have not been checked" in page
    assert report(sized)["stopped"] is None
    assert "report.html" not in report(sized)["files"]


def test_a_wrong_network_is_kept_with_its_proof_and_goes_no_further(sized, tmp_path, capsys):
    network = json.loads((sized / "network.json").read_text())
    network["couplings"][0]["strength"] *= -1
    (sized / "network.json").write_text(json.dumps(network))
    folder = tmp_path / "wrong"
    assert main(["build", str(sized), "--from", "proof", "--to", "sizing", "-o", str(folder)]) == FAILS
    assert "does not hold: proof: the network does not behave" in capsys.readouterr().err
    found = report(folder)
    assert found["stopped"]["stage"] == "proof"
    assert found["behaviour"]["mismatches"] > 0
    assert not (folder / "sizing.json").exists()
    assert json.loads((folder / "proof.json").read_text())["first_mismatches"]
    page = (folder / "report.html").read_text()
    assert page.index("Does not hold") < page.index("What came out")
    assert "expected verdict[0]" in page
    assert main(["verify", str(folder)]) == UNUSABLE
    assert "ended at proof" in capsys.readouterr().err


def test_a_layout_that_is_not_found_leaves_what_was_made(sized, tmp_path, monkeypatch):
    def jammed(*arguments):
        raise SignoffError("channel 1: no legal tracks for 7 nets")

    monkeypatch.setattr(placing, "place_and_route", jammed)
    folder = tmp_path / "jammed"
    assert main(["build", str(sized), "--from", "placement", "--unit-plates", "1", "-o", str(folder)]) == FAILS
    found = report(folder)
    assert found["stopped"] == {"stage": "placement", "reason": "channel 1: no legal tracks for 7 nets"}
    assert found["failures"] == ["placement: channel 1: no legal tracks for 7 nets"]
    assert "channel 1: no legal tracks for 7 nets" in (folder / "report.html").read_text()
    assert (folder / "sizing.json").exists()
    assert not (folder / "layout.json").exists()
