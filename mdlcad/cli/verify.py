"""``mdlcad verify``: sign a finished build off again."""

from __future__ import annotations

import argparse
from pathlib import Path

from mdlcad.cli.kinds import Commands, jobs, say, verdict


def register(commands: Commands[argparse.ArgumentParser]) -> None:
    """Add the command."""
    verify = commands.add_parser("verify", help="sign a finished build off again, from its files alone")
    verify.add_argument("folder", type=Path, metavar="DIR")
    verify.add_argument("--jobs", type=jobs, default=2, metavar="N", help="processors to use (%(default)s)")
    verify.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from mdlcad.flow.verify import verify

    return verdict(verify(options.folder, options.jobs, say))
