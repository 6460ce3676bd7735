"""One block's instructions executed on values: the intermediate form to a graph of nodes.

The same execution serves every analysis: with what is known of the variables when a block begins,
its result tells what is known when it ends, and what each value depends on.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, Literal

from npchip.engines.state import REGISTERS
from npchip.engines.wasm.graph import Block, constant
from npchip.engines.wasm.values import CONSTANT, Node, Values
from npchip.isa import Decoded, Isa, ir
from npchip.isa.ir import Type

ZERO: Final = REGISTERS
CARRY: Final = REGISTERS + 1
MASKS: Final = REGISTERS + 2
"""Variables are numbered: the registers, Z, C, then the mask of each open region: bit MASKS + k
tells which NPs are active in the regions 0 to k."""

DIRECTIONS: Final = ("north", "east", "south", "west")

Known = Mapping[int, int]
"""What is known of variables: a number from 0 to 255, `SAME` or `ANY`."""
SAME: Final = 256
ANY: Final = 257


def is_bit(variable: int) -> bool:
    """Whether a variable is a flag or a mask."""
    return variable >= REGISTERS


def variables(depth: int) -> range:
    """All variables where `depth` regions are open."""
    return range(MASKS + depth)


@dataclass(frozen=True)
class Site:
    """An output instruction.

    Attributes:
        address: of the instruction.
        port: port number.
    """

    address: int
    port: int


@dataclass(frozen=True)
class Item:
    """Something that a block does at its place in the order: nodes are computed when needed.

    Attributes:
        kind: ``load``, ``store``, ``send``, ``sample``, or ``keep``: compute a node now.
        nodes: load, keep: the node. store: address, value. send: value.
        mask: which NPs it reaches; None for all.
        guard: a wire that must be set.
        site: send: the output instruction.
        bank: sample: first byte.
        signal: sample: whether the light is converted too.
    """

    kind: Literal["load", "store", "send", "sample", "keep"]
    nodes: tuple[Node, ...] = ()
    mask: Node | None = None
    guard: Node | None = None
    site: Site | None = None
    bank: int = 0
    signal: bool = False

    def operands(self) -> list[Node]:
        """Nodes that must be computed for it, if it must be done at all."""
        extra = [node for node in (self.mask, self.guard) if node is not None]
        nodes = self.nodes[0].args if self.kind == "load" else self.nodes
        return [*nodes, *extra]


@dataclass
class Executed:
    """What a block does.

    Attributes:
        items: effects, loads and nodes to keep, in order.
        outs: variables that it writes, with their values at its end.
        wire: where it branches: the wire.
    """

    items: list[Item] = field(default_factory=list)
    outs: dict[int, Node] = field(default_factory=dict)
    wire: Node | None = None

    def ends(self) -> dict[int, int]:
        """What is known of the written variables at its end."""
        return {variable: known(node) for variable, node in self.outs.items()}


def known(node: Node) -> int:
    """What is known of a node."""
    if node.kind == CONSTANT:
        return node.value
    return SAME if node.kind == 1 else ANY


class Executor:
    """Executes blocks on values.

    Args:
        isa: for the meaning of conditions.
        memory_bytes: size of an NP's memory.
    """

    def __init__(self, isa: Isa, memory_bytes: int) -> None:
        self._conditions = isa.conditions
        self._last_byte = memory_bytes - 1

    def execute(self, block: Block, begin: Known) -> Executed:
        """Execute a block.

        Args:
            block: not one that leaves.
            begin: what is known of every variable when it begins.
        """
        self._values = Values()
        self._operators = self._values.operators()
        self._begin = begin
        self._now: dict[int, Node] = {}
        self._done = Executed(outs=self._now)
        self._version = 0  # of the memory
        self._loads: set[Node] = set()
        for step in block.steps:
            assert step.decoded is not None
            self._decoded: Decoded = step.decoded
            self._depth = step.place.depth
            self._address = step.place.address
            self._locals: dict[str, Node] = {}
            for statement in step.decoded.form.statements:
                self._statement(statement)
                for node in self._values.deep:
                    self._done.items.append(Item("keep", (node,)))
                self._values.deep.clear()
        return self._done

    # ---- variables

    def _read(self, variable: int) -> Node:
        node = self._now.get(variable)
        if node is not None:
            return node
        what = self._begin[variable]
        if what < SAME:
            return self._values.constant(what)
        return self._values.leaf(variable, what - SAME + 1)

    def _mask(self) -> Node | None:
        return self._read(MASKS + self._depth - 1) if self._depth else None

    def _write(self, variable: int, value: Node) -> None:
        mask = self._mask()
        if mask is not None:
            select = self._values.select_bit if is_bit(variable) else self._values.select
            value = select(mask, value, self._read(variable))
        self._now[variable] = value

    # ---- statements

    def _statement(self, node: ir.Statement) -> None:
        match node:
            case ir.SetRegister(name=name, value=value):
                self._write(int(self._decoded.values[name]), self._expr(value))
            case ir.SetFlag(name=name, value=value):
                self._write(ZERO if name == "Z" else CARRY, self._expr(value))
            case ir.SetLocal(name=name, value=value):
                self._locals[name] = self._expr(value)
            case ir.Store(address=address, value=value):
                nodes = (self._address_of(address), self._expr(value))
                self._done.items.append(Item("store", nodes, self._mask()))
                self._version += 1
            case ir.Effect():
                self._effect(node)

    def _effect(self, node: ir.Effect) -> None:
        values, args = self._decoded.values, node.args
        guard = None if node.guard is None else self._expr(node.guard)
        match node.name:
            case "mask_push":
                bit = self._expr(args[0])
                mask = self._mask()
                self._now[MASKS + self._depth] = (
                    bit if mask is None else self._values.both(mask, bit)
                )
                self._depth += 1
            case "mask_invert":
                others = self._values.not_(self._read(MASKS + self._depth - 1))
                if self._depth > 1:
                    others = self._values.both(self._read(MASKS + self._depth - 2), others)
                self._now[MASKS + self._depth - 1] = others
            case "mask_pop":
                self._depth -= 1
                self._now.pop(MASKS + self._depth, None)
            case "output":
                site = Site(self._address, constant(args[0], values))
                value = (self._expr(args[1]),)
                self._done.items.append(Item("send", value, self._mask(), guard, site))
            case "sample":
                signal = self._choice(args[0]) == "signal"
                bank = constant(args[1], values)
                item = Item("sample", (), self._mask(), guard, bank=bank, signal=signal)
                self._done.items.append(item)
                self._version += 1
            case _:  # the flow: the graph knows where it leads
                self._done.wire = guard

    def _choice(self, node: ir.Expr) -> str:
        assert isinstance(node, ir.Field)
        return str(self._decoded.values[node.name])

    # ---- expressions

    def _expr(self, node: ir.Expr) -> Node:
        values = self._values
        if node.type is Type.CONST:
            return values.constant(constant(node, self._decoded.values) & 255)
        match node:
            case ir.Register(name=name):
                return self._read(int(self._decoded.values[name]))
            case ir.Flag(name=name):
                return self._read(ZERO if name == "Z" else CARRY)
            case ir.Local(name=name):
                return self._locals[name]
            case ir.Binary(op="<<", left=left, right=right):
                return values.shift_left(self._expr(left), self._count(right))
            case ir.Binary(op=">>", left=left, right=right):
                return values.shift_right(self._expr(left), self._count(right))
            case ir.Binary(op=op, left=left, right=right):
                return self._operators[op](self._expr(left), self._expr(right))
            case ir.Carry(left=left, right=right, carry=extra):
                return values.carry(self._expr(left), self._expr(right), self._optional(extra))
            case ir.Borrow(left=left, right=right, borrow=extra):
                return values.borrow(self._expr(left), self._expr(right), self._optional(extra))
            case ir.Condition(name=name):
                return self._expr(self._conditions[str(self._decoded.values[name])].when)
            case ir.Place(axis=axis):
                return values.place(axis)
            case ir.Not(value=value, type=kind):
                inner = self._expr(value)
                return values.not_(inner) if kind is Type.BIT else values.invert(inner)
            case ir.NotWire(value=value):
                return values.not_(self._expr(value))
            case ir.BitOf(value=value, index=index):
                return values.bit(self._expr(value), self._count(index))
            case ir.Select(condition=condition, then=then, otherwise=otherwise, type=kind):
                select = values.select_bit if kind is Type.BIT else values.select
                return select(self._expr(condition), self._expr(then), self._expr(otherwise))
            case ir.ToByte(value=value):
                return values.byte(self._expr(value))
            case ir.Load(address=address):
                return self._load(self._address_of(address))
            case ir.Neighbour(value=value, direction=direction):
                number = DIRECTIONS.index(self._choice(direction))
                return values.neighbour(self._expr(value), number)
            case ir.AnyOf(value=value):
                mask, bit = self._mask(), self._expr(value)
                return values.any_of(bit if mask is None else values.both(mask, bit))
        raise AssertionError(node)

    def _load(self, address: Node) -> Node:
        node = self._values.load(address, self._version)
        if node not in self._loads:
            self._loads.add(node)
            self._done.items.append(Item("load", (node,)))
        return node

    def _count(self, node: ir.Expr) -> int:
        return constant(node, self._decoded.values) & 255

    def _optional(self, node: ir.Expr | None) -> Node | None:
        return None if node is None else self._expr(node)

    def _address_of(self, node: ir.Expr) -> Node:
        """An address that wraps at the end of the memory."""
        return self._values.and_(self._expr(node), self._values.constant(self._last_byte))
