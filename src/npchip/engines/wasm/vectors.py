"""The code of values, only of those that are needed, and once.

A uniform node takes one scalar instruction. A varying one takes an instruction for each vector of
16 NPs, in a strip; where NPs need each other (a neighbour, the global OR) one strip ends and the
next begins.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.engines.wasm.encode import I32, OPS, V128, Function
from npchip.engines.wasm.executed import Item
from npchip.engines.wasm.layout import VECTOR, Layout
from npchip.engines.wasm.links import links
from npchip.engines.wasm.nodes import CONSTANT, UNIFORM, VARYING, Node
from npchip.engines.wasm.scalars import Scalars
from npchip.engines.wasm.strip import Strip

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
    """Writes values.

    Args:
        out: where to.
        layout: geometry.
        home: gives the local of a uniform variable.

    Attributes:
        strip: what is done for each vector at present.
    """

    def __init__(self, out: Function, layout: Layout, home: Callable[[int], int]) -> None:
        super().__init__(out, home)
        self._layout = layout
        self.strip = Strip(out, layout.vectors)
        self._fresh: set[Node] = set()  # computed in the present strip
        self._leaves: list[Node] = []  # that the present strip has loaded
        self._across: set[int] = set()  # variables whose other vectors it has read
        self._stores: list[tuple[int, Node]] = []  # variables that change where it ends
        self._most: Mapping[int, int] = {}
        self._numbers: dict[int, int] = {}  # locals with numbers in all lanes, in this strip
        self._planes: dict[Node, int] = {}  # local with the first byte of the plane at an address
        indices = np.indices(layout.machine.geometry)
        self._places = {
            axis: self._constant(numbers)
            for axis, numbers in zip(("row", "column"), indices, strict=True)
        }
        self._links = cache(lambda direction: links(layout, direction))

    def _constant(self, plane: NDArray[np.int64]) -> list[bytes]:
        """The constants that make up a plane."""
        lanes = np.zeros(self._layout.stride, np.uint8)
        lanes[: plane.size] = plane.reshape(-1)
        data = lanes.tobytes()
        return [b"\xfd\x0c" + data[start : start + VECTOR] for start in self._layout.starts]

    def begin(
        self,
        most: Mapping[int, int],
        items: Sequence[Item],
        outs: Iterable[Node],
        wires: Iterable[Node | None],
    ) -> None:
        """Begin a block: count how often each node is needed, free all temporaries.

        Args:
            most: see `Block.most`.
            items: effects of the block; loads and kept nodes only count if others need them.
            outs: values needed after it.
            wires: of its branches.
        """
        self.free()
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
        """End the strip."""
        strip = self.strip
        for variable, node in self._stores:
            strip.i32(0)
            strip.get(node.temp)
            strip.memory("v128.store", self._layout.variable(variable))
        strip.flush()
        for leaf in self._leaves:  # loading it again costs less than keeping it
            leaf.temp = -1
        for collection in (self._stores, self._leaves, self._fresh, self._numbers, self._across):
            collection.clear()

    def finish(self, outs: Mapping[int, Node], wire: Node | None) -> None:
        """End the last strip of a block, in which its variables change.

        Args:
            outs: the values of the variables that are needed.
            wire: the wire of its branch; what it needs from other NPs is computed too.
        """
        if wire is not None and _crossings(wire) > 1:  # it needs several strips
            self.settle(wire)
        self.settle(*outs.values())
        for node in outs.values():
            self.hold(node)
        if not self._across.isdisjoint(outs):
            self.flush()
        for node in outs.values():
            self.hold(node, load=True)
        self._stores = [(v, node) for v, node in outs.items() if node.kind == VARYING]
        if wire is not None:
            self.settle(wire)
        self.flush()

    # ---- before a strip

    def settle(self, *nodes: Node) -> None:
        """Compute what `lanes` and `scalar` of these nodes need from other NPs."""
        for node in nodes:
            if node.crosses and node.temp < 0:
                self.settle(*node.args)
                if node.op == "any":
                    self._any(node)
                elif node.op == "neighbour":
                    self.hold(node.args[0])
                    if node.args[0] in self._fresh:
                        self.flush()
            node.crosses = False

    def hold(self, node: Node, *, load: bool = False) -> None:
        """Compute a node, so that `lanes` or `scalar` only fetch it.

        Args:
            node: the node.
            load: whether to fetch a variable as well, until the strip ends.
        """
        self.settle(node)
        if node.kind != VARYING:
            self.hold_scalar(node)
        elif node.temp < 0 and (node.op != "leaf" or load):
            self._compute(node)
            self.take(node)

    def take(self, node: Node) -> None:
        """Let a varying node be what the strip has left on the stack."""
        self._keep(node)
        self.strip.set(node.temp)

    def _keep(self, node: Node) -> None:
        """Give a varying node that is being computed a temporary."""
        node.temp = self.temporary(V128, self._layout.vectors)
        if node.op == "leaf":
            self._leaves.append(node)
        else:
            self._fresh.add(node)

    # ---- in a strip

    def lanes(self, node: Node, *, bit: bool = False) -> None:
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

    def address(self, node: Node) -> int:
        """Push where the plane at a constant or uniform address begins, less what is returned."""
        if node.kind == CONSTANT:
            self.strip.i32(0)
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
        self.strip.get_one(local)
        return start

    def _compute(self, node: Node) -> None:
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
                strip.each(self._places[op])
            case "neighbour":
                self._neighbour(args[0], node.value)
            case "load":
                strip.memory("v128.load", self.address(args[0]))
            case "leaf" | "received":
                where = self._layout
                strip.i32(0)
                strip.memory(
                    "v128.load", where.variable(node.value) if op == "leaf" else where.received
                )
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

    def _bit(self, node: Node, number: int) -> None:
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

    # ---- between NPs

    def _neighbour(self, node: Node, direction: int) -> None:
        """A shuffle of the vectors that hold the neighbours, and 0 outside the array."""
        codes = []
        for link in self._links(direction):
            code = Function()
            if not link.sources:
                code.v128(bytes(VECTOR))
            else:
                for source in (link.sources[0], link.sources[-1]):
                    self._push(code, node, source)
                code.shuffle(link.lanes)
                if link.inside != b"\xff" * VECTOR:
                    code.v128(link.inside)
                    code.op("v128.and")
            codes.append(bytes(code.code))
        self.strip.each(codes)

    def _push(self, code: Function, node: Node, index: int) -> None:
        """Push vector `index` of a node that is held."""
        if node.kind == CONSTANT:
            code.v128(bytes([node.value]) * VECTOR)
        elif node.kind == UNIFORM:
            code.get(self.splat(node))
        elif node.op == "leaf":
            code.i32(0)
            code.memory("v128.load", self._layout.variable(node.value) + VECTOR * index)
            self._across.add(node.value)
        else:
            code.get(node.temp + index)

    def _any(self, node: Node) -> None:
        """Whether a bit is set in any lane that is an NP: it joins the strip, and ends it."""
        out, strip = self._out, self.strip
        (bit,) = node.args
        inverted = self._inverted(bit)
        sign = bit.op == "bit" and bit.value == 7 and bit.temp < 0
        source = inverted or (bit.args[0] if sign else bit)
        joined = self.temporary(V128)
        before = Function()
        before.get(joined)
        strip.rest(before.code)
        self.lanes(source, bit=not sign)
        self._cut(ones=inverted is not None)
        strip.rest(OPS["v128.or" if inverted is None else "v128.and"])
        strip.set_one(joined)
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

    def _cut(self, *, ones: bool) -> None:
        """Let the bits on the stack be `ones` in all lanes that are no NPs."""
        where = self._layout
        inside = where.lanes - where.starts[-1]
        if inside < VECTOR:
            code = Function()
            here, outside = (b"\x00", b"\xff") if ones else (b"\xff", b"\x00")
            code.v128(here * inside + outside * (VECTOR - inside))
            code.op("v128.or" if ones else "v128.and")
            self.strip.last(code.code)

    def count(self, node: Node, total: int | None) -> int:
        """Count in how many NPs a varying bit is set: it joins the strip.

        Args:
            node: the bit.
            total: what to add to: a local that this has returned in the same block, if any.

        Returns:
            A local that holds the count when the strip has ended, parted over its lanes.
        """
        strip = self.strip
        if total is None:
            total = self.temporary(V128)
            none = Function()
            none.v128(bytes(VECTOR))
            none.set(total)
            strip.first(none.code)
        strip.get_one(total)
        self.lanes(node, bit=True)
        self._cut(ones=False)
        strip.op("i8x16.sub")  # a set bit is 255, which is -1
        strip.set_one(total)
        return total


def _crossings(node: Node) -> int:
    """How often a node that is not settled needs other NPs."""
    if not node.crosses or node.temp >= 0:
        return 0
    return sum(map(_crossings, node.args)) + (node.op in {"any", "neighbour"})
