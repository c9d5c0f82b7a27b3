"""The command line: thin. Exit 0 when all holds, 1 when a sign-off does not, 2 when the input cannot be used."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from mdlcad import __version__
from mdlcad.errors import InputError, SignoffError, UsageError

HOLDS, FAILS, UNUSABLE = 0, 1, 2


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

    build = commands.add_parser("build", help="compile FILE into a build folder")
    build.add_argument("file", type=Path, metavar="FILE", help="an MDL program (with --from: a build folder)")
    build.add_argument("-o", dest="folder", type=Path, metavar="DIR", help="build folder (exports/NAME)")
    build.add_argument("--cells", default="parametron", metavar="NAME|PATH", help="cell library (%(default)s)")
    build.add_argument("--process", default="pom_cut", metavar="NAME|PATH", help="fabrication process (%(default)s)")
    build.add_argument("--seed", type=_seed, default=0, metavar="N", help="seed of everything random (%(default)s)")
    build.add_argument("--from", dest="first", metavar="STAGE", help="take earlier artefacts from the folder")
    build.add_argument("--to", dest="last", metavar="STAGE", help="stop after this stage")
    build.add_argument("--jobs", type=_jobs, default=2, metavar="N", help="processors to use (%(default)s)")
    build.set_defaults(run=_build)

    check = commands.add_parser("check", help="parse and lint FILE only")
    check.add_argument("file", type=Path, metavar="FILE")
    check.set_defaults(run=_check)

    verify = commands.add_parser("verify", help="sign a finished build off again, from its files alone")
    verify.add_argument("folder", type=Path, metavar="DIR")
    verify.add_argument("--jobs", type=_jobs, default=2, metavar="N", help="processors to use (%(default)s)")
    verify.set_defaults(run=_verify)

    simulate = commands.add_parser("simulate", help="let a built device act in a world, or follow a script")
    simulate.add_argument("folder", type=Path, metavar="DIR")
    simulate.add_argument("--scenario", metavar="NAME|PATH", help="which (the one named after the design)")
    simulate.set_defaults(run=_simulate)

    for name, words in (("cells", "cell libraries"), ("processes", "fabrication processes")):
        listing = commands.add_parser(name, help=f"list the {words}, or show one")
        listing.add_argument("name", nargs="?", metavar="NAME")
        listing.set_defaults(run=_cells if name == "cells" else _processes)

    schema = commands.add_parser("schema", help="print the JSON schema of an artefact")
    schema.add_argument("name", nargs="?", metavar="NAME")
    schema.set_defaults(run=_schema)
    return parser


def _seed(text: str) -> int:
    value = int(text)
    if not 0 <= value < 2**31:
        raise argparse.ArgumentTypeError("a seed is a whole number from 0 to 2147483647")
    return value


def _jobs(text: str) -> int:
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError("at least one processor")
    return value


def _say(line: str) -> None:
    print(line, flush=True)


def _build(options: argparse.Namespace) -> int:
    from mdlcad.flow.build import Request, build

    place, broken = build(
        Request(
            source=options.file,
            place=options.folder,
            cells=options.cells,
            process=options.process,
            seed=options.seed,
            first=options.first,
            last=options.last,
            workers=options.jobs,
        ),
        _say,
    )
    _say(f"written to {place}")
    return _verdict(broken)


def _verify(options: argparse.Namespace) -> int:
    from mdlcad.flow.verify import verify

    return _verdict(verify(options.folder, options.jobs, _say))


def _simulate(options: argparse.Namespace) -> int:
    from mdlcad.scenario import run_scenario

    return _verdict(run_scenario(options.folder, options.scenario, _say))


def _verdict(broken: list[str]) -> int:
    for words in broken:
        print(f"mdlcad: does not hold: {words}", file=sys.stderr)
    return FAILS if broken else HOLDS


def _check(options: argparse.Namespace) -> int:
    from mdlcad.language import read_device
    from mdlcad.synthesis import synthesise

    device = read_device(options.file)
    synthesise(device)
    _say(f"{options.file}: {device.name}: no errors")
    return HOLDS


def _cells(options: argparse.Namespace) -> int:
    from mdlcad.datafolder import list_data
    from mdlcad.mapping import load_library

    if options.name is None:
        _say("\n".join(list_data("cells", "")))
    else:
        _show(load_library(options.name))
    return HOLDS


def _processes(options: argparse.Namespace) -> int:
    from mdlcad.mechanics import load_process, process_names

    if options.name is None:
        _say("\n".join(process_names()))
    else:
        _show(load_process(options.name))
    return HOLDS


def _show(artefact: object) -> None:
    from mdlcad.artefact import to_json

    sys.stdout.write(to_json(artefact).decode())


def _schema(options: argparse.Namespace) -> int:
    from mdlcad.flow.schemas import ARTEFACTS, schema

    if options.name is None:
        _say("\n".join(sorted(ARTEFACTS)))
    else:
        sys.stdout.write(schema(options.name).decode())
    return HOLDS


if __name__ == "__main__":
    sys.exit(main())
