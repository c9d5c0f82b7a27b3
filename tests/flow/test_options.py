"""The synthesis options of the paper on the command line: what they change, what is written down, what is refused."""

import json
from pathlib import Path

import pytest

from mdlcad.cli import HOLDS, UNUSABLE, main

ROOT = Path(__file__).resolve().parents[2]
MAZE = str(ROOT / "examples" / "mazerobot.mdl")
PAPERS = ("--cells", "two_phase", "--to", "network")


def network(folder: Path) -> dict:
    return json.loads((folder / "network.json").read_text())


def mapped(folder: Path, *options: str) -> dict:
    assert main(["build", MAZE, *PAPERS, *options, "-o", str(folder)]) == HOLDS
    return network(folder)


def test_every_option_changes_what_it_should_and_is_written_down(tmp_path):
    plain = mapped(tmp_path / "plain")
    assert plain["cycles_per_tick"] == 60
    thirty = mapped(tmp_path / "a", "--clock-length", "30", "--parameters", "literal")
    assert (thirty["cycles_per_tick"], thirty["dynamics"]["period"]) == (30, 1.0)
    # loops of 5 and 6 instead of 5 and 12
    assert len(plain["masses"]) - len(thirty["masses"]) == 2 * 6
    bare = mapped(tmp_path / "b", "--no-clock", "--no-branching", "--no-io-gates")
    names = {mass["name"] for mass in bare["masses"]}
    assert not [name for name in names if ".buf_" in name or name.endswith((".in", ".out", ".a0"))]
    recorded = json.loads((tmp_path / "b" / "cells.json").read_text())
    assert recorded["kind"] == "two_phase"
    assert recorded["options"] == {
        "clock_length": 60,
        "clock": False,
        "branching": False,
        "io_gates": False,
        "buffer": "BUF",
    }
    assert json.loads((tmp_path / "a" / "cells.json").read_text())["parameters"] == "literal"


def test_a_build_goes_on_with_the_options_that_it_was_begun_with(tmp_path):
    mapped(tmp_path / "begun", "--clock-length", "20", "--no-io-gates")
    again = ["build", str(tmp_path / "begun"), "--from", "network", "--to", "network", "-o", str(tmp_path / "again")]
    assert main(again) == HOLDS
    for name in ("network.json", "cells.json"):
        assert (tmp_path / "again" / name).read_bytes() == (tmp_path / "begun" / name).read_bytes()


def test_the_default_library_is_written_down_too(tmp_path):
    voter = str(ROOT / "examples" / "voter.mdl")
    assert main(["build", voter, "--to", "network", "-o", str(tmp_path / "v")]) == HOLDS
    assert json.loads((tmp_path / "v" / "cells.json").read_text())["kind"] == "parametron"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--to", "network", "--clock-length", "30"], "--clock-length: the cell library parametron has no such option"),
        (["--to", "network", "--no-io-gates"], "--no-io-gates: the cell library parametron has no such option"),
        ([*PAPERS, "--parameters", "gentle"], "no parameter set 'gentle'; there are literal, near, robust"),
        ([*PAPERS, "--clock-length", "1"], "make it 2 or more"),
        (
            [*PAPERS, "--clock-length", "7"],
            "a clock of 7 cycles is too short for this device: with --clock-length, make it at least",
        ),
        ([*PAPERS, "--buffer", "COPY"], "options.buffer is 'COPY', but the cells are NOR"),
        ([*PAPERS, "--buffer", "NOT"], "cell 'NOT' is not a buffer"),
        (["--cells", "two_phase"], "for which there are no parts yet"),
        (["--cells", "two_phase", "--to", "sizing"], "for which there are no parts yet"),
        (["--cells", "two_phase", "--to", "nonsense"], "no such stage"),
    ],
)
def test_what_does_not_fit_is_refused_and_nothing_is_written(options, words, tmp_path, capsys):
    assert main(["build", MAZE, *options, "-o", str(tmp_path / "out")]) == UNUSABLE
    assert words in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_library_of_ones_own_names_its_buffer_in_its_file_or_on_the_command_line(tmp_path, capsys):
    text = (ROOT / "cells" / "two_phase" / "library.toml").read_text(encoding="utf-8")
    mine = tmp_path / "library.toml"
    mine.write_text(text.replace('name = "BUF"', 'name = "COPY"'), encoding="utf-8")
    build = ["build", MAZE, "--cells", str(mine), "--to", "network", "-o", str(tmp_path / "out")]
    assert main(build) == UNUSABLE
    assert "name the buffer there or with --buffer" in capsys.readouterr().err
    assert main([*build, "--buffer", "COPY"]) == HOLDS
    assert any(".copy_" in mass["name"] for mass in network(tmp_path / "out")["masses"])


def test_options_and_libraries_that_come_too_late_are_refused(tmp_path, capsys):
    mapped(tmp_path / "begun", "--clock-length", "20")
    late = ["build", str(tmp_path / "begun"), "--from", "proof", "--to", "proof"]
    assert main([*late, "--cells", "parametron"]) == UNUSABLE
    assert "the network is taken from the folder" in capsys.readouterr().err
    assert main([*late, "--clock-length", "30"]) == UNUSABLE
    assert "--clock-length: say of which library" in capsys.readouterr().err
