"""When values are computed: only those that are needed, and once.

A uniform node takes one scalar instruction, a varying one an instruction for each vector of 16 NPs,
in a loop. Where NPs need what others have computed (a neighbour's value, the global OR) one loop
ends and the next begins.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from npchip.engines.wasm.emit.encode import I32, V128, Function
from npchip.engines.wasm.emit.layout import Layout
from npchip.engines.wasm.emit.vector_ops import VectorOps
from npchip.engines.wasm.translate.executed import Item
from npchip.engines.wasm.translate.nodes import VARYING, Node


class Vectors(VectorOps):
    """Writes the values of blocks; see `VectorOps` for what it is made of."""

    def __init__(
        self, out: Function, layout: Layout, home: Callable[[int], int], *, many: bool
    ) -> None:
        super().__init__(out, layout, home, many=many)
        self._stores: list[tuple[int, Node]] = []  # variables that change where the loop ends

    def begin(
        self,
        most: Mapping[int, int],
        items: Sequence[Item],
        outs: Iterable[Node],
        wires: Iterable[Node | None],
    ) -> None:
        """Begin a block: count how often each node is needed.

        Args:
            most: see `Block.most`.
            items: effects of the block; loads and kept nodes only count if others need them.
            outs: values needed after it.
            wires: of its branches.
        """
        self._planes.clear()
        self._most = most
        work: list[Node] = []
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
        """End the loop."""
        loop = self.loop
        assert self._read_across.isdisjoint([variable for variable, _ in self._stores])
        for variable, node in self._stores:
            loop.base()
            loop.get(node.temp)
            loop.memory("v128.store", self._layout.variable(variable))
        self._stores = []
        super().flush()

    def finish(self, outs: Mapping[int, Node], wire: Node | None) -> None:
        """End the last loop of a block, in which its variables change: none is read across NPs.

        Args:
            outs: the values of the variables that are needed.
            wire: the wire of its branch; what it needs from other NPs is computed too.
        """
        if wire is not None and _crossings(wire) > 1:  # it needs several strips
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

    # ---- before a loop

    def compute_crossings(self, *nodes: Node) -> None:
        """Compute what `lanes` and `scalar` of these nodes need from other NPs."""
        for node in nodes:
            if node.crosses and node.temp < 0:
                self.compute_crossings(*node.args)
                if node.op == "any":
                    self._any(node)
                elif node.op == "neighbour":
                    self._look(node)
            node.crosses = False

    def materialize(self, node: Node, *, load: bool = False) -> None:
        """Compute a node, so that `lanes` or `scalar` only fetch it.

        Args:
            node: the node.
            load: whether to fetch a variable as well, until the loop ends.
        """
        self.compute_crossings(node)
        if node.kind != VARYING:
            self.materialize_scalar(node)
        elif node.temp < 0 and (node.op != "leaf" or load):
            self._compute(node)
            self.bind(node)

    # ---- between NPs

    def _look(self, node: Node) -> None:
        """Read the neighbours here: where the last loop ends, variables may have changed."""
        (source,) = node.args
        self.materialize(source)
        if source.kind == VARYING and self.loop.computes(source.temp):
            self.flush()
        self._compute(node)
        self.bind(node)

    def _any(self, node: Node) -> None:
        """Whether a bit is set in any lane that is an NP: it joins the loop, and ends it."""
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

    def count(self, node: Node, total: int | None) -> int:
        """Count in how many NPs a varying bit is set: it joins the loop.

        Args:
            node: the bit.
            total: what to add to: a local that this has returned in the same block, if any.

        Returns:
            A local that holds the count when the loop has ended, parted over its lanes.
        """
        loop = self.loop
        if total is None:
            total = self.temporary(V128)
            loop.zero_before(total)
        loop.get_local(total)
        self.vector(node, bit=True)
        loop.set_padding(ones=False)
        loop.op("i8x16.sub")  # a set bit is 255, which is -1
        loop.set_local(total)
        return total


def _crossings(node: Node) -> int:
    """How often a node that is not settled needs other NPs."""
    if not node.crosses or node.temp >= 0:
        return 0
    return sum(map(_crossings, node.args)) + (node.op in {"any", "neighbour"})
