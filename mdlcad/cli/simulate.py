"""``mdlcad simulate``: what a built device does in time."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from mdlcad.cli.kinds import HOLDS, Commands, jobs, progress, say, seed, verdict
from mdlcad.errors import UsageError

_SAMPLES = 100


def register(commands: Commands[argparse.ArgumentParser]) -> None:
    """Add the command."""
    simulate = commands.add_parser(
        "simulate", help="let a built device act in a world, follow a script, or vary its parameters"
    )
    simulate.add_argument("folder", type=Path, metavar="DIR")
    simulate.add_argument("--scenario", metavar="NAME|PATH", help="which (the one named after the design)")
    simulate.add_argument(
        "--spread", type=_spreads, metavar="S[,S...]", help="estimate the yield at these relative standard deviations"
    )
    simulate.add_argument(
        "--samples", type=_samples, metavar="N", help=f"with --spread: devices to simulate ({_SAMPLES})"
    )
    simulate.add_argument("--seed", type=seed, metavar="N", help="with --spread: seed of the devices (0)")
    simulate.add_argument("--jobs", type=jobs, default=2, metavar="N", help="processors to use (%(default)s)")
    simulate.set_defaults(run=_run)


def _spreads(text: str) -> tuple[float, ...]:
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        values = ()
    if not values or any(not (math.isfinite(value) and 0 < value <= 1) for value in values):
        raise argparse.ArgumentTypeError(f"{text!r} should be a number above 0 and at most 1, or several with commas")
    return values


def _samples(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} should be a whole number of at least 1")
    return int(text)


def _run(options: argparse.Namespace) -> int:
    if options.spread is None:
        for flag, value in (("--samples", options.samples), ("--seed", options.seed)):
            if value is not None:
                raise UsageError(f"{flag} says how to vary a device; give --spread S with it")
        from mdlcad.scenario import run_scenario

        return verdict(run_scenario(options.folder, options.scenario, say))
    if options.scenario is not None:
        raise UsageError("--spread and --scenario are two different runs; give one of them")
    from mdlcad.characterise import run_spread

    try:
        run_spread(
            options.folder,
            options.spread,
            options.samples or _SAMPLES,
            options.seed or 0,
            options.jobs,
            say,
            progress,
        )
    finally:
        progress("")
    return HOLDS
