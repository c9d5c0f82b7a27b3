"""Speed of the RK4 kernel against its peers: the same work in the same run, on one core each.

    ./run bench

Work is counted in mass-steps: masses x steps x lanes. All fixed-step solvers take the same 400 steps a period; SciPy's
adaptive ones are asked for the error that RK4 really has here, and their time for the same simulated time counts. The
error is against DOP853 at a tolerance of 1e-12. All solvers take turns, several rounds of them, and the best time of
each counts: so another program on the machine slows all of them or none.
"""

from __future__ import annotations

import os

# one core each, before anybody reads it
os.environ.update(
    OMP_NUM_THREADS="1",
    OPENBLAS_NUM_THREADS="1",
    XLA_FLAGS="--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1",
)

import importlib.util
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mdlcad.simulation.run import STEPS_PER_PERIOD, simulate, undriven
from mdlcad.simulation.system import System, system_of
from tests.benchmarks import peers
from tests.benchmarks.devices import maze, random_parametron

PERIODS = 5
ROUNDS = 3
TURN = 0.3  # seconds: a solver that is done earlier runs again within its turn
LANES = 16


@dataclass(frozen=True, slots=True)
class Solver:
    """What takes part: ``solve`` gives final displacements, float[n] or float[n, lanes]."""

    name: str
    solve: Callable[[], np.ndarray]
    lanes: int = 1


def solvers(system: System, exact: np.ndarray) -> list[Solver]:
    steps = PERIODS * STEPS_PER_PERIOD
    ours = [
        Solver("kernel", lambda: simulate(system, undriven(), steps).x[:, 0]),
        Solver(f"kernel, {LANES} lanes", lambda: simulate(system, undriven(LANES), steps).x, LANES),
    ]
    theirs = [
        Solver("NumPy RK4, dense", lambda: peers.numpy_rk4(system, steps, sparse=False)),
        Solver("NumPy RK4, sparse", lambda: peers.numpy_rk4(system, steps, sparse=True)),
        Solver(f"NumPy RK4, {LANES} lanes", lambda: peers.numpy_rk4(system, steps, True, LANES), LANES),
    ]
    error = float(np.abs(ours[0].solve() - exact).max())
    for method in ("DOP853", "RK45"):
        for tolerance in 10.0 ** -np.arange(3, 12):
            found = peers.scipy_solution(system, PERIODS * system.period, tolerance, method)
            if np.abs(found - exact).max() <= error:
                break
        theirs.append(
            Solver(
                f"solve_ivp {method} {tolerance:.0e}",
                lambda method=method, tolerance=tolerance: peers.scipy_solution(
                    system, PERIODS * system.period, tolerance, method
                ),
            )
        )
    if importlib.util.find_spec("diffrax"):
        theirs += [Solver(f"diffrax {name}", peers.diffrax_solution(system, steps, name)) for name in ("RK4", "Tsit5")]
        theirs += [
            Solver("JAX, RK4 by hand", peers.jax_rk4(system, steps)),
            Solver(f"diffrax RK4, {LANES} lanes", peers.diffrax_solution(system, steps, "RK4", LANES), LANES),
            Solver(f"JAX by hand, {LANES} lanes", peers.jax_rk4(system, steps, LANES), LANES),
        ]
    return ours + theirs


def measure(title: str, system: System) -> None:
    """Print one line a solver, and the ratios that count."""
    steps = PERIODS * STEPS_PER_PERIOD
    exact = peers.scipy_solution(system, PERIODS * system.period, 1e-12)
    entrants = solvers(system, exact)
    best = {entrant.name: float("inf") for entrant in entrants}
    error = {}
    for _ in range(ROUNDS):
        for entrant in entrants:
            turn = time.perf_counter()
            while (start := time.perf_counter()) < turn + TURN:
                x = entrant.solve()
                best[entrant.name] = min(best[entrant.name], time.perf_counter() - start)
            error[entrant.name] = float(np.abs((x if x.ndim == 1 else x[:, 0]) - exact).max())
    n = len(system.names)
    rate = {entrant.name: n * steps * entrant.lanes / best[entrant.name] / 1e6 for entrant in entrants}
    print(f"\n{title}: {n} masses, {len(system.base) + len(system.latch_base)} coupling entries, {steps} steps")
    for entrant in entrants:
        ratio = rate["kernel" if entrant.lanes == 1 else f"kernel, {LANES} lanes"] / rate[entrant.name]
        print(
            f"  {entrant.name:24} {rate[entrant.name]:8.2f} M mass-steps/s  error {error[entrant.name]:.0e}"
            f"  kernel is {ratio:6.1f} times as fast"
        )
    numpy = max(rate["NumPy RK4, dense"], rate["NumPy RK4, sparse"])
    print(f"  one run against the better NumPy: {rate['kernel'] / numpy:.0f} times (aim 25)")
    if "diffrax RK4" in rate:
        peer = max(rate[name] for name in ("diffrax RK4", "diffrax Tsit5", "JAX, RK4 by hand"))
        print(f"  one run against the best compiled peer: {rate['kernel'] / peer:.0f} times (aim 3)")
    else:
        print("  diffrax is not installed here; ./run bench installs it")
    print(f"  lanes against one NumPy run: {rate[f'kernel, {LANES} lanes'] / numpy:.0f} times (aim 100)")


def main() -> None:
    """Measure the maze with both cell libraries, and a random network of the size of the paper's maze."""
    print(f"Python {sys.version.split()[0]}, NumPy {np.__version__}; {ROUNDS} rounds, best of each")
    measure("maze, parametron", system_of(maze("parametron")))
    measure("maze, two_phase", system_of(maze("two_phase")))
    measure("random parametron", system_of(random_parametron(187)))


if __name__ == "__main__":
    main()
