"""``mdlcad view``: look at a finished build, in a window, or as a picture, a page or an animation."""

from __future__ import annotations

import argparse
from pathlib import Path

from mdlcad.cli.kinds import HOLDS, Commands, say


def register(commands: Commands[argparse.ArgumentParser]) -> None:
    """Add the command."""
    view = commands.add_parser(
        "view",
        help="look at a build: a window, --screenshot, --html or --animate",
        description="Look at the build in DIR. Without --screenshot, --html or --animate it opens a window.",
    )
    view.add_argument("folder", type=Path, metavar="DIR")
    out = view.add_argument_group("without a screen")
    out.add_argument("--screenshot", type=Path, metavar="P", help="write a picture (.png)")
    out.add_argument("--html", type=Path, metavar="P", help="write one self-contained page (.html)")
    out.add_argument("--animate", type=Path, metavar="P", help="play a simulation to a .gif, or .mp4 with ffmpeg")
    look = view.add_argument_group("what is seen")
    look.add_argument("--plates", metavar="A,B", help="plates to show (all but the cover); 'all' for every one")
    look.add_argument("--explode", type=_share, default=0.0, metavar="F", help="take the plates apart, 0 to 1")
    look.add_argument(
        "--colour",
        "--color",
        default="part",
        choices=("part", "phase", "polarity", "state", "margin"),
        help="what colours stand for (%(default)s)",
    )
    look.add_argument(
        "--camera",
        default="iso",
        choices=("iso", "top", "bottom", "front", "back", "left", "right"),
        help="where to look from (%(default)s)",
    )
    look.add_argument("--size", type=_size, default=None, metavar="WxH", help="pixels (1600x1200; animation 960x720)")
    look.add_argument(
        "--find", "--search", metavar="NAME", help="mark what has this name, and fill the picture with it"
    )
    run = view.add_argument_group("simulation")
    run.add_argument("--scenario", metavar="NAME|PATH", help="what is played (the scenario of the design)")
    run.add_argument("--at", type=_cycles, metavar="C", help="the moment of a picture, in clock cycles from power-up")
    run.add_argument("--cycles", type=_cycles, metavar="N", help="clock cycles to animate (three decisions)")
    view.add_argument("--edited", action="store_true", help="look at files that were changed after they were built")
    view.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from mdlcad.view.ask import Wanted, view  # VTK takes seconds to load
    from mdlcad.view.built import Trust
    from mdlcad.view.camera import Preset
    from mdlcad.view.colours import ColourBy
    from mdlcad.view.scene import Look

    plates = None if options.plates is None else tuple(name.strip() for name in options.plates.split(","))
    view(
        options.folder,
        Wanted(
            look=Look(
                plates=plates,
                explode=options.explode,
                colour=ColourBy(options.colour),
                camera=Preset(options.camera),
                find=options.find,
                at=options.at,
                scenario=options.scenario,
            ),
            size=options.size,
            cycles=options.cycles,
            screenshot=options.screenshot,
            html=options.html,
            animate=options.animate,
            trust=Trust.EDITED if options.edited else Trust.BUILT,
        ),
        say,
    )
    return HOLDS


def _share(text: str) -> float:
    value = float(text)
    if not 0.0 <= value <= 1.0:
        raise argparse.ArgumentTypeError("from 0 (assembled) to 1 (wholly apart)")
    return value


def _cycles(text: str) -> float:
    value = float(text)
    if not 0.0 <= value < 1e6:
        raise argparse.ArgumentTypeError("a number of clock cycles, 0 or more")
    return value


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.lower().partition("x")
    if not (width.isdigit() and height.isdigit() and all(100 <= int(side) <= 8000 for side in (width, height))):
        raise argparse.ArgumentTypeError("WIDTHxHEIGHT in pixels, each from 100 to 8000")
    return int(width), int(height)
