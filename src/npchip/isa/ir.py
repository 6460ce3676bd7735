"""The typed intermediate form of an instruction's meaning.

The loader translates the semantics of the instruction-set file into these nodes; engines lower
them and know nothing else about an instruction. Statements run in order, each seeing what the
earlier ones wrote. Writes reach active NPs only; effects on the GCU ignore activity.

Nodes are never changed. Their classes are not frozen, and compare by identity: making two dozen
classes that check it would be a noticeable part of the start of every process.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Final, Literal


class Type(Enum):
    """Type of an expression."""

    CONST = "constant"  # a number known when a word is decoded
    NAME = "name"  # a choice known when a word is decoded, such as `north`
    BYTE = "byte"  # 8 bits in every NP
    BIT = "bit"  # one bit in every NP
    WIRE = "wire"  # one bit in the GCU: what the global OR answers


@dataclass(eq=False)
class Const:
    """A number written in the semantics."""

    value: int
    type: Type = Type.CONST


@dataclass(eq=False)
class Field:
    """The value of an operand field of the word: a number, an address or the name of a choice."""

    name: str
    type: Type = Type.CONST


@dataclass(eq=False)
class Register:
    """The register that operand `name` selects."""

    name: str
    type: Type = Type.BYTE


@dataclass(eq=False)
class Flag:
    """Flag ``Z`` or ``C`` of every NP."""

    name: Literal["Z", "C"]
    type: Type = Type.BIT


@dataclass(eq=False)
class Condition:
    """The condition that operand `name` selects, evaluated on the flags of every NP."""

    name: str
    type: Type = Type.BIT


@dataclass(eq=False)
class Local:
    """A name that an earlier statement of the same semantics has set."""

    name: str
    type: Type


@dataclass(eq=False)
class Place:
    """The NP's own ``row`` or ``column`` number."""

    axis: Literal["row", "column"]
    type: Type = Type.BYTE


ByteOp = Literal["+", "-", "&", "|", "^"]
ShiftOp = Literal["<<", ">>"]
CompareOp = Literal["==", "!=", "<", "<=", ">", ">="]
BitOp = Literal["and", "or"]


@dataclass(eq=False)
class Binary:
    """``left op right``: bytes modulo 256, unsigned comparison, or bits."""

    op: ByteOp | ShiftOp | CompareOp | BitOp
    left: Expr
    right: Expr
    type: Type


@dataclass(eq=False)
class Not:
    """The complement of a bit, or all eight complements of a byte."""

    value: Expr
    type: Type


@dataclass(eq=False)
class BitOf:
    """Bit number `index` (a constant, 0 the lowest) of a byte."""

    value: Expr
    index: Expr
    type: Type = Type.BIT


@dataclass(eq=False)
class Select:
    """`then` where the bit is set, else `otherwise`, NP by NP."""

    condition: Expr
    then: Expr
    otherwise: Expr
    type: Type


@dataclass(eq=False)
class Carry:
    """Bit 8 of left + right + carry."""

    left: Expr
    right: Expr
    carry: Expr | None
    type: Type = Type.BIT


@dataclass(eq=False)
class Borrow:
    """Whether left - right - borrow is negative."""

    left: Expr
    right: Expr
    borrow: Expr | None
    type: Type = Type.BIT


@dataclass(eq=False)
class ToByte:
    """A bit as the byte 0 or 1."""

    value: Expr
    type: Type = Type.BYTE


@dataclass(eq=False)
class Load:
    """Byte of the NP's memory; the address wraps at the end of the memory."""

    address: Expr
    type: Type = Type.BYTE


@dataclass(eq=False)
class Neighbour:
    """What the expression is in the NP to the north, east, south or west; 0 outside."""

    value: Expr
    direction: Field
    type: Type = Type.BYTE


@dataclass(eq=False)
class Input:
    """The byte that the link has delivered to the port."""

    port: Expr
    type: Type = Type.BYTE


@dataclass(eq=False)
class AnyOf:
    """The global OR: does any active NP have the bit set?"""

    value: Expr
    type: Type = Type.WIRE


@dataclass(eq=False)
class NotWire:
    """The complement of a wire."""

    value: Expr
    type: Type = Type.WIRE


Expr = (
    Const
    | Field
    | Register
    | Flag
    | Condition
    | Local
    | Place
    | Binary
    | Not
    | BitOf
    | Select
    | Carry
    | Borrow
    | ToByte
    | Load
    | Neighbour
    | Input
    | AnyOf
    | NotWire
)


@dataclass(eq=False)
class SetRegister:
    """Write a byte to the register that operand `name` selects."""

    name: str
    value: Expr


@dataclass(eq=False)
class SetFlag:
    """Write a flag."""

    name: Literal["Z", "C"]
    value: Expr


@dataclass(eq=False)
class SetLocal:
    """Name a value for the statements that follow."""

    name: str
    value: Expr


@dataclass(eq=False)
class Store:
    """Write a byte to the NP's memory; the address wraps at the end of the memory."""

    address: Expr
    value: Expr


EffectName = Literal[
    "jump",
    "call",
    "ret",
    "halt",
    "expose",
    "sample",
    "output",
    "mask_push",
    "mask_invert",
    "mask_pop",
]


@dataclass(eq=False)
class Effect:
    """What only the GCU or a device does.

    ``jump(target)``, ``call(target)``, ``ret()``, ``halt()``, ``expose()``,
    ``sample(level, bank)``, ``output(port, byte)``, ``mask_push(bit)``, ``mask_invert()``,
    ``mask_pop()``; with `guard`, only if that wire is set.
    """

    name: EffectName
    args: tuple[Expr, ...]
    guard: Expr | None = None


Statement = SetRegister | SetFlag | SetLocal | Store | Effect
Node = Statement | Expr


def children(node: Node) -> Iterator[Node]:
    """Yield what stands directly below a node."""
    for value in vars(node).values():
        for child in value if isinstance(value, tuple) else (value,):
            if isinstance(child, Node):
                yield child


def walk(node: Node) -> Iterator[Node]:
    """Yield the node and everything below it, parents first."""
    yield node
    for child in children(node):
        yield from walk(child)


def constant(node: Expr, values: Mapping[str, int | str]) -> int:
    """The number that a constant expression is in a decoded word.

    Args:
        node: of constants, operands and arithmetic on them.
        values: operands of the word by name.
    """
    match node:
        case Const(value=value):
            return value
        case Field(name=name):
            return int(values[name])
        case Binary(op=op, left=left, right=right):
            return _ARITHMETIC[op](constant(left, values), constant(right, values))
    raise AssertionError(node)


_ARITHMETIC: Final = {
    "+": int.__add__,
    "-": int.__sub__,
    "&": int.__and__,
    "|": int.__or__,
    "^": int.__xor__,
}
