"""``mdlcad cells``: list the cell libraries, or show one."""

from __future__ import annotations

import argparse

from mdlcad.cli.kinds import HOLDS, Commands, say, show


def register(commands: Commands[argparse.ArgumentParser]) -> None:
    """Add the command."""
    listing = commands.add_parser("cells", help="list the cell libraries, or show one")
    listing.add_argument("name", nargs="?", metavar="NAME|PATH")
    form = listing.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="all numbers, as JSON")
    form.add_argument("--liberty", action="store_true", help="what logic synthesis sees, as Liberty text")
    listing.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from mdlcad.datafolder import list_data
    from mdlcad.mapping import liberty_view, load_library
    from mdlcad.mapping.describe import describe

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
