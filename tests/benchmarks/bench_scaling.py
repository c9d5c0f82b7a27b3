"""Cost of a time step against the number of masses, 50 to 50,000; the plot goes to docs/images/simulation-cost.png.

./run python -m tests.benchmarks.bench_scaling [PNG]
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from mdlcad.simulation.kernel_lanes import BLOCK
from mdlcad.simulation.run import simulate, undriven
from mdlcad.simulation.system import system_of
from tests.benchmarks.devices import ROOT, random_parametron

MASSES = (51, 102, 201, 501, 1002, 2001, 5001, 10002, 20001, 50001)
ROUNDS = 7


def seconds(work: Callable[[], object]) -> float:
    """Time of one call on this core; waiting for the core does not count."""
    start = time.thread_time()
    work()
    return time.thread_time() - start


def main() -> None:
    """Measure all sizes in turn, several rounds, and keep the best of each."""
    systems = {n: system_of(random_parametron(n)) for n in MASSES}
    work: dict[tuple[int, int], tuple[int, Callable[[], object]]] = {}
    for n, system in systems.items():
        for lanes in (1, BLOCK):
            steps = max(20, 3_000_000 // (n * lanes))
            work[n, lanes] = steps, lambda s=system, k=steps, m=lanes: simulate(s, undriven(m), k)
    best: dict[tuple[int, int], float] = {}
    for _ in range(ROUNDS):
        for key, (steps, run) in work.items():
            # what does not grow with the steps (arrays made, masses sorted) is measured by a run without any
            system, lanes = systems[key[0]], key[1]
            spent = seconds(run) - seconds(lambda s=system, m=lanes: simulate(s, undriven(m), 0))
            best[key] = min(best.get(key, float("inf")), spent / steps)
    figure, axes = plt.subplots(figsize=(6.4, 4.2), dpi=150)
    n = np.array(MASSES)
    for lanes, colour in ((1, "#1b6ca8"), (BLOCK, "#c8553d")):
        cost = np.array([best[k, lanes] / lanes for k in MASSES]) * 1e6
        exponent = np.polyfit(np.log(n), np.log(cost), 1)[0]
        label = f"{'one run' if lanes == 1 else f'{lanes} lanes, per lane'}: cost ~ masses^{exponent:.2f}"
        axes.loglog(n, cost, "o-", color=colour, label=label, markersize=4)
        print(label)
        for k, micro in zip(MASSES, cost, strict=True):
            print(f"  {k:6} masses  {micro:9.2f} us a step  {k / micro:6.1f} M mass-steps/s")
    axes.loglog(n, best[MASSES[0], 1] * 1e6 * n / n[0], ":", color="0.5", label="in proportion to the masses")
    axes.set_xlabel("masses (1.45 random springs each)")
    axes.set_ylabel("time of one RK4 step (us, one core)")
    axes.grid(True, which="major", color="0.9")
    axes.legend(frameon=False)
    figure.tight_layout()
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "images" / "simulation-cost.png"
    figure.savefig(target, metadata={"Software": None})


if __name__ == "__main__":
    main()
