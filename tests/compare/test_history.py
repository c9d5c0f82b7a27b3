"""Many builds in a table, with gaps where there are gaps."""

import csv
import json
from pathlib import Path

import pytest
from PIL import Image

from mdlcad.artefact import from_json
from mdlcad.cli import FAILS, HOLDS, UNUSABLE, main
from mdlcad.compare.history import History, history_of
from tests.compare.edits import copy_of, edited, run


@pytest.fixture(scope="module")
def partial(voter_build, tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("partial") / "partial"
    assert main(["build", str(voter_build), "--from", "netlist", "--to", "network", "-o", str(folder)]) == HOLDS
    return folder


def test_rows_come_as_given_and_partial_builds_show_gaps(voter_build, partial, capsys):
    code, said, _ = run(capsys, "history", partial, voter_build, partial)
    assert code == HOLDS
    lines = said.splitlines()
    assert [line.split()[0] for line in lines] == ["build", "partial", "voter", "partial"]
    assert "-" in lines[1].split()
    assert "-" not in lines[2].split()


def test_the_figures_are_the_report_s_and_the_proofs(voter_build):
    (row,) = history_of([voter_build]).rows
    report = json.loads((voter_build / "report.json").read_text())
    assert (row.masses, row.couplings, row.gates) == (report["masses"], report["couplings"], report["gates"])
    assert [row.width_mm, row.depth_mm, row.height_mm] == report["extent_mm"]
    assert row.plates == len(report["plates"])
    assert row.seconds == pytest.approx(sum(stage["seconds"] for stage in report["stages"]), abs=1e-3)
    assert row.margin == json.loads((voter_build / "proof.json").read_text())["margin"]
    assert row.parts == len(json.loads((voter_build / "parts.json").read_text())["bodies"])
    assert row.bytes == sum((voter_build / name).stat().st_size for name in report["files"])


def test_table_json_csv_and_plots_agree(voter_build, partial, tmp_path, capsys):
    paths = [tmp_path / name for name in ("h.json", "h.csv", "h.png", "h.svg")]
    arguments = ["history", voter_build, partial, "--json", paths[0], "--csv", paths[1], "--plot"]
    assert run(capsys, *arguments, paths[2])[0] == HOLDS
    assert run(capsys, *arguments, paths[3])[0] == HOLDS
    found = from_json(paths[0].read_bytes(), History)
    rows = list(csv.DictReader(paths[1].open()))
    assert [row["folder"] for row in rows] == [row.folder for row in found.rows] == ["voter", "partial"]
    assert rows[1]["margin"] == ""
    assert float(rows[0]["margin"]) == found.rows[0].margin
    with Image.open(paths[2]) as picture:
        assert min(picture.size) > 800
        assert len(picture.convert("L").getcolors()) > 20
    assert paths[3].read_text().count("voter") >= 1
    before = paths[3].read_bytes()
    assert run(capsys, *arguments, paths[3])[0] == HOLDS
    assert paths[3].read_bytes() == before


def test_an_edited_build_is_marked_and_a_lost_one_does_not_hide_the_others(voter_build, tmp_path, capsys):
    copy = copy_of(voter_build, tmp_path / "copy")
    with edited(copy, "layout.json") as layout:
        layout["seed"] += 1
    code, said, wrong = run(capsys, "history", copy, voter_build)
    assert code == FAILS
    assert "copy*" in said
    assert "layout.json" in wrong
    code, said, wrong = run(capsys, "history", tmp_path / "nowhere", voter_build)
    assert code == UNUSABLE
    assert "voter" in said
    assert "nowhere: no such build folder" in wrong


@pytest.mark.parametrize("name", ["plot.pdf", "plot"])
def test_a_plot_has_a_format_that_is_known(voter_build, tmp_path, capsys, name):
    code, _, wrong = run(capsys, "history", voter_build, "--plot", tmp_path / name)
    assert code == UNUSABLE
    assert "png or svg" in wrong
