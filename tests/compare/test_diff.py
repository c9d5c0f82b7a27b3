"""Two builds compared: what was changed is found, by name and place; what was not is not."""

import json
import re
import subprocess
import sys
import time
from pathlib import Path

import ezdxf
import msgspec
import numpy as np
import pytest

from mdlcad.artefact import from_json, to_json
from mdlcad.cli import FAILS, HOLDS, UNUSABLE, main
from mdlcad.compare.change import Comparison, LevelState, Sort, Verdict
from mdlcad.compare.compare import compare
from tests.compare.edits import copy_of, edited, move_unit, remove_link, run

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def copy(voter_build, tmp_path) -> Path:
    return copy_of(voter_build, tmp_path / "copy")


def changes(found: Comparison, level: str) -> list[tuple[str, str, str]]:
    return [(c.sort.value, c.what, c.name) for item in found.levels if item.name == level for c in item.changes]


def states(found: Comparison) -> dict[str, LevelState]:
    return {level.name: level.state for level in found.levels}


def test_a_build_and_its_copy_are_the_same_at_every_level(voter_build, copy, capsys):
    code, said, _ = run(capsys, "diff", voter_build, copy)
    assert code == HOLDS
    found = compare(voter_build, copy)
    assert found.verdict is Verdict.SAME
    assert set(states(found).values()) == {LevelState.SAME}
    assert [level.name for level in found.levels] == [
        "settings", "program", "netlist", "network", "placement", "routing", "plates", "parts", "behaviour", "files",
    ]  # fmt: skip
    assert "the same within 1 um" in said


def test_a_moved_unit_and_a_removed_link_are_found_by_name(voter_build, copy, capsys):
    mass, link = move_unit(copy, 0.05), remove_link(copy)
    found = compare(voter_build, copy)
    assert changes(found, "network") == [("removed", "coupling", link)]
    assert changes(found, "placement") == [("moved", "unit", mass)]
    assert ("removed", "coupler", link) in changes(found, "routing")
    assert ("removed", "body", f"coupler.{link}") in changes(found, "parts")
    assert ("moved", "body", f"unit.{mass}") in changes(found, "parts")
    move = next(c for level in found.levels if level.name == "placement" for c in level.changes)
    assert move.size == pytest.approx(0.05, abs=1e-9)
    unit = next(c for level in found.levels if level.name == "plates" for c in level.changes if c.name == "unit")
    assert any(f"unit.{mass}" in spot.bodies for spot in unit.spots)
    code, said, _ = run(capsys, "diff", voter_build, copy)
    assert code == FAILS
    assert f"unit {mass}: by 0.050 mm" in said
    assert f"coupling {link}" in said
    assert found.b.edited == ("layout.json", "network.json", "parts.json", "placement.json")


@pytest.mark.long
def test_both_are_found_in_a_copy_of_the_maze_in_under_ten_seconds(tmp_path):
    maze = tmp_path / "maze"
    assert main(["build", str(ROOT / "examples" / "mazerobot.mdl"), "-o", str(maze)]) == HOLDS
    copy = copy_of(maze, tmp_path / "copy")
    mass, link = move_unit(copy, 0.05), remove_link(copy)
    began = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-m", "mdlcad.cli", "diff", str(maze), str(copy)], capture_output=True, text=True, cwd=ROOT
    )
    seconds = time.perf_counter() - began
    assert done.returncode == FAILS
    assert f"> unit {mass}: by 0.050 mm" in done.stdout
    assert f"- coupling {link}" in done.stdout
    assert seconds < 10.0


def test_a_move_below_the_tolerance_is_none(voter_build, copy):
    move_unit(copy, 0.05)
    assert compare(voter_build, copy, 60.0).verdict is Verdict.SAME
    assert compare(voter_build, copy, 40.0).verdict is Verdict.DIFFERENT


def plate_change(a: Path, b: Path, plate: str):
    found = compare(a, b)
    assert [name for _, _, name in changes(found, "plates")] == [plate]
    assert states(found)["parts"] is LevelState.SAME
    return next(c for level in found.levels if level.name == "plates" for c in level.changes)


def test_a_hole_widened_in_a_dxf_alone_is_found_and_located(voter_build, copy):
    path = copy / "plates" / "H0.dxf"
    drawing = ezdxf.readfile(path)
    holes = [item for item in drawing.modelspace() if item.dxf.layer == "INNER"]
    # a square one: the corners of a round hole are the ends of its arcs
    hole = next(item for item in holes if not any(bulge for *_, bulge in item.get_points()))
    points = np.array([(x, y) for x, y, *_ in hole.get_points()])
    centre = points.mean(axis=0)
    hole.set_points([tuple(centre + 1.1 * (point - centre)) for point in points])
    drawing.saveas(path)
    before = np.prod(np.ptp(points, axis=0))
    change = plate_change(voter_build, copy, "H0")
    assert "seen in dxf" in change.words
    assert change.size == pytest.approx(0.21 * before, rel=1e-2)
    x0, y0, x1, y1 = change.spots[0].box
    assert (x0 + x1) / 2 == pytest.approx(centre[0], abs=0.1)
    assert (y0 + y1) / 2 == pytest.approx(centre[1], abs=0.1)
    assert change.spots[0].bodies


def test_a_part_shifted_in_an_stl_alone_is_found_and_located(voter_build, copy):
    path = copy / "plates" / "H1.stl"
    data = path.read_bytes()
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    mesh = np.frombuffer(data, record, offset=84).copy()
    with edited(copy, "parts.json") as parts:
        rung = next(item for item in parts["bodies"] if item["plate"] == "H1" and item["kind"] == "rung")
    corners = np.array([[float(v) for v in pair.split(",")] for pair in rung["section"][0].split(" ")])
    low, high = corners.min(axis=0) - 1e-3, corners.max(axis=0) + 1e-3
    inside = ((mesh["corners"][..., :2] >= low) & (mesh["corners"][..., :2] <= high)).all(axis=(1, 2))
    assert inside.any()
    mesh["corners"][..., 1][inside[:, None] & np.ones((1, 3), bool)] += 0.0  # the shape stays closed
    mesh["corners"][..., 0][mesh["corners"][..., 0] > high[0] - 2e-3] += 0.2
    path.write_bytes(data[:84] + mesh.tobytes())
    (copy / "parts.json").write_bytes((voter_build / "parts.json").read_bytes())
    change = plate_change(voter_build, copy, "H1")
    assert "seen in stl" in change.words
    assert change.size > 0.0


def test_an_svg_that_only_looks_different_is_the_same_in_meaning(voter_build, copy):
    path = copy / "plates" / "cover.svg"
    path.write_text(path.read_text().replace("<title>plate", "<title> plate"))
    found = compare(voter_build, copy)
    assert found.verdict is Verdict.SAME
    assert any("plates/cover.svg" in note for note in found.levels[-1].notes)


def test_another_seed_changes_placement_and_not_the_network(voter_build, tmp_path):
    other = tmp_path / "other"
    assert (
        main(["build", str(voter_build), "--from", "placement", "--to", "parts", "--seed", "2", "-o", str(other)])
        == HOLDS
    )
    found = compare(voter_build, other)
    assert found.verdict is Verdict.DIFFERENT
    assert [states(found)[name] for name in ("program", "netlist", "network")] == [LevelState.SAME] * 3
    assert states(found)["placement"] is LevelState.DIFFERENT
    behaviour = next(level for level in found.levels if level.name == "behaviour")
    assert any("other has no extraction.json" in note for note in behaviour.notes)


def test_a_partial_build_says_what_could_not_be_compared(voter_build, tmp_path, capsys):
    part = tmp_path / "part"
    assert main(["build", str(voter_build), "--from", "netlist", "--to", "network", "-o", str(part)]) == HOLDS
    code, said, wrong = run(capsys, "diff", voter_build, part)
    assert code == FAILS
    assert wrong == ""
    assert re.search(r"placement +not compared: part has no placement.json", said)
    assert re.search(r"network +same", said)
    for one, other in ((voter_build, part), (part, voter_build), (part, part)):
        assert compare(one, other).verdict is not Verdict.TROUBLE


def test_another_process_is_told_figure_by_figure(voter_build, tmp_path):
    other = tmp_path / "other"
    command = ["build", str(voter_build), "--from", "sizing", "--to", "sizing", "--process", "pa12_mjf"]
    assert main([*command, "-o", str(other)]) == HOLDS
    found = compare(voter_build, other)
    assert found.verdict is Verdict.DIFFERENT
    assert ("changed", "setting", "process") in changes(found, "settings")
    assert any(what == "process" and name.endswith("modulus") for _, what, name in changes(found, "settings"))
    assert any(what == "size of unit" for _, what, _ in changes(found, "parts"))


def test_what_a_unit_was_solved_for_is_part_of_the_meaning(voter_build, copy):
    with edited(copy, "compensation.json") as compensation:
        compensation["units"][0]["asked"] += 0.25
        compensation["couplers"][0]["left"] += 0.25
        names = {compensation["units"][0]["mass"], compensation["couplers"][0]["size"]["coupling"]}
    assert {name for _, _, name in changes(compare(voter_build, copy), "parts")} == names


def grid_placement(copy: Path) -> None:
    """As a library without parts leaves it."""
    with edited(copy, "placement.json") as placement:
        masses = [{"mass": m["mass"], "x": m["column"], "y": m["row"], "port": None} for m in placement["masses"]]
        placement.clear()
        placement.update(
            placer="anneal", seed=0, boundary=[[0, 0], [9, 0], [9, 9]], footprint=1, masses=masses, ports=[],
            crossings=1, length=2.5,
        )  # fmt: skip


def test_masses_on_the_program_s_grid_are_compared_with_their_like_alone(voter_build, copy, tmp_path):
    grid_placement(copy)
    other = copy_of(copy, tmp_path / "other")
    with edited(other, "placement.json") as placement:
        placement["masses"][0]["x"] += 1
        mass = placement["masses"][0]["mass"]
    assert changes(compare(copy, other), "placement") == [("changed", "mass", mass)]
    level = next(level for level in compare(voter_build, copy).levels if level.name == "placement")
    assert level.state is LevelState.NOT_COMPARED
    assert "program's grid" in level.reason


def test_a_build_of_another_version_is_compared_as_far_as_it_can_be_read(voter_build, copy):
    from mdlcad.artefact import checksum

    with edited(copy, "placement.json") as placement:
        del placement["mm_per_grid"]
    with edited(copy, "report.json") as report:
        report["version"] = "0.0.7"
        report["files"]["placement.json"] = checksum((copy / "placement.json").read_bytes())
        report["no_such_key_today"] = [1, 2]
        del report["mechanics"]
    found = compare(voter_build, copy)
    assert found.verdict is Verdict.DIFFERENT
    assert found.b.version == "0.0.7"
    level = next(level for level in found.levels if level.name == "placement")
    assert level.state is LevelState.NOT_COMPARED
    assert "another version (0.0.7)" in level.reason


def test_a_file_that_could_not_be_compared_is_never_the_same_in_meaning(voter_build, copy):
    from mdlcad.artefact import checksum

    with edited(copy, "parts.json") as parts:
        parts["bodies"][0]["kind"] = "of another version"
    with edited(copy, "report.json") as report:
        report["files"]["parts.json"] = checksum((copy / "parts.json").read_bytes())
    found = compare(voter_build, copy)
    assert found.verdict is Verdict.DIFFERENT
    assert ("changed", "file", "parts.json") in changes(found, "files")


@pytest.mark.parametrize(
    ("name", "damage", "words"),
    [
        ("network.json", lambda path: path.write_bytes(path.read_bytes()[:300]), "not whole JSON"),
        ("plates/unit.dxf", lambda path: path.write_bytes(b"not a drawing"), "unit.dxf"),
        ("plates/H0.stl", lambda path: path.unlink(), "missing"),
        ("report.json", lambda path: path.write_text("[]"), "shape"),
    ],
)
def test_trouble_names_the_file(voter_build, copy, capsys, name, damage, words):
    damage(copy / name)
    code, _, wrong = run(capsys, "diff", voter_build, copy)
    assert code == UNUSABLE
    assert name.rpartition("/")[2] in wrong
    assert words in wrong


def test_the_json_is_whole_and_the_same_every_time(voter_build, copy, tmp_path, capsys):
    move_unit(copy, 0.2)
    for name in ("one.json", "two.json"):
        assert run(capsys, "diff", voter_build, copy, "--json", tmp_path / name, "-q")[0] == FAILS
    data = (tmp_path / "one.json").read_bytes()
    assert data == (tmp_path / "two.json").read_bytes()
    assert to_json(from_json(data, Comparison)) == data
    assert str(tmp_path) not in data.decode()
    assert run(capsys, "schema", "diff")[0] == HOLDS


def test_verbosity(voter_build, copy, capsys):
    with edited(copy, "network.json") as network:
        for mass in network["masses"]:
            mass["bias"] += 0.25
            mass["k0"] += 0.5
        for item in network["couplings"]:
            item["strength"] *= 1.5
    said = [run(capsys, "diff", voter_build, copy, *flags)[1].splitlines() for flags in (["-q"], [], ["-v"], ["-vv"])]
    assert len(said[0]) == 1
    assert len(said[0]) < len(said[1]) < len(said[2]) <= len(said[3])


def test_the_page_needs_nothing_else_and_lists_what_changed(voter_build, copy, tmp_path, capsys):
    mass, link = move_unit(copy, 0.05), remove_link(copy)
    path = tmp_path / "page.html"
    assert run(capsys, "diff", voter_build, copy, "-q", "--html", path)[0] == FAILS
    text = path.read_text()
    assert not re.search(r'(?:src|href)="(?!#)', text)
    assert "http" not in text.replace("http://www.w3.org/2000/svg", "")
    assert link.replace(">", "&gt;") in text
    assert f"<b>{mass}</b>" in text
    scene = json.loads(re.search(r'id="scene">(.*?)</script>', text, re.S)[1])
    unit = next(plate for plate in scene["plates"] if plate["name"] == "unit")
    assert unit["only_a"] is not None
    assert unit["only_b"] is not None
    assert {shape["name"] for shape in unit["a"]} >= {f"unit.{mass}"}


def test_names_cannot_break_out_of_the_page(voter_build, copy, tmp_path, capsys):
    evil = "</script><b>x</b>"
    with edited(copy, "parts.json") as parts:
        parts["bodies"][0]["name"] = evil
    path = tmp_path / "page.html"
    assert run(capsys, "diff", voter_build, copy, "-q", "--html", path)[0] == FAILS
    assert evil not in path.read_text()


def test_a_place_that_cannot_be_written_is_said(voter_build, copy, tmp_path, capsys):
    (tmp_path / "file").write_text("")
    code, _, wrong = run(capsys, "diff", voter_build, copy, "--json", tmp_path / "file" / "x.json")
    assert code == UNUSABLE
    assert "cannot be written" in wrong


def test_sorts_have_their_own_symbols():
    from mdlcad.compare.words import SYMBOLS

    assert set(SYMBOLS) == set(Sort)
    assert len(set(SYMBOLS.values())) == len(SYMBOLS)
    assert msgspec.json.schema(Comparison)["$ref"]
