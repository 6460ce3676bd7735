"""Nodes of a block that are made once.

A node is *constant*, *uniform* (one number for all NPs) or *varying* (a number for each NP). Bits
are nodes too: a uniform bit is 0 or 1, a varying one 0 or 255 in each lane. Equal nodes are the
same object, so what is computed twice is computed once, and a value that nobody needs costs
nothing.
"""

from __future__ import annotations

from typing import Final

from npchip.engines.wasm.translate.nodes import VARYING, Node

_LONGEST_CHAIN: Final = 9
"""Deeper nodes are computed where they are made: the emitter's recursion stays shallow, and the
compiler behind it has no long chains to juggle."""


class Sharing:
    """Makes nodes, or finds those that were made before.

    Attributes:
        deep: nodes that end a long chain, in the order they were made; whoever takes one out
            must compute it at that point.
    """

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Begin another block."""
        self._nodes: dict[tuple[object, ...], Node] = {}
        self.deep: list[Node] = []

    def leaf(self, variable: int, kind: int) -> Node:
        """What a variable holds when the block begins."""
        return self._leaf("leaf", variable, kind, 1 << variable)

    def place(self, axis: str) -> Node:
        """The NP's row or column number."""
        return self._leaf(axis, 0, VARYING, 0)

    def received(self) -> Node:
        """The byte that the block has received."""
        return self._leaf("received", 0, VARYING, 0)

    def _leaf(self, op: str, value: int, kind: int, deps: int) -> Node:
        key = (op, value)
        node = self._nodes.get(key)
        if node is None:
            node = self._nodes[key] = Node(op, (), value, kind, deps)
        return node

    def _unary(self, op: str, a: Node, value: int = 0, kind: int = -1) -> Node:
        key = (op, a, value)
        node = self._nodes.get(key)
        if node is None:
            node = Node(op, (a,), value, a.kind if kind < 0 else kind, a.deps, a.level + 1)
            node.crosses = a.crosses
            self._add(key, node)
        return node

    def _binary(self, op: str, a: Node, b: Node) -> Node:
        key = (op, a, b)
        node = self._nodes.get(key)
        if node is None:
            kind = max(a.kind, b.kind)
            level = max(a.level, b.level) + 1
            node = Node(op, (a, b), 0, kind, a.deps | b.deps, level)
            node.crosses = a.crosses or b.crosses
            self._add(key, node)
        return node

    def _choose(self, bit: Node, a: Node, b: Node) -> Node:
        key = ("select", bit, a, b)
        node = self._nodes.get(key)
        if node is None:
            args = (bit, a, b)
            kind = max([arg.kind for arg in args])
            level = max([arg.level for arg in args]) + 1
            node = Node("select", args, 0, kind, bit.deps | a.deps | b.deps, level)
            node.crosses = any(arg.crosses for arg in args)
            self._add(key, node)
        return node

    def _add(self, key: tuple[object, ...], node: Node) -> None:
        self._nodes[key] = node
        if node.level > _LONGEST_CHAIN:
            node.level = 0
            self.deep.append(node)
