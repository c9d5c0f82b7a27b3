"""A model on a PyVista stage: one actor a plate and kind of body, whatever the number of bodies."""

from __future__ import annotations

import os
from collections.abc import Collection, Sequence
from typing import Any

import numpy as np
import pyvista
import vtk

from mdlcad.view.camera import VIEW_ANGLE, Pose
from mdlcad.view.colours import Colours, rgb
from mdlcad.view.mesh import Model
from mdlcad.view.motion import Floats

# VTK asks for an X server first and says so on the terminal when there is none
vtk.vtkLogger.SetStderrVerbosity(vtk.vtkLogger.VERBOSITY_ERROR)
if "DISPLAY" not in os.environ:
    os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")

FOUND = "#e5177b"
"""Colour of what was searched for."""

_AMBIENT = 0.45  # with one light beside the camera, no face is black and none is washed out
_AROUND = 0.10  # opacity of everything else meanwhile


class Stage:
    """Shows a model. Everything set on it holds until it is set again."""

    def __init__(self, model: Model, plotter: Any) -> None:
        """Put ``model`` on ``plotter`` (a ``pyvista.Plotter``; that library has no types)."""
        self.model = model
        self.plotter = plotter
        self.shown: tuple[str, ...] = model.plates
        self.found: tuple[int, ...] = ()
        self._explode = 0.0
        self.moves = 0  # how often the bodies have been moved
        self.meshes = []
        self.actors = []
        self._marked: list[Any] = []
        plotter.set_background("white")
        plotter.remove_all_lights()
        plotter.add_light(pyvista.Light(position=(-0.5, 0.7, 1.0), light_type="camera light", intensity=1.0))
        for number, group in enumerate(model.groups):
            mesh = pyvista.PolyData(group.points.copy(), _cells(group.faces))
            mesh.cell_data["rgb"] = np.zeros((len(group.faces), 3), dtype=np.uint8)
            actor = plotter.add_mesh(
                mesh,
                scalars="rgb",
                rgb=True,
                smooth_shading=False,
                ambient=_AMBIENT,
                diffuse=1.0 - _AMBIENT,
                name=f"group {number}",
                reset_camera=False,
                render=False,
            )
            self.meshes.append(mesh)
            self.actors.append(actor)

    @property
    def explode(self) -> float:
        """How far the plates are taken apart, 0 to 1."""
        return self._explode

    @property
    def aspect(self) -> float:
        """Width over height of the picture."""
        width, height = self.plotter.window_size
        return float(width / height)

    def body_at(self, actor: object, cell: int) -> int | None:
        """Number of the body that a picked cell is of; None if the actor is not of the model."""
        for number, own in enumerate(self.actors):
            if own is actor:
                return int(self.model.groups[number].body[cell])
        return None

    def points(self, numbers: Collection[int] | None = None) -> Floats:
        """float[n, 3], mm: points of the bodies shown, or of the bodies called for, where they now stand."""
        found = []
        for group, mesh in zip(self.model.groups, self.meshes, strict=True):
            if numbers is None:
                if group.plate in self.shown:
                    found.append(np.asarray(mesh.points))
            else:
                chosen = group.faces[np.isin(group.body, list(numbers))]
                found.append(np.asarray(mesh.points)[np.unique(chosen)])
        parts = [part for part in found if len(part)]
        whole: Floats = np.concatenate(parts) if parts else np.zeros((1, 3))
        return whole

    def show(self, plates: Sequence[str]) -> None:
        """Show these plates only."""
        self.shown = tuple(plates)
        for group, actor in zip(self.model.groups, self.actors, strict=True):
            actor.SetVisibility(group.plate in self.shown)
        self.mark(self.found)

    def stand(self, *, explode: float, displacements: Floats | None) -> None:
        """Take the plates apart (0 to 1) and move the references (float[r, 2], mm; None: as assembled)."""
        self._explode = explode
        self.moves += 1
        for group, mesh in zip(self.model.groups, self.meshes, strict=True):
            mesh.points[:] = group.placed(explode * self.model.apart, displacements)
            mesh.GetPoints().Modified()
            mesh.Modified()

    def paint(self, colours: Colours) -> None:
        """Colour the bodies, uint8[b, 3]."""
        for group, mesh in zip(self.model.groups, self.meshes, strict=True):
            mesh.cell_data["rgb"][:] = colours[group.body]
            mesh.GetCellData().Modified()
            mesh.GetCellData().GetArray("rgb").Modified()
            mesh.Modified()

    def mark(self, numbers: Sequence[int]) -> None:
        """Make these bodies stand out, whatever lies over them, and all others recede; with none, all are as usual."""
        self.found = tuple(numbers)
        for actor in self._marked:
            self.plotter.remove_actor(actor, reset_camera=False, render=False)
        self._marked = []
        for actor in self.actors:
            actor.GetProperty().SetOpacity(_AROUND if numbers else 1.0)
        for number, (group, mesh) in enumerate(zip(self.model.groups, self.meshes, strict=True)):
            faces = group.faces[np.isin(group.body, self.found)]
            if not len(faces):
                continue
            own = pyvista.PolyData(np.zeros((len(group.points), 3)), _cells(faces))
            own.SetPoints(mesh.GetPoints())  # the same points: what moves the group moves its marked bodies
            actor = self.plotter.add_mesh(
                own,
                color=rgb(FOUND).tolist(),
                smooth_shading=False,
                ambient=_AMBIENT,
                diffuse=1.0 - _AMBIENT,
                name=f"found {number}",
                reset_camera=False,
                render=False,
                pickable=False,
            )
            self._marked.append(actor)

    def look(self, pose: Pose) -> None:
        """Set the camera."""
        camera = self.plotter.camera
        camera.view_angle = VIEW_ANGLE
        camera.focal_point, camera.position, camera.up = pose.focus, pose.position, pose.up
        camera.SetParallelProjection(pose.half_height is not None)
        if pose.half_height is not None:
            camera.parallel_scale = pose.half_height
        self.plotter.renderer.ResetCameraClippingRange()

    def picture(self) -> Colours:
        """uint8[height, width, 3], the stage as seen now."""
        self.plotter.renderer.ResetCameraClippingRange()
        self.plotter.render()
        image: Colours = np.asarray(self.plotter.screenshot(None, return_img=True))[:, :, :3]
        return image


def hidden_stage(model: Model, size: tuple[int, int], *, smooth: str = "ssaa") -> Stage:
    """A stage without a window, (width, height) pixels; ``smooth`` is PyVista's name of an anti-aliasing."""
    plotter = pyvista.Plotter(off_screen=True, window_size=list(size))
    plotter.enable_anti_aliasing(smooth)
    return Stage(model, plotter)


def _cells(faces: Any) -> Any:
    """VTK's form of int[m, 3] triangles."""
    return np.column_stack([np.full(len(faces), 3, dtype=np.int64), faces]).ravel()
