"""A build in a notebook: it shows itself, and the viewer runs inline."""

from __future__ import annotations

import base64
import html
from dataclasses import replace
from functools import cached_property
from pathlib import Path

from mdlcad.view.camera import Preset
from mdlcad.view.colours import ColourBy
from mdlcad.view.page import page
from mdlcad.view.scene import Look, Scene, open_scene
from mdlcad.view.still import still

_PICTURE = (900, 640)


class Frame:
    """A page inside a notebook: whole in itself, with no server behind it."""

    def __init__(self, data: bytes, height: int) -> None:
        self._data = data
        self._height = height

    def _repr_html_(self) -> str:
        source = html.escape(self._data.decode("utf-8"), quote=True)
        return (
            f'<iframe srcdoc="{source}" style="width: 100%; height: {self._height}px; border: 1px solid #d5dae1; '
            'border-radius: 8px" allow="fullscreen"></iframe>'
        )


class Build:
    """A finished build, opened to be looked at; as the last line of a notebook's cell it shows itself."""

    def __init__(self, folder: Path) -> None:
        """Read the build in ``folder``.

        Raises:
            UsageError: it is not a whole build; the message names the file.
        """
        self.folder = folder
        self.scene: Scene = open_scene(folder)

    def __repr__(self) -> str:
        return f"<build of {self.scene.built.report.design}: " + ", ".join(f"{k} {v}" for k, v in self.figures) + ">"

    @cached_property
    def figures(self) -> tuple[tuple[str, str], ...]:
        """The key figures, in words."""
        built = self.scene.built
        report = built.report
        found = [
            ("cells", report.cells),
            ("process", report.process),
            ("units", str(len(built.network.masses))),
            ("couplings", str(len(built.network.couplings))),
            ("cycles a decision", str(built.network.cycles_per_tick)),
        ]
        if report.extent_mm is not None:
            found.append(("size", " x ".join(f"{side:.0f}" for side in report.extent_mm) + " mm"))
        if report.drc is not None:
            broken = {rule: count for rule, count in report.drc.items() if count}
            words = ", ".join(f"{rule} {count}" for rule, count in broken.items())
            found.append(("design rules", words or "all hold"))
        return tuple(found)

    def picture(self, look: Look | None = None) -> bytes:
        """PNG of the device.

        Raises:
            UsageError: the look asks for what the device has not.
        """
        return still(self.scene, look or Look(size=_PICTURE))

    def show(
        self,
        *,
        colour: str = "part",
        explode: float = 0.0,
        camera: str = "iso",
        find: str | None = None,
        scenario: str | None = None,
        height: int = 640,
    ) -> Frame:
        """The viewer, inline: turn, take apart, colour, point at, search, play.

        Args:
            colour: part, phase, polarity, state or margin; camera: iso, top, bottom, front, back, left or right.
            height: of the frame, pixels.

        Raises:
            UsageError: there is nothing called ``find``, or the scenario does not fit the device.
            ValueError: no such colouring or camera.
        """
        look = Look(explode=explode, colour=ColourBy(colour), camera=Preset(camera), find=find, scenario=scenario)
        return Frame(page(self.scene, look), height)

    def _repr_html_(self) -> str:
        small = self.picture(replace(Look(), size=_PICTURE))
        source = base64.b64encode(small).decode("ascii")
        rows = "".join(
            f'<tr><td style="text-align: left; color: #5b636e">{html.escape(name)}</td>'
            f'<td style="text-align: left">{html.escape(value)}</td></tr>'
            for name, value in self.figures
        )
        design = html.escape(self.scene.built.report.design)
        return (
            '<div style="display: flex; flex-wrap: wrap; gap: 24px; align-items: center">'
            f'<img alt="the device {design}" style="max-width: 560px; width: 100%" '
            f'src="data:image/png;base64,{source}">'
            f"<div><h3>{design}</h3><table>{rows}</table></div></div>"
        )
