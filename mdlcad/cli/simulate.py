"""``mdlcad simulate``: what a built device does in time."""

from __future__ import annotations

import argparse
from pathlib import Path

from mdlcad.cli.kinds import Commands, say, verdict


def register(commands: Commands[argparse.ArgumentParser]) -> None:
    """Add the command."""
    simulate = commands.add_parser("simulate", help="let a built device act in a world, or follow a script")
    simulate.add_argument("folder", type=Path, metavar="DIR")
    simulate.add_argument("--scenario", metavar="NAME|PATH", help="which (the one named after the design)")
    simulate.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from mdlcad.scenario import run_scenario

    return verdict(run_scenario(options.folder, options.scenario, say))
