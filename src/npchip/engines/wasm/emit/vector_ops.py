"""Code of varying values: each operation computes a vector of 16 NPs inside a vector loop."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from npchip.engines.wasm.emit.encode import I32, V128, Function
from npchip.engines.wasm.emit.layout import VECTOR, Layout
from npchip.engines.wasm.emit.loop_recorder import LoopRecorder
from npchip.engines.wasm.emit.scalars import Scalars
from npchip.engines.wasm.translate.values import CONSTANT, UNIFORM, VARYING, Value

_LANES: Final = {
    "add": "i8x16.add",
    "sub": "i8x16.sub",
    "sub_sat": "i8x16.sub_sat_u",
    "and": "v128.and",
    "or": "v128.or",
    "xor": "v128.xor",
    "eq": "i8x16.eq",
    "ge": "i8x16.ge_u",
    "both": "v128.and",
    "either": "v128.or",
}
_WIRES: Final = ("both", "either")


class VectorOps(Scalars):
    """Writes varying values into the current vector loop.

    Args:
        out: the function to write to.
        layout: addresses in the module's memory.
        home: returns the local of a uniform variable.
        many: whether the program has many blocks.

    Attributes:
        loop: records the vector loops.
    """

    def __init__(
        self, out: Function, layout: Layout, home: Callable[[int], int], *, many: bool
    ) -> None:
        super().__init__(out, home)
        self._layout = layout
        self.loop = LoopRecorder(out, layout, many=many)
        self._leaves: list[Value] = []  # loaded by this loop
        self._read_across: set[int] = set()  # variables of neighbours that this loop reads
        self._most: Mapping[int, int] = {}  # upper bounds of variables
        self._numbers: dict[int, int] = {}  # locals with splatted constants, in this loop
        self._planes: dict[Value, int] = {}  # locals with the planes' offsets, by address node

    def flush(self) -> None:
        """End the vector loop."""
        self.loop.flush()
        for leaf in self._leaves:  # loading again is cheaper than a register
            leaf.temp = -1
        self._leaves.clear()
        self._numbers.clear()
        self._read_across.clear()

    def bind(self, node: Value) -> None:
        """Pop the vector on the stack as the value of a varying node."""
        self._keep(node)
        self.loop.set(node.temp)

    def _keep(self, node: Value) -> None:
        """Assign a new loop value to a varying node."""
        node.temp = self.loop.new_value()
        if node.op == "leaf":
            self._leaves.append(node)

    def vector(self, node: Value, *, bit: bool = False) -> None:
        """Push a vector of a node's value. A bit is 0 or 255 in each lane.

        Args:
            node: a node that needs no other NPs, or whose crossings have been computed.
            bit: whether a bit is expected; a constant does not show it.
        """
        loop = self.loop
        if node.kind == CONSTANT:
            self._number(255 * node.value if bit else node.value)
        elif node.kind == UNIFORM:
            loop.use_local("get", self.splat(node))
        elif node.temp >= 0:
            loop.get(node.temp)
        else:
            self._compute(node)
            if node.uses > 1:
                self._keep(node)
                loop.tee(node.temp)

    def _number(self, number: int) -> None:
        """Push a constant, splatted over all lanes."""
        if number in {0, 255}:
            self.loop.v128(bytes([number]) * VECTOR)
            return
        local = self._numbers.get(number)
        if local is None:
            local = self._numbers[number] = self.temporary(V128)
            self.loop.i32(0)
            self.loop.load_same("v128.load", self._layout.numbers + VECTOR * number)
            self.loop.use_local("tee", local)
        else:
            self.loop.use_local("get", local)

    def address(self, node: Value) -> int:
        """Push the base of the plane at a constant or uniform NP address, and return the offset.

        The plane begins at the sum of both.
        """
        if node.kind == CONSTANT:
            self.loop.base()
            return self._layout.memory + node.value * self._layout.stride
        start = self._layout.memory
        if node.op == "add" and node.args[1].kind == CONSTANT:
            base, distance = node.args[0], node.args[1].value
            if base.op == "leaf" and self._most.get(base.value, 255) + distance < 256:
                node = base  # the sum cannot wrap
                start += distance * self._layout.stride
        local = self._planes.get(node)
        if local is None:
            local = self._planes[node] = self.temporary(I32)
            self.scalar(node)
            self._out.i32(self._layout.stride)
            self._out.op("i32.mul")
            self._out.set(local)
        self.loop.base(local)
        return start

    def _compute(self, node: Value) -> None:
        loop, op, args = self.loop, node.op, node.args
        name = _LANES.get(op)
        if name is not None:
            bits = op in _WIRES
            left, right = args
            inverted = self._inverted(right) if name == "v128.and" else None
            self.vector(left, bit=bits)
            if inverted is not None:
                self.vector(inverted, bit=True)
                loop.op("v128.andnot")
            else:
                self.vector(right, bit=bits)
                loop.op(name)
            return
        match op:
            case "shl" | "shr":
                self.vector(args[0])
                loop.i32(node.value)
                loop.op("i8x16.shl" if op == "shl" else "i8x16.shr_u")
            case "byte":
                self.vector(args[0], bit=True)
                loop.v128(b"\x01" * VECTOR)
                loop.op("v128.and")
            case "mask":
                self.vector(args[0], bit=True)
            case "not":
                self.vector(args[0], bit=True)
                loop.op("v128.not")
            case "bit":
                self._bit(args[0], node.value)
            case "select":
                self.vector(args[1])
                self.vector(args[2])
                self.vector(args[0], bit=True)
                loop.op("v128.bitselect")
            case "row" | "column":
                loop.base()
                loop.memory("v128.load", self._layout.axes[op])
            case "neighbour":
                self._neighbour(args[0], node.value)
            case "load":
                loop.memory("v128.load", self.address(args[0]))
            case "leaf" | "received":
                where = self._layout
                loop.base()
                loop.memory(
                    "v128.load", where.variable(node.value) if op == "leaf" else where.received
                )
            case _:
                raise AssertionError(op)

    def _inverted(self, node: Value) -> Value | None:
        """Return the node whose complement `node` is, unless `node` itself is at hand."""
        if node.op == "mask" and node.temp < 0:
            node = node.args[0]
        if node.kind != VARYING or node.temp >= 0:
            return None
        complement = node.op == "xor" and node.args[1].kind == CONSTANT
        complement = complement and node.args[1].value == 255
        return node.args[0] if node.op == "not" or complement else None

    def _bit(self, node: Value, number: int) -> None:
        loop = self.loop
        self.vector(node)
        if number == 7:  # the sign
            loop.v128(bytes(VECTOR))
            loop.op("i8x16.lt_s")
        else:
            loop.v128(bytes([1 << number]) * VECTOR)
            loop.op("v128.and")
            loop.v128(bytes([1 << number]) * VECTOR)
            loop.op("i8x16.eq")

    def _neighbour(self, node: Value, direction: int) -> None:
        """Push the neighbours' values: a shifted plane, with 0 outside the array."""
        loop, where = self.loop, self._layout
        if node.kind != VARYING:
            self.vector(node)
        elif node.op == "leaf":
            loop.base()
            loop.memory("v128.load", where.variable(node.value) + where.distances[direction])
            self._read_across.add(node.value)
        else:
            loop.get_shifted(node.temp, where.distances[direction])
        loop.base()
        loop.memory("v128.load", where.has_neighbour(direction))
        loop.op("v128.and")
