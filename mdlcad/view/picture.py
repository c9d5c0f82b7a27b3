"""Pictures of the real bodies with PyVista, without a screen."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pyvista
import vtk
from numpy.typing import NDArray

from mdlcad.export.solid import prism, triangles
from mdlcad.parts.body import Body
from mdlcad.view.camera import VIEW_ANGLE, Preset, pose

_WINDOW = (1600, 1200)
_TALL = (1200, 1800)  # a stack drawn apart is higher than wide
# VTK asks for an X server first and says so on the terminal when there is none
vtk.vtkLogger.SetStderrVerbosity(vtk.vtkLogger.VERBOSITY_ERROR)
if "DISPLAY" not in os.environ:
    os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")


def device_mesh(bodies: Sequence[Body], lift_mm: dict[str, float] | None = None) -> pyvista.PolyData:
    """One mesh of all bodies as assembled, with cell colours "rgb" (uint8, (cells, 3)).

    Args:
        lift_mm: how far each plate is lifted in z (an exploded view).
    """
    lifts = lift_mm or {}
    points: list[NDArray[np.float64]] = []
    faces: list[NDArray[np.int64]] = []
    colours: list[NDArray[np.uint8]] = []
    offset = 0
    for body in bodies:
        section = body.assembled if body.assembled is not None else body.section
        vertices, corners = triangles(prism([section], body.z + lifts.get(body.plate, 0.0), body.thickness))
        points.append(vertices)
        faces.append(np.column_stack([np.full(len(corners), 3, dtype=np.int64), corners + offset]))
        colours.append(np.tile(_rgb(body.colour), (len(corners), 1)))
        offset += len(vertices)
    mesh = pyvista.PolyData(np.concatenate(points), np.concatenate(faces).ravel())
    mesh.cell_data["rgb"] = np.concatenate(colours)
    return mesh


def _rgb(colour: str) -> NDArray[np.uint8]:
    return np.array([int(colour[start : start + 2], 16) for start in (1, 3, 5)], dtype=np.uint8)


def write_picture(
    bodies: Sequence[Body], path: Path, *, from_above: bool, lift_mm: dict[str, float] | None = None
) -> None:
    """Render ``bodies`` to a PNG: from above (parallel, to scale) or from a raised corner."""
    size = _TALL if lift_mm else _WINDOW
    plotter = pyvista.Plotter(off_screen=True, window_size=list(size))
    plotter.set_background("white")
    mesh = device_mesh(bodies, lift_mm)
    # one light beside the camera: no face is black and none is washed out
    plotter.remove_all_lights()
    plotter.add_light(pyvista.Light(position=(-0.5, 0.7, 1.0), light_type="camera light", intensity=1.0))
    plotter.add_mesh(mesh, scalars="rgb", rgb=True, smooth_shading=False, ambient=0.4, diffuse=0.6)
    plotter.enable_anti_aliasing("ssaa")
    if from_above:
        plotter.view_xy()
        plotter.enable_parallel_projection()
        plotter.camera.zoom(1.3)
    else:
        # from the front right and well above, whatever the outline: one that looks along an edge shows lines
        seen = pose(Preset.ISO, np.asarray(mesh.points), size[0] / size[1])
        plotter.camera.view_angle = VIEW_ANGLE
        plotter.camera.focal_point, plotter.camera.position, plotter.camera.up = seen.focus, seen.position, seen.up
        plotter.renderer.ResetCameraClippingRange()
    plotter.screenshot(str(path))
    plotter.close()
