"""Exit 0 when all holds, 1 when a sign-off does not (or a comparison differs), 2 when the input cannot be used."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence

from mdlcad import __version__
from mdlcad.cli import build, cells, check, diff, history, processes, schema, simulate, verify, view
from mdlcad.cli.kinds import FAILS, UNUSABLE
from mdlcad.errors import InputError, SignoffError, UsageError

COMMANDS = (build, check, verify, view, diff, history, simulate, cells, processes, schema)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; the exit code."""
    options = _parser().parse_args(arguments)
    try:
        return int(options.run(options))
    except InputError as problem:
        print(problem, file=sys.stderr)
        return UNUSABLE
    except UsageError as problem:
        print(f"mdlcad: error: {problem}", file=sys.stderr)
        return UNUSABLE
    except SignoffError as problem:
        print(f"mdlcad: does not hold: {problem}", file=sys.stderr)
        return FAILS
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return UNUSABLE
    except KeyboardInterrupt:
        print("mdlcad: stopped", file=sys.stderr)
        return 130


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="mdlcad", description="Compile a mechanical description to a device.")
    parser.add_argument("--version", action="version", version=f"mdlcad {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for command in COMMANDS:
        command.register(commands)
    return parser
