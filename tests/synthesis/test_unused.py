"""Sensors that decide nothing are warned of, at their line; those that do are not."""

from pathlib import Path

import pytest

from mdlcad.cli import HOLDS, main
from mdlcad.language import parse_device, read_device
from mdlcad.synthesis import synthesise
from mdlcad.synthesis.unused import unused_sensors

EXAMPLES = Path(__file__).parents[2] / "examples"


def program(behaviour: str) -> str:
    text = (EXAMPLES / "voter.mdl").read_text()
    wanted = "(left_vote & right_vote) | (left_vote & base_vote) | (right_vote & base_vote)"
    assert wanted in text
    return text.replace(wanted, behaviour)


@pytest.mark.parametrize(
    ("behaviour", "idle"),
    [
        ("left_vote & right_vote & base_vote", []),
        ("left_vote & right_vote", ["base_vote"]),
        ("~left_vote", ["right_vote", "base_vote"]),
    ],
)
def test_sensors_without_effect_are_named(behaviour: str, idle: list[str]) -> None:
    device = parse_device(program(behaviour), "voter.mdl")
    found = unused_sensors(device, synthesise(device))
    places = {sensor.name: (sensor.where.line, sensor.where.column) for sensor in device.sensors}
    assert [(item.line, item.column) for item in found] == [places[name] for name in idle]
    assert all(f"sensor '{name}'" in item.message for name, item in zip(idle, found, strict=True))


def test_of_a_wide_sensor_the_idle_bits_are_named() -> None:
    text = (EXAMPLES / "lock.mdl").read_text()
    device = parse_device(text.replace("~|(code ^ kept)", "~|(code[2:0] ^ kept[2:0])"), "lock.mdl")
    (found,) = unused_sensors(device, synthesise(device))
    assert "code[3] of sensor 'code'" in found.message


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.mdl")), ids=lambda path: path.stem)
def test_the_examples_use_all_their_sensors(path: Path) -> None:
    device = read_device(path)
    assert unused_sensors(device, synthesise(device)) == []


def test_check_warns_and_holds(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "two.mdl"
    path.write_text(program("left_vote & right_vote"))
    assert main(["check", str(path)]) == HOLDS
    said = capsys.readouterr()
    line = 1 + path.read_text()[: path.read_text().index("sensor base_vote")].count("\n")
    assert said.err.startswith(f"{path}:{line}:8: warning: the behaviour does not use sensor 'base_vote'")
    assert "no errors" in said.out
