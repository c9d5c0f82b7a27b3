"""``mdlcad processes``: list the fabrication processes, or show one."""

from __future__ import annotations

import argparse

from mdlcad.cli.kinds import HOLDS, Commands, say, show


def register(commands: Commands[argparse.ArgumentParser]) -> None:
    """Add the command."""
    listing = commands.add_parser("processes", help="list the fabrication processes, or show one")
    listing.add_argument("name", nargs="?", metavar="NAME")
    listing.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from mdlcad.mechanics import load_process, process_names

    if options.name is None:
        say("\n".join(process_names()))
    else:
        show(load_process(options.name))
    return HOLDS
