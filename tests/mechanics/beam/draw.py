"""The figures of docs/mechanics.md: ./run python -m tests.mechanics.beam.draw [FOLDER]"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes

from mdlcad.mechanics import process_names
from mdlcad.mechanics.beam.curves import Curve
from tests.mechanics.beam import curves

ROOT = Path(__file__).parents[3]


def draw(axes: Axes, curve: Curve, title: str) -> None:
    axes.plot(curve.displacement, curve.reduced, "-", color="#1b6ca8", label="reduced model")
    axes.plot(curve.displacement, curve.force, "o", color="#c8553d", markersize=3, label="beam computation")
    axes.axhline(0.0, color="0.8", linewidth=0.8, zorder=0)
    if curve.part == "unit":
        rests = curve.rests()
        axes.plot(rests, [0.0] * len(rests), "k^", markersize=6, label="rests here")
    axes.set_title(f"{title}: {100 * curve.error:.1f} % rms, strain {100 * curve.strain.max():.1f} %", fontsize=8)
    axes.tick_params(labelsize=7)


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "images"
    process, sizing = curves.sized("pom_cut")
    figure, panels = plt.subplots(1, 3, figsize=(10, 3.2), dpi=130)
    for axes, curve in zip(panels, curves.units(process, sizing), strict=True):
        draw(axes, curve, curve.state)
    # where no curve runs
    panels[0].legend(fontsize=7, frameon=False, loc="upper left")
    finish(figure, folder / "beam-unit.png")
    parts = [curves.spring(process, sizing), *curves.leaves(process, sizing)]
    figure, grid = plt.subplots(2, 4, figsize=(13, 6), dpi=110)
    for axes, curve in zip(grid.flat, parts, strict=False):
        draw(axes, curve, f"{curve.part}, {curve.state}" if curve.state else curve.part)
    grid.flat[0].legend(fontsize=7, frameon=False)
    for axes in list(grid.flat)[len(parts) :]:
        axes.set_axis_off()
    finish(figure, folder / "beam-leaves.png")
    for name in process_names():
        process, sizing = curves.sized(name)
        every = [*curves.units(process, sizing), curves.spring(process, sizing), *curves.leaves(process, sizing)]
        for curve in every:
            print(
                f"{name:10} {curve.part:13} {curve.state:16} {100 * curve.error:5.1f} % rms   strain "
                f"{100 * curve.strain.max():4.1f} % of {100 * curve.limit:3.1f} % allowed"
            )


def finish(figure: plt.Figure, path: Path) -> None:
    figure.supxlabel("displacement (mm)", fontsize=8)
    figure.supylabel("force (N)", fontsize=8)
    figure.tight_layout()
    figure.savefig(path, metadata={"Software": None})


if __name__ == "__main__":
    main()
