"""Scenarios end to end: what is reported, and what is drawn."""

from __future__ import annotations

import io
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mdlcad.artefact import from_json, to_json
from mdlcad.errors import UsageError
from mdlcad.scenario import run_scenario
from mdlcad.scenario.result import ScenarioResult
from mdlcad.scenario.run import RESULT
from tests.scenario.builds import make_build, network_of


@pytest.fixture(scope="module")
def light(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_build("traffic_light", tmp_path_factory.mktemp("light"))


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_build("mazerobot", tmp_path_factory.mktemp("robot"))


@pytest.fixture(scope="module")
def lock(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_build("lock", tmp_path_factory.mktemp("lock"))


def quiet(line: str) -> None:
    assert line


def result_of(build: Path, name: str) -> ScenarioResult:
    return from_json((build / "scenarios" / name / RESULT).read_bytes(), ScenarioResult)


def script(folder: Path, text: str) -> str:
    path = folder / "mine.toml"
    path.write_text('kind = "script"\n' + text)
    return str(path)


def copy(build: Path, folder: Path) -> Path:
    for name in ("device.json", "network.json"):
        (folder / name).write_bytes((build / name).read_bytes())
    return folder


def test_the_robot_finds_the_way_out(robot: Path) -> None:
    assert run_scenario(robot, "maze", quiet) == []
    result = result_of(robot, "maze")
    assert (result.end_cell, len(result.decisions), result.disagreements) == ((0, 7), 45, 0)
    cells = [decision.cell for decision in result.decisions] + [result.end_cell]
    assert all(a and b and abs(a[0] - b[0]) + abs(a[1] - b[1]) == 1 for a, b in pairwise(cells))
    place = robot / "scenarios" / "maze"
    assert {path.name for path in place.iterdir()} == {*result.files, RESULT}
    for name in result.files:
        assert ink(place / name), f"{name} shows nothing"
    assert (place / "run.gif").stat().st_size < 3_000_000
    with Image.open(place / "run.gif") as film:
        assert film.n_frames == 180


def ink(path: Path) -> bool:
    """The last frame has more than one colour, and is large enough to see something."""
    with Image.open(path) as image:
        image.seek(getattr(image, "n_frames", 1) - 1)
        pixels = np.asarray(image.convert("L"))
    return bool(min(pixels.shape) > 200 and np.ptp(pixels) > 100 and 0.003 < (pixels < 200).mean() < 0.9)


def test_the_lock_keeps_its_code(lock: Path) -> None:
    said: list[str] = []
    assert run_scenario(lock, None, said.append) == []
    result = result_of(lock, "lock")
    doors = [decision.actuators[0].label for decision in result.decisions]
    assert doors == ["open", "closed", "closed", "closed", "closed", "open", "open"]
    kept = {value.register: value.digits for value in result.after}["kept"]
    assert kept == "1001"
    assert any("try 0011" in line and "door=closed" in line for line in said)


def test_a_wrong_expectation_fails(light: Path, tmp_path: Path) -> None:
    text = '[[steps]]\nsay = "ask"\nset = { walker = "asks to cross" }\nexpect = { flags = "green" }\n'
    found = run_scenario(light, script(tmp_path, text), quiet)
    assert len(found) == 1
    assert "decision 0 (ask): flags should be green (001), and is amber (010)" in found[0]
    assert result_of(light, "mine").failures == tuple(found)


def test_a_broken_network_fails(light: Path, tmp_path: Path) -> None:
    """The sensor pushes the wrong way: even a scenario without expectations tells."""
    network = network_of(light)
    sensor = network.sensors[0].mass
    broken = [
        replace(coupling, strength=-coupling.strength) if sensor in (coupling.source, coupling.target) else coupling
        for coupling in network.couplings
    ]
    build = copy(light, tmp_path)
    (build / "network.json").write_bytes(to_json(replace(network, couplings=tuple(broken))))
    found = run_scenario(build, None, quiet)
    assert any("not as its program" in words for words in found)
    assert result_of(build, "each-sensor").disagreements > 0


def test_a_stopped_clock_fails(light: Path, tmp_path: Path) -> None:
    network = network_of(light)
    build = copy(light, tmp_path)
    still = tuple(coupling for coupling in network.couplings if coupling.target != network.tick)
    (build / "network.json").write_bytes(to_json(replace(network, couplings=still)))
    found = run_scenario(build, None, quiet)
    assert len(found) == 1 and "tick" in found[0]
    assert ink(build / "scenarios" / "each-sensor" / "network.png")


def test_the_same_run_writes_the_same_bytes_and_nothing_else_stays(light: Path, tmp_path: Path) -> None:
    build = copy(light, tmp_path)
    assert run_scenario(build, None, quiet) == []
    place = build / "scenarios" / "each-sensor"
    first = {path.name: path.read_bytes() for path in place.iterdir()}
    (place / "old.png").write_bytes(b"left by another version")
    assert run_scenario(build, None, quiet) == []
    assert {path.name: path.read_bytes() for path in place.iterdir()} == first
    assert b"traffic" in first[RESULT]


def test_placed_masses_are_drawn_in_their_slots(light: Path, tmp_path: Path) -> None:
    build = copy(light, tmp_path)
    network = network_of(build)
    names = [mass.name for mass in network.masses]
    ports = (*network.sensors, *network.actuators)
    placed = {
        "boundary": [[0.0, 0.0], [0.0, 300.0], [80.0, 300.0], [80.0, 0.0]],
        "masses": [{"mass": name, "x": 40.0, "y": 20.0 * (i + 1), "row": i} for i, name in enumerate(names)],
        "ports": [{"bit": port.bit, "x": 0.0, "y": 75.0 * (i + 1)} for i, port in enumerate(ports)],
    }
    (build / "placement.json").write_bytes(to_json(placed))
    assert run_scenario(build, None, quiet) == []
    with Image.open(io.BytesIO((build / "scenarios" / "each-sensor" / "network.png").read_bytes())) as image:
        assert image.height > 1.3 * image.width  # as narrow as the placement's boundary
    placed["masses"] = placed["masses"][1:]
    (build / "placement.json").write_bytes(to_json(placed))
    with pytest.raises(UsageError, match=r"placement\.json: has no place for"):
        run_scenario(build, None, quiet)


@pytest.mark.parametrize("name", ["device.json", "network.json"])
@pytest.mark.parametrize("content", [None, b"", b"{}", b"[1, 2"])
def test_builds_that_cannot_be_used(light: Path, tmp_path: Path, name: str, content: bytes | None) -> None:
    build = copy(light, tmp_path)
    (build / name).unlink()
    if content is not None:
        (build / name).write_bytes(content)
    with pytest.raises(UsageError, match=name):
        run_scenario(build, None, quiet)
    assert not (build / "scenarios").exists()
