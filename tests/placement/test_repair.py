from dataclasses import replace

import numpy as np
import pytest

from mdlcad.placement.lattice import Lattice, lattices, place_ports
from mdlcad.placement.levels import start_by_levels
from mdlcad.placement.placer import place
from mdlcad.placement.problem import Problem, build
from mdlcad.placement.repair import Columns, repair
from tests.placement.networks import MAZE_PORTS, SQUARE, maze, pom_rules
from tests.placement.tiles import tiled

LARGE = tiled(maze(), 4, 0.1, 1, 1)


def lattice() -> Lattice:
    return lattices(SQUARE, place_ports(LARGE, MAZE_PORTS, 20.0), pom_rules(LARGE), 20.0, len(LARGE.masses))[0]


@pytest.fixture(scope="module")
def problem() -> Problem:
    return build(LARGE, lattice(), pom_rules(LARGE))


@pytest.fixture
def columns(problem: Problem) -> Columns:
    return start_by_levels(problem, lattice(), 1).columns


def overfull(problem: Problem, columns: Columns) -> list[int]:
    """Masses whose hubs hold too many items or posts, counted from the couplings one by one."""
    masses, last = len(columns.column), problem.slot_at.shape[0] - 1
    items, posts = np.zeros((masses, 2), int), np.zeros((masses, 2), int)
    own = np.zeros((masses, 2), int)
    for j, (source, target, posted, _) in enumerate(problem.coupling.tolist()):
        across = columns.column[target] - columns.column[source]
        own[source, columns.side[j] if across == 0 else int(across > 0)] = 1
        side = columns.side[j] if across == 0 else int(across < 0)
        items[target, side] += 1
        posts[target, side] += posted
    for tab, mass in enumerate(problem.tab[:, 3].tolist()):
        way = problem.way[tab, columns.column[mass]]
        if way[0] >= 0:
            own[mass, 0 if way[0] == columns.column[mass] else 1] = 1
    for mass in range(masses):
        if problem.mass[mass, 3]:
            items[mass, columns.bias[mass]] += 1
            posts[mass, columns.bias[mass]] += 1
    room = np.full((masses, 2), int(problem.sizes[2]))
    room[columns.column == 0, 0] = room[columns.column == last, 1] = 1
    return np.flatnonzero(np.any((items + own > room) | (posts > 1), axis=1)).tolist()


def around(problem: Problem, columns: Columns, mass: int, reach: int) -> set[int]:
    near = {mass}
    for _ in range(reach):
        near |= {other for one in near for other in columns.beside(problem, one)}
    return near


def spoiled(problem: Problem, columns: Columns) -> int:
    """Turn what hangs on the fullest inner hub in its own column to one side; that hub, which then holds too much."""
    for mass in np.argsort(-np.diff(problem.mass[:, 1]), kind="stable").tolist():
        ins = columns.ins(problem, mass)
        turned = [j for j in ins if columns.column[problem.coupling[j, 0]] == columns.column[mass]]
        for side in (0, 1):
            columns.side[turned] = side
            columns.bias[mass] = side
            if mass in overfull(problem, columns):
                return mass
    raise AssertionError("no hub can be spoiled")


def test_columns_of_a_large_network_leave_no_hub_overfull(problem: Problem) -> None:
    for seed in (1, 2, 3):
        found = start_by_levels(problem, lattice(), seed).columns
        assert overfull(problem, found) == []
        assert found.wrong(problem, np.arange(len(found.column), dtype=np.int32)) == []


def test_an_overfull_hub_is_mended_by_those_around_it_alone(problem: Problem, columns: Columns) -> None:
    hub = spoiled(problem, columns)
    assert hub in columns.wrong(problem, np.array([hub], np.int32))
    before = columns.column.copy()
    movable = around(problem, columns, hub, 2)
    assert repair(problem, columns, movable, 1)
    assert overfull(problem, columns) == []
    moved = set(np.flatnonzero(columns.column != before).tolist())
    assert moved <= movable
    ends = problem.coupling
    apart = np.abs(columns.column[ends[:, 0]] - columns.column[ends[:, 1]])
    assert np.all(apart[np.isin(ends[:, 0], list(movable))] <= ends[np.isin(ends[:, 0], list(movable)), 3])


def test_where_no_way_is_found_nothing_is_changed(problem: Problem, columns: Columns) -> None:
    hub = spoiled(problem, columns)
    # a hub side that holds nothing can not be mended by anything
    none = problem._replace(sizes=np.array([*problem.sizes[:2], 0.0, problem.sizes[3]]))
    before = replace(columns, column=columns.column.copy(), side=columns.side.copy(), bias=columns.bias.copy())
    assert not repair(none, columns, around(problem, columns, hub, 2), 1)
    for name in ("column", "side", "bias"):
        assert np.array_equal(getattr(columns, name), getattr(before, name))


def test_starts_tried_at_once_give_what_one_after_the_other_do() -> None:
    one, two = (place(LARGE, lattice(), pom_rules(LARGE), 3, workers=workers) for workers in (1, 2))
    assert one == two


def test_the_same_answer_every_time(problem: Problem) -> None:
    one, two = (start_by_levels(problem, lattice(), 7).columns for _ in range(2))
    assert np.array_equal(one.column, two.column)
    assert np.array_equal(one.side, two.side)
