"""Everything a build writes for other programs."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import nullcontext
from pathlib import Path

from mdlcad.artefact import write_atomic
from mdlcad.export.drawing import dxf_plate, svg_plate
from mdlcad.export.mesh import stl_plate, threemf_device
from mdlcad.export.step import step_assembly
from mdlcad.mechanics import Process
from mdlcad.parts.body import Body
from mdlcad.parts.plates import plates_of
from mdlcad.parts.tiles import tiles_of


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
    # a child that was forked would share this one's CAD kernel
    pool = ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) if workers > 1 else nullcontext()
    with pool as executor:
        whole = _started(executor, design, bodies)
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
                put(f"{stem}.svg", svg_plate(plate, cut))
                put(f"{stem}.dxf", dxf_plate(cut, kerf_mm))
            put(f"plates/{plate}.step", step_assembly(plate, members))
        progress("STEP of the device")
        put(f"{design}.step", whole())
    return tuple(sorted(written))


def _started(executor: Executor | None, name: str, bodies: Sequence[Body]) -> Callable[[], bytes]:
    """A STEP file under way; calling the result waits for its bytes."""
    if executor is None:
        return lambda: step_assembly(name, bodies)
    future: Future[bytes] = executor.submit(step_assembly, name, bodies)
    return future.result
