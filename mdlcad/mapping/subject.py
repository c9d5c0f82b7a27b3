"""The subject graph: the program's logic as two-input ANDs, with as many ways to build each function as were found.

A literal is 2 node + inverted; node 0 is the constant 0. Up to ``MOST_EXACT_INPUTS`` inputs every node carries its
whole truth table, nodes are equal if their functions are, and each keeps the different ways to build it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from mdlcad.synthesis.netlist import Gate, GateKind

MOST_EXACT_INPUTS = 13

FALSE = 0
TRUE = 1


class Subject:
    """A growing graph of AND nodes over named inputs.

    Attributes:
        inputs: input names; input i is node i + 1.
        ways: for every node (a, b, inverted), so that it is a AND b or the inverse of that, in the order
            found; the first is never inverted. Empty for inputs and the constant.
        tables: for every node its truth table (bit m: value where input i is bit i of m), or None if there are too
            many inputs.
    """

    def __init__(self, inputs: Iterable[str]) -> None:
        self.inputs = tuple(inputs)
        self.exact = len(self.inputs) <= MOST_EXACT_INPUTS
        self.full = (1 << (1 << len(self.inputs))) - 1 if self.exact else 0
        self.ways: list[list[tuple[int, int, bool]]] = [[]]
        self.tables: list[int | None] = [0 if self.exact else None]
        self._by_pair: dict[tuple[int, int], int] = {}
        self._by_table: dict[int, int] = {0: FALSE, self.full: TRUE} if self.exact else {}
        for index in range(len(self.inputs)):
            self._new_node(self._input_table(index) if self.exact else None)

    def input(self, name: str) -> int:
        """Literal of an input."""
        return 2 * (self.inputs.index(name) + 1)

    def is_input(self, node: int) -> bool:
        """Whether ``node`` is an input."""
        return 1 <= node <= len(self.inputs)

    def table(self, literal: int) -> int:
        """Truth table of a literal; only of an exact graph."""
        table = self.tables[literal >> 1]
        assert table is not None
        return table ^ self.full if literal & 1 else table

    def find(self, table: int) -> int | None:
        """The literal with that truth table, if there is one."""
        return self._by_table.get(table)

    def conjunction(self, a: int, b: int) -> int:
        """Literal of a AND b; a way to build it is noted if it is new."""
        a, b = min(a, b), max(a, b)
        if a == FALSE or a == b ^ 1:
            return FALSE
        if a in (TRUE, b):
            return b
        known = self._by_pair.get((a, b))
        if known is None:
            table = self.table(a) & self.table(b) if self.exact else None
            known = self._by_table.get(table) if table is not None else None
            if known is None:
                known = self._new_node(table)
            if known > TRUE and not self.is_input(known >> 1):
                self.ways[known >> 1].append((a, b, bool(known & 1)))
            self._by_pair[(a, b)] = known
        return known

    def disjunction(self, a: int, b: int) -> int:
        """Literal of a OR b."""
        return self.conjunction(a ^ 1, b ^ 1) ^ 1

    def choose(self, if_zero: int, if_one: int, select: int) -> int:
        """Literal of a multiplexer."""
        return self.disjunction(self.conjunction(select ^ 1, if_zero), self.conjunction(select, if_one))

    def add_gate(self, gate: Gate, nets: Mapping[str, int]) -> int:
        """Literal of a gate over nets that have literals."""
        at = [nets[net] for net in gate.inputs]
        if gate.kind is GateKind.NOT:
            return at[0] ^ 1
        if gate.kind is GateKind.AND:
            return self.conjunction(at[0], at[1])
        if gate.kind is GateKind.OR:
            return self.disjunction(at[0], at[1])
        if gate.kind is GateKind.XOR:
            return self.choose(at[1], at[1] ^ 1, at[0])
        return self.choose(at[0], at[1], at[2])

    def cofactor(self, literal: int, node: int, value: bool) -> int:
        """Literal of the function with input ``node`` fixed to ``value``."""
        done: dict[int, int] = {node: TRUE if value else FALSE, 0: FALSE}
        stack = [literal >> 1]
        while stack:
            top = stack[-1]
            if top in done:
                stack.pop()
            elif self.is_input(top):
                done[stack.pop()] = 2 * top
            else:
                a, b, _ = self.ways[top][0]
                missing = [lit >> 1 for lit in (a, b) if lit >> 1 not in done]
                if missing:
                    stack += missing
                else:
                    done[stack.pop()] = self.conjunction(done[a >> 1] ^ (a & 1), done[b >> 1] ^ (b & 1))
        return done[literal >> 1] ^ (literal & 1)

    def _new_node(self, table: int | None) -> int:
        literal = 2 * len(self.ways)
        self.ways.append([])
        self.tables.append(table)
        if table is not None:
            self._by_table[table] = literal
            self._by_table[table ^ self.full] = literal ^ 1
        return literal

    def _input_table(self, index: int) -> int:
        block = ((1 << (1 << index)) - 1) << (1 << index)
        width = 2 << index
        table = 0
        for start in range(0, 1 << len(self.inputs), width):
            table |= block << start
        return table
