"""Chooses, all at once: the gate of every function, the phase of every mass, the buffers, the registers' structure and
the number of cycles a decision takes, so that the fewest masses remain. One CP-SAT model.

Time is counted in cycles. A mass of phase p takes its value from masses of phase p - 1; from phase 2 to phase 0 a new
cycle begins. Sensors change when cycle 0 of a decision begins. The set terms see the tick in phase 1 of cycle A, and
the next decision begins with cycle N. So what a set term reads (phase 0) must have settled by cycle A after a change
of the sensors in cycle 0 or of the registers (phase 2) in cycle A - N; and what an actuator shows by cycle N - 1
after a change of the sensors in cycle 0 or of the registers in cycle A.
"""

from __future__ import annotations

from dataclasses import dataclass

from ortools.sat.python import cp_model

from mdlcad.mapping.candidates import Candidate
from mdlcad.mapping.plan import Key, Plan, PlannedMass, Role
from mdlcad.mapping.registers import RegisterChoices, SetChoice
from mdlcad.mapping.subject import FALSE, TRUE, Subject
from mdlcad.mapping.threshold import COPY, Threshold
from mdlcad.mapping.tickring import LEAST_CYCLES, plan_ring

# A mass is a unit with its plates' area, an input weight a leaf in it.
MASS_COST = 16
COUPLING_COST = 1
CYCLE_COST = 2

PHASES = 3
_HOLD_PHASE = 1
_STORE_PHASE = 2
_FOLLOW_PHASE = 0


@dataclass(frozen=True, slots=True)
class Option:
    """One way to make a mass: a literal of the model, its sources and its function."""

    chosen: cp_model.IntVar
    sources: tuple[Key, ...]
    function: Threshold


class CoverModel:
    """The model: for every mass that may be made whether it is, and by which option.

    A mass is made by exactly one option, and an option needs all its sources.
    """

    def __init__(
        self,
        subject: Subject,
        candidates: list[tuple[Candidate, ...]],
        registers: list[RegisterChoices],
        outputs: list[int],
        weight_limit: int,
        most_cycles: int,
    ) -> None:
        self.subject = subject
        self.candidates = candidates
        self.registers = registers
        self.outputs = outputs
        self.weight_limit = weight_limit
        self.most_cycles = most_cycles
        self.model = cp_model.CpModel()
        self.present: dict[Key, cp_model.IntVar] = {}
        self.options: dict[Key, list[Option]] = {}
        self.sets: list[list[cp_model.IntVar]] = []
        self.carriers: list[list[tuple[cp_model.IntVar | None, Key]]] = []
        self._pending: list[Key] = []
        self._register_of = {choices.output >> 1: index for index, choices in enumerate(registers)}
        self._tick0 = Key(Role.TICK, (), _FOLLOW_PHASE)
        self._tick2 = Key(Role.TICK, (), _STORE_PHASE)

        self._add_registers()
        self._add_outputs()
        self._add_sensors()
        while self._pending:
            self._add_logic(self._pending.pop())
        self.cycles = self.model.new_int_var(1, most_cycles, "N")
        self.tick_cycle = self.model.new_int_var(0, most_cycles - 1, "A")
        self._add_timing()
        self._add_cost()

    # ---- what can be made of what

    def signal(self, node: int, phase: int) -> Key:
        """The mass that carries ``node`` in ``phase``."""
        register = self._register_of.get(node)
        if register is not None and phase == _STORE_PHASE:
            return Key(Role.STORE, (register,), phase)
        if register is not None and phase == _FOLLOW_PHASE:
            return Key(Role.FOLLOW, (register,), phase)
        return Key(Role.LOGIC, (node,), phase)

    def _need(self, key: Key) -> cp_model.IntVar:
        if key not in self.present:
            self.present[key] = self.model.new_bool_var(str(key))
            self.options[key] = []
            if key.role is Role.LOGIC:
                self._pending.append(key)
            elif key.role is Role.LOAD:
                self._add_gated(key, self._tick2, key.of[0])
        return self.present[key]

    def _option(
        self, key: Key, sources: tuple[Key, ...], function: Threshold, given: cp_model.IntVar | None = None
    ) -> None:
        """One way to make ``key``; with ``given``, only if that holds."""
        self._need(key)
        chosen = self.model.new_bool_var("")
        for source in sources:
            self.model.add_implication(chosen, self._need(source))
        if given is not None:
            self.model.add_implication(chosen, given)
        self.options[key].append(Option(chosen, sources, function))

    def _gates(self, literal: int, phase: int) -> list[tuple[tuple[Key, ...], Threshold]]:
        """Every gate of ``literal`` in ``phase``: sources and function."""
        gates = []
        for gate in self.candidates[literal >> 1]:
            function = gate.function.negated() if literal & 1 else gate.function
            gates.append((tuple(self.signal(leaf, (phase - 1) % PHASES) for leaf in gate.leaves), function))
        return gates

    def _add_logic(self, key: Key) -> None:
        node = key.of[0]
        before = self.signal(node, (key.phase - 1) % PHASES)
        self._option(key, (before,), COPY)
        for sources, function in self._gates(2 * node, key.phase):
            self._option(key, sources, function)

    def _add_gated(self, key: Key, gate: Key, literal: int) -> None:
        """``key`` = ``gate`` AND ``literal``."""
        if literal == TRUE:
            self._option(key, (gate,), COPY)
            return
        value = self.signal(literal >> 1, (key.phase - 1) % PHASES)
        self._option(key, (gate, value), Threshold((1, -1 if literal & 1 else 1), -1))
        for sources, function in self._gates(literal, key.phase):
            gated = function.gated()
            if gated.total <= self.weight_limit and gate not in sources:
                self._option(key, (gate, *sources), gated)

    # ---- registers, outputs, sensors

    def _add_registers(self) -> None:
        for index, choices in enumerate(self.registers):
            sets = [self.model.new_bool_var(f"set {choices.bit} {k}") for k in range(len(choices.sets))]
            releases = [self.model.new_bool_var(f"release {choices.bit} {k}") for k in range(len(choices.releases))]
            self.sets.append(sets)
            self.model.add_exactly_one(sets)
            self.model.add_exactly_one(releases)
            for chosen, fits in zip(sets, choices.fits, strict=True):
                self.model.add_bool_or([chosen.negated(), *(releases[k] for k in fits)])
            store = Key(Role.STORE, (index,), _STORE_PHASE)
            hold = Key(Role.HOLD, (index,), _HOLD_PHASE)
            follow = Key(Role.FOLLOW, (index,), _FOLLOW_PHASE)
            for key in (store, hold, follow):
                self.model.add(self._need(key) == 1)
            self._option(follow, (store,), COPY)
            self._add_store(store, index, False)
            for release, chosen in zip(choices.releases, releases, strict=True):
                self._add_hold(hold, follow, release, chosen)

    def _add_store(self, key: Key, index: int, inverted: bool) -> None:
        """``key`` takes the register's next value, or its inverse."""
        for chosen, choice in zip(self.sets[index], self.registers[index].sets, strict=True):
            sources = (*self._terms(choice), Key(Role.HOLD, (index,), _HOLD_PHASE))
            function = Threshold((1,) * len(sources), len(sources) - 1)
            self._option(key, sources, function.negated() if inverted else function, chosen)

    def _terms(self, choice: SetChoice) -> tuple[Key, ...]:
        keys = []
        for term in choice.terms:
            key = Key(Role.TERM, (-1 if term.load is None else term.load, term.literal), _HOLD_PHASE)
            if key not in self.present:
                self._need(key)
                gate = self._tick0 if term.load is None else Key(Role.LOAD, (term.load,), _FOLLOW_PHASE)
                self._add_gated(key, gate, term.literal)
            keys.append(key)
        return tuple(keys)

    def _add_hold(self, hold: Key, follow: Key, release: int, chosen: cp_model.IntVar) -> None:
        inhibited = Threshold((1, -1), -1)
        if release == FALSE:
            self._option(hold, (follow,), COPY, chosen)
            return
        if release == TRUE:
            self._option(hold, (follow, self._tick0), inhibited, chosen)
            return
        self._option(hold, (follow, Key(Role.LOAD, (release,), _FOLLOW_PHASE)), inhibited, chosen)
        direct = [((self.signal(release >> 1, _FOLLOW_PHASE),), Threshold((-1 if release & 1 else 1,), 0))]
        for sources, function in [*direct, *self._gates(release, _HOLD_PHASE)]:
            kept = function.gated().negated().gated()
            if kept.total <= self.weight_limit and follow not in sources:
                self._option(hold, (follow, self._tick0, *sources), kept, chosen)

    def _add_outputs(self) -> None:
        served: set[int] = set()
        used: dict[Key, list[cp_model.IntVar]] = {}
        for index, literal in enumerate(self.outputs):
            node, inverted = literal >> 1, bool(literal & 1)
            register = self._register_of.get(node)
            ways: list[tuple[cp_model.IntVar | None, Key]] = []
            if node == 0:
                key = Key(Role.PORT, (index,), 0)
                self._option(key, (), Threshold((), 1 if inverted else -1))
                ways.append((None, key))
            elif register is not None and not inverted and node not in served:
                ways.append((None, self.signal(node, _STORE_PHASE)))
                served.add(node)
            elif register is not None:
                key = Key(Role.PORT, (index,), _STORE_PHASE)
                self._need(key)
                self._add_store(key, register, inverted)
                ways.append((None, key))
            else:
                ways = self._logic_output(index, literal, used)
            self.carriers.append(ways)
            if len(ways) == 1:
                self.model.add(self._need(ways[0][1]) == 1)
        for _, choices in sorted(used.items()):
            self.model.add_at_most_one(choices)

    def _logic_output(
        self, index: int, literal: int, used: dict[Key, list[cp_model.IntVar]]
    ) -> list[tuple[cp_model.IntVar | None, Key]]:
        """The output is shown by a mass of the logic itself (for one output alone), or by one of its own."""
        node = literal >> 1
        ways: list[tuple[cp_model.IntVar | None, Key]] = []
        for phase in range(PHASES):
            port = Key(Role.PORT, (index,), phase)
            before = self.signal(node, (phase - 1) % PHASES)
            self._option(port, (before,), COPY.negated() if literal & 1 else COPY)
            for sources, function in self._gates(literal, phase):
                self._option(port, sources, function)
            keys = [port] if self.subject.is_input(node) else [port, self.signal(node, phase)]
            for key in keys:
                chosen = self.model.new_bool_var(f"output {index} {key}")
                self.model.add_implication(chosen, self._need(key))
                ways.append((chosen, key))
                used.setdefault(key, []).append(chosen)
        self.model.add_exactly_one(chosen for chosen, _ in ways if chosen is not None)
        return ways

    def _add_sensors(self) -> None:
        """A sensor is itself a mass, in a phase of our choice."""
        for node in range(1, len(self.subject.inputs) + 1):
            if node in self._register_of:
                continue
            at = []
            for phase in range(PHASES):
                key = Key(Role.LOGIC, (node,), phase)
                self._option(key, (), Threshold((), 0))
                at.append(self.options[key][-1].chosen)
            self.model.add_exactly_one(at)

    # ---- time and cost

    def _add_timing(self) -> None:
        if self.registers:
            self.model.add(self.cycles >= LEAST_CYCLES)
            self.model.add(self.tick_cycle <= self.cycles - 1)
            settled = self._arrivals("D", self.tick_cycle - self.cycles)
            for key in sorted(self.options):
                for option in self.options[key]:
                    if key.role in (Role.TERM, Role.HOLD, Role.LOAD):
                        late = 1 if key.role is Role.LOAD else 0
                        for source in option.sources:
                            if source in settled:
                                self.model.add(settled[source] <= self.tick_cycle - late).only_enforce_if(option.chosen)
        if any(chosen is not None for ways in self.carriers for chosen, _ in ways):
            shown = self._arrivals("O", self.tick_cycle)
            for ways in self.carriers:
                for chosen, key in ways:
                    if chosen is not None:
                        self.model.add(shown[key] <= self.cycles - 1).only_enforce_if(chosen)

    def _arrivals(self, label: str, register_cycle: cp_model.LinearExprT) -> dict[Key, cp_model.IntVar]:
        """The last cycle in which each mass can still change, after the sensors in cycle 0, the registers in theirs."""
        most = self.most_cycles
        arrival: dict[Key, cp_model.IntVar] = {}
        for key in sorted(self.present):
            if key.role in (Role.LOGIC, Role.PORT, Role.STORE, Role.FOLLOW):
                arrival[key] = self.model.new_int_var(-most, 2 * most, f"{label} {key}")
        for key, cycle in arrival.items():
            if key.role is Role.STORE:
                self.model.add(cycle == register_cycle)
                continue
            for option in self.options[key]:
                if not option.sources:
                    self.model.add(cycle >= 0).only_enforce_if(option.chosen)
                for source in option.sources:
                    if source in arrival:
                        late = 1 if key.phase == 0 else 0
                        self.model.add(cycle >= arrival[source] + late).only_enforce_if(option.chosen)
        return arrival

    def _add_cost(self) -> None:
        cost: list[cp_model.LinearExprT] = [CYCLE_COST * self.cycles]
        for key in sorted(self.present):
            if key.role is Role.TICK:
                continue
            self.model.add(sum(option.chosen for option in self.options[key]) == self.present[key])
            cost.append(MASS_COST * self.present[key])
            for option in self.options[key]:
                weight = COUPLING_COST * sum(abs(w) for w in option.function.weights)
                if weight:
                    cost.append(weight * option.chosen)
        if self.registers:
            cost.append(MASS_COST * self._ring_cost())
        self.model.minimize(sum(cost))

    def _ring_cost(self) -> cp_model.LinearExprT:
        plans = [plan_ring(n) for n in range(LEAST_CYCLES, self.most_cycles + 1)]
        is_n = [self.model.new_bool_var(f"N = {plan.cycles}") for plan in plans]
        self.model.add_exactly_one(is_n)
        self.model.add(self.cycles == sum(plan.cycles * chosen for plan, chosen in zip(plans, is_n, strict=True)))
        extra = self.model.new_bool_var("both ticks decoded")
        early = self.present.get(self._tick2)
        late = self.present.get(self._tick0)
        if early is not None and late is not None:
            decoded = [chosen for plan, chosen in zip(plans, is_n, strict=True) if plan.decoded]
            for chosen in decoded:
                self.model.add_bool_or([chosen.negated(), early.negated(), late.negated(), extra])
        return sum(plan.masses(False) * chosen for plan, chosen in zip(plans, is_n, strict=True)) + extra


def solve_cover(cover: CoverModel, deterministic_time: float, seed: int) -> Plan:
    """The best plan found within the deterministic time.

    Raises:
        RuntimeError: none was found in that time.
    """
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    solver.parameters.random_seed = seed
    solver.parameters.interleave_search = True
    solver.parameters.max_deterministic_time = deterministic_time
    status = solver.solve(cover.model)
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        raise RuntimeError("no cover was found in the time allowed")
    return _read_plan(cover, solver)


def _read_plan(cover: CoverModel, solver: cp_model.CpSolver) -> Plan:
    chosen: dict[Key, Option] = {}
    for key in sorted(cover.present):
        if key.role is not Role.TICK and solver.value(cover.present[key]):
            chosen[key] = next(option for option in cover.options[key] if solver.value(option.chosen))
    # a sensor's own mass is the option without sources
    own = {
        key: Key(Role.SENSOR, key.of, key.phase)
        for key, option in chosen.items()
        if key.role is Role.LOGIC and not option.sources
    }
    carriers = []
    inverted: set[Key] = set()
    for literal, ways in zip(cover.outputs, cover.carriers, strict=True):
        key = next(key for flag, key in ways if flag is None or solver.value(flag))
        carriers.append(key)
        if literal & 1 and key.role is Role.LOGIC:
            inverted.add(key)
    masses = []
    for key, option in chosen.items():
        signs = [-1 if source in inverted else 1 for source in option.sources]
        function = Threshold(
            tuple(s * w for s, w in zip(signs, option.function.weights, strict=True)), option.function.bias
        )
        if key in inverted:
            function = function.negated()
        sources = tuple(own.get(source, source) for source in option.sources)
        masses.append(PlannedMass(own.get(key, key), sources, function))
    cycles = solver.value(cover.cycles)
    return Plan(
        masses=tuple(masses),
        ring=plan_ring(cycles) if cover.registers else None,
        tick_cycle=solver.value(cover.tick_cycle) if cover.registers else 0,
        cycles=cycles,
        carriers=tuple(own.get(key, key) for key in carriers),
    )
