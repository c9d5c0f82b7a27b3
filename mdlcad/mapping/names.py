"""Names of masses: from the program's own nets, or from a function's inputs and truth table, never from a number that
shifts when something else is edited."""

from __future__ import annotations

import hashlib
from collections import defaultdict

from mdlcad.mapping.plan import Key, Plan, Role
from mdlcad.mapping.subject import FALSE, TRUE, Subject
from mdlcad.synthesis.netlist import Netlist

_DIGITS = 4


def name_masses(
    plan: Plan, subject: Subject, netlist: Netlist, nets: dict[str, int]
) -> tuple[dict[Key, str], set[int]]:
    """A unique name for every planned mass, and the nodes whose masses should carry the inverse of the node.

    A node that is one of the program's nets, or its inverse, is called like the net and carries it.

    Args:
        nets: literal of every net of the netlist.
    """
    known: dict[int, str] = {}
    for gate in netlist.gates:
        literal = nets[gate.net]
        if literal > TRUE and not subject.is_input(literal >> 1):
            known.setdefault(literal >> 1, gate.net)
    inverted = {node for node, net in known.items() if nets[net] & 1}
    owners = _owners(plan, subject, netlist)
    digests = _Digests(subject)
    gates = _gate_phases(plan)

    wishes: dict[Key, str] = {}
    terms: dict[str, list[Key]] = defaultdict(list)
    for mass in plan.masses:
        key = mass.key
        owner = owners.get(key, netlist.design)
        if key.role is Role.SENSOR:
            wishes[key] = subject.inputs[key.of[0] - 1]
        elif key.role is Role.LOGIC:
            node = key.of[0]
            if subject.is_input(node):
                stem = subject.inputs[node - 1]
            else:
                stem = known.get(node) or f"{owner}.{digests.of(2 * node)[:_DIGITS]}"
            wishes[key] = stem + _delay(key, gates[node])
        elif key.role is Role.TERM:
            terms[owner].append(key)
        elif key.role is Role.PORT:
            wishes[key] = netlist.outputs[key.of[0]].bit
        elif key.role is Role.STAGE:
            wishes[key] = f"tick.{key.of[0]}"
        elif key.role is Role.TICK:
            wishes[key] = "tick" if key.phase == 0 else "tick.early"
        elif key.role is Role.LOAD:
            wishes[key] = f"{owner}.load_{digests.of(key.of[0])[:_DIGITS]}"
        else:
            suffix = {Role.STORE: "", Role.FOLLOW: ".q", Role.HOLD: ".hold"}[key.role]
            wishes[key] = netlist.registers[key.of[0]].bit + suffix
    for owner, keys in terms.items():
        one = len({key.of for key in keys}) == 1
        for key in keys:
            digest = hashlib.sha256("|".join(digests.of(lit) for lit in key.of if lit >= 0).encode()).hexdigest()
            wishes[key] = f"{owner}.set" if one else f"{owner}.set_{digest[:_DIGITS]}"
    wishes = {key: f"{wish}.twin{key.twin}" if key.twin else wish for key, wish in wishes.items()}
    return _unique(wishes), inverted


def _delay(key: Key, gate_phases: list[int]) -> str:
    """ "" for a gate, ".d1" or ".d2" for a buffer by how far it is behind its gate, ".again" for a second gate."""
    if key.phase in gate_phases:
        return "" if key.phase == gate_phases[0] else f".again{gate_phases.index(key.phase)}"
    return f".d{min((key.phase - phase) % 3 for phase in gate_phases)}"


def _gate_phases(plan: Plan) -> dict[int, list[int]]:
    phases: dict[int, list[int]] = defaultdict(list)
    for mass in plan.masses:
        key = mass.key
        if key.role is Role.SENSOR or (key.role is Role.LOGIC and not _is_buffer(mass.sources, key)):
            phases[key.of[0]].append(key.phase)
        elif key.role is Role.LOGIC and mass.sources[0].role in (Role.STORE, Role.FOLLOW):
            # the buffer of a register counts from its following mass, which is in phase 0
            phases[key.of[0]] = [0]
    return {node: sorted(set(found)) for node, found in phases.items()}


def _is_buffer(sources: tuple[Key, ...], key: Key) -> bool:
    return len(sources) == 1 and (sources[0].of == key.of or sources[0].role in (Role.STORE, Role.FOLLOW))


def _owners(plan: Plan, subject: Subject, netlist: Netlist) -> dict[Key, str]:
    """The register or output, first by name, in whose cone each mass lies."""
    sources = {mass.key: mass.sources for mass in plan.masses}
    roots: list[tuple[str, Key]] = []
    for index, register in enumerate(netlist.registers):
        roots.append((register.bit, Key(Role.STORE, (index,), 2)))
        roots.append((register.bit, Key(Role.HOLD, (index,), 1)))
    roots += [(output.bit, carrier) for output, carrier in zip(netlist.outputs, plan.carriers, strict=True)]
    owners: dict[Key, str] = {}
    for name, root in sorted(roots):
        stack = [root]
        while stack:
            key = stack.pop()
            if key in owners and key != root:
                continue
            owners.setdefault(key, name)
            if key == root or key.role in (Role.LOGIC, Role.TERM, Role.LOAD, Role.PORT):
                stack += [s for s in sources.get(key, ()) if s not in owners]
    return owners


class _Digests:
    """Digits that depend on a literal's function of named inputs and on nothing else."""

    def __init__(self, subject: Subject) -> None:
        self._subject = subject
        self._known: dict[int, str] = {}

    def of(self, literal: int) -> str:
        if literal in (FALSE, TRUE):
            return hashlib.sha256(str(literal).encode()).hexdigest()
        text = self._exact(literal) if self._subject.exact else self._structural(literal)
        return hashlib.sha256(text.encode()).hexdigest()

    def _exact(self, literal: int) -> str:
        """The function's truth table over the inputs that it depends on, in the order of their names."""
        subject = self._subject
        table = subject.table(literal)
        support = []
        for index, name in enumerate(subject.inputs):
            value = subject.table(2 * (index + 1))
            if (table & value) >> (1 << index) != table & (value >> (1 << index)):
                support.append((name, index))
        bits = []
        ordered = sorted(support)
        for minterm in range(1 << len(ordered)):
            at = sum(1 << index for place, (_, index) in enumerate(ordered) if minterm >> place & 1)
            bits.append(str(table >> at & 1))
        return ",".join(name for name, _ in ordered) + ":" + "".join(bits)

    def _structural(self, literal: int) -> str:
        stack = [literal >> 1]
        while stack:
            node = stack[-1]
            if node in self._known:
                stack.pop()
            elif self._subject.is_input(node):
                self._known[stack.pop()] = self._subject.inputs[node - 1]
            else:
                a, b, _ = self._subject.ways[node][0]
                missing = [lit >> 1 for lit in (a, b) if lit >> 1 not in self._known]
                if missing:
                    stack += missing
                else:
                    parts = sorted(f"{self._known[lit >> 1]}{lit & 1}" for lit in (a, b))
                    self._known[stack.pop()] = hashlib.sha256("&".join(parts).encode()).hexdigest()
        return f"{self._known[literal >> 1]}{literal & 1}"


def _unique(wishes: dict[Key, str]) -> dict[Key, str]:
    names: dict[Key, str] = {}
    taken: set[str] = set()
    # what the user knows by name comes first
    order = {Role.SENSOR: 0, Role.STORE: 1, Role.PORT: 2}
    for key in sorted(wishes, key=lambda k: (order.get(k.role, 3), wishes[k], k)):
        name, count = wishes[key], 1
        while name in taken:
            count += 1
            name = f"{wishes[key]}.{count}"
        names[key] = name
        taken.add(name)
    return names
