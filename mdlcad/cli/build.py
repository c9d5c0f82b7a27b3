"""``mdlcad build``: a program to a build folder."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from mdlcad.cli.kinds import Commands, bed, count, jobs, length, say, seed, verdict, warn

if TYPE_CHECKING:
    from mdlcad.errors import Diagnostic
    from mdlcad.placement.placers import Placer

PLACERS = ("anneal", "paper")
"""The names of ``PlacerName``, whose packages take longer to load than help should."""
_PAPERS = ("iterations", "iterations_pinned", "uncross", "uncross_sweeps", "uncross_radius", "uncross_tests")


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
    build.add_argument(
        "--unit-plates",
        choices=("1", "2", "auto"),
        default="auto",
        help="how many; auto: a second one if the device cannot be placed and routed on one (%(default)s)",
    )
    build.add_argument("--from", dest="first", metavar="STAGE", help="take earlier artefacts from the folder")
    build.add_argument("--to", dest="last", metavar="STAGE", help="stop after this stage")
    build.add_argument("--jobs", type=jobs, default=2, metavar="N", help="processors to use (%(default)s)")
    build.add_argument("--kerf", action="store_true", help="draw DXF files wider by the process's kerf (as designed)")
    build.add_argument(
        "--fresh", action="store_true", help="rerun every stage, also those whose inputs are as in the folder's build"
    )
    _add_placement(build.add_argument_group("placement"))
    _add_paper(build.add_argument_group("options of --placer paper", "as the paper has them"))
    _add_synthesis(build.add_argument_group("synthesis options", "of libraries of kind two_phase"))
    build.set_defaults(run=_run)


def _add_placement(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--like",
        type=Path,
        metavar="DIR",
        help="keep places and routes of that earlier build, as far as the program still has what was there",
    )
    group.add_argument(
        "--seeds",
        type=count,
        default=1,
        metavar="N",
        help="try N seeds, --seed and those after it, on --jobs processors; the best is kept (%(default)s)",
    )
    group.add_argument(
        "--placer",
        choices=PLACERS,
        default=PLACERS[0],
        help="who decides where masses go: ours, or the paper's method (%(default)s)",
    )


def _add_paper(group: argparse._ArgumentGroup) -> None:
    group.add_argument("--iterations", type=count, metavar="N", help="of the first force-directed layout (100)")
    group.add_argument("--iterations-pinned", type=count, metavar="N", help="of the second, with the ports held (100)")
    group.add_argument(
        "--uncross", action=argparse.BooleanOptionalAction, help="remove crossings by swapping masses (--uncross)"
    )
    group.add_argument("--uncross-sweeps", type=count, metavar="N", help="most scans of all pairs to swap (30)")
    group.add_argument(
        "--uncross-radius", type=float, metavar="R", help="how far apart swapped masses may be, sites (3)"
    )
    group.add_argument("--uncross-tests", type=count, metavar="N", help="most pairs tested in all (1000000)")


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
    from mdlcad.routing.driver import Size, UnitPlates

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
            size=Size(options.pitch, options.fit, UnitPlates(options.unit_plates)),
            outlines=Outlines.KERF if options.kerf else Outlines.AS_DESIGNED,
            reuse=Reuse.FRESH if options.fresh else Reuse.KEEP,
            placer=_placer(options),
            seeds=options.seeds,
            like=options.like,
        ),
        say,
    )
    if options.file.is_file():
        warn(_idle(options.file, place))
    say(f"written to {place}")
    return verdict(broken)


def _idle(source: Path, place: Path) -> list[Diagnostic]:
    """Of a build from ``source`` in ``place``, the sensors that its behaviour does not use."""
    from mdlcad.artefact import load
    from mdlcad.language import Device, placed
    from mdlcad.synthesis.netlist import Netlist
    from mdlcad.synthesis.unused import unused_sensors

    if not (place / "netlist.json").is_file():
        return []
    found = unused_sensors(load(place, "device.json", Device), load(place, "netlist.json", Netlist))
    return placed(found, source)


def _placer(options: argparse.Namespace) -> Placer:
    """The placer that was asked for, with its options.

    Raises:
        UsageError: an option of the paper's placer is given without it.
    """
    from mdlcad.errors import UsageError
    from mdlcad.placement.placers import ANNEAL, PaperPlacer
    from mdlcad.placement.sites import PaperOptions

    given = {name: getattr(options, name) for name in _PAPERS if getattr(options, name) is not None}
    if options.placer == ANNEAL.name:
        for name in given:
            raise UsageError(f"--{name.replace('_', '-')}: is an option of --placer paper; leave it out, or add that")
        return ANNEAL
    usual = PaperOptions()
    removes = given.get("uncross", True)
    return PaperPlacer(
        PaperOptions(
            iterations=given.get("iterations", usual.iterations),
            iterations_pinned=given.get("iterations_pinned", usual.iterations_pinned),
            sweeps=given.get("uncross_sweeps", usual.sweeps) if removes else 0,
            radius=given.get("uncross_radius", usual.radius),
            tests=given.get("uncross_tests", usual.tests),
        )
    )
