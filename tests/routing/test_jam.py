"""What a failure shows and says, and how the size of a device is bounded."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest

from mdlcad.routing.driver import Size
from mdlcad.routing.jam import MARGIN, Jam, draw_jam
from mdlcad.routing.pieces import Channel, Edge, Item, Role, TrunkPiece
from tests.parts.device import small_device

SVG = "{http://www.w3.org/2000/svg}"


def test_the_picture_shows_the_full_channel_with_what_it_was_to_hold() -> None:
    device = small_device()
    rules, placement = device.sizing.rules, device.placement
    low, high = placement.row_y[0], placement.row_y[2]
    trunks = [TrunkPiece("m0", ((0, 1),), low, high), TrunkPiece("m1", ((0, 1),), low, high)]
    item = Item(Role.COUPLER, "m0", "m0->m3", (("m3", 0),), low - 1.0, low + 1.0, Edge(0), Edge(1), trunk=0)
    jam = Jam(placement, Channel(1, trunks, [item]))
    data = draw_jam(device.network, jam, rules, "channel 1 cannot hold <all> of it")
    assert data == draw_jam(device.network, jam, rules, "channel 1 cannot hold <all> of it")
    root = ElementTree.fromstring(data)
    titles = [title.text for title in root.iter(f"{SVG}title")]
    assert {"channel 1", "trunk of m0", "trunk of m1", "coupler m0->m3 of m0"} <= set(titles)
    box = next(rect for rect in root.iter(f"{SVG}rect") if rect.get("class") == "jc")
    left = float(box.get("x", "0")) - MARGIN
    assert left == pytest.approx(placement.column_x[0] + rules.hub_half, abs=0.01)
    assert float(box.get("width", "0")) == pytest.approx(rules.column_pitch - 2 * rules.hub_half, abs=0.01)
    assert "cannot hold <all>" in " ".join(text.text or "" for text in root.iter(f"{SVG}text"))


def test_a_bed_bounds_the_scale_either_way_round() -> None:
    house = ((0, 35), (20, 49), (39, 35), (39, 0), (0, 0))
    assert Size(fit=(200.0, 250.0)).most(house) == pytest.approx(250.0 / 49)
    assert Size(fit=(250.0, 200.0)).most(house) == pytest.approx(250.0 / 49)
    assert Size(fit=(250.0, 100.0)).most(house) == pytest.approx(100.0 / 39)
    assert Size().most(house) > 1e9
