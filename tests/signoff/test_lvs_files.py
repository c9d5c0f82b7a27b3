"""Faults in real geometry: bodies written to a STEP file and read back, each fault caught and named."""

from dataclasses import replace
from pathlib import Path

import pytest
import shapely
from shapely import Polygon, box
from shapely.affinity import translate

from mdlcad.export.step import step_assembly
from mdlcad.parts.body import Body, BodyKind
from mdlcad.signoff.lvs import compare, recover
from mdlcad.signoff.readback import ReadBody, read_step
from tests.parts.device import Device


class Bench:
    """The device's bodies as read; parts are exchanged for others that went through a STEP file of their own."""

    def __init__(self, device: Device, found: tuple[ReadBody, ...], bodies: dict[str, Body], folder: Path) -> None:
        self.device, self.bodies, self.folder = device, bodies, folder
        self.found = {body.name: body for body in found}

    def write(self, *changed: Body) -> None:
        path = self.folder / "changed.step"
        path.write_bytes(step_assembly("changed", [replace(body, assembled=None) for body in changed]))
        self.found |= {body.name: body for body in read_step(path)}

    def section(self, name: str) -> Polygon:
        return self.found[name].section

    def differences(self) -> str:
        result = compare(recover(list(self.found.values())), self.device.network)
        assert result.matched == (not result.differences)
        return "\n".join(result.differences)


@pytest.fixture
def bench(device: Device, files, bodies: dict[str, Body], tmp_path: Path) -> Bench:
    return Bench(device, files[0], bodies, tmp_path)


def test_the_device_matches(bench: Bench) -> None:
    assert bench.differences() == ""


@pytest.mark.parametrize(
    ("leaf", "words"),
    [
        ("coupler.m0->m3", "coupling missing: m0->m3"),
        ("rocker.m1->m4", "coupling missing: m1->m4"),
        ("bias.m2", "bias"),
    ],
)
def test_a_missing_leaf(bench: Bench, leaf: str, words: str) -> None:
    del bench.found[leaf]
    assert words in bench.differences()


def test_a_leaf_cut_through(bench: Bench) -> None:
    """The block stays on its hub, but the wall ends short of the carrier."""
    section = bench.section("coupler.m0->m3")
    low, bottom, high, top = section.bounds
    bench.write(replace(bench.bodies["coupler.m0->m3"], section=section.intersection(box(low + 1, bottom, high, top))))
    assert "open: coupler.m0->m3" in bench.differences()


def test_a_swapped_pair(bench: Bench) -> None:
    """Units m3 and m4 stand in each other's place."""
    m3, m4 = bench.section("unit.m3"), bench.section("unit.m4")
    bench.write(replace(bench.bodies["unit.m3"], section=m4), replace(bench.bodies["unit.m4"], section=m3))
    found = bench.differences()
    assert "coupling missing: m0->m3" in found and "coupling not in the network: m0->m4" in found


def test_a_short_between_carriers(bench: Bench) -> None:
    """A sliver of the trunk plate joins two trunks."""
    first, second = (bench.section(f"trunk.{name}.t") for name in ("m0", "m1"))
    low, high = max(first.bounds[1], second.bounds[1]), min(first.bounds[3], second.bounds[3])
    left, right = sorted((first, second), key=lambda s: s.bounds[0])
    bridge = box(left.bounds[2] - 0.1, (low + high) / 2, right.bounds[0], (low + high) / 2 + 1)
    bench.write(
        replace(
            bench.bodies["trunk.m0.t"],
            section=shapely.union_all([first, bridge])
            if left is first
            else shapely.union_all([first, translate(bridge, 0.1)]),
        )
    )
    assert "short: the shuttles of m0, m1 are joined by one carrier" in bench.differences()


def test_a_misplaced_pin(bench: Bench) -> None:
    """A hub pin three millimetres off its hole."""
    name = next(name for name in bench.found if name.startswith("pin.hub.m3."))
    bench.write(replace(bench.bodies[name], section=translate(bench.section(name), 0.0, 6.0)))
    assert "open: coupler.m0->m3" in bench.differences()


def test_a_pin_left_out(bench: Bench) -> None:
    del bench.found[next(name for name in bench.found if name.startswith("pin.via.m0."))]
    assert bench.differences() != ""


def test_a_missing_slot(bench: Bench) -> None:
    """The clock pin of m5, phase 2, comes up through clock-1: without its slot, that plate would drive it too."""
    pin = bench.section("pin.clock.m5")
    filled = bench.section("clock-1").union(pin.buffer(3.0, join_style="mitre")).difference(pin)
    assert isinstance(filled, Polygon)
    bench.write(replace(bench.bodies["clock-1"], section=filled))
    assert "jam: pin.clock.m5 meets clock-1 and clock-2" in bench.differences()


def test_a_missing_notch(bench: Bench) -> None:
    """A rim that a carrier runs into."""
    trunk = bench.section("trunk.m0.t")
    rim = bench.section("frame.V").union(box(-1, trunk.bounds[1], trunk.bounds[0], trunk.bounds[1] + 2))
    bench.write(replace(bench.bodies["frame.V"], kind=BodyKind.FRAME, section=rim))
    assert "jam: trunk.m0.t meets frame.V" in bench.differences()


def test_a_clock_plate_without_one_of_its_guides(bench: Bench) -> None:
    del bench.found["guide.clock-1.1"]
    assert bench.differences() == "open: 1 guides hold clock-1, 2 are needed"


def test_a_guide_cut_from_its_rim(bench: Bench) -> None:
    guide = bench.bodies["guide.clock-0.0"]
    low, bottom, high, top = guide.section.bounds
    bench.write(replace(guide, section=box(low, bottom + 1.0, high, top)))
    assert "open: guide.clock-0.0 joins clock-0, not a clock plate and its rim" in bench.differences()


def test_a_clock_plate_that_is_not_cut_free_of_its_rim(bench: Bench) -> None:
    plate = bench.section("clock-0")
    left, bottom, _, top = plate.bounds
    middle = (bottom + top) / 2.0
    bridged = plate.union(box(bench.section("spacer.clock-0").bounds[0] + 8.0, middle, left + 0.1, middle + 1.0))
    assert isinstance(bridged, Polygon)
    bench.write(replace(bench.bodies["clock-0"], section=bridged))
    assert "jam: clock-0 meets spacer.clock-0" in bench.differences()
