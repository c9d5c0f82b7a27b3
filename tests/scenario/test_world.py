"""Worlds: what is felt where, and who goes where."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mdlcad.language import Device, Line, Place, read_device
from mdlcad.scenario.file import GridWalk, Script, Step, find_scenario, load_scenario
from mdlcad.scenario.registers import register_values
from mdlcad.scenario.world import Hands, Maze, each_sensor, make_world
from tests.scenario.test_file import device

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def robot() -> Device:
    return read_device(EXAMPLES / "mazerobot.mdl")


def maze(robot: Device, *rows: str, **more: object) -> Maze:
    world = make_world(GridWalk(map=rows, **more), robot, "s.toml")  # type: ignore[arg-type]
    assert isinstance(world, Maze)
    return world


def bits(text: str) -> np.ndarray:
    return np.array([int(bit) for bit in text], dtype=np.uint8)


def test_sides_that_face_a_wall_are_pressed(robot: Device) -> None:
    # in the order of the program: left, front (up), right, back (down); the map is open to nowhere
    assert maze(robot, "###", "#SE", "#.#").feels().tolist() == [1, 1, 0, 0]
    assert maze(robot, "E", "S").feels().tolist() == [1, 0, 1, 1]


@pytest.mark.parametrize(("drive", "cell"), [("00", (1, 0)), ("10", (0, 1)), ("01", (1, 2)), ("11", (2, 1))])
def test_each_value_goes_its_way(robot: Device, drive: str, cell: tuple[int, int]) -> None:
    """``drive`` is given here lowest bit first, as in the vector of outputs."""
    world = maze(robot, "...", ".S.", "..E")
    assert world.after(bits(drive)).cell == cell


def test_walls_and_undecided_values_stop(robot: Device) -> None:
    world = maze(robot, "#S#E")
    assert [world.after(bits(drive)).cell for drive in ("00", "01", "10", "11", "20")] == [(0, 1)] * 5


def test_the_walk_ends_at_the_exit_or_when_time_is_up(robot: Device) -> None:
    world = maze(robot, "S.E", decisions=3)
    assert not world.finished
    assert world.after(bits("01")).after(bits("01")).finished
    idle = world.after(bits("00")).after(bits("00"))
    assert not idle.finished and idle.after(bits("00")).finished


def test_named_sensors_and_moves_win(robot: Device) -> None:
    world = maze(robot, "SE", sensors={"wall_back": "left"}, moves={"drive": {"00": "right", "go up": "stay"}})
    assert world.feels().tolist() == [0, 0, 0, 1]
    assert world.after(bits("00")).cell == (0, 1)
    assert world.after(bits("10")).cell == world.after(bits("11")).cell == (0, 0)


def test_slanted_sides_feel_nothing(robot: Device) -> None:
    boundary = (*robot.boundary[:1], Line("front", (0, 39), (39, 35)), Line("right", (39, 35), (39, 0)))
    slanted = replace(robot, boundary=(*boundary, robot.boundary[3]))
    assert maze(slanted, "S#E").feels().tolist() == [1, 0, 1, 1]


def test_the_left_hand_finds_the_way_out_of_our_maze_in_45_decisions(robot: Device) -> None:
    """By the rule alone, without program or network."""
    world = make_world(load_scenario(find_scenario("maze")), robot, "maze")
    assert isinstance(world, Maze)
    clockwise = ["left", "up", "right", "down"]
    ways = {"left": (0, -1), "up": (-1, 0), "right": (0, 1), "down": (1, 0)}
    heading, cells = 0, [world.cell]
    while cells[-1] != world.exit:
        row, column = cells[-1]
        for turn in (-1, 0, 1, 2):
            down, right = ways[clockwise[(heading + turn) % 4]]
            if not world.is_wall((row + down, column + right)):
                heading = (heading + turn) % 4
                cells.append((row + down, column + right))
                break
    assert len(cells) - 1 == 45


def test_our_maze_has_no_loops(robot: Device) -> None:
    rows = load_scenario(find_scenario("maze")).map  # type: ignore[union-attr]
    floor = {(r, c) for r, row in enumerate(rows) for c, mark in enumerate(row) if mark != "#"}
    doors = sum(((r, c + 1) in floor) + ((r + 1, c) in floor) for r, c in floor)
    assert doors == len(floor) - 1


def test_a_script_holds_its_sensors_until_told_otherwise() -> None:
    script = Script(
        steps=(Step(set={"code": "10"}), Step(set={"feeler": "wall"}, repeat=2, expect={"signal": "high"})),
        also={"signal": ("banner", "flag")},
    )
    world = make_world(script, device(), "s.toml")
    assert isinstance(world, Hands)
    felt = []
    while not world.finished:
        felt.append(world.feels().tolist())
        world = world.after(bits("00"))
    assert felt == [[0, 1, 0], [0, 1, 1], [0, 1, 1]]
    # expected when the step ends, not before
    assert [[port.name for port, _ in step.expected] for step in world.steps] == [[], [], ["flag"]]


def test_without_a_script_every_sensor_bit_is_pressed() -> None:
    world = each_sensor(device())
    felt = [step.sensors for step in world.steps]
    digits = [tuple(value for _, value in sensors) for sensors in felt]
    assert digits == [("00", "0"), ("01", "0"), ("10", "0"), ("00", "1"), ("11", "1"), ("00", "0")]


def test_a_device_without_a_way_to_move_is_refused(robot: Device) -> None:
    still = replace(robot, actuators=(replace(robot.actuators[0], values=()),))
    with pytest.raises(Exception, match="moves"):
        maze(still, "SE")
    deaf = replace(robot, sensors=(replace(robot.sensors[0], places=(Place("left", 0.5),)),))
    assert len(maze(deaf, "SE").feels()) == 1


def test_registers_are_put_together_where_none_is_missing() -> None:
    names = ("kept[1]", "door[0]", "kept[0]", "flags[2]", "alone")
    assert [str(value) for value in register_values(names, bits("10210"))] == [
        "alone=0",
        "door=0",
        "flags[2]=1",
        "kept=1?",
    ]
