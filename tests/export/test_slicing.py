"""Every STL plate of the maze through a slicer that others print with: no repair, and G-code at the end."""

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from mdlcad.cli import HOLDS, main
from mdlcad.export.mesh import stl_plate
from tests.export.bodies import few_bodies

MAZE = Path(__file__).resolve().parents[2] / "examples" / "mazerobot.mdl"
SLICER = shutil.which("prusa-slicer")
# what PrusaSlicer prints of a mesh only where it had to mend it
REPAIRS = ("open_edges", "backwards_edges", "degenerate_facets", "edges_fixed", "facets_removed", "facets_reversed")
# a bed that holds every plate, and the layers of a common print
SETTINGS = ["--bed-shape", "0x0,600x0,600x600,0x600", "--center", "300,300", "--layer-height", "0.3"]
SETTINGS += ["--first-layer-height", "0.3", "--nozzle-diameter", "0.4"]

needs_slicer = pytest.mark.skipif(
    SLICER is None, reason="PrusaSlicer is NOT installed (apt-get install prusa-slicer): no plate was sliced"
)


def run(*arguments: str) -> str:
    found = subprocess.run([SLICER, *arguments], capture_output=True, text=True, timeout=900)
    assert found.returncode == 0, found.stderr[-2000:]
    return found.stdout + found.stderr


def faults(path: Path) -> list[str]:
    """What PrusaSlicer finds wrong with a mesh."""
    said = dict(re.findall(r"^(\w+)\s*=\s*(\S+)", run("--info", str(path)), re.M))
    return [f"{key} = {said[key]}" for key in REPAIRS if key in said] + (
        [] if said.get("manifold") == "yes" else [f"manifold = {said.get('manifold')}"]
    )


@pytest.fixture(scope="module")
def maze(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("build") / "maze"
    assert main(["build", str(MAZE), "-o", str(folder)]) == HOLDS
    return folder


@pytest.mark.long
@needs_slicer
def test_every_plate_of_the_maze_is_sliced_without_a_repair(maze, tmp_path):
    plates = sorted((maze / "plates").glob("*.stl"))
    assert len(plates) == 11
    for plate in plates:
        assert faults(plate) == [], plate.name
        target = tmp_path / f"{plate.stem}.gcode"
        said = run("--export-gcode", *SETTINGS, "--output", str(target), str(plate))
        assert "repair" not in said.lower(), (plate.name, said)
        moves = re.findall(r"^G1 .*E", target.read_text(), re.M)
        assert len(moves) > 100, plate.name


@pytest.mark.long
@needs_slicer
def test_a_plate_with_a_hole_in_its_surface_is_noticed(tmp_path):
    data = stl_plate("unit", few_bodies()[:1])
    whole, holed = tmp_path / "whole.stl", tmp_path / "holed.stl"
    whole.write_bytes(data)
    count = int(np.frombuffer(data[80:84], "<u4")[0])
    holed.write_bytes(data[:80] + np.uint32(count - 1).tobytes() + data[84:-50])
    assert faults(whole) == []
    assert faults(holed) != []
