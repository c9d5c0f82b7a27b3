import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import LineString

from mdlcad.placement.placers import AnnealPlacer, PaperPlacer, Placer
from mdlcad.placement.sites import (
    PaperOptions,
    SiteProblem,
    StraightOptions,
    measure,
    place_like_the_paper,
    place_straight,
)
from mdlcad.placement.sites.kernels import count_crossings
from mdlcad.placement.sites.problem import lines_between
from mdlcad.placement.unit_grid import Seating, grid_problem, place_on_grid
from tests.placement.networks import HOUSE, MAZE_PORTS, SQUARE, synthetic

GRID = np.array([(x, y) for x in range(8) for y in range(8)], np.float64)


def ring(nodes: int) -> SiteProblem:
    pairs = [(i, (i + 1) % nodes) for i in range(nodes)] + [(0, nodes)]
    return SiteProblem(nodes, GRID, np.array([(-1.0, 3.0)]), lines_between(pairs))


@given(
    st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), min_size=6, max_size=9, unique=True),
    st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5)), min_size=3, max_size=12),
)
@settings(max_examples=150, deadline=None)
def test_crossings_are_those_of_another_library(places: list[tuple[int, int]], pairs: list[tuple[int, int]]) -> None:
    lines = lines_between(pairs)
    points = np.array(places, np.float64)
    drawn = [LineString([places[a], places[b]]) for a, b in lines]
    expected = sum(
        drawn[i].intersects(drawn[j])
        for i in range(len(lines))
        for j in range(i)
        if not set(lines[i].tolist()) & set(lines[j].tolist())
    )
    assert count_crossings(points, lines) == expected


@pytest.mark.parametrize("place", [place_like_the_paper, place_straight])
def test_every_mass_has_a_site_of_its_own_and_the_figures_are_right(place) -> None:
    problem = ring(20)
    found = place(problem, 3)
    assert len(set(found.site_of.tolist())) == 20
    again = measure(problem, found.site_of)
    assert (found.crossings, found.length) == (again.crossings, again.length)
    assert place(problem, 3).site_of.tolist() == found.site_of.tolist()
    assert place(problem, 4).site_of.tolist() != found.site_of.tolist()


def test_annealing_finds_a_ring_without_crossings() -> None:
    found = place_straight(ring(20), 0, StraightOptions(moves_per_mass=3000))
    assert found.crossings == 0
    assert found.length <= 1.15 * 21


def test_swaps_only_ever_take_crossings_away() -> None:
    problem = ring(30)
    before = place_like_the_paper(problem, 1, PaperOptions(sweeps=0)).crossings
    after = place_like_the_paper(problem, 1, PaperOptions(sweeps=30, radius=20.0)).crossings
    assert before > 0
    assert after < before


def test_too_few_sites_are_refused() -> None:
    with pytest.raises(ValueError, match="65 masses do not fit 64 sites"):
        SiteProblem(65, GRID, np.zeros((0, 2)), lines_between([]))


@pytest.mark.parametrize("boundary", [SQUARE, HOUSE])
@pytest.mark.parametrize("seating", list(Seating))
@pytest.mark.parametrize("placer", [AnnealPlacer(), PaperPlacer()])
def test_a_network_on_the_programs_grid(boundary, seating: Seating, placer: Placer) -> None:
    network = synthetic(40, 60, 6, 4, 5, 4, 2, 0)
    ports = MAZE_PORTS  # on the square; for the house the pins just stand where they are
    found = place_on_grid(network, boundary, ports, placer, seating, 0)
    assert [place.mass for place in found.masses] == [mass.name for mass in network.masses]
    assert len({(place.x, place.y) for place in found.masses}) == 40
    at = {place.bit: (place.x, place.y) for place in ports}
    seated = [place for place in found.masses if place.port is not None]
    assert bool(seated) == (seating is Seating.ON_BOUNDARY)
    assert all((place.x, place.y) == at[place.port] for place in seated)
    assert all((port.x, port.y) == at[port.bit] for port in found.ports)


def test_a_small_grid_is_divided_until_all_masses_fit() -> None:
    network = synthetic(40, 60, 6, 4, 5, 4, 2, 0)
    small = ((0, 0), (0, 4), (4, 4), (4, 0))
    problem = grid_problem(network, small, MAZE_PORTS, Seating.TAB)
    assert problem.scale == 0.5
    assert len(problem.sites.sites) == 49
