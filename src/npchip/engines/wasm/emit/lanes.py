"""The code of varying values: an instruction for each vector of 16 NPs, in a strip."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from npchip.engines.wasm.emit.encode import I32, V128, Function
from npchip.engines.wasm.emit.layout import VECTOR, Layout
from npchip.engines.wasm.emit.scalars import Scalars
from npchip.engines.wasm.emit.schedule import Strip
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


class Lanes(Scalars):
    """Writes what the present strip does with values.

    Args:
        out: where to.
        layout: geometry.
        home: gives the local of a uniform variable.
        many: whether the program has many blocks.

    Attributes:
        strip: what is done for each vector at present.
    """

    def __init__(
        self, out: Function, layout: Layout, home: Callable[[int], int], *, many: bool
    ) -> None:
        super().__init__(out, home)
        self._layout = layout
        self.strip = Strip(out, layout, many=many)
        self._leaves: list[Value] = []  # that the present strip has loaded
        self._across: set[int] = set()  # variables that it has read at neighbours
        self._most: Mapping[int, int] = {}
        self._numbers: dict[int, int] = {}  # locals with numbers in all lanes, in this strip
        self._planes: dict[Value, int] = {}  # local with the first byte of the plane at an address

    def flush(self) -> None:
        """End the strip."""
        self.strip.flush()
        for leaf in self._leaves:  # loading it again costs less than keeping it
            leaf.temp = -1
        self._leaves.clear()
        self._numbers.clear()
        self._across.clear()

    def take(self, node: Value) -> None:
        """Let a varying node be what the strip has left on the stack."""
        self._keep(node)
        self.strip.set(node.temp)

    def _keep(self, node: Value) -> None:
        """Give a varying node that is being computed a temporary."""
        node.temp = self.strip.value()
        if node.op == "leaf":
            self._leaves.append(node)

    def lanes(self, node: Value, *, bit: bool = False) -> None:
        """Push a vector of a node that is settled; a bit is 0 or 255 in each lane.

        Args:
            node: the node.
            bit: whether the place asks for a bit: a constant does not tell.
        """
        strip = self.strip
        if node.kind == CONSTANT:
            self._number(255 * node.value if bit else node.value)
        elif node.kind == UNIFORM:
            strip.get_one(self.splat(node))
        elif node.temp >= 0:
            strip.get(node.temp)
        else:
            self._compute(node)
            if node.uses > 1:
                self._keep(node)
                strip.tee(node.temp)

    def _number(self, number: int) -> None:
        """Push a number in all lanes."""
        if number in {0, 255}:
            self.strip.v128(bytes([number]) * VECTOR)
            return
        local = self._numbers.get(number)
        if local is None:
            local = self._numbers[number] = self.temporary(V128)
            self.strip.i32(0)
            self.strip.one("v128.load", self._layout.numbers + VECTOR * number)
            self.strip.tee_one(local)
        else:
            self.strip.get_one(local)

    def address(self, node: Value) -> int:
        """Push where the plane at a constant or uniform address begins, less what is returned."""
        if node.kind == CONSTANT:
            self.strip.base()
            return self._layout.memory + node.value * self._layout.stride
        start = self._layout.memory
        if node.op == "add" and node.args[1].kind == CONSTANT:
            base, distance = node.args[0], node.args[1].value
            if base.op == "leaf" and self._most.get(base.value, 255) + distance < 256:
                node = base  # it does not wrap
                start += distance * self._layout.stride
        local = self._planes.get(node)
        if local is None:
            local = self._planes[node] = self.temporary(I32)
            self.scalar(node)
            self._out.i32(self._layout.stride)
            self._out.op("i32.mul")
            self._out.set(local)
        self.strip.base(local)
        return start

    def _compute(self, node: Value) -> None:
        strip, op, args = self.strip, node.op, node.args
        name = _LANES.get(op)
        if name is not None:
            bits = op in _WIRES
            left, right = args
            inverted = self._inverted(right) if name == "v128.and" else None
            self.lanes(left, bit=bits)
            if inverted is not None:
                self.lanes(inverted, bit=True)
                strip.op("v128.andnot")
            else:
                self.lanes(right, bit=bits)
                strip.op(name)
            return
        match op:
            case "shl" | "shr":
                self.lanes(args[0])
                strip.i32(node.value)
                strip.op("i8x16.shl" if op == "shl" else "i8x16.shr_u")
            case "byte":
                self.lanes(args[0], bit=True)
                strip.v128(b"\x01" * VECTOR)
                strip.op("v128.and")
            case "mask":
                self.lanes(args[0], bit=True)
            case "not":
                self.lanes(args[0], bit=True)
                strip.op("v128.not")
            case "bit":
                self._bit(args[0], node.value)
            case "select":
                self.lanes(args[1])
                self.lanes(args[2])
                self.lanes(args[0], bit=True)
                strip.op("v128.bitselect")
            case "row" | "column":
                strip.base()
                strip.memory("v128.load", self._layout.axes[op])
            case "neighbour":
                self._neighbour(args[0], node.value)
            case "load":
                strip.memory("v128.load", self.address(args[0]))
            case "leaf" | "received":
                where = self._layout
                strip.base()
                strip.memory(
                    "v128.load", where.variable(node.value) if op == "leaf" else where.received
                )
            case _:
                raise AssertionError(op)

    def _inverted(self, node: Value) -> Value | None:
        """What `node` is the complement of, if that need not be computed for itself."""
        if node.op == "mask" and node.temp < 0:
            node = node.args[0]
        if node.kind != VARYING or node.temp >= 0:
            return None
        complement = node.op == "xor" and node.args[1].kind == CONSTANT
        complement = complement and node.args[1].value == 255
        return node.args[0] if node.op == "not" or complement else None

    def _bit(self, node: Value, number: int) -> None:
        strip = self.strip
        self.lanes(node)
        if number == 7:  # the sign
            strip.v128(bytes(VECTOR))
            strip.op("i8x16.lt_s")
        else:
            strip.v128(bytes([1 << number]) * VECTOR)
            strip.op("v128.and")
            strip.v128(bytes([1 << number]) * VECTOR)
            strip.op("i8x16.eq")

    def _neighbour(self, node: Value, direction: int) -> None:
        """Read a plane that begins as many lanes later or earlier; outside the array there is 0."""
        strip, where = self.strip, self._layout
        if node.kind != VARYING:
            self.lanes(node)
        elif node.op == "leaf":
            strip.base()
            strip.memory("v128.load", where.variable(node.value) + where.distances[direction])
            self._across.add(node.value)
        else:
            strip.near(node.temp, where.distances[direction])
        strip.base()
        strip.memory("v128.load", where.has_neighbour(direction))
        strip.op("v128.and")
