"""What merging is worth: the viewer's stage against one actor a body, on the same build and in the same run.

    python tests/benchmarks/bench_view.py DIR [frames]

Both are drawn without a screen at the same size, turning by the same angle a frame. Figures that stay true on other
machines are the number of actors and the ratio of the two times; the frame rate is that of this machine's renderer.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyvista

from mdlcad.view.camera import Preset, pose
from mdlcad.view.mesh import Model
from mdlcad.view.scene import open_scene
from mdlcad.view.stage import Stage

_SIZE = [800, 600]


def one_actor_a_body(model: Model) -> Any:
    """The same triangles, each body an actor of its own."""
    plotter = pyvista.Plotter(off_screen=True, window_size=_SIZE)
    for group in model.groups:
        for number in group.members:
            faces = group.faces[group.body == number]
            used, places = np.unique(faces, return_inverse=True)
            cells = np.column_stack([np.full(len(faces), 3), places.reshape(-1, 3)]).ravel()
            colour = model.built.bodies[number].colour
            plotter.add_mesh(
                pyvista.PolyData(group.points[used], cells), color=colour, reset_camera=False, render=False
            )
    return plotter


def seconds_a_frame(plotter: Any, frames: int, before: Callable[[int], None]) -> float:
    """Time of a frame, the first (which loads everything) left out."""
    plotter.show(auto_close=False)
    plotter.render()
    began = time.perf_counter()
    for frame in range(frames):
        before(frame)
        plotter.camera.azimuth += 2.0
        plotter.render()
    return (time.perf_counter() - began) / frames


def main() -> None:
    """Print actors, times and ratios."""
    model = open_scene(Path(sys.argv[1])).model
    frames = int(sys.argv[2]) if len(sys.argv) > 2 else 20
    stage = Stage(model, pyvista.Plotter(off_screen=True, window_size=_SIZE))
    stage.paint(np.full((len(model.built.bodies), 3), 160, dtype=np.uint8))
    single = one_actor_a_body(model)
    view = pose(Preset.ISO, stage.points(), stage.aspect)
    stage.look(view)
    single.camera_position = [view.position, view.focus, view.up]
    merged = seconds_a_frame(stage.plotter, frames, lambda _: None)
    apart = seconds_a_frame(stage.plotter, frames, lambda n: stage.stand(explode=n / frames, displacements=None))
    each = seconds_a_frame(single, frames, lambda _: None)
    triangles = sum(len(group.faces) for group in model.groups)
    print(f"{model.built.report.design}: {len(model.built.bodies)} bodies, {triangles} triangles")
    for name, actors, seconds in (
        ("merged", len(stage.actors), merged),
        ("merged, moving", len(stage.actors), apart),
        ("one actor a body", len(single.actors), each),
    ):
        print(f"{name:<17}{actors:5} actors {1e3 * seconds:8.1f} ms a frame, {seconds / merged:.1f} times as long")


if __name__ == "__main__":
    main()
