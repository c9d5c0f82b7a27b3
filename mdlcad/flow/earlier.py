"""The build that another is to be like: loaded, and held to fit it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from mdlcad.artefact import checksum, load
from mdlcad.errors import UsageError
from mdlcad.flow.folder import REPORT
from mdlcad.mapping import Before, Library, recorded_library
from mdlcad.mapping.two_phase import TwoPhaseLibrary
from mdlcad.mechanics import Process, Sizing
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.placement import Placement
from mdlcad.placement.unit_grid import GridPlacement
from mdlcad.report.report import Report
from mdlcad.routing.earlier import Earlier
from mdlcad.routing.layout import Layout
from mdlcad.synthesis.netlist import Netlist

_ON_GRID = ("netlist.json", "network.json", "placement.json")
_DEVICE = ("netlist.json", "network.json", "sizing.json", "placement.json", "layout.json")


@dataclass(frozen=True, slots=True)
class EarlierBuild:
    """What a new build keeps of an earlier one.

    Attributes:
        checksum: SHA-256 over the names and SHA-256 of the artefacts that were taken from it.
        netlist, network: the earlier ones.
        device: its placement and layout; None if its masses stand on the program's grid.
        rules: what that layout was held to; None on the grid.
        grid: its placement on the program's grid; None for a device with parts.
    """

    checksum: str
    netlist: Netlist
    network: Network
    device: Earlier | None
    rules: LayoutRules | None
    grid: GridPlacement | None

    def before(self) -> Before:
        """Its network, and where on a device with parts the masses stand."""
        if self.device is None:
            return Before(self.network)
        placement = self.device.placement
        seats = {unit.mass: (unit.column, unit.row) for unit in placement.masses}
        return Before(self.network, seats, placement.slots)


def load_earlier(folder: Path, library: Library, process: Process) -> EarlierBuild:
    """The build in ``folder``, which must have the same cell library and process as the new one.

    Raises:
        UsageError: no such folder; a file in it is missing, garbled or not the one that was built; or it is a build of
            another library or process. Says which.
    """
    if not folder.is_dir():
        raise UsageError(f"--like {folder}: no such build folder")
    report = load(folder, REPORT, Report)
    theirs = recorded_library(folder)
    if theirs != library:
        what = "with other options" if theirs.name == library.name else f"and this one is of {library.name}"
        raise UsageError(
            f"--like {folder}: its masses are those of the cell library {theirs.name} {what}; give the same --cells "
            "and options, or build without --like"
        )
    on_grid = isinstance(library, TwoPhaseLibrary)
    if not on_grid and load(folder, "process.json", Process) != process:
        raise UsageError(
            f"--like {folder}: is of the process {report.process}, and not as {process.name} is now; give the same "
            "--process, or build without --like"
        )
    names = _ON_GRID if on_grid else _DEVICE
    lines = []
    for name in names:
        if not (folder / name).is_file():
            raise UsageError(f"--like {folder}: has no {name}; a build to be like must have come as far as its layout")
        digest = checksum((folder / name).read_bytes())
        if report.files.get(name) != digest:
            raise UsageError(f"{folder / name}: is not the file that was built (its SHA-256 differs from {REPORT})")
        lines.append(f"{digest}  {name}\n")
    total = checksum("".join(lines).encode())
    netlist, network = load(folder, "netlist.json", Netlist), load(folder, "network.json", Network)
    if on_grid:
        grid = load(folder, "placement.json", GridPlacement)
        _hold(folder, network, {item.mass for item in grid.masses})
        return EarlierBuild(total, netlist, network, None, None, grid)
    placement, layout = load(folder, "placement.json", Placement), load(folder, "layout.json", Layout)
    _hold(folder, network, {unit.mass for unit in placement.masses})
    known = {item.name for item in network.couplings}
    if not {leaf.coupling for leaf in layout.couplers} <= known:
        raise UsageError(f"--like {folder}: layout.json and network.json are not of one build; build it again")
    rules = load(folder, "sizing.json", Sizing).rules
    return EarlierBuild(total, netlist, network, Earlier(network, placement, layout), rules, None)


def _hold(folder: Path, network: Network, placed: set[str]) -> None:
    if placed != {mass.name for mass in network.masses}:
        raise UsageError(f"--like {folder}: placement.json and network.json are not of one build; build it again")
