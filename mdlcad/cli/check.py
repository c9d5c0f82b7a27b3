"""``mdlcad check``: parse and lint only."""

from __future__ import annotations

import argparse
from pathlib import Path

from mdlcad.cli.kinds import HOLDS, Commands, say, warn


def register(commands: Commands[argparse.ArgumentParser]) -> None:
    """Add the command."""
    check = commands.add_parser("check", help="parse and lint FILE only")
    check.add_argument("file", type=Path, metavar="FILE")
    check.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from mdlcad.errors import InputError
    from mdlcad.language import anchored, placed, read_device
    from mdlcad.synthesis import synthesise
    from mdlcad.synthesis.unused import unused_sensors

    device = read_device(options.file)
    try:
        netlist = synthesise(device)
    except InputError as problem:
        raise anchored(problem, options.file) from None
    warn(placed(unused_sensors(device, netlist), options.file))
    say(f"{options.file}: {device.name}: no errors")
    return HOLDS
