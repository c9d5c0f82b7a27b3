"""``mdlcad diff``: two builds, level by level."""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

from mdlcad.cli.kinds import FAILS, HOLDS, UNUSABLE, Commands, say


def register(commands: Commands[argparse.ArgumentParser]) -> None:
    """Add the command."""
    diff = commands.add_parser(
        "diff",
        help="compare two builds: exit 0 the same, 1 different, 2 trouble",
        description="Compare two builds at every level, from the program to the plates. Exit 0: the same, 1: "
        "different, 2: a file cannot be read as it should.",
    )
    diff.add_argument("a", type=Path, metavar="DIR_A")
    diff.add_argument("b", type=Path, metavar="DIR_B")
    diff.add_argument("--json", type=Path, metavar="P", help="write the comparison as JSON (mdlcad schema diff)")
    diff.add_argument("--html", type=Path, metavar="P", help="write a page with the two layouts side by side")
    diff.add_argument(
        "--tolerance-um",
        type=_tolerance,
        default=1.0,
        metavar="X",
        help="lengths that differ by no more are the same (%(default)s)",
    )
    diff.add_argument("-v", "--verbose", action="count", default=0, help="more changes, with their fields; -vv: all")
    diff.add_argument("-q", "--quiet", action="store_true", help="the verdict alone")
    diff.set_defaults(run=_run)


def _tolerance(text: str) -> float:
    value = float(text)
    if not (math.isfinite(value) and 0.0 <= value <= 1e5):
        raise argparse.ArgumentTypeError("a tolerance is 0 to 100000 um")
    return value


def _run(options: argparse.Namespace) -> int:
    from mdlcad.artefact import to_json
    from mdlcad.cli.kinds import write_output
    from mdlcad.compare.change import Verdict
    from mdlcad.compare.compare import compare
    from mdlcad.compare.words import Verbosity, told

    found = compare(options.a, options.b, options.tolerance_um)
    verbosity = Verbosity.VERDICT if options.quiet else Verbosity(min(1 + options.verbose, Verbosity.ALL))
    if options.json:
        write_output(options.json, to_json(found))
    if options.html:
        from mdlcad.compare.page import page

        write_output(options.html, page(found, options.a, options.b))
    for line in told(found, verbosity):
        say(line)
    for words in found.troubles:
        print(f"mdlcad: error: {words}", file=sys.stderr)
    return {Verdict.SAME: HOLDS, Verdict.DIFFERENT: FAILS, Verdict.TROUBLE: UNUSABLE}[found.verdict]
