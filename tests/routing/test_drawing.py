"""The drawing of placement and routing: every piece named, every plate told apart, legible however large."""

import math
from dataclasses import replace
from itertools import pairwise
from xml.etree import ElementTree

import pytest

from mdlcad.routing.drawing import NAME_TEXT, PIXELS_A_MM, draw_layout
from mdlcad.routing.sheet import PLATES, Lanes
from tests.routing.made import good
from tests.routing.tiled import tiled

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def large():
    network, rules, placement, layout = good()
    return tiled(network, placement, layout, rules, 6)


def drawn(network, placement, layout, rules) -> ElementTree.Element:
    return ElementTree.fromstring(draw_layout(network, placement, layout, rules))


def titles(root: ElementTree.Element) -> list[str]:
    return [item.findtext(f"{SVG}title") or "" for item in root.iter() if item.find(f"{SVG}title") is not None]


def test_five_hundred_masses_have_every_piece_and_name(large):
    network, _, layout, _ = large
    assert len(network.masses) == 576
    root = drawn(*large)
    names, shown = {item.text for item in root.iter(f"{SVG}text")}, " | ".join(titles(root))
    assert {mass.name for mass in network.masses} <= names
    for piece in (*layout.rungs, *layout.trunks):
        assert f"{piece.name} of {piece.net} on" in shown
    for leaf in layout.couplers:
        assert f" {leaf.coupling} on {leaf.plate}" in shown


def test_names_are_at_least_eleven_pixels_high_at_its_own_size_and_stay_in_their_row(large):
    _, _, _, rules = large
    root = drawn(*large)
    _, _, width, _ = (float(word) for word in root.get("viewBox").split())
    assert float(root.get("width")) / width * NAME_TEXT == pytest.approx(NAME_TEXT * PIXELS_A_MM, rel=1e-3)
    assert NAME_TEXT * PIXELS_A_MM >= 11
    lanes = Lanes(rules)
    top_lane = max(lanes.offset.values()) + lanes.width / 2
    # below a name is the topmost lane of its own row
    assert rules.row_pitch / 2 - 0.3 - NAME_TEXT >= top_lane


def test_the_heading_grows_with_the_device(large):
    network, rules, placement, layout = good()

    def share(root):
        heading = next(item for item in root.iter(f"{SVG}text"))
        return float(heading.get("font-size")) / float(root.get("viewBox").split()[2])

    assert share(drawn(*large)) > 0.5 * share(drawn(network, placement, layout, rules))


@pytest.mark.parametrize("longer", [0.0, 5.0])
def test_names_of_ports_stand_beyond_their_tabs(longer):
    network, rules, placement, layout = good()
    tabs = []
    for tab in layout.tabs:
        (from_x, from_y), (x, y) = tab.path[-2:]
        on = (x, y + math.copysign(longer, y - from_y)) if x == from_x else (x + math.copysign(longer, x - from_x), y)
        tabs.append(replace(tab, path=(*tab.path[:-1], on)))
    root = drawn(network, placement, replace(layout, tabs=tuple(tabs)), rules)
    names = {item.text: item for item in root.iter(f"{SVG}text") if item.get("class") == "lt"}
    assert tabs and {tab.bit for tab in tabs} <= set(names)
    for item in root.iter(f"{SVG}rect"):
        title = item.findtext(f"{SVG}title") or ""
        if title.startswith("tab of "):
            name = names[title.split()[2]]
            x, y, width, height = (float(item.get(key, "")) for key in ("x", "y", "width", "height"))
            at, line, size = (float(name.get(key, "")) for key in ("x", "y", "font-size"))
            # capitals are some 0.75 of the size high
            apart = {
                "start": at - (x + width),
                "end": x - at,
                "middle": max(line - 0.75 * size - (y + height), y - line),
            }
            assert apart[name.get("text-anchor", "")] > 0.0, title


def test_no_two_plates_share_a_lane_or_a_colour():
    _, rules, _, _ = good()
    lanes = Lanes(rules)
    places = sorted(lanes.offset.values())
    assert min(b - a for a, b in pairwise(places)) > lanes.width
    assert len(set(PLATES)) == len(PLATES) >= len(rules.link_plates)
    assert list(lanes.offset) == list(rules.link_plates) and places == list(lanes.offset.values())


def test_the_key_names_every_plate_and_the_scale_bar_is_true():
    network, rules, placement, layout = good()
    root = drawn(network, placement, layout, rules)
    words = [item.text for item in root.iter(f"{SVG}text")]
    assert all(any(f"rung, {plate}" in text for text in words) for plate in rules.link_plates)
    group = root.find(f"{SVG}g")
    scale = float(group.get("transform").partition("scale(")[2].rstrip(")"))
    bar = next(item for item in group.iter(f"{SVG}rect") if (item.findtext(f"{SVG}title") or "").endswith(" mm"))
    length = float(bar.findtext(f"{SVG}title").split()[0])
    assert float(bar.get("width")) * scale == pytest.approx(length, rel=0.01)
