"""The page of a comparison: one HTML file that needs nothing else, with both layouts and every change."""

from __future__ import annotations

from pathlib import Path

import msgspec

from mdlcad.compare.bodies import read_bodies
from mdlcad.compare.change import Comparison, Spot
from mdlcad.compare.folders import Build, NotComparable, open_build, read
from mdlcad.compare.scene import Drawn, Scene, drawn_bodies, drawn_layout, make_scene
from mdlcad.compare.words import SYMBOLS, counted, verdict_words
from mdlcad.errors import UsageError
from mdlcad.mechanics import Sizing
from mdlcad.placement.placement import Placement
from mdlcad.report.templates import environment
from mdlcad.routing.layout import Layout

# a level lists no more than this on the page; the JSON has all
MOST_CHANGES = 400
# a plate shows no more marks than this
MOST_MARKS = 30


def page(comparison: Comparison, folder_a: Path, folder_b: Path) -> bytes:
    """The HTML of a comparison of two folders.

    Raises:
        UsageError: a folder is no build.
    """
    scene, missing = _scene(open_build(folder_a), open_build(folder_b))
    text = (
        environment("mdlcad.compare", "templates")
        .get_template("diff.html")
        .render(
            comparison=comparison,
            verdict=verdict_words(comparison),
            symbols=SYMBOLS,
            counted=counted,
            most=MOST_CHANGES,
            missing=missing,
            scene=_data(scene) if scene is not None else None,
            marks=_data(_marks(comparison)),
        )
    )
    return text.encode()


def _marks(comparison: Comparison) -> list[Spot]:
    """The largest places of every plate, in the order of their numbers."""
    return [
        spot
        for level in comparison.levels
        if level.name == "plates"
        for change in level.changes
        for spot in change.spots[:MOST_MARKS]
    ]


def _data(value: Scene | list[Spot]) -> str:
    """JSON that may stand inside of a script element."""
    return msgspec.json.encode(value).decode().replace("</", "<\\/")


def _scene(a: Build, b: Build) -> tuple[Scene | None, list[str]]:
    drawn, missing = [], []
    for build in (a, b):
        try:
            drawn.append(_drawn(build))
        except (NotComparable, UsageError) as problem:
            drawn.append([])
            missing.append(str(problem))
    return (make_scene(drawn[0], drawn[1]) if any(drawn) else None), missing


def _drawn(build: Build) -> list[Drawn]:
    """The bodies of a build, or else its placement and routing."""
    try:
        return drawn_bodies(read_bodies(build))
    except NotComparable:
        placement, sizing = read(build, "placement.json", Placement), read(build, "sizing.json", Sizing)
        layout = read(build, "layout.json", Layout) if build.has("layout.json") else None
        return drawn_layout(placement, layout, sizing.rules)
