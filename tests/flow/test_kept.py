"""Building again into a folder reruns what has to be, keeps the rest, and gives the bytes of a fresh build."""

import ast
import inspect
import json
import shutil
from pathlib import Path

import pytest

from mdlcad.artefact import checksum, to_json
from mdlcad.cli import FAILS, HOLDS, UNUSABLE, main
from mdlcad.errors import SignoffError
from mdlcad.flow import placing, steps
from mdlcad.flow.inputs import _SETTINGS
from mdlcad.flow.state import State, narrowed
from mdlcad.parts.store import records_of

ROOT = Path(__file__).resolve().parents[2]
VOTER = ROOT / "examples" / "voter.mdl"
EARLY = ["device", "netlist", "network", "proof", "sizing"]


def report(folder: Path) -> dict:
    return json.loads((folder / "report.json").read_text())


def origins(folder: Path) -> dict[str, str]:
    return {stage["name"]: stage["origin"] for stage in report(folder)["stages"]}


def made(folder: Path) -> list[str]:
    return [name for name, origin in origins(folder).items() if origin == "made"]


def without_times(folder: Path) -> dict:
    found = report(folder)
    for stage in found["stages"]:
        del stage["seconds"], stage["origin"]
    return found


@pytest.fixture
def whole(voter_build: Path, tmp_path: Path) -> Path:
    shutil.copytree(voter_build, tmp_path / "voter")
    return tmp_path / "voter"


@pytest.fixture(scope="module")
def sized(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("early") / "voter"
    assert main(["build", str(VOTER), "-o", str(folder), "--to", "sizing"]) == HOLDS
    return folder


@pytest.fixture
def early(sized: Path, tmp_path: Path) -> Path:
    shutil.copytree(sized, tmp_path / "voter")
    return tmp_path / "voter"


def rebuild(folder: Path, *options: str, source: Path = VOTER) -> list[str]:
    """Build the first stages again; the names of those that ran."""
    assert main(["build", str(source), "-o", str(folder), "--to", "sizing", *options]) == HOLDS
    return made(folder)


def test_nothing_changed_nothing_runs_and_every_byte_is_that_of_the_fresh_build(voter_build, whole, capsys):
    assert main(["build", str(VOTER), "-o", str(whole), "--jobs", "1"]) == HOLDS
    said = [line for line in capsys.readouterr().out.splitlines() if not line.startswith("written")]
    assert made(whole) == []
    assert len(said) == len(origins(whole)) and all(line.endswith("(kept)") for line in said)
    assert without_times(whole) == without_times(voter_build)
    for name in report(voter_build)["files"]:
        assert (whole / name).read_bytes() == (voter_build / name).read_bytes(), name
    assert main(["verify", str(whole)]) == HOLDS


def test_a_truncated_file_is_noticed_and_only_its_stage_runs_again(voter_build, whole):
    drive = whole / "drive.json"
    drive.write_bytes(drive.read_bytes()[:-5])
    (whole / "views" / "layout.svg").write_text("<svg/>")
    assert main(["build", str(VOTER), "-o", str(whole)]) == HOLDS
    assert made(whole) == ["layout", "drive"]
    assert without_times(whole) == without_times(voter_build)


def test_stages_that_run_again_on_kept_ones_and_side_by_side_make_what_they_made(voter_build, whole, capsys):
    for name in ("guide.html", "extraction.json", "views/exploded.png"):
        (whole / name).unlink()
    assert main(["build", str(VOTER), "-o", str(whole), "--jobs", "2"]) == HOLDS
    said = [line.split()[0] for line in capsys.readouterr().out.splitlines() if not line.startswith("written")]
    assert said == list(origins(voter_build))
    assert made(whole) == ["guide", "extraction", "views"]
    assert without_times(whole) == without_times(voter_build)
    assert not list(whole.glob(".*"))


def test_fresh_runs_everything(early):
    assert rebuild(early) == []
    assert rebuild(early, "--fresh") == EARLY


def test_a_setting_reruns_the_stages_that_read_it_alone(early):
    assert rebuild(early, "--process", "petg_fdm") == ["sizing"]
    # other walks have other peaks, which sizing may or may not have to follow
    assert rebuild(early, "--process", "petg_fdm", "--seed", "1")[0] == "proof"
    assert rebuild(early, "--process", "petg_fdm", "--seed", "1", "--jobs", "1") == []


def test_a_comment_reruns_what_reads_the_program_and_stops_where_the_bytes_are_the_same(early, tmp_path):
    source = tmp_path / VOTER.name
    source.write_text("// a remark\n" + VOTER.read_text())
    again = rebuild(early, source=source)
    assert again == ["device", "netlist", "proof"]


def test_another_version_of_the_code_reruns_everything(early, monkeypatch):
    monkeypatch.setattr("mdlcad.flow.inputs._code", lambda: "another")
    assert rebuild(early) == EARLY


@pytest.mark.parametrize("damage", ["missing", "edited", "shape"])
def test_an_artefact_that_is_not_as_written_is_made_again(sized, early, damage):
    path = early / "network.json"
    if damage == "missing":
        path.unlink()
    else:
        path.write_text("[]\n" if damage == "shape" else path.read_text().replace("0.3", "0.4", 1) + "\n")
    if damage == "shape":  # even if the report vouches for it
        found = report(early)
        found["files"]["network.json"] = checksum(path.read_bytes())
        (early / "report.json").write_text(json.dumps(found))
    assert rebuild(early) == ["network"]
    assert path.read_bytes() == (sized / "network.json").read_bytes()


def test_a_report_that_names_files_outside_its_folder_is_not_followed(early, tmp_path):
    (tmp_path / "secret").write_text("secret")
    found = report(early)
    name = "../secret"
    found["files"][name] = checksum(b"secret")
    found["stages"][2]["files"].append(name)
    (early / "report.json").write_text(json.dumps(found))
    assert "network" in rebuild(early)


def test_a_build_that_does_not_hold_goes_beside_the_one_that_does(early, monkeypatch, capsys):
    def jammed(*arguments):
        raise SignoffError("channel 1: no legal tracks for 7 nets")

    monkeypatch.setattr(placing, "place_and_route", jammed)
    before = (early / "report.json").read_bytes()
    assert main(["build", str(VOTER), "--unit-plates", "1", "-o", str(early)]) == FAILS
    assert (early / "report.json").read_bytes() == before
    failed = early.with_name("voter.failed")
    assert report(failed)["stopped"]["stage"] == "placement"
    said = capsys.readouterr().out
    assert "keeps the build that it has, which holds" in said and f"written to {failed}" in said
    # one that does not hold may be replaced by another
    assert main(["build", str(VOTER), "--unit-plates", "1", "-o", str(failed)]) == FAILS
    assert sorted(path.name for path in early.parent.iterdir()) == ["voter", "voter.failed"]


def test_a_program_with_an_error_leaves_the_build_as_it_is(early, tmp_path):
    broken = tmp_path / "voter.mdl"
    broken.write_text(VOTER.read_text().replace("boundary {", "boundary (", 1))
    before = (early / "report.json").read_bytes()
    assert main(["build", str(broken), "-o", str(early)]) == UNUSABLE
    assert (early / "report.json").read_bytes() == before
    assert not early.with_name("voter.failed").exists()


def test_a_program_that_is_not_there_is_named_and_leaves_the_build_as_it_is(early, tmp_path, capsys):
    before = (early / "report.json").read_bytes()
    assert main(["build", str(tmp_path / "absent.mdl"), "-o", str(early)]) == UNUSABLE
    assert "absent.mdl" in capsys.readouterr().err
    assert (early / "report.json").read_bytes() == before


@pytest.mark.parametrize("step", steps.STEPS, ids=lambda step: step.name)
def test_a_step_reads_no_setting_that_it_does_not_declare(step):
    """The number of workers and the folder change no result; all else that a step reads is in its inputs."""
    tree = ast.parse(inspect.getsource(step.run).strip().rstrip(",")) if step.name != "layout" else ast.parse("")
    job = [
        node for node in ast.walk(tree) if isinstance(node, ast.Attribute) and getattr(node.value, "id", "") == "job"
    ]
    whole = [node for node in ast.walk(tree) if isinstance(node, ast.Name) and node.id == "job"]
    assert {node.attr for node in job} - {"folder", "workers"} == set(step.reads)
    assert len(whole) == len(job), "a step hands its whole job on"
    assert set(step.reads) <= set(_SETTINGS)


def test_a_step_sees_no_artefact_that_it_does_not_declare():
    state = State(files=("a",), carriers=("c",))
    assert narrowed(state, ("files",)) == State(files=("a",))


def test_bodies_come_back_from_their_artefact_as_they_were(voter_build):
    from mdlcad.artefact import load
    from mdlcad.parts.store import Parts, bodies_of

    parts = load(voter_build, "parts.json", Parts)
    assert to_json(records_of(bodies_of(parts.bodies))) == to_json(parts.bodies)
