"""Everything that can be made of a program: for each mass that may exist the ways to make it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from mdlcad.mapping.candidates import Candidate
from mdlcad.mapping.cell_library import GatesTable
from mdlcad.mapping.plan import Key, Role
from mdlcad.mapping.registers import RegisterChoices, SetChoice
from mdlcad.mapping.subject import FALSE, TRUE, Subject
from mdlcad.mapping.threshold import COPY, Threshold

PHASES = 3
HOLD_PHASE = 1
STORE_PHASE = 2
FOLLOW_PHASE = 0

TICK0 = Key(Role.TICK, (), FOLLOW_PHASE)
TICK2 = Key(Role.TICK, (), STORE_PHASE)


class Of(StrEnum):
    """What a guard is about."""

    SET = "set"
    RELEASE = "release"


@dataclass(frozen=True, slots=True)
class Guard:
    """A decision about a register: its set choice, or its release, of that number."""

    of: Of
    register: int
    number: int


@dataclass(frozen=True, slots=True)
class Option:
    """One way to make a mass, open only if the ``guard`` was decided so. A sensor's own mass has no sources."""

    sources: tuple[Key, ...]
    function: Threshold
    guard: Guard | None = None


@dataclass(frozen=True, slots=True)
class Carrier:
    """A mass that can show an output; a ``shared`` one is a mass of the logic, which can show one output only."""

    key: Key
    shared: bool


class OptionGraph:
    """The masses that may exist and the options of each.

    Attributes:
        options: by mass; masses without any cannot be made (the tick's, which are made elsewhere, are not listed).
        required: masses that are needed whatever is decided.
        carriers: for every output the masses that can show it; it needs one of them.
        sensors: for every sensor its own mass in each phase; exactly one of them takes its option without sources.
        strange: for every option of a mass what is charged because an earlier network did not have it so.
        load_limit, echo_limit: beyond which a mass needs a twin (see ``relieve``).
    """

    def __init__(
        self,
        subject: Subject,
        candidates: list[tuple[Candidate, ...]],
        registers: list[RegisterChoices],
        outputs: list[int],
        limits: GatesTable,
    ) -> None:
        self.subject = subject
        self.load_limit = limits.load_limit
        self.echo_limit = limits.echo_limit
        self.registers = registers
        self.outputs = outputs
        self.options: dict[Key, list[Option]] = {}
        self.strange: dict[Key, tuple[int, ...]] = {}
        self.required: list[Key] = []
        self.carriers: list[tuple[Carrier, ...]] = []
        self.sensors: list[tuple[Key, ...]] = []
        self._candidates = candidates
        self._weight_limit = limits.weight_limit
        self._pending: list[Key] = []
        self._register_of = {choices.output >> 1: index for index, choices in enumerate(registers)}
        for index in range(len(registers)):
            self._add_register(index)
        self._add_outputs()
        self._add_sensors()
        while self._pending:
            self._add_logic(self._pending.pop())

    @property
    def size(self) -> int:
        """Number of options."""
        return sum(len(options) for options in self.options.values())

    def signal(self, node: int, phase: int) -> Key:
        """The mass that carries ``node`` in ``phase``."""
        register = self._register_of.get(node)
        if register is not None and phase == STORE_PHASE:
            return Key(Role.STORE, (register,), phase)
        if register is not None and phase == FOLLOW_PHASE:
            return Key(Role.FOLLOW, (register,), phase)
        return Key(Role.LOGIC, (node,), phase)

    def charge(self, key: Key, number: int) -> int:
        """What an option is charged for being strange."""
        prices = self.strange.get(key)
        return 0 if prices is None else prices[number]

    def _add(self, key: Key, sources: tuple[Key, ...], function: Threshold, guard: Guard | None = None) -> None:
        self._know(key)
        for source in sources:
            self._know(source)
        self.options[key].append(Option(sources, function, guard))

    def _know(self, key: Key) -> None:
        if key.role is Role.TICK or key in self.options:
            return
        self.options[key] = []
        if key.role is Role.LOGIC:
            self._pending.append(key)
        elif key.role is Role.LOAD:
            self._add_gated(key, TICK2, key.of[0])

    def _gates(self, literal: int, phase: int) -> list[tuple[tuple[Key, ...], Threshold]]:
        """Every gate of ``literal`` in ``phase``: sources and function."""
        gates = []
        for gate in self._candidates[literal >> 1]:
            function = gate.function.negated() if literal & 1 else gate.function
            gates.append((tuple(self.signal(leaf, (phase - 1) % PHASES) for leaf in gate.leaves), function))
        return gates

    def _add_logic(self, key: Key) -> None:
        node = key.of[0]
        self._add(key, (self.signal(node, (key.phase - 1) % PHASES),), COPY)
        for sources, function in self._gates(2 * node, key.phase):
            self._add(key, sources, function)

    def _add_gated(self, key: Key, gate: Key, literal: int) -> None:
        """``key`` = ``gate`` AND ``literal``."""
        if literal == TRUE:
            self._add(key, (gate,), COPY)
            return
        value = self.signal(literal >> 1, (key.phase - 1) % PHASES)
        self._add(key, (gate, value), Threshold((1, -1 if literal & 1 else 1), -1))
        for sources, function in self._gates(literal, key.phase):
            gated = function.gated()
            if gated.total <= self._weight_limit:
                self._add(key, (gate, *sources), gated)

    def _add_register(self, index: int) -> None:
        choices = self.registers[index]
        store = Key(Role.STORE, (index,), STORE_PHASE)
        hold = Key(Role.HOLD, (index,), HOLD_PHASE)
        follow = Key(Role.FOLLOW, (index,), FOLLOW_PHASE)
        self.required += [store, hold, follow]
        self._add(follow, (store,), COPY)
        self._add_store(store, index, False)
        for number, release in enumerate(choices.releases):
            self._add_hold(hold, follow, release, Guard(Of.RELEASE, index, number))

    def _add_store(self, key: Key, index: int, inverted: bool) -> None:
        """``key`` takes the register's next value, or its inverse."""
        for number, choice in enumerate(self.registers[index].sets):
            sources = (*self._terms(choice), Key(Role.HOLD, (index,), HOLD_PHASE))
            function = Threshold((1,) * len(sources), len(sources) - 1)
            self._add(key, sources, function.negated() if inverted else function, Guard(Of.SET, index, number))

    def _terms(self, choice: SetChoice) -> tuple[Key, ...]:
        keys = []
        for term in choice.terms:
            key = Key(Role.TERM, (-1 if term.load is None else term.load, term.literal), HOLD_PHASE)
            if key not in self.options:
                gate = TICK0 if term.load is None else Key(Role.LOAD, (term.load,), FOLLOW_PHASE)
                self._add_gated(key, gate, term.literal)
            keys.append(key)
        return tuple(keys)

    def _add_hold(self, hold: Key, follow: Key, release: int, guard: Guard) -> None:
        inhibited = Threshold((1, -1), -1)
        if release == FALSE:
            self._add(hold, (follow,), COPY, guard)
            return
        if release == TRUE:
            self._add(hold, (follow, TICK0), inhibited, guard)
            return
        self._add(hold, (follow, Key(Role.LOAD, (release,), FOLLOW_PHASE)), inhibited, guard)
        direct = [((self.signal(release >> 1, FOLLOW_PHASE),), Threshold((-1 if release & 1 else 1,), 0))]
        for sources, function in [*direct, *self._gates(release, HOLD_PHASE)]:
            kept = function.gated().negated().gated()
            if kept.total <= self._weight_limit and follow not in sources:
                self._add(hold, (follow, TICK0, *sources), kept, guard)

    def _add_outputs(self) -> None:
        served: set[int] = set()
        for index, literal in enumerate(self.outputs):
            node, inverted = literal >> 1, bool(literal & 1)
            register = self._register_of.get(node)
            if node == 0:
                port = Key(Role.PORT, (index,), 0)
                self._add(port, (), Threshold((), 1 if inverted else -1))
                self.carriers.append((Carrier(port, False),))
            elif register is not None and not inverted and node not in served:
                self.carriers.append((Carrier(self.signal(node, STORE_PHASE), False),))
                served.add(node)
            elif register is not None:
                port = Key(Role.PORT, (index,), STORE_PHASE)
                self._add_store(port, register, inverted)
                self.carriers.append((Carrier(port, False),))
            else:
                self.carriers.append(self._logic_output(index, literal))

    def _logic_output(self, index: int, literal: int) -> tuple[Carrier, ...]:
        node = literal >> 1
        ways = []
        for phase in range(PHASES):
            port = Key(Role.PORT, (index,), phase)
            before = self.signal(node, (phase - 1) % PHASES)
            self._add(port, (before,), COPY.negated() if literal & 1 else COPY)
            for sources, function in self._gates(literal, phase):
                self._add(port, sources, function)
            ways.append(Carrier(port, False))
            if not self.subject.is_input(node):
                self._know(self.signal(node, phase))
                ways.append(Carrier(self.signal(node, phase), True))
        return tuple(ways)

    def _add_sensors(self) -> None:
        """A sensor is itself a mass, in a phase of our choice."""
        for node in range(1, len(self.subject.inputs) + 1):
            if node not in self._register_of:
                keys = tuple(Key(Role.LOGIC, (node,), phase) for phase in range(PHASES))
                for key in keys:
                    self._add(key, (), Threshold((), 0))
                self.sensors.append(keys)
