"""The code of values, only of those that are needed, and once.

A uniform node takes one scalar instruction, a varying one an instruction for each vector of 16 NPs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Final

import numpy as np

from npchip.engines.wasm.block import DIRECTIONS, Item, is_bit
from npchip.engines.wasm.encode import I32, V128, Function
from npchip.engines.wasm.layout import VECTOR, Layout
from npchip.engines.wasm.values import CONSTANT, UNIFORM, VARYING, Node

_BITS: Final = frozenset({"eq", "ge", "bit", "not", "both", "either", "any"})
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
_SCALAR: Final = {
    "add": ("i32.add", True),  # whether the result may leave the byte
    "sub": ("i32.sub", True),
    "and": ("i32.and", False),
    "or": ("i32.or", False),
    "xor": ("i32.xor", False),
    "eq": ("i32.eq", False),
    "ge": ("i32.ge_u", False),
    "both": ("i32.and", False),
    "either": ("i32.or", False),
}


class Vectors:
    """Writes values.

    Args:
        out: where to.
        layout: geometry.
        home: gives the first local of a variable's home, for a variable and a kind.
    """

    def __init__(self, out: Function, layout: Layout, home: Callable[[int, int], int]) -> None:
        self._out = out
        self._layout = layout
        self._home = home
        self._count = layout.vectors
        self._pools: dict[tuple[int, int], list[int]] = {}
        self._taken: dict[tuple[int, int], int] = {}
        self._ready: set[tuple[Node, int]] = set()
        self._splats: dict[tuple[Node, bool], int] = {}
        indices = np.indices((layout.machine.np_rows, layout.machine.np_cols))
        self._places = {
            axis: self._padded(numbers.reshape(-1))
            for axis, numbers in zip(("row", "column"), indices, strict=True)
        }
        self._inside = self._padded(np.full(layout.lanes, 255))
        self._shifts: dict[int, list[tuple[list[tuple[int, list[int]]], bytes]]] = {}

    def _padded(self, lanes: np.ndarray[tuple[int, ...], np.dtype[np.int64]]) -> bytes:
        plane = np.zeros(self._layout.stride, np.uint8)
        plane[: lanes.size] = lanes
        return plane.tobytes()

    def begin(self, items: Sequence[Item], outs: Iterable[Node], wire: Node | None) -> None:
        """Begin a block: count how often each node is needed, free all temporaries.

        Args:
            items: effects of the block; loads and kept nodes only count if others need them.
            outs: values needed after it; kept in temporaries.
            wire: the wire of its branch.
        """
        self._taken.clear()
        self._ready.clear()
        self._splats.clear()
        work: list[Node] = []
        for item in items:
            if item.kind in {"store", "send", "sample"}:
                twice = 2 if item.guard is not None else 1
                work += item.operands() * twice
        for node in outs:
            work += (node, node)
        if wire is not None:
            work.append(wire)
        while work:
            node = work.pop()
            node.uses += 1
            if node.uses == 1:
                work += node.args

    def temporary(self, kind: int, count: int = 1) -> int:
        """First of `count` locals that are free until the block ends."""
        key = kind, count
        pool = self._pools.setdefault(key, [])
        number = self._taken.get(key, 0)
        self._taken[key] = number + 1
        if number == len(pool):
            pool.append(self._out.local(kind, count))
        return pool[number]

    # ---- computing once

    def hold(self, node: Node, *, splat: bool = False) -> None:
        """Compute a node now, so that `scalar` and `held_lanes` only fetch it.

        Args:
            node: the node.
            splat: whether `lanes` shall only fetch it too.
        """
        if node.kind == VARYING:
            self.keep(node)
        elif node.kind == UNIFORM:
            if node.op != "leaf" and (node, 0) not in self._ready:
                node.uses = max(node.uses, 2)
                self.scalar(node)
                self._out.set(self.temporary(I32))  # only to take it from the stack
            if splat:
                self.lanes(node, 0)
                self._out.set(self.temporary(V128))

    def keep(self, node: Node) -> None:
        """Compute a node now if it is needed."""
        if not node.uses or node.op == "leaf" or node.kind == CONSTANT:
            return
        if node.kind == UNIFORM:
            self.hold(node)
            return

        def push(index: int) -> None:
            self._compute(node, index)

        self.take(node, push)

    def take(self, node: Node, push: Callable[[int], None]) -> None:
        """Let a varying node be what `push` leaves on the stack for each vector."""
        for index in range(self._count):
            if (node, index) not in self._ready:
                push(index)
                self._out.set(self._temp(node) + index)
                self._ready.add((node, index))

    def _temp(self, node: Node) -> int:
        if node.temp < 0:
            varying = node.kind == VARYING
            node.temp = self.temporary(V128 if varying else I32, self._count if varying else 1)
        return node.temp

    # ---- lanes

    def lanes(self, node: Node, index: int, *, bit: bool = False) -> None:
        """Push vector `index` of a node; a bit is 0 or 255 in each lane.

        Args:
            node: the node.
            index: number of the vector.
            bit: whether the place asks for a bit: a constant does not tell.
        """
        if node.kind == CONSTANT:
            number = 255 * node.value if bit else node.value
            self._out.v128(bytes([number]) * VECTOR)
        elif node.kind == UNIFORM:
            self._splat_once(node)
        elif node.op == "leaf":
            self._out.get(self._home(node.value, VARYING) + index)
        elif (node, index) in self._ready:
            self._out.get(node.temp + index)
        else:
            self._compute(node, index)
            if node.uses > 1:
                self._out.tee(self._temp(node) + index)
                self._ready.add((node, index))

    def held_lanes(self, node: Node, index: int, *, bit: bool) -> None:
        """As `lanes` for a node that is held; leaves no trace, so it may stand in an arm."""
        if node.kind == UNIFORM:
            self.scalar(node)
            self.splat(bit=bit)
        else:
            self.lanes(node, index, bit=bit)

    def _splat_once(self, node: Node) -> None:
        bit = node.op in _BITS or (node.op == "leaf" and is_bit(node.value))
        key = node, bit
        if key in self._splats:
            self._out.get(self._splats[key])
            return
        self.scalar(node)
        self.splat(bit=bit)
        local = self._splats[key] = self.temporary(V128)
        self._out.tee(local)

    def splat(self, *, bit: bool) -> None:
        """Spread the number on the stack over all lanes."""
        if bit:
            number = self.temporary(I32)
            self._out.set(number)
            self._out.i32(0)
            self._out.get(number)
            self._out.op("i32.sub")
        self._out.op("i8x16.splat")

    def _compute(self, node: Node, index: int) -> None:
        out, op, args = self._out, node.op, node.args
        name = _LANES.get(op)
        if name is not None:
            bits = op in {"both", "either"}
            left, right = args
            inverted = self._inverted(right) if name == "v128.and" else None
            self.lanes(left, index, bit=bits)
            if inverted is not None:
                self.lanes(inverted, index, bit=True)
                out.op("v128.andnot")
            else:
                self.lanes(right, index, bit=bits)
                out.op(name)
            return
        match op:
            case "shl" | "shr":
                self.lanes(args[0], index)
                out.i32(node.value)
                out.op("i8x16.shl" if op == "shl" else "i8x16.shr_u")
            case "byte":
                self.lanes(args[0], index, bit=True)
                out.v128(b"\x01" * VECTOR)
                out.op("v128.and")
            case "mask":
                self.lanes(args[0], index, bit=True)
            case "not":
                self.lanes(args[0], index, bit=True)
                out.op("v128.not")
            case "bit":
                self._bit(args[0], node.value, index)
            case "select":
                self.lanes(args[1], index)
                self.lanes(args[2], index)
                self.lanes(args[0], index, bit=True)
                out.op("v128.bitselect")
            case "row" | "column":
                start = VECTOR * index
                out.v128(self._places[op][start : start + VECTOR])
            case "neighbour":
                self._neighbour(args[0], node.value, index)
            case _:
                raise AssertionError(op)

    def _inverted(self, node: Node) -> Node | None:
        """What `node` is the complement of, if that need not be computed for itself."""
        if node.op == "mask" and node.temp < 0:
            node = node.args[0]
        if node.kind != VARYING or node.temp >= 0:
            return None
        complement = node.op == "xor" and node.args[1].kind == CONSTANT
        complement = complement and node.args[1].value == 255
        return node.args[0] if node.op == "not" or complement else None

    def _bit(self, node: Node, number: int, index: int) -> None:
        out = self._out
        self.lanes(node, index)
        if number == 7:  # the sign
            out.v128(bytes(VECTOR))
            out.op("i8x16.lt_s")
        else:
            out.v128(bytes([1 << number]) * VECTOR)
            out.op("v128.and")
            out.v128(bytes([1 << number]) * VECTOR)
            out.op("i8x16.eq")

    # ---- neighbours

    def _neighbour(self, node: Node, direction: int, index: int) -> None:
        """A shuffle of the vectors that hold the neighbours, and 0 outside the array."""
        sources, inside = self._shift(direction)[index]
        if not sources:
            self._out.v128(bytes(VECTOR))
            return
        first, lanes = sources[0]
        self.lanes(node, first)
        self.lanes(node, sources[1][0] if len(sources) > 1 else first)
        self._out.shuffle(lanes)
        if inside != b"\xff" * VECTOR:
            self._out.v128(inside)
            self._out.op("v128.and")

    def _shift(self, direction: int) -> list[tuple[list[tuple[int, list[int]]], bytes]]:
        """For each vector the vectors that it reads with the shuffle, and which lanes count."""
        if direction not in self._shifts:
            machine = self._layout.machine
            rows, cols = np.indices((machine.np_rows, machine.np_cols)).reshape(2, -1)
            down, right = {"north": (-1, 0), "south": (1, 0), "west": (0, -1), "east": (0, 1)}[
                DIRECTIONS[direction]
            ]
            rows, cols = rows + down, cols + right
            inside = (rows >= 0) & (rows < machine.np_rows)
            inside &= (cols >= 0) & (cols < machine.np_cols)
            numbers = np.full(self._layout.stride, -1)
            numbers[: self._layout.lanes] = np.where(inside, rows * machine.np_cols + cols, -1)
            self._shifts[direction] = [
                _shuffle(numbers[start : start + VECTOR].tolist())
                for start in range(0, self._layout.stride, VECTOR)
            ]
        return self._shifts[direction]

    # ---- scalars

    def scalar(self, node: Node) -> None:
        """Push a constant or uniform node as a number."""
        out = self._out
        if node.kind == CONSTANT:
            out.i32(node.value)
        elif node.op == "leaf":
            out.get(self._home(node.value, UNIFORM))
        elif (node, 0) in self._ready:
            out.get(node.temp)
        else:
            self._compute_scalar(node)
            if node.uses > 1:
                out.tee(self._temp(node))
                self._ready.add((node, 0))

    def _compute_scalar(self, node: Node) -> None:
        out, op, args = self._out, node.op, node.args
        if op == "any":
            self._any(args[0])
            return
        if op == "mask":
            out.i32(0)
        if op == "select":
            args = (args[1], args[2], args[0])
        for arg in args:
            self.scalar(arg)
        if op in _SCALAR:
            name, leaves = _SCALAR[op]
            out.op(name)
        else:
            leaves = op in {"shl", "mask"}
            match op:
                case "shl" | "shr" | "bit":
                    out.i32(node.value)
                    out.op("i32.shl" if op == "shl" else "i32.shr_u")
                case "mask":
                    out.op("i32.sub")
                case "select":
                    out.op("select")
                case "not":
                    out.op("i32.eqz")
                case "byte":
                    pass
                case _:
                    raise AssertionError(op)
        if leaves or op == "bit":
            out.i32(1 if op == "bit" else 255)
            out.op("i32.and")

    def _any(self, node: Node) -> None:
        """Whether a bit is set in any lane that is an NP."""
        out = self._out
        padded = self._layout.stride != self._layout.lanes
        inverted = self._inverted(node)
        sign = node.op == "bit" and node.value == 7 and node.temp < 0
        source = inverted or (node.args[0] if sign else node)
        for index in range(self._count):
            self.lanes(source, index, bit=not sign)
            last = self._inside[VECTOR * index : VECTOR * (index + 1)]
            if padded and index == self._count - 1:
                if inverted is None:
                    out.v128(last)
                    out.op("v128.and")
                else:
                    out.v128(bytes(255 - lane for lane in last))
                    out.op("v128.or")
            if index:
                out.op("v128.or" if inverted is None else "v128.and")
        if inverted is not None:
            out.op("v128.not")
        if sign:
            out.op("i8x16.bitmask")
            out.i32(0)
            out.op("i32.ne")
        else:
            out.op("v128.any_true")


def _shuffle(numbers: list[int]) -> tuple[list[tuple[int, list[int]]], bytes]:
    """Vectors to read and the lanes to take, for lanes with these numbers (-1 for none)."""
    vectors = sorted({number // VECTOR for number in numbers if number >= 0})
    assert len(vectors) <= 2
    lanes = [
        0 if number < 0 else number % VECTOR + VECTOR * vectors.index(number // VECTOR)
        for number in numbers
    ]
    inside = bytes(255 if number >= 0 else 0 for number in numbers)
    return [(vector, lanes) for vector in vectors], inside
