"""A build with the paper's library: proved, placed and drawn, and no further."""

import hashlib
import json
import re
import shutil
from pathlib import Path

import pytest

from mdlcad.cli import FAILS, HOLDS, UNUSABLE, main

ROOT = Path(__file__).resolve().parents[2]
VOTER = str(ROOT / "examples" / "voter.mdl")
BUILD = ("build", VOTER, "--cells", "two_phase")


@pytest.fixture(scope="module")
def placed(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("two_phase") / "voter"
    assert main([*BUILD, "--to", "placement", "-o", str(folder)]) == HOLDS
    return folder


def artefact(folder: Path, name: str) -> dict:
    return json.loads((folder / f"{name}.json").read_text())


def test_the_placed_network_is_drawn_with_all_that_is_in_it(placed):
    network, placement = artefact(placed, "network"), artefact(placed, "placement")
    assert [item["mass"] for item in placement["masses"]] == [item["name"] for item in network["masses"]]
    drawing = (placed / "views" / "placement.svg").read_text()
    titles = re.findall(r"<title>([^:]*): ", drawing)
    assert sorted(titles) == sorted(item["name"] for item in network["masses"])
    for port in placement["ports"]:
        assert f">{port['bit']}<" in drawing
    assert "clock wave 1" in drawing and "negative coupling" in drawing
    assert (placed / "views" / "placement.png").read_bytes().startswith(b"\x89PNG")


def test_the_report_stops_where_the_build_does(placed):
    report = artefact(placed, "report")
    assert report["cells"] == "two_phase"
    assert report["behaviour"]["mismatches"] == 0 and report["behaviour"]["transitions_checked"] == 8
    assert report["extracted"] is None and report["plates"] == []
    assert {"placement.json", "cells.json", "views/placement.svg", "views/placement.png"} <= set(report["files"])


def test_the_same_bytes_again_and_from_the_folder(placed, tmp_path):
    again = ["build", str(placed), "--from", "placement", "--to", "placement", "-o", str(tmp_path / "again")]
    assert main(again) == HOLDS
    for name, digest in artefact(placed, "report")["files"].items():
        assert artefact(tmp_path / "again", "report")["files"][name] == digest, name


def test_verify_maps_again_and_checks_the_places(placed, tmp_path, capsys):
    assert main(["verify", str(placed)]) == HOLDS
    said = capsys.readouterr().out
    assert all(f"{name:<11} holds" in said for name in ("hashes", "behaviour", "mapping", "placement"))
    copy = tmp_path / "copy"
    shutil.copytree(placed, copy)
    # a build whose files agree with its report, but not with each other
    for name, old, new in (
        ("cells", '"parameters": "robust"', '"parameters": "other"'),
        ("cells", '"io_gates": true', '"io_gates": false'),
        ("placement", f'"x": {artefact(placed, "placement")["ports"][0]["x"]}', '"x": 0.5'),
    ):
        text = (copy / f"{name}.json").read_text()
        assert old in text
        (copy / f"{name}.json").write_text(text.replace(old, new))
    report = artefact(copy, "report")
    for name in ("cells.json", "placement.json"):
        report["files"][name] = hashlib.sha256((copy / name).read_bytes()).hexdigest()
    (copy / "report.json").write_text(json.dumps(report))
    assert main(["verify", str(copy)]) == FAILS
    said = capsys.readouterr()
    assert "network.json: not what cells.json makes" in said.err
    assert "is not where the program has it" in said.err or "is not at its port" in said.err


def test_a_whole_build_says_how_far_it_can_go_and_writes_nothing(tmp_path, capsys):
    assert main([*BUILD, "-o", str(tmp_path / "out")]) == UNUSABLE
    said = capsys.readouterr().err
    assert "there are no parts yet" in said and "--to placement" in said
    assert not list(tmp_path.iterdir())
