"""Everything a build writes for other programs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from mdlcad.artefact import write_atomic
from mdlcad.export.drawing import dxf_plate, svg_plate
from mdlcad.export.mesh import stl_plate, threemf_device
from mdlcad.export.step import step_assembly
from mdlcad.parts.body import Body
from mdlcad.parts.plates import plates_of


def write_files(design: str, bodies: Sequence[Body], folder: Path, progress: Callable[[str], None]) -> tuple[str, ...]:
    """Write NAME.step, NAME.3mf and plates/PLATE.{step,stl,dxf,svg}; the paths written, relative to ``folder``.

    Raises:
        SignoffError: a file read back does not hold what it should.
    """
    written: list[str] = []

    def put(name: str, data: bytes) -> None:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomic(path, data)
        written.append(name)

    progress("assembly")
    put(f"{design}.step", step_assembly(design, bodies))
    put(f"{design}.3mf", threemf_device(design, bodies))
    for plate, members in plates_of(bodies).items():
        progress(f"plate {plate}")
        put(f"plates/{plate}.stl", stl_plate(plate, members))
        put(f"plates/{plate}.svg", svg_plate(plate, members))
        put(f"plates/{plate}.dxf", dxf_plate(members))
        put(f"plates/{plate}.step", step_assembly(plate, members))
    return tuple(written)
