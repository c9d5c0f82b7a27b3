"""The command line: thin, one file a command."""

from mdlcad.cli.kinds import FAILS, HOLDS, UNUSABLE
from mdlcad.cli.main import main

__all__ = ["FAILS", "HOLDS", "UNUSABLE", "main"]
