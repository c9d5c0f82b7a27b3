"""Exit codes and messages: 2 and a place for bad input, never a traceback, nothing half-written."""

import subprocess
import sys
from pathlib import Path

import pytest

from mdlcad.cli import HOLDS, UNUSABLE, main

ROOT = Path(__file__).resolve().parents[2]
MAZE = ROOT / "examples" / "mazerobot.mdl"


@pytest.mark.parametrize("example", sorted((ROOT / "examples").glob("*.mdl")), ids=lambda path: path.stem)
def test_examples_have_no_errors(example, capsys):
    assert main(["check", str(example)]) == HOLDS
    assert "no errors" in capsys.readouterr().out


def test_a_syntax_error_has_a_place_an_excerpt_and_exit_2(tmp_path):
    path = tmp_path / "bad.mdl"
    path.write_text(MAZE.read_text().replace("boundary {", "boundary (", 1))
    run = subprocess.run(
        [sys.executable, "-m", "mdlcad.cli", "build", str(path), "-o", str(tmp_path / "out")],
        capture_output=True,
        text=True,
    )
    assert run.returncode == UNUSABLE
    place = run.stderr.splitlines()[0]
    line, column = (int(part) for part in place.split("bad.mdl:")[1].split(":")[:2])
    assert "boundary (" in path.read_text().splitlines()[line - 1]
    assert column >= 1
    assert "error:" in place
    assert "Traceback" not in run.stderr
    assert [item.name for item in tmp_path.iterdir()] == ["bad.mdl"]


def test_a_verilog_error_is_at_its_line_of_the_program(tmp_path, capsys):
    text = MAZE.read_text()
    path = tmp_path / "bad.mdl"
    path.write_text(text.replace("endmodule", "assign drive = nothing_of_that_name; endmodule", 1))
    wanted = next(n for n, line in enumerate(text.splitlines(), 1) if "endmodule" in line)
    assert main(["check", str(path)]) == UNUSABLE
    assert f"bad.mdl:{wanted}:" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["check", "nowhere.mdl"], "nowhere.mdl"),
        (["build", str(MAZE), "--to", "nonsense"], "no such stage"),
        (["build", str(MAZE), "--from", "layout", "--to", "device"], "nothing to do"),
        (["build", str(MAZE), "--from", "layout"], "is made together with placement"),
        (["build", str(MAZE), "--from", "guide"], "a build can start again from any stage up to drive"),
        (["build", str(MAZE), "--process", "nonsense"], "pom_cut"),
        (["build", str(MAZE), "--cells", "nonsense"], "parametron"),
        (["verify", "nowhere"], "no such build folder"),
        (["schema", "nonsense"], "no artefact"),
    ],
)
def test_what_cannot_be_used_is_said_with_what_there_is(arguments, words, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == UNUSABLE
    assert words in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("given", ["x", "-1", "1.5", "", "٣x", "1e3"])
@pytest.mark.parametrize(
    ("option", "words"),
    [
        ("seed", "a seed is a whole number from 0 to 2147483647"),
        ("seeds", "a whole number from 1 to 1000000000"),
        ("jobs", "a number of processors, 1 or more"),
    ],
)
def test_a_number_that_is_none_says_what_one_is(option, words, given, capsys):
    with pytest.raises(SystemExit) as left:
        main(["build", str(MAZE), f"--{option}={given}"])
    assert left.value.code == UNUSABLE
    assert f"argument --{option}: {words}" in capsys.readouterr().err


def test_build_stops_after_the_network_when_told(tmp_path, capsys):
    folder = tmp_path / "maze"
    assert main(["build", str(MAZE), "-o", str(folder), "--to", "network"]) == HOLDS
    said = capsys.readouterr().out
    assert "network" in said
    assert "proof" not in said
    names = {path.name for path in folder.iterdir()}
    assert {"device.json", "netlist.json", "network.json", "report.json"} <= names
    assert "placement.json" not in names


@pytest.mark.parametrize(
    "command",
    [
        ["cells"],
        ["processes"],
        ["schema"],
        ["cells", "parametron"],
        ["cells", "two_phase", "--liberty"],
        ["processes", "pom_cut"],
    ],
)
def test_listings(command, capsys):
    assert main(command) == HOLDS
    assert capsys.readouterr().out.strip()


def test_a_library_without_parts_says_so_and_writes_nothing(tmp_path, capsys):
    voter = ROOT / "examples" / "voter.mdl"
    assert main(["build", str(voter), "--cells", "two_phase", "-o", str(tmp_path / "out")]) == UNUSABLE
    assert "no parts yet" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
