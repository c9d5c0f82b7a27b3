"""The window: a scene that one can turn, take apart, colour, point at and search."""

from __future__ import annotations

import os
import sys
from typing import Any

import pyvista
import vtk

from mdlcad.errors import UsageError
from mdlcad.view.camera import Preset, pose
from mdlcad.view.colours import ColourBy
from mdlcad.view.find import find
from mdlcad.view.playback import Playback, at_rest, play
from mdlcad.view.scene import Look, Scene
from mdlcad.view.stage import Stage
from mdlcad.view.still import arrange, moment, moment_of

_HELP = """plates     click the boxes
apart      x (or the slider)
colours    c
camera     v next, b back, r all of it
search     / then a name, Enter, Esc
play       space
help       h        quit  q"""

_COLOURS = tuple(ColourBy)
_PRESETS = tuple(Preset)
_FRAMES_A_TICK = 2
_TICK_MS = 50
_STEPS_APART = (0.0, 0.35, 1.0)


def need_screen() -> None:
    """A window needs a screen.

    Raises:
        UsageError: there is none.
    """
    if sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
        raise UsageError(
            "there is no screen to open a window on (DISPLAY is not set); write a picture with --screenshot P.png, a "
            "page with --html P.html or an animation with --animate P.gif"
        )


def open_window(scene: Scene, look: Look) -> None:
    """Open the window; returns when it is closed.

    Raises:
        UsageError: there is no screen, or it cannot show a window.
    """
    need_screen()
    plotter = pyvista.Plotter(title=f"mdlcad: {scene.built.report.design}", window_size=list(look.size))
    if sys.platform.startswith("linux") and not plotter.ren_win.IsA("vtkXOpenGLRenderWindow"):
        # VTK has asked the X server, found none, and would draw where nobody sees it
        plotter.close()
        raise UsageError(
            f"the screen {os.environ.get('DISPLAY')} (DISPLAY) cannot be opened; write a picture with --screenshot "
            "P.png, a page with --html P.html or an animation with --animate P.gif"
        )
    try:
        controls = Controls(scene, Stage(scene.model, plotter), look)
        controls.attach()
        plotter.show(auto_close=True)
    except RuntimeError as problem:
        raise UsageError(
            f"the screen cannot show a window ({problem}); use --screenshot, --html or --animate"
        ) from None


class Controls:
    """What keys, boxes, the slider and the mouse do to a stage."""

    def __init__(self, scene: Scene, stage: Stage, look: Look) -> None:
        self.scene = scene
        self.stage = stage
        self.colour = look.colour
        self.preset = look.camera
        self.typed: str | None = None
        self.card = ""
        self.playing = False
        self._scenario = look.scenario
        self._playback: Playback | None = None
        self._now = moment(scene, look)
        self._frame = 0
        self._picker = vtk.vtkCellPicker()
        self._picker.SetTolerance(0.0)
        self._locators: list[Any] = []
        self._located = -1
        self._slider: Any = None
        arrange(stage, scene, look, self._now)

    def attach(self) -> None:
        """Put the widgets on the plotter and listen to keys and mouse."""
        plotter = self.stage.plotter
        for mesh in self.stage.meshes:
            locator = vtk.vtkStaticCellLocator()
            locator.SetDataSet(mesh)
            self._picker.AddLocator(locator)
            self._locators.append(locator)
        interactor = plotter.iren.interactor
        plotter.iren.clear_key_event_callbacks()
        for event, handler in (
            ("KeyPressEvent", lambda caller, _: self.key(caller.GetKeySym(), caller.GetKeyCode())),
            ("MouseMoveEvent", lambda caller, _: self.point(*caller.GetEventPosition())),
            ("TimerEvent", lambda *_: self.tick()),
        ):
            interactor.AddObserver(event, handler)
        plotter.iren.style = _quiet_style()
        self._slider = plotter.add_slider_widget(
            self.apart,
            (0.0, 1.0),
            value=self.stage.explode,
            title="apart",
            pointa=(0.80, 0.06),
            pointb=(0.97, 0.06),
            style="modern",
            title_height=0.018,
            slider_width=0.012,
            tube_width=0.012,
            interaction_event="always",
        )
        for number, plate in enumerate(self.scene.model.plates):
            y = 12 + 24 * number
            plotter.add_checkbox_button_widget(
                lambda on, plate=plate: self.plate(plate, on),
                value=plate in self.stage.shown,
                position=(12, y),
                size=18,
            )
            plotter.add_text(plate, position=(36, y), font_size=8, color="black", name=f"plate {plate}")
        interactor.CreateRepeatingTimer(_TICK_MS)
        self.write()

    def plate(self, name: str, on: bool) -> None:
        """Show or hide a plate."""
        shown = [plate for plate in self.scene.model.plates if (on if plate == name else plate in self.stage.shown)]
        self.stage.show(shown)
        self.stage.plotter.render()

    def apart(self, share: float) -> None:
        """Take the plates apart."""
        self.stage.stand(explode=share, displacements=self._now.moved)
        self.stage.plotter.render()

    def key(self, name: str, code: str) -> None:
        """A key was pressed: ``name`` as VTK calls it, ``code`` its character."""
        if self.typed is not None:
            self._type(name, code)
        elif name in ("slash", "f"):
            self.typed = ""
        elif name == "space":
            self.playing = not self.playing
            if self.playing:
                self._need_playback()
        elif name == "c":
            self.colour = _COLOURS[(_COLOURS.index(self.colour) + 1) % len(_COLOURS)]
            self._paint()
        elif name in ("v", "b"):
            step = 1 if name == "v" else -1
            self.preset = _PRESETS[(_PRESETS.index(self.preset) + step) % len(_PRESETS)]
            self.frame()
        elif name == "r":
            self.stage.mark(())
            self.frame()
        elif name == "x":
            later = [step for step in _STEPS_APART if step > self.stage.explode + 1e-6]
            self.apart(later[0] if later else 0.0)
            if self._slider is not None:
                self._slider.GetRepresentation().SetValue(self.stage.explode)
            self.frame()
        elif name == "h":
            self.card = _HELP
        elif name == "q":
            self.stage.plotter.iren.interactor.TerminateApp()
            return
        self.write()

    def search(self, text: str) -> int:
        """Mark what has this name and fill the window with it; how many bodies that were."""
        found = find(self.scene.built, self.scene.cards, text)
        self.stage.mark(found)
        if found:
            self.card = str(self.scene.cards[found[0]])
            self.frame()
        else:
            self.card = f"nothing has a name with {text} in it"
        return len(found)

    def point(self, x: int, y: int) -> None:
        """The mouse is at (x, y) pixels: show the card of what is there."""
        if self.playing:
            return
        if self._located != self.stage.moves:
            # a locator does not notice by itself that the points of its mesh have moved
            for locator in self._locators:
                locator.ForceBuildLocator()
            self._located = self.stage.moves
        if not self._picker.Pick(x, y, 0, self.stage.plotter.renderer):
            return
        body = self.stage.body_at(self._picker.GetActor(), self._picker.GetCellId())
        if body is not None and str(self.scene.cards[body]) != self.card:
            self.card = str(self.scene.cards[body])
            self.write()

    def tick(self) -> None:
        """Time passes."""
        if not self.playing:
            return
        playback = self._need_playback()
        self._frame = (self._frame + _FRAMES_A_TICK) % len(playback.x)
        self._now = moment_of(self.scene, playback, self._frame)
        self.stage.stand(explode=self.stage.explode, displacements=self._now.moved)
        self._paint()
        self.write()

    def frame(self) -> None:
        """Look at all that is shown, or at what was found, from the direction of the preset."""
        points = self.stage.points(self.stage.found or None)
        self.stage.look(pose(self.preset, points, self.stage.aspect))

    def write(self) -> None:
        """The words in the window's corners: what is going on and pointed at, and what the colours mean."""
        plotter = self.stage.plotter
        head = self._now.title if self.typed is None else f"search: {self.typed}_"
        plotter.add_text(
            f"{head}\n\n{self.card or 'h: help'}",
            position="upper_left",
            font_size=9,
            color="black",
            font="courier",
            name="head",
            render=False,
        )
        plotter.remove_legend(render=False)
        keys = self.scene.painter.legend(self.colour)
        plotter.add_legend(
            [[key.words, key.colour] for key in keys],
            face="rectangle",
            loc="upper right",
            size=(0.17, 0.026 * len(keys)),
            border=False,
            bcolor="white",
            background_opacity=0.7,
        )
        plotter.render()

    def _paint(self) -> None:
        if self.colour is ColourBy.STATE:
            self._need_playback()
        self.stage.paint(self.scene.painter.paint(self.colour, self._now.x, self._now.waves))

    def _need_playback(self) -> Playback:
        """The simulation, run when it is first asked for."""
        if self._playback is None:
            try:
                self._playback = play(self.scene.built, self._scenario)
            except UsageError as problem:
                x, waves = at_rest(self.scene.built)
                self._playback = Playback(str(problem), x[None], waves[None].repeat(40, axis=0), 1, ("",))
            self._frame = self._playback.frame(float(self._playback.cycles)) - 1
            self._now = moment_of(self.scene, self._playback, max(self._frame, 0))
        return self._playback

    def _type(self, name: str, code: str) -> None:
        typed = self.typed or ""
        if name in ("Return", "KP_Enter"):
            self.typed = None
            self.search(typed)
        elif name == "Escape":
            self.typed = None
            self.stage.mark(())
        elif name == "BackSpace":
            self.typed = typed[:-1]
        elif code and code.isprintable():
            self.typed = typed + code


def _quiet_style() -> Any:
    """Turning and zooming as usual, but VTK's own keys (w wireframe, e exit ...) off: letters are ours."""
    style = vtk.vtkInteractorStyleTrackballCamera()
    style.AddObserver("CharEvent", lambda *_: None)
    return style
