"""``mdlcad cells``: list the cell libraries, or show one."""

from __future__ import annotations

import argparse

from mdlcad.cli.kinds import HOLDS, Commands, say, show


def register(commands: Commands[argparse.ArgumentParser]) -> None:
    """Add the command."""
    listing = commands.add_parser("cells", help="list the cell libraries, or show one")
    listing.add_argument("name", nargs="?", metavar="NAME")
    listing.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from mdlcad.datafolder import list_data
    from mdlcad.mapping import load_library

    if options.name is None:
        say("\n".join(list_data("cells", "")))
    else:
        show(load_library(options.name))
    return HOLDS
