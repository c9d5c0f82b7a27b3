"""A boundary without room is known before the search, and the message holds the size that would do."""

from __future__ import annotations

import re
from dataclasses import replace

from mdlcad.routing import find_lack
from tests.placement.networks import MAZE_PORTS, SQUARE, maze, pom_rules

SLIVER = ((0, 0), (0, 1), (3000, 1), (3000, 0))


def test_the_maze_has_room_in_its_square() -> None:
    network = maze()
    assert find_lack(network, SQUARE, MAZE_PORTS, pom_rules(network)) is None


def test_a_sliver_is_too_thin_and_the_size_named_would_do() -> None:
    network = maze()
    rules = pom_rules(network)
    ports = tuple(replace(port, x=port.x * 70, y=float(port.y > 20)) for port in MAZE_PORTS)
    lack = find_lack(network, SLIVER, ports, rules)
    assert lack is not None and lack.bit is None
    assert f"its {len(network.masses)} units" in lack.what
    size = re.search(r"only at (\d+) x (\d+) mm would it have room", lack.what)
    assert size, lack.what
    # one row of units, and no more than that, between the two rims
    tall = float(size[2]) - 2 * (rules.frame_width + rules.gap)
    assert rules.row_pitch - 1 < tall < rules.row_pitch * 1.2


def test_tabs_that_would_collide_are_named_with_their_distance() -> None:
    network = maze()
    rules = pom_rules(network)
    first = MAZE_PORTS[0]
    ports = tuple(
        replace(port, x=first.x, y=first.y + 0.001, line=first.line, normal=first.normal) if index == 1 else port
        for index, port in enumerate(MAZE_PORTS)
    )
    lack = find_lack(network, SQUARE, ports, rules)
    assert lack is not None and lack.bit == ports[1].bit
    assert f"the places of {first.bit} and {ports[1].bit} are 0.001 grid units apart" in lack.what
    apart = float(re.search(r"at least ([\d.]+) grid units", lack.mend)[1])
    moved = tuple(replace(port, y=first.y + apart) if index == 1 else port for index, port in enumerate(ports))
    assert find_lack(network, SQUARE, moved, rules) is None
