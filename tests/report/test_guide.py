"""The assembly guide of a small device: all of it is there, it needs nothing else, and it says how to start."""

import re
from dataclasses import replace
from html import unescape

import pytest
from shapely import Polygon

from mdlcad.mechanics.drive import ClockPlateLoad, DriveLoads
from mdlcad.network.model import PortBit
from mdlcad.parts.assembly import assembly_of
from mdlcad.parts.body import Body, BodyKind
from mdlcad.report.guide import guide
from tests.parts.device import Device, small_device
from tests.parts.process import with_bed

DRIVE = DriveLoads(tuple(ClockPlateLoad(k, 1.2, -10.0, 40.0) for k in range(3)), 12.0, 1.0, (), ())


@pytest.fixture(scope="module")
def device() -> Device:
    """m0, m1 and m2 held up, m3 and m4 not at all, m5 down; m5 has the tab."""
    made = small_device()
    start = {"m0": 1.2, "m1": 1.2, "m2": 1.2, "m5": -1.2}
    masses = tuple(replace(mass, initial=start.get(mass.name, 0.0)) for mass in made.network.masses)
    return replace(made, network=replace(made.network, masses=masses, actuators=(PortBit("out[0]", "m5"),)))


@pytest.fixture(scope="module")
def bodies(device) -> tuple[Body, ...]:
    return device.bodies()


@pytest.fixture(scope="module")
def page(device, bodies) -> str:
    return guide(device.network, device.sizing, device.placement, device.process, bodies, DRIVE)


def rows(page: str) -> dict[str, list[str]]:
    """Cells of the table of starting places, by unit."""
    start = page[page.index('id="start"') :]
    found = {}
    for row in re.findall(r"<tr><td class=\"n\">(.*?)</tr>", start, re.S):
        cells = [unescape(re.sub(r"<[^>]*>", "", cell)) for cell in re.split(r"</t[dh]>", row)]
        found[cells[1]] = cells[2:5]
    return found


def test_the_page_needs_no_other_file(page):
    assert not re.search(r"https?://|<script|<link|\bsrc=|@import|url\(", page)
    assert "@media print" in page


def test_every_step_has_a_number_a_title_and_a_drawing(page, device, bodies):
    steps = assembly_of(bodies, device.process)
    titles = re.findall(r"<h2>(\d+) · ([^<]*)</h2>", page)
    assert [int(number) for number, _ in titles] == list(range(1, len(steps) + 1))
    assert page.count("<svg ") == len(steps) + 1
    assert page.count("</svg>") == len(steps) + 1


def test_pins_are_pressed_into_those_clock_plates_that_have_some(device, bodies):
    bare = [body for body in bodies if body.kind is not BodyKind.PIN or not body.name.startswith("pin.clock")]
    assert len(bare) < len(bodies)
    for made, pressed in ((bodies, 3), (bare, 0)):
        text = guide(device.network, device.sizing, device.placement, device.process, made, DRIVE)
        assert text.count("Press its pins into the plate first.") == pressed
        assert text.count("It must slide to and fro by") == 3


def test_every_unit_has_its_preload_and_every_bent_leaf_its_bend(page, device):
    text = unescape(page)
    for unit in device.sizing.units:
        side = "left" if unit.preload >= 0 else "right"
        assert f"unit.{unit.mass}: <em>{abs(unit.preload):.2f} mm {side}</em>" in text
    for bias in device.sizing.biases:
        side = "up" if bias.offset > 0 else "down"
        assert f"post.bias.{bias.mass}: <em>first bend its leaf by {abs(bias.offset):.2f} mm {side} the page" in text


def test_every_loose_piece_is_listed_in_the_step_that_lays_it(page, bodies):
    text = unescape(page)
    for body in bodies:
        if body.kind in (BodyKind.RUNG, BodyKind.TRUNK, BodyKind.COUPLER, BodyKind.ROCKER, BodyKind.BIAS):
            assert body.name in text


def test_hardware_is_counted(page, bodies):
    screws = sum(body.kind is BodyKind.SCREW for body in bodies)
    assert screws >= 4
    assert f"{screws} screws of" in page


def test_the_starting_state_says_which_side_how_far_and_by_what(page, device, bodies):
    found = rows(page)
    assert set(found) == {"m0", "m1", "m2", "m5"}
    assert found["m5"][0] == "down the page" and found["m0"][0] == "up the page"
    millimetres = f"{1.2 * device.process.unit.throw_unit:.2f}"
    assert all(cells[1] == millimetres for cells in found.values())
    assert found["m5"][2] == "the tab of out[0]"
    cover = next(body.section for body in bodies if body.kind is BodyKind.COVER)
    windows = [Polygon(ring) for ring in cover.interiors if Polygon(ring).minimum_rotated_rectangle.area > 20.0]
    by_window = [mass for mass, cells in found.items() if "window" in cells[2]]
    assert len(windows) == len(by_window) > 0
    for mass, cells in found.items():
        assert mass == "m5" or (mass in by_window) != ("before the cover goes on" in cells[2])


def test_the_clock_starts_a_third_of_a_turn_apart(page):
    start = unescape(page[page.index('id="start"') :])
    assert re.findall(r"clock-\d</th><td class=\"n\">([^<]*)<", start) == ["in its middle", "0.52 right", "0.52 left"]


def test_tiles_are_named_where_a_plate_is_larger_than_the_bed(device, bodies):
    process = with_bed(device.process, (100.0, 80.0))
    text = guide(device.network, device.sizing, device.placement, process, bodies, DRIVE)
    assert "tiles/base-1, tiles/base-2" in text


def test_the_same_page_every_time(page, device, bodies):
    assert page == guide(device.network, device.sizing, device.placement, device.process, bodies, DRIVE)
