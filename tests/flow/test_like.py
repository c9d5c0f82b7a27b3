"""A build like an earlier one: the same where nothing changed, in place where little did, else refused."""

import json
import shutil
from pathlib import Path

import pytest

from mdlcad.cli import HOLDS, UNUSABLE, main

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = (ROOT / "examples" / "voter.mdl").read_text(encoding="utf-8")
SUM = "(left_vote & right_vote) | (left_vote & base_vote) | (right_vote & base_vote)"


def built(place: Path, text: str, *options: str) -> Path:
    source = place.with_suffix(".mdl")
    source.write_text(text, encoding="utf-8")
    assert main(["build", str(source), "-o", str(place), "--to", "layout", *options]) == HOLDS
    return place


def artefact(folder: Path, name: str) -> dict:
    return json.loads((folder / f"{name}.json").read_text())


@pytest.fixture(scope="module")
def first(tmp_path_factory) -> Path:
    return built(tmp_path_factory.mktemp("like") / "voter", PROGRAM)


def test_a_renamed_comment_changes_nothing(first, tmp_path):
    again = built(tmp_path / "again", PROGRAM.replace("feeler", "antenna"), "--like", str(first), "--seed", "7")
    for name in ("netlist", "network", "placement", "layout"):
        assert (again / f"{name}.json").read_bytes() == (first / f"{name}.json").read_bytes(), name
    like = artefact(again, "report")["like"]
    masses = artefact(first, "report")["masses"]
    counts = ("kept", "changed", "moved", "new", "gone")
    assert tuple(like[name] for name in counts) == (masses, 0, 0, 0, 0)


def test_the_report_says_like_what_by_hash(first, tmp_path):
    moved = tmp_path / "elsewhere"
    shutil.copytree(first, moved)
    one = built(tmp_path / "one", PROGRAM, "--like", str(first))
    two = built(tmp_path / "two", PROGRAM, "--like", str(moved))
    likes = [artefact(folder, "report")["like"] for folder in (one, two)]
    assert likes[0] == likes[1] and len(likes[0]["build"]) == 64
    assert str(tmp_path) not in (one / "report.json").read_text()


def test_a_changed_condition_leaves_the_others_in_place(first, tmp_path):
    edited = PROGRAM.replace(SUM, "(left_vote & right_vote) | base_vote")
    roomy = built(tmp_path / "roomy", PROGRAM, "--pitch", "4")
    # a device that is as small as can be may grow by a step of 3 %, one with some room keeps its size
    for before, most in ((first, 1.031), (roomy, 1.0)):
        after = built(tmp_path / f"after_{before.name}", edited, "--like", str(before))
        like = artefact(after, "report")["like"]
        assert like["kept"] >= 3  # the sensors at least
        assert like["moved"] <= 0.1 * (like["kept"] - like["changed"])
        old, new = artefact(before, "placement"), artefact(after, "placement")
        assert old["mm_per_grid"] <= new["mm_per_grid"] <= most * old["mm_per_grid"]
        assert main(["diff", str(before), str(after)]) == 1


@pytest.mark.parametrize("name", ["report.json", "cells.json", "process.json", "network.json", "layout.json"])
@pytest.mark.parametrize("damage", ["missing", "garbled"])
def test_a_damaged_folder_is_refused_by_the_file(first, tmp_path, capsys, name, damage):
    copy = tmp_path / "copy"
    shutil.copytree(first, copy)
    if damage == "missing":
        (copy / name).unlink()
    else:
        (copy / name).write_bytes((copy / name).read_bytes()[:200])
    refused(copy, tmp_path, capsys, name)


def test_another_process_or_library_is_refused(first, tmp_path, capsys):
    refused(first, tmp_path, capsys, "process", "--process", "petg_fdm")
    refused(first, tmp_path, capsys, "cell library", "--cells", "two_phase", "--to", "placement")
    refused(tmp_path / "nowhere", tmp_path, capsys, "no such build folder")


def test_a_build_without_a_layout_is_refused(tmp_path, capsys):
    source = tmp_path / "v.mdl"
    source.write_text(PROGRAM, encoding="utf-8")
    assert main(["build", str(source), "-o", str(tmp_path / "v"), "--to", "network"]) == HOLDS
    refused(tmp_path / "v", tmp_path, capsys, "sizing.json")


def refused(like: Path, place: Path, capsys, words: str, *options: str) -> None:
    source = place / "voter.mdl"
    source.write_text(PROGRAM, encoding="utf-8")
    capsys.readouterr()
    assert main(["build", str(source), "-o", str(place / "out"), "--like", str(like), *options]) == UNUSABLE
    said = capsys.readouterr().err
    assert words in said and "Traceback" not in said
    assert not (place / "out").exists()


def test_the_papers_library_keeps_places_on_the_grid(tmp_path):
    options = ("--cells", "two_phase", "--to", "placement")
    first = built(tmp_path / "first", PROGRAM, *options)
    edited = PROGRAM.replace(SUM, "(left_vote & right_vote) | (left_vote & base_vote)")
    after = built(tmp_path / "after", edited, *options, "--like", str(first))
    like = artefact(after, "report")["like"]
    assert like["moved"] == 0 and like["kept"] > 10


@pytest.mark.long
def test_one_changed_condition_in_the_maze_moves_a_tenth_at_most(tmp_path):
    program = (ROOT / "examples" / "mazerobot.mdl").read_text(encoding="utf-8")
    edits = {
        "last": ("wall_back,  LEFT,  wall_left,  UP);", "wall_back,  LEFT,  wall_left,  LEFT);"),
        "free": ("UP,    wall_front, RIGHT, wall_right, DOWN);", "UP,    wall_front, RIGHT, 1'b0, DOWN);"),
    }
    first = built(tmp_path / "maze", program)
    for name, (old, new) in edits.items():
        assert program.count(old) == 1
        after = built(tmp_path / name, program.replace(old, new), "--like", str(first))
        like = artefact(after, "report")["like"]
        assert like["changed"] + like["new"] <= 4, name
        assert like["moved"] <= 0.1 * (like["kept"] - like["changed"]), name
