"""``mdlcad build``: a program to a build folder."""

from __future__ import annotations

import argparse
from pathlib import Path

from mdlcad.cli.kinds import Commands, bed, jobs, length, say, seed, verdict


def register(commands: Commands[argparse.ArgumentParser]) -> None:
    """Add the command."""
    build = commands.add_parser("build", help="compile FILE into a build folder")
    build.add_argument("file", type=Path, metavar="FILE", help="an MDL program (with --from: a build folder)")
    build.add_argument("-o", dest="folder", type=Path, metavar="DIR", help="build folder (exports/NAME)")
    build.add_argument(
        "--cells", metavar="NAME|PATH", help="cell library (parametron; with --from: the one in the folder)"
    )
    build.add_argument("--process", default="pom_cut", metavar="NAME|PATH", help="fabrication process (%(default)s)")
    build.add_argument("--seed", type=seed, default=0, metavar="N", help="seed of everything random (%(default)s)")
    extent = build.add_mutually_exclusive_group()
    extent.add_argument("--pitch", type=length, metavar="MM", help="size of a grid unit (as small as can be routed)")
    extent.add_argument("--fit", type=bed, metavar="WxH", help="largest size of the boundary in mm, either way round")
    build.add_argument("--from", dest="first", metavar="STAGE", help="take earlier artefacts from the folder")
    build.add_argument("--to", dest="last", metavar="STAGE", help="stop after this stage")
    build.add_argument("--jobs", type=jobs, default=2, metavar="N", help="processors to use (%(default)s)")
    build.add_argument("--kerf", action="store_true", help="draw DXF files wider by the process's kerf (as designed)")
    build.add_argument(
        "--fresh", action="store_true", help="rerun every stage, also those whose inputs are as in the folder's build"
    )
    _add_synthesis(build.add_argument_group("synthesis options", "of libraries of kind two_phase"))
    build.set_defaults(run=_run)


def _add_synthesis(group: argparse._ArgumentGroup) -> None:
    """The options of the mapping; each of them, if not given, is what the library's file says."""
    on_off = argparse.BooleanOptionalAction
    group.add_argument("--parameters", metavar="NAME", help="the library's parameter set")
    group.add_argument("--clock-length", type=int, metavar="N", help="power-clock cycles from tick to tick")
    group.add_argument("--clock", action=on_off, help="make the clock, or leave the tick to be driven from outside")
    group.add_argument("--branching", action=on_off, help="buffer trees where an output drives more than the limit")
    group.add_argument("--io-gates", action=on_off, help="a gate of its own for each sensor and each actuator")
    group.add_argument("--buffer", metavar="CELL", help="the library's cell that serves as a buffer")


def _run(options: argparse.Namespace) -> int:
    from mdlcad.flow.build import Request, build
    from mdlcad.flow.kept import Reuse
    from mdlcad.flow.state import Outlines
    from mdlcad.mapping import MappingRequest
    from mdlcad.routing.driver import Size

    place, broken = build(
        Request(
            source=options.file,
            place=options.folder,
            cells=options.cells,
            mapping=MappingRequest(
                parameters=options.parameters,
                clock_length=options.clock_length,
                clock=options.clock,
                branching=options.branching,
                io_gates=options.io_gates,
                buffer=options.buffer,
            ),
            process=options.process,
            seed=options.seed,
            first=options.first,
            last=options.last,
            workers=options.jobs,
            size=Size(options.pitch, options.fit),
            outlines=Outlines.KERF if options.kerf else Outlines.AS_DESIGNED,
            reuse=Reuse.FRESH if options.fresh else Reuse.KEEP,
        ),
        say,
    )
    say(f"written to {place}")
    return verdict(broken)
