import os
import random
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest

from mdlcad.artefact import from_json, to_json
from mdlcad.errors import SignoffError
from mdlcad.placement.ports import PortPlace
from mdlcad.routing import place_and_route, route
from mdlcad.routing.check import check_layout
from mdlcad.routing.drawing import draw_layout
from mdlcad.routing.layout import Layout
from tests.placement.networks import HOUSE, LOCK_PORTS, MAZE_PORTS, SQUARE, lock, maze, pom_rules, small
from tests.routing.made import good

ROOT = Path(__file__).parents[2]

SCRIPT = """
import sys
from mdlcad.artefact import to_json
from mdlcad.routing import place_and_route
from mdlcad.routing.drawing import draw_layout
from tests.placement.networks import SQUARE, small
network, ports, rules = small()
placement, layout = place_and_route(network, SQUARE, ports, rules, 1)
sys.stdout.buffer.write(to_json(placement) + to_json(layout) + draw_layout(network, placement, layout, rules))
"""


def test_same_bytes_in_fresh_processes_with_other_hash_seeds():
    outputs = set()
    for hash_seed in ("1", "4242"):
        environment = {**os.environ, "PYTHONHASHSEED": hash_seed, "PYTHONPATH": str(ROOT)}
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT], capture_output=True, env=environment, check=True, cwd=ROOT
        )
        outputs.add(done.stdout)
    assert len(outputs) == 1
    assert len(outputs.pop()) > 10_000


def test_a_layout_survives_its_json():
    _, _, _, layout = good()
    assert from_json(to_json(layout), Layout) == layout


def test_an_unroutable_placement_is_refused_with_the_channel_named():
    network, rules, placement, _ = good()
    places = [(unit.column, unit.row, unit.x, unit.y) for unit in placement.masses]
    random.Random(7).shuffle(places)
    masses = tuple(
        replace(unit, column=c, row=r, x=x, y=y)
        for unit, (c, r, x, y) in zip(placement.masses, places, strict=True)
    )  # fmt: skip
    with pytest.raises(SignoffError, match="channel"):
        route(network, replace(placement, masses=masses), rules, 1)


def test_a_boundary_with_a_notch_and_a_port_on_a_slope():
    network, ports, rules = small(2)
    boundary = ((0, 0), (0, 30), (12, 42), (24, 42), (24, 24), (44, 24), (44, 0))
    slope = PortPlace("S1[0]", "slope", 6.0, 36.0, (-(0.5**0.5), 0.5**0.5))
    placed = (replace(ports[0], y=12.0), slope, PortPlace("A[0]", "right", 44, 12.0, (1.0, 0.0)))
    placement, layout = place_and_route(network, boundary, placed, rules, 1)
    assert check_layout(network, placement, layout, rules) == ()


def test_a_device_that_nothing_fits_into_is_refused():
    network, ports, rules = small()
    with pytest.raises(SignoffError, match="synthetic"):
        place_and_route(network, SQUARE, ports, replace(rules, unit_left=1e6), 1)


def test_a_larger_device_is_not_made_where_a_smaller_works():
    """The scale found is within a step of the least at which the units fit."""
    network, rules, placement, _ = good()
    footprints = len(network.masses) * (rules.unit_left + rules.unit_right) * rules.row_pitch
    side = 39 * placement.mm_per_grid
    assert footprints < side**2 < 3 * footprints


def test_the_drawing_names_every_piece():
    network, rules, placement, layout = good()
    root = ElementTree.fromstring(draw_layout(network, placement, layout, rules))
    titles = " ".join(node.text or "" for node in root.iter("{http://www.w3.org/2000/svg}title"))
    for name in (
        *(m.name for m in network.masses),
        *(c.name for c in network.couplings),
        *(t.bit for t in layout.tabs),
    ):
        assert name in titles


@pytest.mark.long
@pytest.mark.parametrize("seed", range(4))
def test_a_network_like_the_maze_robot(seed: int):
    network = maze(seed + 1)
    rules = pom_rules(network)
    placement, layout = place_and_route(network, SQUARE, MAZE_PORTS, rules, seed)
    assert check_layout(network, placement, layout, rules) == ()
    assert 39 * placement.mm_per_grid < 260


@pytest.mark.long
def test_a_network_like_the_lock():
    network = lock()
    rules = pom_rules(network)
    placement, layout = place_and_route(network, HOUSE, LOCK_PORTS, rules, 0)
    assert check_layout(network, placement, layout, rules) == ()
    assert 39 * placement.mm_per_grid < 320
