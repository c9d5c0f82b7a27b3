"""Chooses, all at once: the gate of every function, the phase of every mass, the buffers, the registers' structure and
the number of cycles a decision takes, so that the fewest masses remain. One CP-SAT model.

Time is counted in cycles. A mass of phase p takes its value from masses of phase p - 1; from phase 2 to phase 0 a new
cycle begins. Sensors change when cycle 0 of a decision begins. The set terms see the tick in phase 1 of cycle A, and
the next decision begins with cycle N. So what a set term reads (phase 0) must have settled by cycle A after a change
of the sensors in cycle 0 or of the registers (phase 2) in cycle A - N; and what an actuator shows by cycle N - 1
after a change of the sensors in cycle 0 or of the registers in cycle A.
"""

from __future__ import annotations

from ortools.sat.python import cp_model

from mdlcad.mapping.options import TICK0, TICK2, Guard, Of, OptionGraph
from mdlcad.mapping.plan import Key, Role
from mdlcad.mapping.selection import COUPLING_COST, CYCLE_COST, MASS_COST, Selection, arrivals
from mdlcad.mapping.tickring import LEAST_CYCLES, plan_ring
from mdlcad.solver import solver_with

_TIMED = (Role.LOGIC, Role.PORT, Role.STORE, Role.FOLLOW)


class _Model:
    """The CP-SAT model of an option graph: for every mass whether it is made, and by which option."""

    def __init__(self, graph: OptionGraph, most_cycles: int) -> None:
        self.graph = graph
        self.most = most_cycles
        self.model = cp_model.CpModel()
        self.guards: dict[Guard, cp_model.IntVar] = {}
        self.present: dict[Key, cp_model.IntVar] = {}
        self.chosen: dict[Key, list[cp_model.IntVar]] = {}
        self.shows: list[list[cp_model.IntVar]] = []
        self.arrival: dict[str, dict[Key, cp_model.IntVar]] = {}
        self.cycles = self.model.new_int_var(1, most_cycles, "N")
        self.tick_cycle = self.model.new_int_var(0, most_cycles - 1, "A")
        self._add_guards()
        self._add_options()
        self._add_outputs()
        self._add_timing()
        self._add_cost()

    def _add_guards(self) -> None:
        for index, choices in enumerate(self.graph.registers):
            for of, count in ((Of.SET, len(choices.sets)), (Of.RELEASE, len(choices.releases))):
                guards = [Guard(of, index, number) for number in range(count)]
                for guard in guards:
                    self.guards[guard] = self.model.new_bool_var(f"{of} {choices.bit} {guard.number}")
                self.model.add_exactly_one(self.guards[guard] for guard in guards)
            for number, fits in enumerate(choices.fits):
                fitting = [self.guards[Guard(Of.RELEASE, index, release)] for release in fits]
                self.model.add_bool_or([self.guards[Guard(Of.SET, index, number)].negated(), *fitting])

    def _add_options(self) -> None:
        for key in (*sorted(self.graph.options), TICK0, TICK2):
            self.present[key] = self.model.new_bool_var(str(key))
        for key, options in sorted(self.graph.options.items()):
            self.chosen[key] = [self.model.new_bool_var(f"{key} {number}") for number in range(len(options))]
            for option, chosen in zip(options, self.chosen[key], strict=True):
                for source in option.sources:
                    self.model.add_implication(chosen, self.present[source])
                if option.guard is not None:
                    self.model.add_implication(chosen, self.guards[option.guard])
            self.model.add(sum(self.chosen[key]) == self.present[key])
        for key in self.graph.required:
            self.model.add(self.present[key] == 1)
        for keys in self.graph.sensors:
            self.model.add_exactly_one(
                self.chosen[key][number]
                for key in keys
                for number, option in enumerate(self.graph.options[key])
                if not option.sources
            )

    def _add_outputs(self) -> None:
        users: dict[Key, list[cp_model.IntVar]] = {}
        for index, ways in enumerate(self.graph.carriers):
            shows = [self.model.new_bool_var(f"output {index} {way.key}") for way in ways]
            self.shows.append(shows)
            self.model.add_exactly_one(shows)
            for way, flag in zip(ways, shows, strict=True):
                self.model.add_implication(flag, self.present[way.key])
                users.setdefault(way.key, []).append(flag)
        for _, flags in sorted(users.items()):
            self.model.add_at_most_one(flags)

    def _add_timing(self) -> None:
        if self.graph.registers:
            self.model.add(self.cycles >= LEAST_CYCLES)
            self.model.add(self.tick_cycle <= self.cycles - 1)
            settled = self._arrivals("D", self.tick_cycle - self.cycles)
            for key, options in sorted(self.graph.options.items()):
                if key.role not in (Role.TERM, Role.HOLD, Role.LOAD):
                    continue
                late = 1 if key.role is Role.LOAD else 0
                for option, chosen in zip(options, self.chosen[key], strict=True):
                    for source in option.sources:
                        if source in settled:
                            self.model.add(settled[source] <= self.tick_cycle - late).only_enforce_if(chosen)
        if any(way.key.role in (Role.LOGIC, Role.PORT) for ways in self.graph.carriers for way in ways):
            shown = self._arrivals("O", self.tick_cycle)
            for ways, shows in zip(self.graph.carriers, self.shows, strict=True):
                for way, flag in zip(ways, shows, strict=True):
                    if way.key.role is not Role.STORE:
                        self.model.add(shown[way.key] <= self.cycles - 1).only_enforce_if(flag)

    def _arrivals(self, label: str, register_cycle: cp_model.LinearExprT) -> dict[Key, cp_model.IntVar]:
        """The last cycle in which each mass can still change; it also keeps loops of logic out."""
        arrival = {
            key: self.model.new_int_var(-self.most, 2 * self.most + 2, f"{label} {key}")
            for key in sorted(self.graph.options)
            if key.role in _TIMED
        }
        self.arrival[label] = arrival
        for key, cycle in arrival.items():
            if key.role is Role.STORE:
                self.model.add(cycle == register_cycle)
                continue
            late = 1 if key.phase == 0 else 0
            for option, chosen in zip(self.graph.options[key], self.chosen[key], strict=True):
                if not option.sources and key.role is Role.LOGIC:
                    self.model.add(cycle >= 0).only_enforce_if(chosen)
                for source in option.sources:
                    if source in arrival:
                        self.model.add(cycle >= arrival[source] + late).only_enforce_if(chosen)
                    elif key.role is Role.PORT:
                        # the twin of a register's store changes with it
                        self.model.add(cycle >= register_cycle).only_enforce_if(chosen)
        return arrival

    def _add_cost(self) -> None:
        cost: list[cp_model.LinearExprT] = [CYCLE_COST * self.cycles]
        for key, options in sorted(self.graph.options.items()):
            cost.append(MASS_COST * self.present[key])
            for number, (option, chosen) in enumerate(zip(options, self.chosen[key], strict=True)):
                weight = COUPLING_COST * sum(abs(w) for w in option.function.weights) + self.graph.charge(key, number)
                if weight:
                    cost.append(weight * chosen)
        if self.graph.registers:
            cost.append(MASS_COST * self._ring_cost())
        self.model.minimize(sum(cost))

    def _ring_cost(self) -> cp_model.LinearExprT:
        plans = [plan_ring(n) for n in range(LEAST_CYCLES, self.most + 1)]
        flags = [self.model.new_bool_var(f"N = {plan.cycles}") for plan in plans]
        self.model.add_exactly_one(flags)
        self.model.add(self.cycles == sum(plan.cycles * flag for plan, flag in zip(plans, flags, strict=True)))
        extra = self.model.new_bool_var("both ticks decoded")
        for plan, flag in zip(plans, flags, strict=True):
            if plan.decoded:
                both = [self.present[TICK0].negated(), self.present[TICK2].negated()]
                self.model.add_bool_or([flag.negated(), *both, extra])
        return sum(plan.masses(False) * flag for plan, flag in zip(plans, flags, strict=True)) + extra

    def hint(self, start: Selection) -> None:
        """Begin the search at ``start``."""
        add = self.model.add_hint
        add(self.cycles, start.cycles)
        add(self.tick_cycle, start.tick_cycle)
        for guard, flag in self.guards.items():
            decided = start.sets if guard.of is Of.SET else start.releases
            add(flag, int(decided[guard.register] == guard.number))
        for key, flags in self.chosen.items():
            add(self.present[key], int(key in start.chosen))
            for number, flag in enumerate(flags):
                add(flag, int(start.chosen.get(key) == number))
        for ways, shows, carrier in zip(self.graph.carriers, self.shows, start.carriers, strict=True):
            for way, flag in zip(ways, shows, strict=True):
                add(flag, int(way == carrier))
        cycles = {"D": start.tick_cycle - start.cycles, "O": start.tick_cycle}
        for label, arrival in self.arrival.items():
            known = arrivals(self.graph, start, cycles[label])
            for key, variable in arrival.items():
                add(variable, max(-self.most, known.get(key, -self.most)))


def best_cover(graph: OptionGraph, start: Selection, deterministic_time: float, seed: int) -> Selection:
    """The best selection found from ``start`` within the deterministic time; at worst as good as ``start``."""
    model = _Model(graph, start.cycles)
    model.hint(start)
    solver = solver_with(seed, deterministic_time)
    solver.parameters.interleave_search = True
    status = solver.solve(model.model)
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return start
    return _read(model, solver)


def _read(model: _Model, solver: cp_model.CpSolver) -> Selection:
    selection = Selection(cycles=solver.value(model.cycles), tick_cycle=solver.value(model.tick_cycle))
    for key, flags in model.chosen.items():
        if solver.value(model.present[key]):
            selection.chosen[key] = next(number for number, flag in enumerate(flags) if solver.value(flag))
    for index, choices in enumerate(model.graph.registers):
        sets = range(len(choices.sets))
        releases = range(len(choices.releases))
        selection.sets.append(next(n for n in sets if solver.value(model.guards[Guard(Of.SET, index, n)])))
        selection.releases.append(next(n for n in releases if solver.value(model.guards[Guard(Of.RELEASE, index, n)])))
    for ways, shows in zip(model.graph.carriers, model.shows, strict=True):
        selection.carriers.append(next(way for way, flag in zip(ways, shows, strict=True) if solver.value(flag)))
    return selection
