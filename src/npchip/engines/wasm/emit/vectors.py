"""Evaluates the nodes of a block on demand: each one that is needed once.

A uniform node takes one scalar instruction, a varying one a vector instruction in a vector loop.
Nodes that need results of other NPs (a neighbour's value, the global OR) end the current loop and
begin the next.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from npchip.engines.wasm.emit.encode import I32, V128, Function
from npchip.engines.wasm.emit.layout import Layout
from npchip.engines.wasm.emit.vector_ops import VectorOps
from npchip.engines.wasm.translate.summary import Item
from npchip.engines.wasm.translate.values import VARYING, Value


class Vectors(VectorOps):
    """Writes the values of blocks. Takes the arguments of `VectorOps`."""

    def __init__(
        self, out: Function, layout: Layout, home: Callable[[int], int], *, many: bool
    ) -> None:
        super().__init__(out, layout, home, many=many)
        self._stores: list[tuple[int, Value]] = []  # variables to store at the end of the loop

    def begin(
        self,
        most: Mapping[int, int],
        items: Sequence[Item],
        outs: Iterable[Value],
        wires: Iterable[Value | None],
    ) -> None:
        """Begin a block: count the uses of each node.

        Args:
            most: see `Block.most`.
            items: effects of the block; loads and kept nodes are not uses.
            outs: values of the variables that are live after the block.
            wires: conditions of its branch and guards.
        """
        self._planes.clear()
        self._most = most
        work: list[Value] = []
        for item in items:
            if item.kind in {"store", "send", "sample", "count"}:
                twice = 2 if item.guard is not None else 1
                work += item.operands() * twice
        for node in outs:
            work += (node, node)
        work += [wire for wire in wires if wire is not None]
        while work:
            node = work.pop()
            node.uses += 1
            if node.uses == 1:
                work += node.args

    def flush(self) -> None:
        """End the vector loop."""
        loop = self.loop
        assert self._read_across.isdisjoint([variable for variable, _ in self._stores])
        for variable, node in self._stores:
            loop.base()
            loop.get(node.temp)
            loop.memory("v128.store", self._layout.variable(variable))
        self._stores = []
        super().flush()

    def finish(self, outs: Mapping[int, Value], wire: Value | None) -> None:
        """End the last vector loop of a block, which stores the variables.

        No variable is read at neighbours in the loop that stores it.

        Args:
            outs: values of the variables that are live after the block.
            wire: condition of the branch; what it needs from other NPs is computed too.
        """
        if wire is not None and _crossings(wire) > 1:  # it needs several loops
            self.compute_crossings(wire)
        self.compute_crossings(*outs.values())
        for node in outs.values():
            self.materialize(node)
        if not self._read_across.isdisjoint(outs):
            self.flush()
        for node in outs.values():
            self.materialize(node, load=True)
        self._stores = [(v, node) for v, node in outs.items() if node.kind == VARYING]
        if wire is not None:
            self.compute_crossings(wire)
        self.flush()

    # ---- results of other NPs

    def compute_crossings(self, *nodes: Value) -> None:
        """Compute the operands of these nodes that need other NPs."""
        for node in nodes:
            if node.crosses and node.temp < 0:
                self.compute_crossings(*node.args)
                if node.op == "any":
                    self._any(node)
                elif node.op == "neighbour":
                    self._look(node)
            node.crosses = False

    def materialize(self, node: Value, *, load: bool = False) -> None:
        """Compute a node now, into a value or local that `vector` or `scalar` will push.

        Args:
            node: the node.
            load: whether to load variables too, for use in the current loop.
        """
        self.compute_crossings(node)
        if node.kind != VARYING:
            self.materialize_scalar(node)
        elif node.temp < 0 and (node.op != "leaf" or load):
            self._compute(node)
            self.bind(node)

    def _look(self, node: Value) -> None:
        """Read the neighbours' values now, before a later loop stores the variables."""
        (source,) = node.args
        self.materialize(source)
        if source.kind == VARYING and self.loop.computes(source.temp):
            self.flush()
        self._compute(node)
        self.bind(node)

    def _any(self, node: Value) -> None:
        """Compute whether a bit is set in any NP, as a reduction that ends the vector loop."""
        out, loop = self._out, self.loop
        (bit,) = node.args
        inverted = self._inverted(bit)
        sign = bit.op == "bit" and bit.value == 7 and bit.temp < 0
        source = inverted or (bit.args[0] if sign else bit)
        joined = self.temporary(V128)
        self.vector(source, bit=not sign)
        loop.set_padding(ones=inverted is not None)
        loop.reduce(joined, ones=inverted is not None)
        self.flush()
        out.get(joined)
        if inverted is not None:
            out.op("v128.not")
        if sign:
            out.op("i8x16.bitmask")
            out.i32(0)
            out.op("i32.ne")
        else:
            out.op("v128.any_true")
        node.temp = self.temporary(I32)
        out.set(node.temp)

    def count(self, node: Value, total: int | None) -> int:
        """Count in the current loop the NPs in which a varying bit is set.

        Args:
            node: the bit.
            total: result of an earlier call in the block to add to; None starts at 0.

        Returns:
            Local whose lanes add up to the count after the loop.
        """
        loop = self.loop
        if total is None:
            total = self.temporary(V128)
            loop.zero_before(total)
        loop.use_local("get", total)
        self.vector(node, bit=True)
        loop.set_padding(ones=False)
        loop.op("i8x16.sub")  # a set bit is 255, which is -1
        loop.use_local("set", total)
        return total


def _crossings(node: Value) -> int:
    """Return the number of operations below a node that still need other NPs."""
    if not node.crosses or node.temp >= 0:
        return 0
    return sum(map(_crossings, node.args)) + (node.op in {"any", "neighbour"})
