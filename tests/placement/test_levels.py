import itertools
from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mdlcad.placement.lattice import Lattice, lattices, place_ports
from mdlcad.placement.levels import spread, start_by_levels
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


@given(st.lists(st.floats(-5, 60), min_size=1, max_size=25), st.integers(25, 50))
def test_masses_of_a_column_are_spread_as_near_to_their_wishes_as_may_be(wishes: list[float], count: int) -> None:
    wanted = np.sort(np.array(wishes))
    places = spread(wanted, count)
    assert all(0 <= one < count for one in places)
    assert all(two > one for one, two in itertools.pairwise(places))
    if len(wanted) == 1:
        assert places[0] == int(np.clip(np.floor(wanted[0] + 1e-9), 0, count - 1))


def test_what_stands_far_apart_stays_and_what_stands_together_moves_apart_about_its_middle() -> None:
    assert spread(np.array([3.0, 10.0, 20.0]), 30) == [3, 10, 20]
    assert spread(np.array([10.0, 10.0, 10.0]), 30) == [8, 10, 12]
    assert spread(np.array([0.0, 0.0, 29.0]), 30) == [0, 2, 29]


def test_a_mass_with_a_tab_stands_near_it() -> None:
    found = lattice(20.0)
    problem = build(LARGE, found, pom_rules(LARGE))
    slots = start_by_levels(problem, found, 1).slot
    tabs, away = problem.tab[:, 3], []
    rows = np.array([row for _, row in found.slots])
    for low, high, _, mass in problem.tab.tolist():
        away.append(abs(rows[slots[mass]] - (low + high) / 2))
    # as far as any two rows are from each other by chance: a third of all
    assert len(tabs)
    assert np.mean(away) < len(found.row_y) / 3
