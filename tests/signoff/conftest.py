"""The small device's files, written and read back once."""

import pytest

from mdlcad.export.drawing import svg_plate
from mdlcad.export.step import step_assembly
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.plates import plates_of
from mdlcad.signoff.readback import read_step
from mdlcad.signoff.sections import read_cut
from tests.parts.device import Device, small_device


@pytest.fixture(scope="session")
def device() -> Device:
    return small_device()


@pytest.fixture(scope="session")
def bodies(device: Device) -> dict[str, Body]:
    return {body.name: body for body in device.bodies()}


@pytest.fixture(scope="session")
def files(device: Device, bodies: dict[str, Body], tmp_path_factory: pytest.TempPathFactory):
    """The small device's STEP file, read back, and its plates' drawings."""
    folder = tmp_path_factory.mktemp("small")
    (folder / "plates").mkdir()
    # what takes the most time to write and to read, and holds nothing that is looked for
    idle = (BodyKind.FRAME, BodyKind.BASE, BodyKind.COVER, BodyKind.SPACER)
    needed = ("frame.V", *(name for name in bodies if name.startswith("spacer.clock")))
    kept = [body for body in bodies.values() if body.kind not in idle or body.name in needed]
    (folder / "small.step").write_bytes(step_assembly("small", kept))
    for plate, members in plates_of(list(bodies.values())).items():
        (folder / "plates" / f"{plate}.svg").write_bytes(svg_plate(plate, members))
    return read_step(folder / "small.step"), read_cut(folder, device.process)
