from collections import Counter

import numpy as np
import pytest

from mdlcad.placement.lattice import Lattice, lattices, place_ports
from mdlcad.placement.levels import start_by_levels
from mdlcad.placement.problem import build
from tests.placement.networks import MAZE_PORTS, SQUARE, maze, pom_rules
from tests.placement.tiles import tiled

SMALL = maze()
LARGE = tiled(SMALL, 4, 0.1, 1, 1)


def lattice(scale: float) -> Lattice:
    rules = pom_rules(LARGE)
    ports = place_ports(LARGE, MAZE_PORTS, scale)
    return lattices(SQUARE, ports, rules, scale, len(LARGE.masses))[0]


@pytest.fixture(scope="module", params=(14.0, 20.0))
def start(request: pytest.FixtureRequest) -> tuple[Lattice, np.ndarray]:
    found = lattice(request.param)
    return found, start_by_levels(build(LARGE, found, pom_rules(LARGE)), found, 1).slot


def test_everyone_has_a_slot_of_his_own(start: tuple[Lattice, np.ndarray]) -> None:
    found, slots = start
    assert len(slots) == len(LARGE.masses)
    assert len(set(slots.tolist())) == len(slots)
    assert set(slots.tolist()) <= set(range(len(found.slots)))


def test_no_coupling_is_more_than_a_column_too_far() -> None:
    found = lattice(20.0)
    slots = start_by_levels(build(LARGE, found, pom_rules(LARGE)), found, 1).slot
    column = {mass.name: found.slots[int(slot)][0] for mass, slot in zip(LARGE.masses, slots, strict=True)}
    assert max(abs(column[item.source] - column[item.target]) for item in LARGE.couplings) <= 1


def test_swapping_sources_keeps_every_number_of_inputs_and_outputs() -> None:
    plain = tiled(SMALL, 4, 0.0, 1, 1)
    for end in ("source", "target"):
        assert Counter(getattr(c, end) for c in LARGE.couplings) == Counter(getattr(c, end) for c in plain.couplings)
    changed = {c.name for c in LARGE.couplings} - {c.name for c in plain.couplings}
    assert 0.05 * len(plain.couplings) < len(changed) <= 0.11 * len(plain.couplings)
    copies = [sorted(int(end.partition(".")[0]) for end in (c.source, c.target)) for c in LARGE.couplings]
    assert all(b - a <= 1 for a, b in copies)
