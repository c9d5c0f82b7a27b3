"""``mdlcad cells``: list the cell libraries, show one, or measure where one works."""

from __future__ import annotations

import argparse
from pathlib import Path

from mdlcad.cli.kinds import HOLDS, Commands, jobs, progress, say, seed, show, verdict
from mdlcad.errors import UsageError


def register(commands: Commands[argparse.ArgumentParser]) -> None:
    """Add the command."""
    listing = commands.add_parser("cells", help="list the cell libraries, show one, or measure where one works")
    listing.add_argument("name", nargs="?", metavar="NAME|PATH")
    form = listing.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="all numbers, as JSON")
    form.add_argument("--liberty", action="store_true", help="what logic synthesis sees, as Liberty text")
    form.add_argument(
        "--characterise",
        action="store_true",
        help="run cells and a reference circuit over period, damping, fan-out and spread; exit 1 if the library's "
        "numbers are not as measured",
    )
    measure = listing.add_argument_group("with --characterise")
    measure.add_argument("-o", dest="folder", type=Path, metavar="DIR", help="where to (exports/cells/NAME)")
    measure.add_argument("--quick", action="store_true", help="a slice of it")
    measure.add_argument("--seed", type=seed, default=0, metavar="N", help="seed of everything random (%(default)s)")
    measure.add_argument("--jobs", type=jobs, default=2, metavar="N", help="processors to use (%(default)s)")
    listing.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from mdlcad.datafolder import list_data
    from mdlcad.mapping import liberty_view, load_library
    from mdlcad.mapping.describe import describe

    if options.characterise:
        return _characterise(options)
    if options.folder or options.quick:
        raise UsageError(f"{'-o' if options.folder else '--quick'} says how to measure; give --characterise with it")
    if options.name is None:
        for name in list_data("cells", ""):
            say(f"{name:<12} {load_library(name).title}")
        return HOLDS
    library = load_library(options.name)
    if options.json:
        show(library)
    elif options.liberty:
        say(liberty_view(library).rstrip())
    else:
        say(describe(library))
    return HOLDS


def _characterise(options: argparse.Namespace) -> int:
    from mdlcad.characterise.run import Task, characterise
    from mdlcad.datafolder import list_data
    from mdlcad.mapping import load_library

    if options.name is None:
        raise UsageError(f"--characterise needs the name of a library: {', '.join(list_data('cells', ''))}")
    place = options.folder or Path("exports") / "cells" / load_library(options.name).name
    try:
        broken = characterise(Task(options.name, place, options.seed, options.jobs, not options.quick), say, progress)
    finally:
        progress("")
    return verdict(broken)
