"""Several seeds: the best by the stated order, the same for any number of workers and in any process."""

import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from mdlcad.cli import HOLDS, UNUSABLE, main
from mdlcad.flow.outline import port_places
from mdlcad.flow.placing import Work, best_of
from mdlcad.language import read_device
from mdlcad.mapping import load_library, map_netlist
from mdlcad.placement.placers import ANNEAL, PaperPlacer
from mdlcad.routing.driver import SMALLEST
from mdlcad.synthesis import synthesise

ROOT = Path(__file__).resolve().parents[2]
VOTER = ROOT / "examples" / "voter.mdl"


def work(placer) -> Work:
    device = read_device(VOTER)
    network = map_netlist(synthesise(device), load_library("two_phase"))
    outline = tuple(line.start for line in device.boundary)
    return Work(network, outline, port_places(device), placer, None, SMALLEST, None)


@pytest.mark.parametrize(
    "placer", [ANNEAL, pytest.param(PaperPlacer(), marks=pytest.mark.long)], ids=["anneal", "paper"]
)
def test_the_best_seed_is_the_same_on_any_number_of_workers(placer):
    said: list[str] = []
    alone = best_of(work(placer), 3, 3, 1, said.append)
    assert alone == best_of(work(placer), 3, 3, 2, said.append)
    assert "3 of 3 seeds tried" in said[-1]
    single = [best_of(work(placer), seed, 1, 1, said.append).result for seed in range(3, 6)]
    best = min(single, key=lambda grid: (grid.crossings, grid.length, grid.seed))
    assert alone.result == best
    assert alone.search.seeds is not None
    assert (alone.search.seeds.tried, alone.search.seeds.won, alone.search.seeds.failed) == ((3, 4, 5), best.seed, ())


def test_options_of_the_papers_placer_need_it(tmp_path, capsys):
    build = ["build", str(VOTER), "--cells", "two_phase", "--to", "placement", "-o", str(tmp_path / "v")]
    assert main([*build, "--iterations", "30"]) == UNUSABLE
    assert "--iterations: is an option of --placer paper" in capsys.readouterr().err
    assert main([*build, "--placer", "paper", "--iterations", "30", "--no-uncross"]) == HOLDS
    assert json.loads((tmp_path / "v" / "placement.json").read_text())["placer"] == "paper"
    assert json.loads((tmp_path / "v" / "report.json").read_text())["placer"] == "paper"


@pytest.mark.long
def test_a_device_is_the_same_in_fresh_processes_with_other_hashes(tmp_path):
    digests = set()
    for hashes, workers in (("1", "1"), ("2", "2"), ("77", "2")):
        place = tmp_path / f"{hashes}-{workers}"
        command = [sys.executable, "-m", "mdlcad.cli", "build", str(VOTER), "--to", "layout", "--seeds", "2"]
        environment = {**os.environ, "PYTHONHASHSEED": hashes, "PYTHONPATH": str(ROOT)}
        subprocess.run([*command, "--jobs", workers, "-o", str(place)], check=True, env=environment, timeout=600)
        files = json.loads((place / "report.json").read_text())["files"]
        digests.add(hashlib.sha256(json.dumps(files, sort_keys=True).encode()).hexdigest())
        assert json.loads((place / "report.json").read_text())["seeds"]["tried"] == [0, 1]
    assert len(digests) == 1
