"""Our placer against the paper's on 1 x 1 footprints: crossings and length, equal time, same run.

    python tests/benchmarks/bench_placement.py [seeds]

The networks are the maze's and the lock's of both cell libraries. For each seed the paper's method (its default
options) runs again and again, with fresh seeds, until it has had the time that one run of ours takes; its best run
counts: once by crossings, once by length. Ours has one run, which counts for both. Means over the seeds.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from mdlcad.flow.outline import port_places
from mdlcad.language import read_device
from mdlcad.mapping import load_library, map_netlist
from mdlcad.placement.sites import place_like_the_paper, place_straight
from mdlcad.placement.unit_grid import GridProblem, Seating, grid_problem
from mdlcad.synthesis import synthesise

EXAMPLES = Path(__file__).parents[2] / "examples"


def problem_of(design: str, cells: str) -> tuple[int, GridProblem]:
    """Masses, and sites and lines of an example."""
    device = read_device(EXAMPLES / f"{design}.mdl")
    network = map_netlist(synthesise(device), load_library(cells))
    seating = Seating.ON_BOUNDARY if cells == "two_phase" else Seating.TAB
    outline = tuple(line.start for line in device.boundary)
    return len(network.masses), grid_problem(network, outline, port_places(device), seating)


def main(seeds: int) -> None:
    """Print the table."""
    print(f"{'design':<10} {'cells':<11} {'masses':>6}  {'time':>6}  {'crossings':>19}  {'length':>21}")
    for design in ("mazerobot", "lock"):
        for cells in ("parametron", "two_phase"):
            masses, problem = problem_of(design, cells)
            place_straight(problem.sites, 0), place_like_the_paper(problem.sites, 0)  # compiles
            rows = []
            for seed in range(seeds):
                began = time.perf_counter()
                ours = place_straight(problem.sites, seed)
                spent = time.perf_counter() - began
                began, tries = time.perf_counter(), []
                while not tries or time.perf_counter() - began < spent:
                    tries.append(place_like_the_paper(problem.sites, 1000 * seed + len(tries)))
                paper = min(run.crossings for run in tries), min(run.length for run in tries)
                rows.append((spent, paper[0], ours.crossings, paper[1], ours.length))
            spent, *figures = np.array(rows).mean(axis=0)
            crossings, length = (f"{a:7.1f} -> {b:5.1f}  {b / a:4.2f}" for a, b in (figures[:2], figures[2:]))
            print(f"{design:<10} {cells:<11} {masses:6d}  {spent:4.1f} s  {crossings}  {length}", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
