"""Puts a packed scene, the scripts and the style into the page's frame."""

from __future__ import annotations

import json
from importlib.resources import files

import jinja2

from mdlcad.view.page.pack import pack
from mdlcad.view.playback import play
from mdlcad.view.scene import Look, Scene

_SCRIPTS = ("data.js", "camera.js", "draw.js", "search.js", "controls.js", "main.js")


def page(scene: Scene, look: Look) -> bytes:
    """The page, HTML with everything in it, opened at ``look``; the same bytes for the same build, look and version.

    Raises:
        UsageError: the look asks for a plate, a name or a scenario that there is not.
    """
    scene.plates(look), scene.found(look)
    packed = pack(scene, look, play(scene.built, look.scenario))
    # "<" would end the script if a name held "</script>"
    facts = json.dumps(packed.facts, separators=(",", ":"), ensure_ascii=True).replace("<", "\\u003c")
    folder = files("mdlcad.view.page")

    def text(name: str) -> str:
        return folder.joinpath(name).read_text(encoding="utf-8")

    frame = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, keep_trailing_newline=True)
    return (
        frame.from_string(text("page.html"))
        .render(
            design=scene.built.report.design,
            style=text("page.css"),
            script="\n".join(text(name) for name in _SCRIPTS),
            facts=facts,
            block=packed.block,
        )
        .encode("utf-8")
    )
