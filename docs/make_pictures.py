"""Renders the pictures of docs/view.md and docs/compare.md anew: ./run python docs/make_pictures.py MAZE LARGE A B

MAZE and LARGE are builds to look at (the maze robot and a larger device), A and B two builds of one program. Pages are
shown in a browser; without one their two pictures stay as they are, and it says so.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from PIL import Image

from mdlcad.cli import main as mdlcad
from tests.browser import BROWSER, browse

IMAGES = Path(__file__).resolve().parent / "images"
MOMENTS = ("0", "1.5", "3")


def main(maze: str, large: str, first: str, second: str) -> None:
    """Every picture, from builds by their folders."""
    look(large, "view-exploded", "--explode", "0.6", "--size", "900x720")
    look(maze, "view-margin", "--colour", "margin", "--plates", "unit,V,H0,H1", "--size", "900x640")
    look(maze, "view-find", "--find", "drive[1]", "--size", "1000x640")
    with tempfile.TemporaryDirectory() as folder:
        strip(maze, Path(folder))
        if BROWSER is None:
            print("no browser is on this machine: view-page.png and diff.png stay as they were")
            return
        page = Path(folder) / "page.html"
        run("view", maze, "--html", str(page))
        shoot(
            f"{page.as_uri()}#colour=state&explode=0.25&plates=clock-0,unit,V,H0,H1&at=1.9",
            "view-page",
            "1200,760",
            Path(folder),
        )
        run("diff", first, second, "--html", str(page))
        shoot(page.as_uri(), "diff", "1400,920", Path(folder))


def run(*arguments: str) -> None:
    """One command of mdlcad; 1 says that builds differ."""
    if mdlcad(list(arguments)) not in (0, 1):
        raise SystemExit(f"mdlcad {' '.join(arguments)}: failed")


def look(build: str, name: str, *options: str) -> None:
    """One picture of a build."""
    run("view", build, "--screenshot", str(IMAGES / f"{name}.png"), *options)


def strip(maze: str, folder: Path) -> None:
    """Moments of a decision side by side."""
    pictures = []
    for moment in MOMENTS:
        path = folder / f"{moment}.png"
        options = ("--colour", "state", "--camera", "top", "--at", moment, "--size", "640x640")
        run("view", maze, "--screenshot", str(path), *options)
        pictures.append(Image.open(path).convert("RGB"))
    whole = Image.new("RGB", (sum(one.width for one in pictures), pictures[0].height))
    for place, one in enumerate(pictures):
        whole.paste(one, (place * one.width, 0))
    whole.save(IMAGES / "view-run.png", optimize=True)


def shoot(address: str, name: str, size: str, folder: Path) -> None:
    """A page as a browser without a network shows it."""
    browse(folder, size, f"--screenshot={IMAGES / f'{name}.png'}", address)


if __name__ == "__main__":
    main(*sys.argv[1:])
