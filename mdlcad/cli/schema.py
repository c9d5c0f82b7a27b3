"""``mdlcad schema``: the JSON schema of an artefact."""

from __future__ import annotations

import argparse
import sys

from mdlcad.cli.kinds import HOLDS, Commands, say


def register(commands: Commands[argparse.ArgumentParser]) -> None:
    """Add the command."""
    schema = commands.add_parser("schema", help="print the JSON schema of an artefact")
    schema.add_argument("name", nargs="?", metavar="NAME")
    schema.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from mdlcad.flow.schemas import ARTEFACTS, schema

    if options.name is None:
        say("\n".join(sorted(ARTEFACTS)))
    else:
        sys.stdout.write(schema(options.name).decode())
    return HOLDS
