"""What ``mdlcad view`` does with what it was asked for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from mdlcad.artefact import write_atomic
from mdlcad.errors import UsageError
from mdlcad.view.built import Trust
from mdlcad.view.scene import Look, Scene, open_scene

_STILL = (1600, 1200)
_WINDOW = (1200, 800)  # fits the screens of small laptops
_MOVING = (960, 720)


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is to be looked at and how; without any file a window is opened.

    Attributes:
        look: how; its size is that of ``size``, or what fits.
        cycles: clock cycles to animate; None: three decisions.
        screenshot, html, animate: files to write.
    """

    look: Look
    size: tuple[int, int] | None
    cycles: float | None
    screenshot: Path | None
    html: Path | None
    animate: Path | None
    trust: Trust


def view(folder: Path, wanted: Wanted, say: Callable[[str], None]) -> None:
    """Look at the build in ``folder``.

    Raises:
        UsageError: the build cannot be read, it has not what the look asks for, a file cannot be written, or a window
            is asked for where there is no screen. Nothing is half-written.
    """
    for path, suffixes in (
        (wanted.screenshot, (".png",)),
        (wanted.html, (".html", ".htm")),
        (wanted.animate, (".gif", ".mp4")),
    ):
        if path is not None:
            _check_place(path, suffixes)
    to_file = (wanted.screenshot, wanted.html, wanted.animate) != (None, None, None)
    if not to_file:
        from mdlcad.view.window import need_screen

        need_screen()
    elif wanted.animate is not None:
        from mdlcad.view.animate import need_encoder

        need_encoder(wanted.animate)
    scene = open_scene(folder, wanted.trust)
    look = wanted.look
    if look.plates == ("all",):
        look = replace(look, plates=scene.model.plates)
    scene.plates(look), scene.found(look)  # a slip of the hand is told before anything is simulated or drawn
    if not to_file:
        from mdlcad.view.window import open_window

        open_window(scene, replace(look, size=wanted.size or _WINDOW))
        return
    for path, data in _files(scene, look, wanted):
        try:
            write_atomic(path, data)
        except OSError as problem:
            raise UsageError(f"{path}: cannot be written: {problem.strerror}") from None
        say(f"written {path}, {len(data) / 1024:.0f} KB")


def _files(scene: Scene, look: Look, wanted: Wanted) -> list[tuple[Path, bytes]]:
    made = []
    if wanted.screenshot is not None:
        from mdlcad.view.still import still

        made.append((wanted.screenshot, still(scene, replace(look, size=wanted.size or _STILL))))
    if wanted.html is not None:
        from mdlcad.view.page import page

        made.append((wanted.html, page(scene, look)))
    if wanted.animate is not None:
        from mdlcad.view.animate import animate

        made.append(
            (
                wanted.animate,
                animate(scene, replace(look, size=wanted.size or _MOVING), wanted.cycles, wanted.animate.suffix),
            )
        )
    return made


def _check_place(path: Path, suffixes: tuple[str, ...]) -> None:
    if path.suffix.lower() not in suffixes:
        raise UsageError(f"{path}: give a name that ends in {' or '.join(suffixes)}")
    if path.is_dir() or not path.parent.is_dir():
        raise UsageError(f"{path}: {'is a folder' if path.is_dir() else 'its folder is not there'}")
