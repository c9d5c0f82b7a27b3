"""The window's keys, boxes and mouse, on a window that no screen shows; and what is said where there is no screen."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import pyvista

from mdlcad.cli import UNUSABLE, main
from mdlcad.view.colours import ColourBy
from mdlcad.view.scene import Look, Scene
from mdlcad.view.stage import Stage
from mdlcad.view.window import Controls


def test_without_a_screen_it_says_what_to_do(
    voter: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    assert main(["view", str(voter)]) == UNUSABLE
    said = capsys.readouterr().err
    assert "there is no screen" in said and "--screenshot" in said and "--html" in said and said.count("\n") == 1


def test_a_screen_that_is_not_there_is_told_too(voter: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "mdlcad.cli", "view", str(voter)],
        env={"DISPLAY": ":4711", "PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
        timeout=200,
        check=False,
    )
    assert done.returncode == UNUSABLE
    assert "the screen :4711 (DISPLAY) cannot be opened" in done.stderr and "Traceback" not in done.stderr


class Hands:
    """Presses keys and moves the mouse as a window system would tell VTK."""

    def __init__(self, controls: Controls) -> None:
        self._interactor = controls.stage.plotter.iren.interactor

    def press(self, name: str, code: str = "\0") -> None:
        self._interactor.SetKeySym(name)
        self._interactor.SetKeyCode(code)
        self._interactor.InvokeEvent("KeyPressEvent")

    def type(self, text: str) -> None:
        for letter in text:
            self.press(letter, letter)

    def point(self, x: int, y: int) -> None:
        self._interactor.SetEventInformation(x, y, 0, 0, "\0", 0, None)
        self._interactor.InvokeEvent("MouseMoveEvent")

    def wait(self) -> None:
        self._interactor.InvokeEvent("TimerEvent")


@pytest.fixture
def controls(scene: Scene) -> Controls:
    if os.environ.get("DISPLAY"):
        pytest.skip("THERE IS A SCREEN: this test works on a window that none shows; unset DISPLAY to run it")
    plotter = pyvista.Plotter(window_size=[640, 480])
    found = Controls(scene, Stage(scene.model, plotter), Look(size=(640, 480)))
    found.attach()
    yield found
    plotter.close()


def test_keys_colour_take_apart_and_turn(controls: Controls) -> None:
    hands = Hands(controls)
    hands.press("c")
    assert controls.colour is ColourBy.PHASE
    before = controls.stage.points().copy()
    hands.press("x")
    assert controls.stage.explode > 0.0
    assert np.ptp(controls.stage.points()[:, 2]) > np.ptp(before[:, 2]) + 10.0
    place = controls.stage.plotter.camera.position
    hands.press("v")
    assert controls.stage.plotter.camera.position != place


def test_a_name_is_typed_and_found_and_letters_are_no_commands_meanwhile(controls: Controls) -> None:
    hands = Hands(controls)
    hands.press("slash", "/")
    hands.type("xc")
    hands.press("BackSpace")
    hands.press("BackSpace")
    hands.type("verdict[0]")
    assert controls.typed == "verdict[0]"
    assert controls.colour is ColourBy.PART and controls.stage.explode == 0.0
    hands.press("Return")
    names = {controls.scene.built.bodies[number].name for number in controls.stage.found}
    assert "unit.verdict[0]" in names and controls.typed is None
    hands.press("slash", "/")
    hands.type("nobody")
    hands.press("Return")
    assert controls.stage.found == () and "nothing has a name with nobody" in controls.card


def test_pointing_at_a_unit_reads_its_card(controls: Controls) -> None:
    scene, stage = controls.scene, controls.stage
    for plate in scene.model.plates:
        controls.plate(plate, plate == "unit")
    for name in ("b", "b"):  # once round to a view from above: iso, right, left
        controls.key(name, name)
    controls.preset = type(controls.preset)("top")
    controls.apart(0.5)  # moved after the window was made
    controls.frame()
    plotter = stage.plotter
    plotter.ren_win.Render()
    place = next(place for place in scene.built.placement.masses if place.mass == "verdict[0]")
    number = next(i for i, body in enumerate(scene.built.bodies) if body.name == "unit.verdict[0]")
    height = stage.points([number])[:, 2].max()
    renderer = plotter.renderer
    renderer.SetWorldPoint(place.x, place.y, height, 1.0)
    renderer.WorldToDisplay()
    x, y, _ = renderer.GetDisplayPoint()
    Hands(controls).point(round(x), round(y))
    assert controls.card == str(scene.cards[number])


def test_a_plate_that_is_switched_off_is_neither_seen_nor_pointed_at(controls: Controls) -> None:
    controls.plate("unit", False)
    shown = [
        group.plate
        for group, actor in zip(controls.stage.model.groups, controls.stage.actors, strict=True)
        if actor.GetVisibility()
    ]
    assert "unit" not in shown and "H0" in shown
    controls.plate("unit", True)
    assert "unit" in controls.stage.shown


def test_it_plays(controls: Controls) -> None:
    hands = Hands(controls)
    rest = controls.stage.points().copy()
    hands.wait()
    assert np.array_equal(controls.stage.points(), rest)
    hands.press("space", " ")
    hands.wait()
    hands.wait()
    moved = np.abs(controls.stage.points() - rest).max(axis=0)
    assert moved[0] > 0.05 and moved[1] > 0.5  # clock plates in x, shuttles in y


def test_the_whole_device_is_few_actors(controls: Controls) -> None:
    kinds = {(body.plate, body.kind) for body in controls.scene.built.bodies}
    assert len(controls.stage.actors) == len(kinds) < 0.5 * len(controls.scene.built.bodies)
