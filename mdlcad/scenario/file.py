"""Scenario files: TOML that says what world a device is put into. See ``docs/scenarios.md``."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec

from mdlcad.datafolder import find_data, list_data
from mdlcad.errors import UsageError

_FOLDER = "examples/scenarios"
_SUFFIX = ".toml"

# longer runs make pictures that nobody can read
MOST_DECISIONS = 1000


class GridWalk(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag_field="kind", tag="grid walk"):
    """A device that walks from cell to cell of a map.

    Attributes:
        map: rows of equal length; "#" a wall, "." floor, "S" the start, "E" the exit. Beyond the map all is wall.
        sensors: sensor name -> the direction in which it feels a wall ("left", "up", "right", "down"). Without any,
            every sensor feels the way that its side of the boundary faces.
        moves: actuator name -> its value -> the direction in which it moves the device, or "stay". Without any, the
            labels of an actuator's values tell.
        decisions: the exit must be reached within so many.
        design: the device that this scenario was written for; it is run if that is simulated without a scenario.
    """

    map: tuple[str, ...]
    sensors: dict[str, str] = {}
    moves: dict[str, dict[str, str]] = {}
    decisions: int = 200
    design: str = ""


class Step(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Some decisions with the same inputs.

    Attributes:
        set: sensor name -> value; a sensor that is not named keeps its value, and all start at 0.
        expect: actuator name -> the value that it must show at the end of the step.
        repeat: for how many decisions.
        say: what is going on, for people.
    """

    set: dict[str, str] = {}
    expect: dict[str, str] = {}
    repeat: int = 1
    say: str = ""


class Script(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag_field="kind", tag="script"):
    """A list of things done to the device, one after the other.

    Attributes:
        also: name of a port in the steps -> other names by which a device may call it.
        design: as in ``GridWalk``.
    """

    steps: tuple[Step, ...]
    also: dict[str, tuple[str, ...]] = {}
    design: str = ""


ScenarioFile = GridWalk | Script


def find_scenario(name_or_path: str) -> Path:
    """The file of a scenario known by name, or at a path.

    Raises:
        UsageError: there is none; the message lists what there is.
    """
    path = find_data(_FOLDER, name_or_path, _SUFFIX)
    if not path.is_file():
        raise UsageError(f"{name_or_path}: is not a scenario file")
    return path


def scenario_names() -> list[str]:
    """Names of the scenarios that come with this installation, sorted."""
    return list_data(_FOLDER, _SUFFIX)


def own_scenario(design: str) -> Path | None:
    """The scenario to run for ``design`` if none is asked for: that of its name, else the first written for it."""
    names = scenario_names()
    if design in names:
        return find_scenario(design)
    for name in names:
        path = find_scenario(name)
        if load_scenario(path).design == design:
            return path
    return None


def load_scenario(path: Path) -> ScenarioFile:
    """Read and check the shape of a scenario file; names of ports are checked when it meets a device.

    Raises:
        UsageError: it cannot be read or is wrong; the message names the file and the key.
    """
    try:
        found: ScenarioFile = msgspec.toml.decode(path.read_bytes(), type=ScenarioFile)
    except OSError as problem:
        raise UsageError(f"{path}: cannot be read: {problem.strerror}") from None
    except msgspec.ValidationError as problem:
        raise UsageError(f"{path}: {_with_key(str(problem))}") from None
    except (msgspec.DecodeError, ValueError) as problem:
        raise UsageError(f"{path}: is not TOML: {problem}") from None
    if isinstance(found, GridWalk):
        _check_walk(path, found)
    else:
        _check_script(path, found)
    return found


def _with_key(message: str) -> str:
    """msgspec's "what - at `$.key`" as "key: what"."""
    found = re.fullmatch(r"(?P<what>.*) - at `(?:key in )?\$\.?(?P<key>.*)`", message, re.DOTALL)
    if found and found["key"]:
        return f"{found['key']}: {found['what']}"
    return found["what"] if found else message


def _check_walk(path: Path, walk: GridWalk) -> None:
    def wrong(key: str, words: str) -> UsageError:
        return UsageError(f"{path}: {key}: {words}")

    if not walk.map:
        raise wrong("map", "has no rows")
    for number, row in enumerate(walk.map):
        if len(row) != len(walk.map[0]):
            raise wrong(f"map[{number}]", f"has {len(row)} cells, but the first row has {len(walk.map[0])}")
        strange = sorted(set(row) - set("#.SE"))
        if strange:
            raise wrong(f"map[{number}]", f'has "{strange[0]}"; a cell is one of "#" (wall), "." (floor), "S", "E"')
    whole = "".join(walk.map)
    for mark, word in (("S", "start"), ("E", "exit")):
        if whole.count(mark) != 1:
            raise wrong("map", f'needs one {word} "{mark}", and has {whole.count(mark)}')
    if len(walk.moves) > 1:
        raise wrong("moves", "needs the values of one actuator, as [moves.NAME]")
    if not 1 <= walk.decisions <= MOST_DECISIONS:
        raise wrong("decisions", f"must be 1 to {MOST_DECISIONS}")


def _check_script(path: Path, script: Script) -> None:
    if not script.steps:
        raise UsageError(f"{path}: steps: has none")
    for number, step in enumerate(script.steps):
        if step.repeat < 1:
            raise UsageError(f"{path}: steps[{number}].repeat: must be 1 or more")
    if sum(step.repeat for step in script.steps) > MOST_DECISIONS:
        raise UsageError(f"{path}: steps: are more than {MOST_DECISIONS} decisions")
