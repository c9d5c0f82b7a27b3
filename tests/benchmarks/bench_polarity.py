"""How long the least number of negative couplings takes to find and prove, by size.

    python tests/benchmarks/bench_polarity.py [masses]

The maze's and the lock's networks as compiled, turned back to their programs' signs, and random networks of the same
statistics. "direct" is the plain model, one sign a mass and one exclusive or a coupling, in CP-SAT with ten seconds.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

from ortools.sat.python import cp_model

from mdlcad.language import read_device
from mdlcad.mapping import load_library, map_netlist
from mdlcad.mapping.frustration import SignedGraph, least_frustration
from mdlcad.network.model import Network
from mdlcad.synthesis import synthesise
from tests.placement.networks import synthetic

EXAMPLES = Path(__file__).parents[2] / "examples"


def graph_of(network: Network) -> SignedGraph:
    """The couplings with the signs they have while all masses are upright."""
    fixed = {port.mass for port in (*network.sensors, *network.actuators)}
    free = [mass.name for mass in network.masses if mass.name not in fixed]
    node = {name: index + 1 for index, name in enumerate(free)}
    polarity = {mass.name: mass.polarity for mass in network.masses}
    return SignedGraph(
        len(free) + 1,
        tuple((node.get(item.source, 0), node.get(item.target, 0)) for item in network.couplings),
        tuple(item.strength * polarity[item.source] * polarity[item.target] < 0 for item in network.couplings),
    )


def direct(graph: SignedGraph) -> tuple[int, bool]:
    """The plain model's best, and whether it is proven."""
    model = cp_model.CpModel()
    turned = [model.new_bool_var(str(i)) for i in range(graph.nodes)]
    model.add(turned[0] == 0)
    minus = []
    for (a, b), negative in zip(graph.ends, graph.negative, strict=True):
        result = model.new_bool_var("")
        model.add_bool_xor([turned[a], turned[b], result, negative, True])
        minus.append(result)
    model.minimize(sum(minus))
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    solver.parameters.max_time_in_seconds = 10.0
    status = solver.solve(model)
    return round(solver.objective_value), status == cp_model.OPTIMAL


def main(masses: int) -> None:
    """Print the table."""
    cases = []
    for design in ("mazerobot", "lock"):
        netlist = synthesise(read_device(EXAMPLES / f"{design}.mdl"))
        cases.append((design, map_netlist(netlist, load_library("parametron"))))
    for count in (100, 300, masses):
        couplings = int(1.51 * count)
        cases.append((f"random {count}", synthetic(count, couplings, 12, 10, int(0.17 * couplings), 6, 1, 1)))
    columns = f"{'least':>5} {'proven':>6} {'time':>8}   {'direct':>6} {'proven':>6} {'time':>8}"
    print(f"{'network':<12} {'before':>6}   {columns}")
    for name, network in cases:
        graph = graph_of(network)
        began = time.perf_counter()
        found = least_frustration(graph)
        middle = time.perf_counter()
        other, proven = direct(graph)
        ours = f"{sum(found.negative):5d} {found.proven!s:>6} {middle - began:6.2f} s"
        theirs = f"{other:6d} {proven!s:>6} {time.perf_counter() - middle:6.2f} s"
        print(f"{name:<12} {sum(graph.negative):6d}   {ours}   {theirs}", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1000)
