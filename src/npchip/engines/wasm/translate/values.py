"""Values of a block, numbered: equal ones are the same object (value numbering).

A value is a node of a graph. It is *constant*, *uniform* (one number for all NPs) or *varying* (a
number for each NP). Bits are values too: a uniform bit is 0 or 1, a varying one 0 or 255 in each
lane. What is computed twice is computed once, and a value that nobody needs costs nothing.
"""

from __future__ import annotations

from typing import Final

CONSTANT: Final = 0
UNIFORM: Final = 1
VARYING: Final = 2
_LONGEST_CHAIN: Final = 9
"""Deeper nodes are computed where they are made: the emitter's recursion stays shallow, and the
compiler behind it has no long chains to juggle."""


class Value:
    """A value.

    Attributes:
        op: what it computes; `args` are its operands.
        value: a number that belongs to the operation: a constant, a leaf's variable, a count.
        kind: constant, uniform or varying.
        deps: a bit for each variable of the block's beginning that it depends on.
        level: longest chain of operations below it.
        crosses: whether it needs values of other NPs, or needs a node that does; the emitter
            takes it back where these have been computed.
        uses: set by the emitter: how often needed code refers to it.
        temp: set by the emitter: the local that holds it, or of a varying node the number of its
            value (`Strip`); -1 where none does.
    """

    __slots__ = ("args", "crosses", "deps", "kind", "level", "op", "temp", "uses", "value")

    def __init__(  # noqa: PLR0917 - made by the thousand; keywords would cost time
        self, op: str, args: tuple[Value, ...], value: int, kind: int, deps: int, level: int = 0
    ) -> None:
        self.op = op
        self.args = args
        self.value = value
        self.kind = kind
        self.deps = deps
        self.level = level
        self.crosses = False
        self.uses = 0
        self.temp = -1


NUMBERS: Final = [Value("const", (), value, CONSTANT, 0) for value in range(256)]
"""The constants; all blocks share them."""


class ValueNumbering:
    """Makes values, or finds those that were made before.

    Attributes:
        deep: nodes that end a long chain, in the order they were made; whoever takes one out
            must compute it at that point.
    """

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Begin another block."""
        self._nodes: dict[tuple[object, ...], Value] = {}
        self.deep: list[Value] = []

    def leaf(self, variable: int, kind: int) -> Value:
        """What a variable holds when the block begins."""
        return self._leaf("leaf", variable, kind, 1 << variable)

    def place(self, axis: str) -> Value:
        """The NP's row or column number."""
        return self._leaf(axis, 0, VARYING, 0)

    def received(self) -> Value:
        """The byte that the block has received."""
        return self._leaf("received", 0, VARYING, 0)

    def _leaf(self, op: str, value: int, kind: int, deps: int) -> Value:
        key = (op, value)
        node = self._nodes.get(key)
        if node is None:
            node = self._nodes[key] = Value(op, (), value, kind, deps)
        return node

    def _unary(self, op: str, a: Value, value: int = 0, kind: int = -1) -> Value:
        key = (op, a, value)
        node = self._nodes.get(key)
        if node is None:
            node = Value(op, (a,), value, a.kind if kind < 0 else kind, a.deps, a.level + 1)
            node.crosses = a.crosses
            self._add(key, node)
        return node

    def _binary(self, op: str, a: Value, b: Value) -> Value:
        key = (op, a, b)
        node = self._nodes.get(key)
        if node is None:
            kind = max(a.kind, b.kind)
            level = max(a.level, b.level) + 1
            node = Value(op, (a, b), 0, kind, a.deps | b.deps, level)
            node.crosses = a.crosses or b.crosses
            self._add(key, node)
        return node

    def _choose(self, bit: Value, a: Value, b: Value) -> Value:
        key = ("select", bit, a, b)
        node = self._nodes.get(key)
        if node is None:
            args = (bit, a, b)
            kind = max([arg.kind for arg in args])
            level = max([arg.level for arg in args]) + 1
            node = Value("select", args, 0, kind, bit.deps | a.deps | b.deps, level)
            node.crosses = any(arg.crosses for arg in args)
            self._add(key, node)
        return node

    def _add(self, key: tuple[object, ...], node: Value) -> None:
        self._nodes[key] = node
        if node.level > _LONGEST_CHAIN:
            node.level = 0
            self.deep.append(node)
