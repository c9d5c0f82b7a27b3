"""Which column every mass stands in: a small exact problem, solved before annealing looks for the rows.

A coupling reaches the next column at most, and a column holds as many masses as it has slots; annealing from a random
start hardly ever mends a mass two columns away from another, because the whole chain behind it would have to move.
CP-SAT does, and keeps the number of trunks small and even over the channels.
"""

from __future__ import annotations

import threading
from collections.abc import Sequence
from concurrent.futures import Future
from dataclasses import dataclass

from ortools.sat.python import cp_model

from mdlcad.placement.lattice import Lattice
from mdlcad.placement.problem import Problem
from mdlcad.solver import solver_with

LIMIT = 0.2
"""CP-SAT's deterministic time."""
MOST_MASSES, MOST_CLAUSES = 400, 50_000
"""Above these the problem is not small any more (a sliver of a boundary can have a hundred columns)."""
PASSED = 3
"""A hub column that a tab passes takes the room of so many trunks."""


AWAY = 10
"""A mass in another column than its home counts as so many trunks."""


@dataclass(frozen=True, slots=True)
class Question:
    """All that a choice of columns depends on, for M masses and C columns.

    Attributes:
        masses: M. rooms: slots by column.
        couplings: source, target, how many columns apart they may be.
        tabs: mass, and by column of that mass the channel (-1: none), first and last hub column that the tab passes.
    """

    masses: int
    rooms: tuple[int, ...]
    couplings: tuple[tuple[int, int, int], ...]
    tabs: tuple[tuple[int, tuple[tuple[int, int, int], ...]], ...]


def question_of(problem: Problem, lattice: Lattice) -> Question:
    """The columns to choose for ``problem`` on ``lattice``."""
    room = [0] * len(lattice.column_x)
    for column, _ in lattice.slots:
        room[column] += 1
    return Question(
        len(problem.mass) - 1,
        tuple(room),
        tuple((source, target, reach) for source, target, _, reach in problem.coupling.tolist()),
        tuple(
            (int(tab[3]), tuple((channel, first, last) for channel, first, last, _ in ways.tolist()))
            for tab, ways in zip(problem.tab, problem.way, strict=True)
        ),
    )


class Answers:
    """Columns chosen so far in a search, by what they were chosen for: neighbouring sizes ask the same questions.

    May be asked by several threads at once; one of them looks for the answer and the others wait for it.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._known: dict[tuple[Question, int], Future[tuple[int, ...] | None]] = {}

    def choose(self, question: Question, seed: int) -> tuple[int, ...] | None:
        """As ``choose_columns``."""
        with self._lock:
            known = self._known.get((question, seed))
            mine = known is None
            answer = known if known is not None else self._known.setdefault((question, seed), Future())
        if mine:
            try:
                answer.set_result(choose_columns(question, seed))
            except BaseException as error:
                answer.set_exception(error)
        return answer.result()


def choose_columns(
    question: Question, seed: int, homes: Sequence[int] = (), held: bool = False
) -> tuple[int, ...] | None:
    """A column for every mass; None if there is no way, none was found in the limit, or the network is too large.

    Args:
        homes: by mass, the column that it should stay in, or -1; if ``held``, must.
    """
    masses, columns = question.masses, len(question.rooms)
    if masses > MOST_MASSES or len(question.couplings) * columns**2 > MOST_CLAUSES:
        return None
    model = cp_model.CpModel()
    at = [[model.new_bool_var(f"at{mass}.{column}") for column in range(columns)] for mass in range(masses)]
    trunk = [[model.new_bool_var(f"trunk{mass}.{k}") for k in range(columns + 1)] for mass in range(masses)]
    for row in at:
        model.add_exactly_one(row)
    for column, room in enumerate(question.rooms):
        model.add(sum(row[column] for row in at) <= room)
    for source, target, reach in question.couplings:
        for a in range(columns):
            for b in range(columns):
                apart = [~at[source][a], ~at[target][b]]
                if a == b:
                    model.add_bool_or([*apart, trunk[source][a], trunk[source][a + 1]])
                elif abs(a - b) <= reach:
                    model.add_bool_or([*apart, trunk[source][max(a, b)]])
                else:
                    model.add_bool_or(apart)
    passed = []
    for mass, ways in question.tabs:
        for column, (channel, first, last) in enumerate(ways):
            if channel < 0:
                model.add(at[mass][column] == 0)
                continue
            model.add_implication(at[mass][column], trunk[mass][channel])
            passed.append(PASSED * max(0, last - first + 1) * at[mass][column])
    away: list[cp_model.LinearExprT] = []
    for mass, home in enumerate(homes):
        if home >= 0 and held:
            model.add(at[mass][home] == 1)
        elif home >= 0:
            away.append(AWAY * at[mass][home].negated())
            model.add_hint(at[mass][home], True)
    most = model.new_int_var(0, masses, "most")
    loads = [sum(row[k] for row in trunk) for k in range(columns + 1)]
    for load in loads:
        model.add(load <= most)
    model.minimize(sum(loads) + 2 * most + sum(passed) + sum(away))
    solver = solver_with(seed, LIMIT)
    if solver.solve(model) not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None
    return tuple(next(c for c, literal in enumerate(row) if solver.boolean_value(literal)) for row in at)
