"""A small program all the way: text to files, verified from the files alone, and every tampering noticed."""

import json
import shutil
import subprocess
import sys
from fnmatch import fnmatch
from pathlib import Path

import numpy as np
import pytest

from mdlcad.artefact import load
from mdlcad.cli import FAILS, HOLDS, UNUSABLE, main
from mdlcad.mechanics import Sizing
from mdlcad.mechanics.compensation import Compensation
from mdlcad.mechanics.lean import lean_of
from mdlcad.mechanics.process import Process
from mdlcad.network.model import Network
from mdlcad.parts.stiffness import lifts_of
from mdlcad.placement.placement import Placement
from mdlcad.routing.layout import Layout

ROOT = Path(__file__).resolve().parents[2]
VOTER = ROOT / "examples" / "voter.mdl"
PLATES = ["base", "shims", "clock-2", "clock-1", "clock-0", "unit", "V", "H0", "H1", "H2", "cover"]


@pytest.fixture
def built(voter_build: Path) -> Path:
    return voter_build


@pytest.fixture
def copy(built: Path, tmp_path: Path) -> Path:
    shutil.copytree(built, tmp_path / "copy")
    return tmp_path / "copy"


def report(folder: Path) -> dict:
    return json.loads((folder / "report.json").read_text())


def test_the_report_has_the_contract_s_keys_and_says_that_all_holds(built):
    found = report(built)
    assert found["design"] == "voter"
    assert found["behaviour"] == {
        "transitions_total": 8,
        "transitions_checked": 8,
        "mismatches": 0,
        "exhaustive": True,
    }
    assert found["extracted"] == found["behaviour"]
    assert found["lvs"] == {"matched": True, "differences": []}
    assert found["drc"]["unrealised_coupling"] == 0
    assert all(count == 0 for count in found["drc"].values())
    assert found["plates"] == PLATES
    assert len(found["extent_mm"]) == 3
    assert all(len(stage["checksum"]) == 64 for stage in found["stages"])
    assert {"cells", "process", "seed", "version", "masses", "couplings", "gates", "tiles"} <= set(found)


def test_the_k_read_off_the_files_is_the_k_that_was_solved_for(built):
    """Asked by the network, solved once carriers were known, drawn, and read back from the STEP file."""
    asked = {mass["name"]: mass for mass in json.loads((built / "network.json").read_text())["masses"]}
    solved = {unit["mass"]: unit for unit in json.loads((built / "compensation.json").read_text())["units"]}
    network = json.loads((built / "built.json").read_text())["network"]
    found = {mass["name"]: mass for mass in network["masses"]}
    assert asked.keys() == solved.keys() == found.keys()
    for name, mass in asked.items():
        for p in (0, 1, 2):
            left = found[name]["k0"] + p * found[name]["k1"] - mass["k0"] - p * mass["k1"]
            assert left == pytest.approx(solved[name]["left"][p], abs=0.02)
            assert p != 1 or abs(left) < 0.02
    links = {f"{item['source']}->{item['target']}": item for item in network["couplings"]}
    for item in json.loads((built / "compensation.json").read_text())["couplers"]:
        assert links[item["size"]["coupling"]]["strength"] == pytest.approx(item["left"], rel=5e-3)
    worst = [max(abs(unit["left"][p]) for unit in solved.values()) for p in (0, 1, 2)]
    assert report(built)["mechanics"]["compensation_left"] == pytest.approx(worst)
    page = (built / "report.html").read_text()
    assert "asked, solved, left" in page
    assert all(f"{unit['preload']:.4f}" in page for unit in solved.values())


def test_couplings_are_right_half_way_between_held_and_tilting_shuttles(built):
    """As drawn: what was asked for, less what tilting takes from the bias that a coupling is compared with."""
    network, sizing = load(built, "network.json", Network), load(built, "sizing.json", Sizing)
    found, process = load(built, "compensation.json", Compensation), load(built, "process.json", Process)
    lifts = lifts_of(load(built, "placement.json", Placement), load(built, "layout.json", Layout), process)
    assert min(height for pair in lifts.couplings.values() for height in pair) > 0
    drawn = [coupler.size.leaf for coupler in found.couplers]
    carriers = [coupler.carrier for coupler in found.couplers]
    lean = lean_of(network, drawn, np.ones(len(drawn)), carriers, sizing.biases, sizing.law, lifts)
    share = dict(zip([mass.name for mass in network.masses], lean.biases, strict=True))
    middle = np.abs(lean.held + lean.free) / 2.0 / sizing.law.stiffness_unit
    for coupling, coupler, got in zip(network.couplings, found.couplers, middle, strict=True):
        wanted = coupler.asked * (1.0 + share[coupling.target]) / 2.0
        assert abs(got) == pytest.approx(abs(wanted), rel=0.025)
        assert abs(coupler.left) > 0.98 * abs(coupler.asked)


def test_every_promised_file_is_there_and_hashed(built):
    files = report(built)["files"]
    wanted = [f"{name}.json" for name in ("device", "netlist", "network", "placement", "layout")]
    wanted += ["voter.step", "voter.3mf", "views/stack.png", "views/layout.svg"]
    wanted += [f"plates/{plate}.{kind}" for plate in PLATES for kind in ("step", "stl", "dxf", "svg")]
    wanted += [f"views/plate-{plate}.png" for plate in PLATES if plate != "shims"]
    assert set(wanted) <= set(files)
    on_disk = {path.relative_to(built).as_posix() for path in built.rglob("*") if path.is_file()}
    assert on_disk == set(files) | {"report.json", "report.html"}


def test_every_file_of_a_build_is_told_in_the_docs_and_every_file_told_is_there(built):
    lines = (ROOT / "docs" / "formats.md").read_text().splitlines()
    told = [line.split("`")[1].replace("NAME", "voter") for line in lines if line.startswith("| `")]
    assert len(told) > 20
    files = [path.relative_to(built).as_posix() for path in built.rglob("*") if path.is_file()]
    assert [name for name in files if not any(fnmatch(name, pattern) for pattern in told)] == []
    assert [pattern for pattern in told if not any(fnmatch(name, pattern) for name in files)] == []


def test_verify_signs_the_untouched_build_off(built, capsys):
    assert main(["verify", str(built)]) == HOLDS
    said = capsys.readouterr().out
    assert all(
        f"{name:<11} holds" in said for name in ("hashes", "behaviour", "drc", "step", "stl", "lvs", "extracted")
    )


def test_verify_names_a_changed_file(copy, capsys):
    path = copy / "plates" / "unit.stl"
    data = bytearray(path.read_bytes())
    data[200] ^= 1
    path.write_bytes(bytes(data))
    assert main(["verify", str(copy)]) == FAILS
    assert "plates/unit.stl" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["network.json", "voter.step", "report.json"])
def test_verify_names_a_missing_file(copy, capsys, name):
    (copy / name).unlink()
    assert main(["verify", str(copy)]) == UNUSABLE
    assert name in capsys.readouterr().err


def rehash(folder: Path, name: str) -> None:
    """Make the report vouch for a changed file, so that the checks behind the hashes are reached."""
    from mdlcad.artefact import checksum

    found = report(folder)
    found["files"][name] = checksum((folder / name).read_bytes())
    (folder / "report.json").write_text(json.dumps(found))


def test_verify_finds_a_flipped_coupling_behind_a_right_hash(copy, capsys):
    network = json.loads((copy / "network.json").read_text())
    network["couplings"][0]["strength"] *= -1
    (copy / "network.json").write_text(json.dumps(network))
    rehash(copy, "network.json")
    assert main(["verify", str(copy)]) == FAILS
    assert "behaviour" in capsys.readouterr().err


def test_verify_finds_another_device_in_the_step_file(copy, capsys):
    (copy / "voter.step").write_bytes((copy / "plates" / "unit.step").read_bytes())
    rehash(copy, "voter.step")
    assert main(["verify", str(copy)]) == FAILS
    said = capsys.readouterr().err
    assert "coupling missing" in said
    assert "the STEP file holds it 0 times" in said


def test_the_same_bytes_in_a_fresh_process_with_other_hashes_and_one_worker(built, tmp_path):
    again = tmp_path / "again"
    subprocess.run(
        [sys.executable, "-m", "mdlcad.cli", "build", str(VOTER), "-o", str(again), "--jobs", "1"],
        env={"PYTHONHASHSEED": "4711", "PATH": "/usr/bin:/bin"},
        check=True,
        capture_output=True,
        timeout=300,
    )
    first, second = report(built), report(again)
    assert first["files"] == second["files"]
    for found in (first, second):
        for stage in found["stages"]:
            del stage["seconds"]
    assert first == second


def test_a_build_can_start_again_from_a_stage(built, tmp_path):
    folder = tmp_path / "from"
    assert main(["build", str(built), "--from", "sizing", "--to", "sizing", "-o", str(folder)]) == HOLDS
    assert (folder / "sizing.json").read_bytes() == (built / "sizing.json").read_bytes()


def test_what_is_taken_from_a_folder_is_written_as_it_was(built, tmp_path):
    """The sizing too, although the compensation makes it anew after it."""
    folder = tmp_path / "from"
    assert main(["build", str(built), "--from", "drive", "--to", "drc", "-o", str(folder)]) == HOLDS
    for path in sorted(folder.glob("*.json")):
        if path.name != "report.json":
            assert path.read_bytes() == (built / path.name).read_bytes(), path.name
