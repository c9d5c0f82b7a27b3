"""Hubs that hold too much, mended exactly: who stands in which column among the few masses around one.

Annealing brings nearly every hub below what it holds, but hardly ever the last ones: for them several masses have to
change columns and sides together. Around a single hub that is a small problem for CP-SAT. What it is told are the
counts; whether trunks find room in their windows and orders, the kernels judge (``crossings``), and what they refuse
is ruled out and another answer asked for.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from ortools.sat.python import cp_model

from mdlcad.placement.crossings import EDGE, hub_costs
from mdlcad.placement.problem import Floats, Ints, Problem
from mdlcad.solver import solver_with


@dataclass(frozen=True, slots=True)
class Effort:
    """How much is tried for a hub.

    Attributes:
        reach: how many couplings away from it masses may be that move for it.
        answers: most answers to ask for; limit: CP-SAT's deterministic time for each.
    """

    reach: int
    answers: int = 25
    limit: float = 0.1


EFFORTS = (*(Effort(reach) for reach in (1, 2, 2, 3, 4, 5)), Effort(5, 100, 1.0), Effort(6, 100, 1.0))
"""One time after the other, for the hubs that still hold too much."""
SPARE = 25
"""Up to so many masses, the answer with the fewest trunks is asked for; for more, any."""
WIDTH = 2
"""Columns that a mass may move by."""


@dataclass(frozen=True, slots=True)
class Columns:
    """Where everything hangs, as arrays that are changed in place.

    Attributes:
        column: (M,) by mass. side: (J,) by coupling, the channel (0 left, 1 right) that it takes within a column.
        bias: (M,) side of the leaf.
        into: (J,) couplings by target. slots: (C,) how many masses a column has room for.
    """

    column: Ints
    side: Ints
    bias: Ints
    into: Ints
    slots: Ints

    @staticmethod
    def of(problem: Problem, column: Ints, side: Ints, bias: Ints) -> Columns:
        """Those, on the slots of ``problem``."""
        into = np.argsort(problem.coupling[:, 1], kind="stable").astype(np.int32)
        slots = np.bincount(problem.slot[:, 0], minlength=problem.slot_at.shape[0]).astype(np.int32)
        return Columns(column, side, bias, into, slots)

    def costs(self, problem: Problem, hubs: Ints) -> Floats:
        """(N, 2) what rules cost that ``hubs`` break by themselves, and by orders."""
        return np.asarray(hub_costs(problem, self.into, self.column, self.side, self.bias, hubs), np.float64)

    def wrong(self, problem: Problem, hubs: Ints) -> list[int]:
        """Those of ``hubs`` that hold too much."""
        return [int(hub) for hub in hubs[np.max(self.costs(problem, hubs), axis=1, initial=0.0) > 0]]

    def beside(self, problem: Problem, mass: int) -> list[int]:
        """The masses that ``mass`` is coupled to."""
        driven = [int(problem.coupling[j, 1]) for j in self.outs(problem, mass)]
        return driven + [int(problem.coupling[j, 0]) for j in self.ins(problem, mass)]

    def outs(self, problem: Problem, mass: int) -> list[int]:
        """The couplings that ``mass`` drives."""
        return [int(j) for j in problem.outs[problem.mass[mass, 0] : problem.mass[mass + 1, 0]]]

    def ins(self, problem: Problem, mass: int) -> list[int]:
        """The couplings that drive ``mass``."""
        return [int(j) for j in self.into[problem.mass[mass, 1] : problem.mass[mass + 1, 1]]]


def repair_all(problem: Problem, columns: Columns, seed: int) -> None:
    """Mend those hubs that hold too much, one by one, with more and more around them; in place."""
    wrong = columns.wrong(problem, np.arange(len(columns.column), dtype=np.int32))
    for effort in EFFORTS:
        for hub in wrong:
            if not columns.wrong(problem, np.array([hub], np.int32)):
                continue
            near = {hub}
            for _ in range(effort.reach):
                near |= {other for mass in near for other in columns.beside(problem, mass)}
            repair(problem, columns, near, seed, effort)
        wrong = columns.wrong(problem, np.array(wrong, np.int32))


def repair(problem: Problem, columns: Columns, movable: Iterable[int], seed: int, effort: Effort = EFFORTS[-1]) -> bool:
    """Move masses of ``movable``, their sides and leaves, until no hub of theirs and beside them holds too much.

    All else stays where it is, and hubs beside them that held too much before may go on doing so. In place; where no
    way is found nothing is changed, and the answer is False.
    """
    masses = sorted(set(movable))
    beside = sorted({m for mass in masses for m in columns.beside(problem, mass)} - set(masses))
    # a trunk's window follows from all that it drives, and orders at a hub from the windows of the trunks there
    sources = {int(problem.coupling[j, 0]) for mass in masses for j in columns.ins(problem, mass)}
    far = {int(problem.coupling[j, 1]) for mass in sources for j in columns.outs(problem, mass)} - {*masses, *beside}
    others = np.array([*beside, *sorted(far)], np.int32)
    beyond = set(columns.wrong(problem, others))
    held = np.array([*masses, *(hub for hub in others.tolist() if hub not in beyond)], np.int32)
    model = _Counts(problem, columns, frozenset(masses))
    for hub in held.tolist():
        if hub not in far:
            model.hold(hub)
    model.keep_room()
    if len(masses) <= SPARE:
        model.spare_trunks()
    before = [array.copy() for array in (columns.column, columns.side, columns.bias)]
    solver = solver_with(seed, effort.limit)
    for _ in range(effort.answers):
        if solver.solve(model.model) not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            break
        model.take(solver)
        costs = columns.costs(problem, held)
        if not np.any(costs > 0):
            return True
        for hub, (own, orders) in zip(held.tolist(), costs.tolist(), strict=True):
            if own > 0:
                model.refuse([hub], [])
            if orders > 0:
                ins = columns.ins(problem, hub)
                model.refuse([hub, *(int(problem.coupling[j, 0]) for j in ins)], ins)
    for array, old in zip((columns.column, columns.side, columns.bias), before, strict=True):
        array[:] = old
    return False


class _Counts:
    """The counts of hubs as a model of CP-SAT.

    Attributes:
        at: by mass and column, whether it stands there. right: by coupling, whether it hangs on the right of its
            source, and of its target. leaf: by mass, whether its leaf hangs on the right.
    """

    def __init__(self, problem: Problem, columns: Columns, free: frozenset[int]) -> None:
        self.model = cp_model.CpModel()
        self.at: dict[int, dict[int, cp_model.IntVar]] = {}
        self.right: dict[int, tuple[cp_model.IntVar, cp_model.IntVar]] = {}
        self.leaf: dict[int, cp_model.IntVar] = {}
        self._problem, self._columns, self._free = problem, columns, free
        self._yes = self.model.new_constant(1)
        self._trunks: list[cp_model.LinearExprT] = []

    def hold(self, hub: int) -> None:
        """A side of ``hub`` holds an item a rung plate, one post, and one item where the rim is beside it."""
        p, plates = self._problem, int(self._problem.sizes[2])
        at, last = self._at(hub), p.slot_at.shape[0] - 1
        own = (self.model.new_bool_var(""), self.model.new_bool_var(""))
        self._trunks += own
        items: tuple[list[cp_model.LinearExprT], list[cp_model.LinearExprT]] = ([own[0]], [own[1]])
        posts: tuple[list[cp_model.LinearExprT], list[cp_model.LinearExprT]] = ([], [])
        for j in self._columns.outs(p, hub):
            right = self._right(j)[0]
            self.model.add_implication(right, own[1])
            self.model.add_implication(right.negated(), own[0])
        hanging = [(self._right(j)[1], bool(p.coupling[j, 2])) for j in self._columns.ins(p, hub)]
        if p.mass[hub, 3]:
            self.leaf[hub] = self.model.new_bool_var("")
            hanging.append((self.leaf[hub], True))
        for right, posted in hanging:
            for k, literal in enumerate((right.negated(), right)):
                items[k].append(literal)
                if posted:
                    posts[k].append(literal)
        for tab in range(p.mass[hub, 2], p.mass[hub + 1, 2]):
            for column, stands in at.items():
                way = p.way[tab, column]
                if way[0] >= 0:
                    self.model.add_implication(stands, own[0 if way[0] == column else 1])
                elif hub in self._free:
                    self.model.add(stands == 0)
        for k, rim in enumerate((0, last)):
            self.model.add(sum(items[k]) <= plates)
            self.model.add(sum(posts[k]) <= 1)
            if rim in at:
                self.model.add(sum(items[k]) <= EDGE).only_enforce_if(at[rim])

    def keep_room(self) -> None:
        """No column gets more masses than it has slots."""
        free = np.array(sorted(self._free), np.int64)
        room = self._columns.slots - np.bincount(
            np.delete(self._columns.column, free), minlength=len(self._columns.slots)
        )
        for column, left in enumerate(room.tolist()):
            here = [self.at[mass][column] for mass in free.tolist() if column in self.at[mass]]
            if len(here) > left:
                self.model.add(sum(here) <= left)

    def spare_trunks(self) -> None:
        """As few trunks as may be."""
        self.model.minimize(sum(self._trunks))

    def take(self, solver: cp_model.CpSolver) -> None:
        """Write the answer into the columns."""
        for mass in self._free:
            self._columns.column[mass] = next(
                c for c, literal in self.at[mass].items() if solver.boolean_value(literal)
            )
        for j, (right, _) in self.right.items():
            self._columns.side[j] = int(solver.boolean_value(right))
        for mass, leaf in self.leaf.items():
            self._columns.bias[mass] = int(solver.boolean_value(leaf))

    def refuse(self, trunks: list[int], also: list[int]) -> None:
        """Rule out what ``trunks`` drive from where they stand in the answer that was taken, and couplings ``also``.

        The window of a trunk follows from what it drives; where counts are held, that is all that can be wrong with a
        hub by itself.
        """
        p, columns = self._problem, self._columns
        couplings = sorted({*also, *(j for mass in trunks for j in columns.outs(p, mass))})
        masses = sorted({*trunks, *(int(p.coupling[j, 1]) for j in couplings)} & self._free)
        same = [self.at[mass][int(columns.column[mass])] for mass in masses]
        for j in couplings:
            if j in self.right:
                right = self.right[j][0]
                same.append(right if columns.side[j] else right.negated())
        self.model.add_bool_or([literal.negated() for literal in same])

    def _at(self, mass: int) -> dict[int, cp_model.IntVar]:
        if mass not in self.at:
            here = int(self._columns.column[mass])
            if mass in self._free:
                last = self._problem.slot_at.shape[0] - 1
                near = range(max(0, here - WIDTH), min(last, here + WIDTH) + 1)
                self.at[mass] = {column: self.model.new_bool_var("") for column in near}
                self.model.add_exactly_one(self.at[mass].values())
            else:
                self.at[mass] = {here: self._yes}
        return self.at[mass]

    def _right(self, j: int) -> tuple[cp_model.IntVar, cp_model.IntVar]:
        if j in self.right:
            return self.right[j]
        source, target, _, reach = self._problem.coupling[j].tolist()
        one, two = self.model.new_bool_var(""), self.model.new_bool_var("")
        for a, stands in self._at(source).items():
            for b, hangs in self._at(target).items():
                there = [stands, hangs]
                if abs(a - b) > reach and (source in self._free or target in self._free):
                    self.model.add_bool_or([literal.negated() for literal in there])
                elif a != b:
                    self.model.add_bool_and([one if b > a else one.negated()]).only_enforce_if(there)
                    self.model.add_bool_and([two if a > b else two.negated()]).only_enforce_if(there)
                else:
                    self.model.add(one == two).only_enforce_if(there)
        if source not in self._free and target not in self._free:
            # the hub at its far end may be one that is not looked at
            self.model.add(one == int(self._hangs_right(j)))
        self.right[j] = one, two
        return one, two

    def _hangs_right(self, j: int) -> bool:
        source, target, *_ = self._problem.coupling[j].tolist()
        across = int(self._columns.column[target]) - int(self._columns.column[source])
        return bool(self._columns.side[j]) if across == 0 else across > 0
