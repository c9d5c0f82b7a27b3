"""What the benchmarks simulate."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from mdlcad.artefact import from_json
from mdlcad.network.model import Coupling, Dynamics, Mass, MassKind, Network

ROOT = Path(__file__).parents[2]


def maze(cells: str) -> Network:
    """The maze robot, compiled now."""
    with tempfile.TemporaryDirectory() as folder:
        build = [sys.executable, "-m", "mdlcad.cli", "build", "examples/mazerobot.mdl", "--cells", cells]
        subprocess.run([*build, "--to", "network", "-o", folder + "/maze"], cwd=ROOT, check=True, capture_output=True)
        return from_json((Path(folder) / "maze" / "network.json").read_bytes(), Network)


def random_parametron(masses: int, seed: int = 0) -> Network:
    """Compensated three-phase masses with 1.45 springs each, phase to next phase, near and far alike."""
    rng = np.random.default_rng(seed)
    source = rng.integers(masses, size=int(1.45 * masses))
    target = 3 * rng.integers(masses // 3, size=len(source)) + (source + 1) % 3
    sign, initial = rng.choice([-1.0, 1.0], len(source)), rng.choice([-1.0, 1.0], masses)
    load = 0.3 * np.bincount(np.concatenate([source, target]), minlength=masses)
    return Network(
        "random",
        "none",
        Dynamics(0.05, 0.25, 1.0, 10.0, 3),
        tuple(
            Mass(f"m{i}", MassKind.GATE, i % 3, 3.0, -2.75, -float(load[i]), 0.5 * (i % 2), float(initial[i]))
            for i in range(masses)
        ),
        tuple(
            Coupling(f"m{s}", f"m{t}", 0.3 * float(plus), 0.3) for s, t, plus in zip(source, target, sign, strict=True)
        ),
        (),
        (),
        (),
        None,
        1,
    )
