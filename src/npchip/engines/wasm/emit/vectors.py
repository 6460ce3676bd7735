"""Evaluates the values of a block on demand: each one that is needed, once.

A uniform value takes one scalar instruction, and an operation on varying values takes a vector
instruction in a vector loop, for 16 NPs at a time. Values that need other NPs (a neighbour's value,
the global OR) end the current loop and begin the next.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Final

from npchip.engines.wasm.emit.encode import I32, V128, Function
from npchip.engines.wasm.emit.layout import VECTOR, Layout
from npchip.engines.wasm.emit.scalars import Scalars
from npchip.engines.wasm.emit.vector_loop import LoopRecorder
from npchip.engines.wasm.translate.values import CONSTANT, UNIFORM, VARYING, Value, split

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


class Vectors(Scalars):
    """Writes the values of blocks.

    Args:
        out: the function to write to.
        layout: addresses in the module's memory.
        home: returns the local of a uniform variable.

    Attributes:
        loop: records the vector loops.
        users: a needed value that has the key as an operand.
    """

    def __init__(self, out: Function, layout: Layout, home: Callable[[int], int]) -> None:
        super().__init__(out, home)
        self._layout = layout
        self.loop = LoopRecorder(out, layout)
        self.users: dict[Value, Value] = {}
        self._stores: list[tuple[int, Value]] = []  # variables to store at the end of the loop
        self._leaves: list[Value] = []  # loaded by this loop
        self._read_across: set[int] = set()  # variables of neighbours that this loop reads
        self._bounds: Mapping[int, int] = {}  # upper bounds of variables
        self._planes: dict[Value, int] = {}  # locals with the planes' offsets, by address

    def begin(
        self, bounds: Mapping[int, int], needs: Sequence[Value], outs: Iterable[Value]
    ) -> None:
        """Begin a block: count the uses of each value, and note one.

        Args:
            bounds: see `Block.bounds`.
            needs: see `Summary.needs`; loads and values to compute are not uses.
            outs: values of the variables that are live after the block.
        """
        self.users.clear()
        self._planes.clear()
        self._bounds = bounds
        work = [*needs, *(value for value in outs for _ in range(2))]
        while work:
            value = work.pop()
            value.uses += 1
            if value.uses == 1:
                work += value.args
                self.users.update(dict.fromkeys(value.args, value))

    def flush(self) -> None:
        """End the vector loop."""
        loop = self.loop
        assert self._read_across.isdisjoint([variable for variable, _ in self._stores])
        for variable, value in self._stores:
            loop.base()
            loop.get(value.temp)
            loop.memory("v128.store", self._layout.variable(variable))
        self._stores = []
        loop.flush()
        for leaf in self._leaves:  # loading again is cheaper than a register
            leaf.temp = -1
        self._leaves.clear()
        self._read_across.clear()

    def finish(self, outs: Mapping[int, Value], wire: Value | None) -> None:
        """End the last vector loop of a block, which stores the variables.

        No variable is read at neighbours in the loop that stores it.

        Args:
            outs: values of the variables that are live after the block.
            wire: condition of the branch; what it needs from other NPs is computed too.
        """
        if wire is not None and wire.crosses > 1:  # it needs several loops
            self.compute_crossings(wire)
        self.compute_crossings(*outs.values())
        for value in outs.values():
            self.materialize(value)
        if not self._read_across.isdisjoint(outs):
            self.flush()
        for value in outs.values():
            self.materialize(value, load=True)
        self._stores = [(v, value) for v, value in outs.items() if value.kind == VARYING]
        if wire is not None:
            self.compute_crossings(wire)
        self.flush()

    # ---- results of other NPs

    def compute_crossings(self, *values: Value) -> None:
        """Compute the operands of these values that need other NPs."""
        for value in values:
            if value.crosses and value.temp < 0:
                self.compute_crossings(*value.args)
                if value.op == "any":
                    self._any(value)
                elif value.op == "neighbour":
                    self._look(value)
            value.crosses = 0

    def materialize(self, value: Value, *, load: bool = False) -> None:
        """Compute a value now, into a slot or local that `vector` or `scalar` will push.

        Args:
            value: the value.
            load: whether to load variables too, for use in the current loop.
        """
        self.compute_crossings(value)
        if value.kind != VARYING:
            self.materialize_scalar(value)
        elif value.temp < 0 and (value.op != "leaf" or load):
            self._compute(value)
            self.bind(value)

    def _look(self, value: Value) -> None:
        """Read the neighbours' values now, before a later loop stores the variables."""
        (source,) = value.args
        self.materialize(source)
        if source.kind == VARYING and self.loop.computes(source.temp):
            self.flush()
        self._compute(value)
        self.bind(value)

    def _any(self, value: Value) -> None:
        """Compute whether a bit is set in any NP, as a reduction that ends the vector loop."""
        out, loop = self._out, self.loop
        (bit,) = value.args
        sign = bit.op == "bit" and bit.number == 7 and bit.temp < 0
        joined = self.temporary(V128)
        self.vector(bit.args[0] if sign else bit, bit=not sign)
        loop.clear_padding()
        loop.reduce(joined)
        self.flush()
        out.get(joined)
        out.write("i8x16.bitmask i32.const 0 i32.ne" if sign else "v128.any_true")
        value.temp = self.temporary(I32)
        out.set(value.temp)

    # ---- vectors of 16 NPs

    def bind(self, value: Value) -> None:
        """Pop the vector on the stack as a varying value."""
        self._keep(value)
        self.loop.set(value.temp)

    def _keep(self, value: Value) -> None:
        """Assign a new slot to a varying value."""
        value.temp = self.loop.new_slot()
        if value.op == "leaf":
            self._leaves.append(value)

    def vector(self, value: Value, *, bit: bool = False) -> None:
        """Push a vector of a value. A bit is 0 or 255 in each lane.

        Args:
            value: a value that needs no other NPs, or whose crossings have been computed.
            bit: whether a bit is expected; a constant does not show it.
        """
        loop = self.loop
        if value.kind == CONSTANT:
            loop.v128(bytes([255 * value.number if bit else value.number]) * VECTOR)
        elif value.kind == UNIFORM:
            loop.use_local("get", self.splat(value))
        elif value.temp >= 0:
            loop.get(value.temp)
        else:
            self._compute(value)
            if value.uses > 1:
                self._keep(value)
                loop.tee(value.temp)

    def address(self, value: Value) -> int:
        """Push the base of the plane at a constant or uniform NP address, and return the offset.

        The plane begins at the sum of both.
        """
        if value.kind == CONSTANT:
            self.loop.base()
            return self._layout.memory + value.number * self._layout.stride
        start = self._layout.memory
        base, distance = split(value)
        if base.op == "leaf" and self._bounds.get(base.number, 255) + distance < 256:
            value = base  # the sum cannot wrap
            start += distance * self._layout.stride
        local = self._planes.get(value)
        if local is None:
            local = self._planes[value] = self.temporary(I32)
            self.scalar(value)
            self._out.write(f"i32.const {self._layout.stride} i32.mul local.set {local}")
        self.loop.base(local)
        return start

    def _compute(self, value: Value) -> None:
        loop, op, args = self.loop, value.op, value.args
        name = _LANES.get(op)
        if name is not None:
            bits = op in _WIRES
            left, right = args
            self.vector(left, bit=bits)
            self.vector(right, bit=bits)
            loop.op(name)
            return
        match op:
            case "shl" | "shr":
                self.vector(args[0])
                loop.i32(value.number)
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
                self._bit(args[0], value.number)
            case "select":
                self.vector(args[1])
                self.vector(args[2])
                self.vector(args[0], bit=True)
                loop.op("v128.bitselect")
            case "row" | "column":
                loop.base()
                loop.memory("v128.load", self._layout.axes[op])
            case "neighbour":
                self._neighbour(args[0], value.number)
            case "load":
                loop.memory("v128.load", self.address(args[0]))
            case "leaf" | "received":
                where = self._layout
                loop.base()
                loop.memory(
                    "v128.load", where.variable(value.number) if op == "leaf" else where.received
                )
            case _:
                raise AssertionError(op)

    def _bit(self, value: Value, number: int) -> None:
        loop = self.loop
        self.vector(value)
        if number == 7:  # the sign
            loop.v128(bytes(VECTOR))
            loop.op("i8x16.lt_s")
        else:
            loop.v128(bytes([1 << number]) * VECTOR)
            loop.op("v128.and")
            loop.v128(bytes([1 << number]) * VECTOR)
            loop.op("i8x16.eq")

    def _neighbour(self, value: Value, direction: int) -> None:
        """Push the neighbours' values: a shifted plane, with 0 outside the array."""
        loop, where = self.loop, self._layout
        if value.kind != VARYING:
            self.vector(value)
        elif value.op == "leaf":
            loop.base()
            loop.memory("v128.load", where.variable(value.number) + where.distances[direction])
            self._read_across.add(value.number)
        else:
            loop.get_shifted(value.temp, where.distances[direction])
        loop.base()
        loop.memory("v128.load", where.has_neighbour(direction))
        loop.op("v128.and")
