"""``mdlcad build``: a program to a build folder."""

from __future__ import annotations

import argparse
from pathlib import Path

from mdlcad.cli.kinds import Commands, jobs, say, seed, verdict


def register(commands: Commands[argparse.ArgumentParser]) -> None:
    """Add the command."""
    build = commands.add_parser("build", help="compile FILE into a build folder")
    build.add_argument("file", type=Path, metavar="FILE", help="an MDL program (with --from: a build folder)")
    build.add_argument("-o", dest="folder", type=Path, metavar="DIR", help="build folder (exports/NAME)")
    build.add_argument("--cells", default="parametron", metavar="NAME|PATH", help="cell library (%(default)s)")
    build.add_argument("--process", default="pom_cut", metavar="NAME|PATH", help="fabrication process (%(default)s)")
    build.add_argument("--seed", type=seed, default=0, metavar="N", help="seed of everything random (%(default)s)")
    build.add_argument("--from", dest="first", metavar="STAGE", help="take earlier artefacts from the folder")
    build.add_argument("--to", dest="last", metavar="STAGE", help="stop after this stage")
    build.add_argument("--jobs", type=jobs, default=2, metavar="N", help="processors to use (%(default)s)")
    build.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from mdlcad.flow.build import Request, build

    place, broken = build(
        Request(
            source=options.file,
            place=options.folder,
            cells=options.cells,
            process=options.process,
            seed=options.seed,
            first=options.first,
            last=options.last,
            workers=options.jobs,
        ),
        say,
    )
    say(f"written to {place}")
    return verdict(broken)
