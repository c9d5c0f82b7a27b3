"""``mdlcad history``: many builds in figures."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from mdlcad.cli.kinds import FAILS, HOLDS, UNUSABLE, Commands, say, write_output


def register(commands: Commands[argparse.ArgumentParser]) -> None:
    """Add the command."""
    history = commands.add_parser(
        "history",
        help="tabulate builds: size, masses, margins, plates, extent, time",
        description="Tabulate builds in the order given. Exit 1: a build was edited since it was made, 2: one cannot "
        "be read as it should.",
    )
    history.add_argument("folders", type=Path, nargs="+", metavar="DIR")
    history.add_argument("--json", type=Path, metavar="P", help="write the table as JSON (mdlcad schema history)")
    history.add_argument("--csv", type=Path, metavar="P", help="write the table as CSV")
    history.add_argument("--plot", type=Path, metavar="P", help="draw it; P ends in .png or .svg")
    history.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from mdlcad.artefact import to_json
    from mdlcad.compare.history import as_csv, history_of
    from mdlcad.compare.history_table import table

    found = history_of(options.folders)
    if options.plot:
        from mdlcad.compare.history_plot import plot

        write_output(options.plot, plot(found, options.plot.suffix.removeprefix(".")))
    if options.json:
        write_output(options.json, to_json(found))
    if options.csv:
        write_output(options.csv, as_csv(found))
    for line in table(found):
        say(line)
    for words in found.troubles:
        print(f"mdlcad: error: {words}", file=sys.stderr)
    edited = [f"{row.folder}: {name} is not the file that was built" for row in found.rows for name in row.edited]
    for words in edited:
        print(f"mdlcad: does not hold: {words} (its SHA-256 differs from report.json)", file=sys.stderr)
    return UNUSABLE if found.troubles else FAILS if edited else HOLDS
