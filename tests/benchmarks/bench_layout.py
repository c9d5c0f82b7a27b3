"""Time and memory of placing and routing against the number of masses; the plot goes to docs/images/layout-cost.png.

    ./run python -m tests.benchmarks.bench_layout [--reach COPIES] [--fill SHARE] [--png PATH] [COPIES ...]

The networks are copies of the lock's as compiled, one tenth of the couplings swapped between copies at most
``--reach`` apart (default 1; as large as the number of copies for any two). The lattice is that of a square in which
the masses fill ``--fill`` of the slots (default 0.14), sized for ``pom_cut``. Every size runs in a process of its own.
"""

from __future__ import annotations

import argparse
import json
import math
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator

from mdlcad.artefact import from_json, to_json
from mdlcad.errors import SignoffError
from mdlcad.language import read_device
from mdlcad.mapping import load_library, map_netlist
from mdlcad.mechanics import load_process, size
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.costs import HARD
from mdlcad.placement.lattice import Lattice, lattices, place_ports
from mdlcad.placement.placer import place
from mdlcad.placement.ports import PortPlace
from mdlcad.routing.check import check_layout
from mdlcad.routing.router import route
from mdlcad.synthesis import synthesise
from tests.benchmarks.devices import ROOT
from tests.placement.networks import SQUARE
from tests.placement.tiles import tiled

COPIES = (3, 4, 10, 20, 200)
WARMING = (3, 4)
"""Sizes that are run before all others, and not counted: they compile kernels (not all are needed at every size)."""
CORES = 2
"""Starts of a placement that are tried at once, and channels that are routed at once."""
PORT_ROWS = 5
"""Rows from port to port, unless the wall is too short."""
PEAK = 1.8
"""Largest |x|, as in the lock's own simulation."""


def lattice_for(network: Network, rules: LayoutRules, fill: float) -> Lattice:
    """The smallest square in which ``network`` fills ``fill`` of the slots and channels are as wide as may be.

    All ports stand on the left wall, from its lower end on: only the first copy has any. Beside the outermost columns
    is room for a coupler's trunk.
    """
    bits = [bit.bit for bit in (*network.sensors, *network.actuators)]
    need = math.ceil(len(network.masses) / fill)
    scale = math.sqrt(need * rules.column_most * rules.row_pitch) / 39
    while True:
        apart = min(39 / len(bits), PORT_ROWS * rules.row_pitch / scale)
        ports = tuple(PortPlace(bit, "left", 0, apart * (i + 0.5), (-1.0, 0.0)) for i, bit in enumerate(bits))
        for found in lattices(SQUARE, place_ports(network, ports, scale), rules, scale, need):
            one, two = found.column_x[:2]
            beside = one - found.inner.bounds[0] - rules.unit_left
            if two - one > rules.column_most - 0.1 and beside > rules.track_pitch + rules.bar_width / 2:
                return found
        scale *= 1.005


def measure(network: Network, fill: float) -> dict[str, Any]:
    """One size: seconds on two cores, conflicts left by the placer, findings of the checker."""
    rules = size(network, load_process("pom_cut"), {mass.name: PEAK for mass in network.masses}).rules
    lattice = lattice_for(network, rules, fill)
    began = time.perf_counter()
    placed = place(network, lattice, rules, 1, workers=CORES)
    middle = time.perf_counter()
    words, findings = "", -1
    try:
        layout = route(network, placed.placement, rules, 1, sides=placed.sides, workers=CORES)
    except SignoffError as error:
        words = str(error)
    spent = time.perf_counter() - middle
    if not words:
        findings = len(check_layout(network, placed.placement, layout, rules))
    return {
        "masses": len(network.masses),
        "couplings": len(network.couplings),
        "columns": len(lattice.column_x),
        "place": round(middle - began, 2),
        "cost": round(placed.cost, 1),
        "route": round(spent, 2),
        "findings": findings,
        "mb": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024),
        "words": words,
    }


def main() -> None:
    """Measure every size in a process of its own, print the table, draw the plot."""
    parser = argparse.ArgumentParser()
    parser.add_argument("copies", type=int, nargs="*", default=list(COPIES))
    parser.add_argument("--reach", type=int, default=1)
    parser.add_argument("--fill", type=float, default=0.14)
    parser.add_argument("--limit", type=float, default=600.0, help="seconds a size")
    parser.add_argument("--png", type=Path, default=ROOT / "docs" / "images" / "layout-cost.png")
    parser.add_argument("--one", type=Path, help="measure the one size, of the network in this file")
    options = parser.parse_args()
    if options.one:
        network = from_json(options.one.read_bytes(), Network)
        print(json.dumps(measure(tiled(network, options.copies[0], 0.1, options.reach, 1), options.fill)))
        return
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        lock = Path(folder) / "network.json"
        netlist = synthesise(read_device(ROOT / "examples" / "lock.mdl"))
        lock.write_bytes(to_json(map_netlist(netlist, load_library("parametron"))))
        for turn, copies in enumerate((*WARMING, *options.copies)):
            again = [sys.executable, "-m", "tests.benchmarks.bench_layout", str(copies), "--one", str(lock)]
            again += ["--reach", str(options.reach), "--fill", str(options.fill)]
            try:
                done = subprocess.run(again, cwd=ROOT, check=True, capture_output=True, timeout=options.limit)
            except subprocess.TimeoutExpired:
                print(f"{copies} copies: not done in {options.limit:g} s")
                break
            row = json.loads(done.stdout)
            if turn >= len(WARMING):
                rows.append(row)
                print(
                    f"{row['masses']:6} masses {row['couplings']:6} couplings {row['columns']:4} columns  "
                    f"place {row['place']:7.1f} s (conflicts {row['cost'] / HARD:.0f})  route {row['route']:7.1f} s  "
                    f"{row['findings']} findings  {row['mb']} MB  {row['words'][:100]}",
                    flush=True,
                )
    draw(rows, options.png)


def draw(rows: list[dict[str, Any]], png: Path) -> None:
    """Seconds against masses; a hollow point has conflicts left."""
    figure, axes = plt.subplots(figsize=(6.4, 4.2), dpi=150)
    for key, colour in (("place", "#1b6ca8"), ("route", "#c8553d")):
        # a size with conflicts left is placed, but not routed
        done = [row for row in rows if key == "place" or row["findings"] == 0]
        axes.loglog([r["masses"] for r in done], [r[key] for r in done], "o-", color=colour, label=key, markersize=4)
        left = [row for row in rows if key == "place" and row["cost"] > 0]
        axes.loglog([r["masses"] for r in left], [r[key] for r in left], "o", color="white", markersize=2)
    axes.set_xlabel("masses (copies of the lock, a tenth of the couplings swapped)")
    axes.set_ylabel(f"seconds, {CORES} cores")
    # the sizes that were measured and round seconds, as plain numbers
    axes.set_xticks([row["masses"] for row in rows], [f"{row['masses']:,}" for row in rows])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda seconds, _: f"{seconds:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.grid(True, which="major", color="0.9")
    axes.legend(frameon=False)
    figure.tight_layout()
    figure.savefig(png, metadata={"Software": None})


if __name__ == "__main__":
    main()
