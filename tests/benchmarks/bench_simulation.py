"""Speed of the RK4 kernel against vectorised NumPy and scipy on the same work in the same run.

    python tests/benchmarks/bench_simulation.py [masses] [periods]

Work is counted in mass-steps: masses x steps x lanes. The NumPy solver takes the same RK4 steps (its couplings are a
sparse matrix product) and must end where the kernel ends. scipy's adaptive DOP853 is asked for the error that the
kernel really has on this work, and its time is compared for the same simulated time.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp
from scipy.sparse import csr_array

from mdlcad.network.model import Coupling, Dynamics, Mass, MassKind, Network
from mdlcad.simulation.run import STEPS_PER_PERIOD, simulate, undriven
from mdlcad.simulation.system import System, system_of, wave_table


def random_parametron(masses: int, seed: int = 0) -> Network:
    """Compensated three-phase masses with 1.45 springs each, phase to next phase."""
    rng = np.random.default_rng(seed)
    couplings = []
    load = np.zeros(masses)
    for _ in range(int(1.45 * masses)):
        source = int(rng.integers(masses))
        target = int(rng.choice(np.arange(masses)[np.arange(masses) % 3 == (source + 1) % 3]))
        couplings.append(Coupling(f"m{source}", f"m{target}", 0.3 * float(rng.choice([-1, 1])), 0.3))
        load[[source, target]] += 0.3
    return Network(
        "random",
        "none",
        Dynamics(0.05, 0.25, 1.0, 10.0, 3),
        tuple(
            Mass(f"m{i}", MassKind.GATE, i % 3, 3.0, -2.75, -float(load[i]), 0.5 * (i % 2), float(rng.choice([-1, 1])))
            for i in range(masses)
        ),
        tuple(couplings),
        (),
        (),
        (),
        None,
        1,
    )


def acceleration(system: System) -> Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]:
    """a(x, v, waves), vectorised over masses."""
    n = len(system.names)
    springs = csr_array((system.base, system.column, system.row_start), shape=(n, n))

    def a(x: np.ndarray, v: np.ndarray, waves: np.ndarray) -> np.ndarray:
        stiffness = system.stiffness_base + system.stiffness_swing * waves[system.phase]
        force = springs @ x - system.bias - (stiffness + system.quartic * x * x) * x
        return (force - system.damping * v) / system.inertia

    return a


def numpy_rk4(system: System, steps: int) -> np.ndarray:
    """Final displacements after ``steps`` RK4 steps."""
    a = acceleration(system)
    h = system.period / STEPS_PER_PERIOD
    table = wave_table(system.phases, 2 * STEPS_PER_PERIOD)
    x, v = system.initial.copy(), np.zeros(len(system.initial))
    for step in range(steps):
        w0, w1, w2 = (table[(2 * step + half) % len(table)] for half in range(3))
        a1 = a(x, v, w0)
        v2 = v + 0.5 * h * a1
        a2 = a(x + 0.5 * h * v, v2, w1)
        v3 = v + 0.5 * h * a2
        a3 = a(x + 0.5 * h * v2, v3, w1)
        v4 = v + h * a3
        a4 = a(x + h * v3, v4, w2)
        x = x + h / 6 * (v + 2 * v2 + 2 * v3 + v4)
        v = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
    return x


def scipy_solution(system: System, time_end: float, tolerance: float) -> np.ndarray:
    """Final displacements by DOP853."""
    a = acceleration(system)
    n = len(system.initial)
    turn = 2 * np.pi

    def slope(t: float, y: np.ndarray) -> np.ndarray:
        waves = 1 + np.sin(turn * t / system.period - turn * np.arange(system.phases) / system.phases)
        return np.concatenate([y[n:], a(y[:n], y[n:], waves)])

    start = np.concatenate([system.initial, np.zeros(n)])
    return solve_ivp(slope, (0, time_end), start, method="DOP853", rtol=tolerance, atol=tolerance).y[:n, -1]


def timed(work: Callable[[], np.ndarray], repeats: int = 3) -> tuple[np.ndarray, float]:
    """The result and the best time of ``repeats``, in seconds."""
    best = float("inf")
    for _ in range(repeats):
        start = time.perf_counter()
        result = work()
        best = min(best, time.perf_counter() - start)
    return result, best


def main() -> None:
    """Print one line a solver."""
    masses = int(sys.argv[1]) if len(sys.argv) > 1 else 187
    periods = int(sys.argv[2]) if len(sys.argv) > 2 else 10
    steps = periods * STEPS_PER_PERIOD
    system = system_of(random_parametron(masses))
    simulate(system, undriven(), 1)
    simulate(system, undriven(16), 1)  # compiled now, or read from the cache

    x, seconds = timed(lambda: simulate(system, undriven(), steps).x[:, 0])
    slow, numpy_seconds = timed(lambda: numpy_rk4(system, steps), 1)
    exact = simulate(system, undriven(), 16 * steps, steps_per_period=16 * STEPS_PER_PERIOD).x[:, 0]
    error = float(np.abs(x - exact).max())
    for tolerance in 10.0 ** -np.arange(3, 12):
        other, scipy_seconds = timed(lambda tol=tolerance: scipy_solution(system, periods * system.period, tol), 1)
        scipy_error = float(np.abs(other - exact).max())
        if scipy_error <= error:
            break
    rate = masses * steps / seconds / 1e6
    print(f"{masses} masses, {steps} steps; error of the kernel {error:.1e}")
    print(f"kernel, 1 lane            {rate:8.1f} M mass-steps/s")
    print(
        f"NumPy RK4, same steps     {masses * steps / numpy_seconds / 1e6:8.1f} M mass-steps/s   "
        f"kernel is {numpy_seconds / seconds:.0f} times as fast, same result to {np.abs(slow - x).max():.0e}"
    )
    print(
        f"scipy DOP853 (error {scipy_error:.0e}) {scipy_seconds:.2f} s against {seconds:.3f} s   "
        f"kernel is {scipy_seconds / seconds:.0f} times as fast"
    )
    for lanes, workers in ((16, 1), (64, 1), (64, 2)):
        _, together = timed(
            lambda lanes=lanes, workers=workers: simulate(system, undriven(lanes), steps, workers=workers).x
        )
        print(
            f"kernel, {lanes:2} lanes, {workers} thread{'s' if workers > 1 else ' '} "
            f"{masses * steps * lanes / together / 1e6:8.1f} M mass-steps/s   "
            f"{masses * steps * lanes / together / 1e6 / rate:.1f} times one lane"
        )


if __name__ == "__main__":
    main()
