"""``mdlcad simulate DIR --spread S``: yield, interval, and the cells that fail first."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from PIL import Image
from scipy.stats import binomtest

from mdlcad.artefact import from_json, to_json
from mdlcad.characterise.yields import SpreadResult, describe_cell
from mdlcad.cli import main
from tests.scenario.builds import QUICKLY, make_build, network_of


@pytest.fixture(scope="module")
def voter(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_build("voter", tmp_path_factory.mktemp("voter"), QUICKLY)


def copy(build: Path, folder: Path) -> Path:
    for name in ("device.json", "network.json"):
        (folder / name).write_bytes((build / name).read_bytes())
    return folder


def result_of(build: Path) -> SpreadResult:
    return from_json((build / "spread" / "result.json").read_bytes(), SpreadResult)


def test_yield_with_its_interval_and_weak_cells(
    voter: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    build = copy(voter, tmp_path)
    before = {path.name: path.read_bytes() for path in build.iterdir()}
    assert main(["simulate", str(build), "--spread", "0.5,0.02", "--samples", "24", "--seed", "3"]) == 0
    told = capsys.readouterr().out
    found = result_of(build)
    assert (found.seed, found.interval, found.confidence) == (3, "Wilson", 0.95)
    small, large = found.points
    assert (small.spread, small.right, small.weak_cells) == (0.02, 24, ())
    assert large.right < 24 and large.weak_cells
    for point in found.points:
        theirs = binomtest(point.right, point.samples).proportion_ci(0.95, "wilson")
        assert (point.low, point.high) == pytest.approx((theirs.low, theirs.high), abs=1e-9)
        assert f"{point.right} of 24 devices right" in told
    names = {mass.name for mass in network_of(build).masses}
    assert all(cell.mass in names for cell in large.weak_cells)
    assert sum(cell.count for cell in large.weak_cells) <= 24 - large.right
    assert large.weak_cells[0].mass in told and large.weak_cells[0].cell in told
    with Image.open(build / "spread" / "yield.png") as image:
        assert min(image.size) > 300
    assert {path.name: path.read_bytes() for path in build.iterdir() if path.is_file()} == before


def test_the_same_bytes_on_any_number_of_processors(voter: Path, tmp_path: Path) -> None:
    made = []
    for jobs in ("1", "2"):
        folder = tmp_path / jobs
        folder.mkdir()
        build = copy(voter, folder)
        assert main(["simulate", str(build), "--spread", "0.3", "--samples", "6", "--jobs", jobs]) == 0
        made.append({path.name: path.read_bytes() for path in (build / "spread").iterdir()})
    assert made[0] == made[1]


def test_a_weakened_cell_is_named(voter: Path, tmp_path: Path) -> None:
    """A bias that nearly outweighs the inputs makes its mass the first to fail."""
    build = copy(voter, tmp_path)
    network = network_of(build)
    victim = next(mass.name for mass in network.masses if any(c.target == mass.name for c in network.couplings))
    masses = tuple(replace(m, bias=0.28) if m.name == victim else m for m in network.masses)
    (build / "network.json").write_bytes(to_json(replace(network, masses=masses)))
    assert main(["simulate", str(build), "--spread", "0.15", "--samples", "12"]) == 0
    assert result_of(build).points[0].weak_cells[0].mass == victim
    assert "biased" in result_of(build).points[0].weak_cells[0].cell


def test_cells_are_described_as_logic(voter: Path) -> None:
    network = network_of(voter)
    majority = next(m for m in network.masses if sum(c.target == m.name for c in network.couplings) == 3)
    assert describe_cell(network, majority.name).startswith("gate, weights +1 +1 +1, drives")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--spread", "0"], "above 0"),
        (["--spread=-0.1"], "above 0"),
        (["--spread", "nan"], "above 0"),
        (["--spread", "0.1", "--samples", "0"], "at least 1"),
        (["--spread", "0.1", "--samples", "many"], "at least 1"),
        (["--samples", "5"], "give --spread"),
        (["--seed", "5"], "give --spread"),
        (["--spread", "0.1", "--scenario", "maze"], "give one of them"),
    ],
)
def test_arguments_that_make_no_sense(
    arguments: list[str], words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        code = main(["simulate", str(tmp_path), *arguments])
    except SystemExit as stop:
        code = int(str(stop.code))
    assert code == 2
    assert words in capsys.readouterr().err


def test_a_folder_without_a_build_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", str(tmp_path), "--spread", "0.1"]) == 2
    assert "device.json: is missing" in capsys.readouterr().err
    assert not (tmp_path / "spread").exists()
