"""A build folder with a missing, truncated, edited or foreign file: a message that names it, and exit code 2."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mdlcad.artefact import checksum
from mdlcad.cli import UNUSABLE, main
from mdlcad.errors import UsageError
from mdlcad.view.built import Trust, read_build

FILES = ("device.json", "network.json", "sizing.json", "process.json", "placement.json", "parts.json")


def complaint(folder: Path, trust: Trust = Trust.BUILT) -> str:
    with pytest.raises(UsageError) as caught:
        read_build(folder, trust)
    return str(caught.value)


def vouch(folder: Path, name: str) -> None:
    """Make the report vouch for a changed file, so that what comes after the hashes is reached."""
    report = json.loads((folder / "report.json").read_text())
    report["files"][name] = checksum((folder / name).read_bytes())
    (folder / "report.json").write_text(json.dumps(report))


def edit(folder: Path, name: str, change: Callable[[Any], None]) -> None:
    found = json.loads((folder / name).read_text())
    change(found)
    (folder / name).write_text(json.dumps(found))


def test_the_whole_build_is_read(voter: Path) -> None:
    assert len(read_build(voter).bodies) > 50


def test_what_is_no_folder_is_told(tmp_path: Path) -> None:
    assert complaint(tmp_path / "nowhere").endswith("nowhere: no such build folder")
    assert "report.json: is missing" in complaint(tmp_path)


@pytest.mark.parametrize("name", ("report.json", *FILES))
def test_a_missing_file_is_named(copy: Path, name: str) -> None:
    (copy / name).unlink()
    assert f"{name}: is missing from the build; build it again" in complaint(copy)


@pytest.mark.parametrize("name", ("report.json", *FILES))
@pytest.mark.parametrize("share", [0.0, 0.5, 0.99])
def test_a_truncated_file_is_named(copy: Path, name: str, share: float) -> None:
    data = (copy / name).read_bytes()
    (copy / name).write_bytes(data[: int(share * len(data))])
    if name == "report.json":
        assert "report.json: is not whole JSON" in complaint(copy)
        return
    assert f"{name}: is not the file that was built (its SHA-256 differs" in complaint(copy)
    vouch(copy, name)
    assert f"{name}: is not whole JSON" in complaint(copy)


@pytest.mark.parametrize("name", FILES)
def test_a_file_edited_by_hand_is_named_and_can_be_looked_at_on_purpose(copy: Path, name: str) -> None:
    (copy / name).write_bytes((copy / name).read_bytes() + b" ")
    assert f"{name}: is not the file that was built" in complaint(copy)
    assert "--edited" in complaint(copy)
    read_build(copy, Trust.EDITED)


@pytest.mark.parametrize("data", [b"\xff\xfe{}", b"[" * 50_000, b"null", b"{}", b'{"masses": 3}', b"PK\x03\x04"])
@pytest.mark.parametrize("name", ("report.json", "network.json", "parts.json"))
def test_what_is_no_such_artefact_is_named(copy: Path, name: str, data: bytes) -> None:
    (copy / name).write_bytes(data)
    assert f"{name}: " in complaint(copy, Trust.EDITED)


def test_a_file_of_another_version_is_told_as_one(copy: Path) -> None:
    edit(copy, "report.json", lambda report: report.update(version="0.0.7"))
    edit(copy, "sizing.json", lambda sizing: sizing.pop("series"))
    vouch(copy, "sizing.json")
    said = complaint(copy)
    assert "sizing.json: does not have the shape of this artefact" in said
    assert "version 0.0.7 of mdlcad made it" in said


def test_a_build_that_lists_no_parts_is_told_why(copy: Path) -> None:
    edit(copy, "report.json", lambda report: report["files"].pop("parts.json"))
    assert "report.json: lists no parts.json: the build was stopped early (--to), or another version" in complaint(copy)


def ring(parts: Any, text: str) -> None:
    parts["bodies"][3]["section"] = [text]


CONTRADICTIONS: dict[str, tuple[str, Callable[[Any], Any], str]] = {
    "a mass gone": ("network.json", lambda f: f["masses"].pop(), "which is not in network.json"),
    "a mass new": ("network.json", lambda f: f["masses"][0].update(name="x"), "for 'x' of network.json"),
    "a coupling astray": ("network.json", lambda f: f["couplings"][0].update(source="x"), "'x->"),
    "a phase too many": ("network.json", lambda f: f["masses"][0].update(phase=7), "has phase 7 of 3"),
    "a unit twice": ("sizing.json", lambda f: f["units"].append(f["units"][0]), "names a unit twice"),
    "a place gone": ("placement.json", lambda f: f["masses"].pop(), "has no place for"),
    "a body twice": ("parts.json", lambda f: f["bodies"].append(f["bodies"][0]), "two bodies are called"),
    "no bodies": ("parts.json", lambda f: f["bodies"].clear(), "holds no bodies"),
    "a body adrift": ("parts.json", lambda f: f["bodies"][0].update(moves_with=["mass:x"]), "moves with mass:x"),
    "a body tied to nothing": ("parts.json", lambda f: f["bodies"][0].update(moves_with=[]), "moves with nothing"),
    "no colour": ("parts.json", lambda f: f["bodies"][0].update(colour="red"), "is no colour"),
    "flat": ("parts.json", lambda f: f["bodies"][0].update(thickness=0.0), "a length that no part has"),
    "a mile long": ("parts.json", lambda f: f["bodies"][0].update(z=1e9), "a length that no part has"),
    "two points": ("parts.json", lambda f: ring(f, "0,0 1,1"), "a ring is not a list of points"),
    "words": ("parts.json", lambda f: ring(f, "here,there"), "a ring is not a list of points"),
    "a bow tie": ("parts.json", lambda f: ring(f, "0,0 1,1 1,0 0,1"), "cross or touch themselves"),
    "not a number": ("parts.json", lambda f: ring(f, "0,0 nan,1 1,0"), "parts.json: body "),
    "no rings": ("parts.json", lambda f: f["bodies"][3].update(section=[]), "a ring is not a list of points"),
}


@pytest.mark.parametrize("case", CONTRADICTIONS)
def test_files_that_contradict_each_other_are_named(copy: Path, case: str) -> None:
    name, change, words = CONTRADICTIONS[case]
    edit(copy, name, change)
    vouch(copy, name)
    said = complaint(copy)
    assert words in said
    assert "build it again" in said


def test_the_command_says_so_in_one_line_and_writes_nothing(
    copy: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (copy / "parts.json").write_text("{")
    for flag, name in (("--screenshot", "a.png"), ("--html", "a.html"), ("--animate", "a.gif")):
        assert main(["view", str(copy), flag, str(tmp_path / name)]) == UNUSABLE
        said = capsys.readouterr().err
        assert said.startswith("mdlcad: error: ") and said.count("\n") == 1 and "parts.json" in said
        assert not (tmp_path / name).exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--screenshot", "a.jpg"], "a.jpg: give a name that ends in .png"),
        (["--html", "no/such/a.html"], "its folder is not there"),
        (["--screenshot", "a.png", "--plates", "unit,attic"], "--plates attic: voter has no such plate; it has base,"),
        (["--screenshot", "a.png", "--find", "unit.verdct"], "near to it: unit.verdict[0]"),
        (["--html", "a.html", "--scenario", "nowhere"], "no entry 'nowhere' in examples/scenarios/"),
        (["--animate", "a.gif", "--at", "900"], "--at 900: the run of each-sensor is"),
        (["--animate", "a.gif", "--cycles", "0"], "nothing is left to animate"),
    ],
)
def test_what_cannot_be_shown_is_told(
    voter: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    words: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["view", str(voter), *arguments]) == UNUSABLE
    assert words in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "arguments", [["--explode", "2"], ["--size", "big"], ["--colour", "taste"], ["--camera", "moon"], ["--at", "-1"]]
)
def test_a_wrong_option_is_a_usage_error(voter: Path, arguments: list[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main(["view", str(voter), *arguments])
    assert caught.value.code == UNUSABLE
