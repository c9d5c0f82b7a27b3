"""Every way to get a scenario file wrong ends in a message that names the file and the key."""

from __future__ import annotations

from pathlib import Path

import pytest

from mdlcad.errors import UsageError
from mdlcad.language import Actuator, Device, Line, Place, Sensor, Value
from mdlcad.scenario.file import GridWalk, Script, find_scenario, load_scenario, own_scenario, scenario_names
from mdlcad.scenario.world import make_world

MAP = 'map = ["####", "#SE#", "####"]\n'
WALK = 'kind = "grid walk"\n' + MAP
STEPS = '[[steps]]\nset = { code = "10" }\n'

SQUARE = (
    Line("left", (0, 0), (0, 9)),
    Line("top", (0, 9), (9, 9)),
    Line("right", (9, 9), (9, 0)),
    Line("bottom", (9, 0), (0, 0)),
)


def device() -> Device:
    return Device(
        "thing",
        SQUARE,
        (
            Sensor("code", (Place("left", 0.3), Place("left", 0.6)), (Value("0", "out"), Value("1", "in"))),
            Sensor("feeler", (Place("top", 0.5),), (Value("0", "free"), Value("1", "wall"))),
        ),
        (
            Actuator("wheel", "", (Place("right", 0.5),), (Value("0", "run left"), Value("1", "run right"))),
            Actuator("flag", "", (Place("bottom", 0.5),), (Value("0", "low"), Value("1", "high"))),
        ),
        "",
        "thing.mdl",
    )


def read(folder: Path, text: str) -> GridWalk | Script:
    path = folder / "s.toml"
    path.write_text(text)
    return load_scenario(path)


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ("kind = ", "is not TOML"),
        ("\x00", "is not TOML"),
        ("", "kind"),
        ('kind = "dance"', "kind"),
        ('kind = "grid walk"', "map"),
        ('kind = "grid walk"\nmap = []', "map: "),
        ('kind = "grid walk"\nmap = ["#S", "E"]', "map[1]: "),
        ('kind = "grid walk"\nmap = ["SE!"]', "map[0]: "),
        ('kind = "grid walk"\nmap = ["SSE"]', "map: needs one start"),
        ('kind = "grid walk"\nmap = ["S.."]', "map: needs one exit"),
        ('kind = "grid walk"\nmap = [1]', "map[0]: "),
        (WALK + "decisions = 0", "decisions: "),
        (WALK + "decisions = 1000000", "decisions: "),
        (WALK + 'decisions = "9"', "decisions: "),
        (WALK + "decision = 9", "`decision`"),
        (WALK + "[moves.a]\n[moves.b]", "moves: "),
        ('kind = "script"', "steps"),
        ('kind = "script"\nsteps = []', "steps: "),
        ('kind = "script"\n[[steps]]\nrepeat = 0', "steps[0].repeat: "),
        ('kind = "script"\n[[steps]]\nrepeat = 9999', "steps: "),
        ('kind = "script"\n[[steps]]\nsets = {}', "`sets`"),
        ('kind = "script"\n[[steps]]\nset = { a = 1 }', "set"),
    ],
)
def test_wrong_files(tmp_path: Path, text: str, key: str) -> None:
    with pytest.raises(UsageError) as caught:
        read(tmp_path, text)
    assert "s.toml: " in str(caught.value)
    assert key in str(caught.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (WALK + '[sensors]\nnose = "up"', "sensors.nose: thing has no sensor of this name; it has code, feeler"),
        (WALK + '[sensors]\nfeeler = "north"', 'sensors.feeler: "north" is no direction'),
        (WALK + '[sensors]\ncode = "up"', "sensors.code: feels walls, so it must have one bit"),
        (WALK + '[moves.leg]\n"0" = "up"', "moves.leg: thing has no actuator"),
        (WALK + '[moves.wheel]\n"2" = "up"', 'moves.wheel.2: "2" is no value of wheel'),
        (WALK + '[moves.wheel]\n"0" = "away"', 'moves.wheel.0: "away" is no direction'),
        (WALK + '[moves.wheel]\n"0" = "up"\n"run left" = "down"', "moves.wheel.run left: "),
        ('kind = "script"\n[[steps]]\nset = { nose = "1" }', "steps[0].set.nose: thing has no sensor"),
        ('kind = "script"\n[[steps]]\nset = { code = "1" }', "steps[0].set.code: "),
        ('kind = "script"\n[[steps]]\nset = { code = "in" }', "steps[0].set.code: "),
        ('kind = "script"\n[[steps]]\nexpect = { flag = "middling" }', 'give 0 or 1, "low", "high"'),
        ('kind = "script"\n[[steps]]\nexpect = { code = "11" }', "steps[0].expect.code: thing has no actuator"),
    ],
)
def test_files_that_do_not_fit_the_device(tmp_path: Path, text: str, words: str) -> None:
    scenario = read(tmp_path, text)
    with pytest.raises(UsageError) as caught:
        make_world(scenario, device(), "s.toml")
    assert str(caught.value).startswith("s.toml: ")
    assert words in str(caught.value)


def test_files_that_are_not_there(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"known: .*lock, maze"):
        find_scenario("nowhere")
    with pytest.raises(UsageError, match=r"nowhere\.toml"):
        find_scenario(str(tmp_path / "nowhere.toml"))
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(UsageError, match=r"folder\.toml"):
        find_scenario(str(tmp_path / "folder.toml"))


def test_the_scenarios_of_this_installation_can_be_read() -> None:
    assert {"lock", "maze"} <= set(scenario_names())
    assert all(load_scenario(find_scenario(name)) for name in scenario_names())


def test_which_scenario_is_run_if_none_is_asked_for() -> None:
    lock, maze = own_scenario("lock"), own_scenario("mazerobot")
    assert lock is not None and lock.stem == "lock"
    assert maze is not None and maze.stem == "maze"
    assert own_scenario("voter") is None
