"""Everything a build writes for other programs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from shapely.affinity import translate

from mdlcad.artefact import write_atomic
from mdlcad.aside import Aside
from mdlcad.export.drawing import dxf_plate, svg_plate
from mdlcad.export.mesh import stl_plate, threemf_device
from mdlcad.export.step import step_assembly
from mdlcad.mechanics import Process
from mdlcad.parts.body import Body
from mdlcad.parts.plates import plates_of
from mdlcad.parts.tiles import tiles_of


def laid_out(bodies: Sequence[Body], apart_mm: float) -> list[Body]:
    """What is cut from one sheet, as it lies there: shims, which lie at many heights, side by side in x.

    Args:
        apart_mm: what is left of the sheet between two heights: a wall, that the machine can leave.
    """
    heights = sorted({body.z for body in bodies})
    boxes = [body.section.bounds for body in bodies]
    step = max(box[2] for box in boxes) - min(box[0] for box in boxes) + apart_mm
    return [
        body if body.z == heights[0] else replace(body, section=translate(body.section, heights.index(body.z) * step))
        for body in bodies
    ]


def write_files(
    design: str,
    bodies: Sequence[Body],
    process: Process,
    kerf_mm: float,
    folder: Path,
    workers: int,
    progress: Callable[[str], None],
) -> tuple[str, ...]:
    """Write NAME.step, NAME.3mf and plates/PLATE.{step,stl,dxf,svg}; the paths written, relative to ``folder``.

    Plates larger than the machine's bed also have tiles/PLATE-N.{stl,dxf,svg}.

    STEP files take most of the time; with more than one worker the device's is made in a process beside this one, which
    makes those of the plates meanwhile. ``kerf_mm`` is what DXF files allow for.

    Raises:
        SignoffError: a file read back does not hold what it should.
    """
    written: list[str] = []

    def put(name: str, data: bytes) -> None:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomic(path, data)
        written.append(name)

    plates = plates_of(bodies)
    with ExitStack() as ending:
        aside = ending.enter_context(Aside(step_assembly, design, bodies)) if workers > 1 else None
        progress("3MF")
        put(f"{design}.3mf", threemf_device(design, bodies))
        for plate, members in plates.items():
            progress(f"plate {plate}")
            tiles = tiles_of(plate, members, process).tiles
            for stem, cut in [
                (f"plates/{plate}", members),
                *((f"tiles/{tile.name}", tile.bodies) for tile in tiles if tile.name != plate),
            ]:
                put(f"{stem}.stl", stl_plate(plate, cut))
                flat = laid_out(cut, process.machine.min_wall)
                put(f"{stem}.svg", svg_plate(plate, flat))
                put(f"{stem}.dxf", dxf_plate(flat, kerf_mm))
            put(f"plates/{plate}.step", step_assembly(plate, members))
        progress("STEP of the device")
        put(f"{design}.step", step_assembly(design, bodies) if aside is None else aside.result())
    return tuple(sorted(written))
