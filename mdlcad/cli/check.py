"""``mdlcad check``: parse and lint only."""

from __future__ import annotations

import argparse
from pathlib import Path

from mdlcad.cli.kinds import HOLDS, Commands, say


def register(commands: Commands[argparse.ArgumentParser]) -> None:
    """Add the command."""
    check = commands.add_parser("check", help="parse and lint FILE only")
    check.add_argument("file", type=Path, metavar="FILE")
    check.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from mdlcad.errors import InputError
    from mdlcad.language import anchored, read_device
    from mdlcad.synthesis import synthesise

    device = read_device(options.file)
    try:
        synthesise(device)
    except InputError as problem:
        raise anchored(problem, options.file) from None
    say(f"{options.file}: {device.name}: no errors")
    return HOLDS
