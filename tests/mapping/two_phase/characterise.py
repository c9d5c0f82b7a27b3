"""Measures what docs/two_phase.md says of the parameter sets, which takes some minutes a set.

    python -m tests.mapping.two_phase.characterise [SET...]

Loops of 4 and 5 stand for those of 5 and 12: the same decisions in a third of the time.
"""

from __future__ import annotations

import sys

from mdlcad.mapping.two_phase import map_two_phase
from mdlcad.proof.reference import build_reference
from mdlcad.proof.spread import estimate_yield
from mdlcad.proof.window import find_window
from mdlcad.simulation.scatter import scatter_of
from mdlcad.synthesis import synthesise
from tests.mapping.two_phase.programs import RACE, example, library, small

PERIODS = {
    "literal": (0.85, 0.9, 0.95, 1.0, 1.05, 1.1, 1.15, 1.2),
    "near": (0.85, 0.9, 1.0, 1.1, 1.2, 1.3, 1.35, 1.4),
    "robust": (1.2, 1.3, 1.5, 2.0, 5.0, 10.0, 30.0, 100.0),
}
DAMPINGS = {
    "literal": (0.2, 0.225, 0.25, 0.275, 0.3),
    "near": (0.15, 0.175, 0.2, 0.25, 0.3, 0.35),
    "robust": (0.02, 0.05, 0.1, 0.25, 0.5, 1.0),
}


def main() -> None:
    """Print the window of periods and dampings, and the yields, of each parameter set."""
    devices = {"maze": example("mazerobot"), "shift register": small(RACE.format(last=1))}
    for name in sys.argv[1:] or tuple(PERIODS):
        for label, device in devices.items():
            network = map_two_phase(synthesise(device), library(name, clock_length=20))
            reference, usual = build_reference(device), network.dynamics
            for title, periods, dampings in (
                ("period", PERIODS[name], (usual.damping,)),
                ("damping", (usual.period,), DAMPINGS[name]),
            ):
                points = find_window(network, reference, periods, dampings, decisions=100)
                held = [f"{getattr(point, title):g} {'holds' if point.holds else 'fails'}" for point in points]
                print(f"{name}, {label}, {title}: {', '.join(held)}", flush=True)
        network = map_two_phase(synthesise(devices["maze"]), library(name, clock_length=20))
        for spread in (0.05, 0.1):
            found = estimate_yield(
                network, build_reference(devices["maze"]), scatter_of(spread), samples=40, decisions=100
            )
            print(f"{name}, maze, spread {spread:g}: {found.right} of {found.samples} devices", flush=True)


if __name__ == "__main__":
    main()
