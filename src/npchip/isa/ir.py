"""The typed intermediate form of an instruction's meaning.

The loader translates the semantics of the instruction-set file into these nodes; engines evaluate
them and know nothing else about an instruction. Statements run in order, and each sees the writes
of the earlier ones. Only active NPs write; effects on the GCU ignore activity.

An `Evaluator` computes expressions in any domain: NumPy closures in the reference engine, numbered
values in the compiled engine, known bits in the analyses.

Nodes are immutable and compare by identity. Their classes are not frozen because frozen
dataclasses slow down the start of every process.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from operator import add, and_, or_, sub, xor
from typing import Any, Final, Generic, Literal, NamedTuple, TypeVar

T = TypeVar("T")

REGISTERS: Final = 16
"""Registers of an NP (decision: a 4-bit register field)."""
ZERO: Final = REGISTERS
CARRY: Final = REGISTERS + 1
FLAGS: Final = {"Z": ZERO, "C": CARRY}
"""Variables are numbered: the registers, then the flags."""


class Type(Enum):
    """Type of an expression."""

    CONST = "constant"  # a number fixed by the word
    NAME = "name"  # a choice fixed by the word, such as `north`
    BYTE = "byte"  # 8 bits in every NP
    BIT = "bit"  # one bit in every NP
    WIRE = "wire"  # one bit in the GCU: the result of a global OR


# ---- constants


@dataclass(eq=False)
class Const:
    """A number written in the semantics."""

    value: int
    type: Type = Type.CONST

    def evaluate(self, _by: Evaluator[Any]) -> Any:
        """Return the number."""
        return self.value


@dataclass(eq=False)
class Field:
    """An operand of the word: a number, an address or the name of a choice."""

    name: str
    type: Type = Type.CONST

    def evaluate(self, by: Evaluator[Any]) -> Any:
        """Return the number or the name."""
        return by.fields[self.name]


@dataclass(eq=False)
class Arithmetic:
    """Arithmetic on constants."""

    op: Literal["+", "-", "&", "|", "^"]
    left: Expr
    right: Expr
    type: Type = Type.CONST

    def evaluate(self, by: Evaluator[Any]) -> Any:
        """Return the result as an int."""
        return constant(self, by.fields)


# ---- bytes, bits and wires


@dataclass(eq=False)
class Immediate:
    """A constant, modulo 256, as a byte in every NP."""

    value: Expr
    type: Type = Type.BYTE

    def evaluate(self, by: Evaluator[T]) -> T:
        """Return the byte."""
        return by.number(constant(self.value, by.fields) & 255)


@dataclass(eq=False)
class Register:
    """The register that operand `name` selects."""

    name: str
    type: Type = Type.BYTE

    def evaluate(self, by: Evaluator[T]) -> T:
        """Return the value of the register."""
        return by.read(by.fields[self.name])


@dataclass(eq=False)
class Flag:
    """Flag ``Z`` or ``C`` of every NP."""

    name: Literal["Z", "C"]
    type: Type = Type.BIT

    def evaluate(self, by: Evaluator[T]) -> T:
        """Return the value of the flag."""
        return by.read(FLAGS[self.name])


@dataclass(eq=False)
class Condition:
    """The condition that operand `name` selects, on the flags of every NP."""

    name: str
    type: Type = Type.BIT

    def evaluate(self, by: Evaluator[T]) -> T:
        """Return the value of the condition."""
        return by.meanings[by.fields[self.name]].evaluate(by)


@dataclass(eq=False)
class Local:
    """A local variable that an earlier statement of the semantics has set."""

    name: str
    type: Type

    def evaluate(self, by: Evaluator[T]) -> T:
        """Return the value of the variable."""
        return by.locals[self.name]


@dataclass(eq=False)
class Operation:
    """An operation of `OPERATIONS` on other expressions."""

    op: str
    args: tuple[Expr, ...]

    @property
    def type(self) -> Type:
        """The type of the result."""
        return OPERATIONS[self.op].type

    def evaluate(self, by: Evaluator[T]) -> T:
        """Return the result."""
        return by.operation(self)


class Signature(NamedTuple):
    """The types of an operation.

    Attributes:
        args: types of the arguments.
        type: type of the result.
        optional: number of trailing arguments that may be missing.
        pure: whether the result in an NP depends only on the NP's arguments: not on the memory,
            the link or other NPs.
    """

    args: tuple[Type, ...]
    type: Type
    optional: int = 0
    pure: bool = True


_BYTES: Final = (Type.BYTE, Type.BYTE)
_BITS: Final = (Type.BIT, Type.BIT)
FUNCTIONS: Final[dict[str, Signature]] = {
    # The global OR: is the bit set in any active NP?
    "any": Signature((Type.BIT,), Type.WIRE, pure=False),
    "byte": Signature((Type.BIT,), Type.BYTE),  # the byte 0 or 1
    "carry": Signature((*_BYTES, Type.BIT), Type.BIT, 1),  # bit 8 of a + b + c
    "borrow": Signature((*_BYTES, Type.BIT), Type.BIT, 1),  # is a - b - c negative?
    # The byte in the NP to the north, east, south or west; 0 outside the array.
    "neighbour": Signature((Type.BYTE, Type.NAME), Type.BYTE, pure=False),
    # The byte that the link has delivered to a port.
    "input": Signature((Type.CONST,), Type.BYTE, pure=False),
}
"""Operations that a semantics calls by name."""
OPERATIONS: Final[dict[str, Signature]] = {
    **dict.fromkeys(("+", "-", "&", "|", "^"), Signature(_BYTES, Type.BYTE)),  # modulo 256
    **dict.fromkeys(("<<", ">>"), Signature((Type.BYTE, Type.CONST), Type.BYTE)),
    # Unsigned comparisons.
    **dict.fromkeys(("==", "!=", "<", "<=", ">", ">="), Signature(_BYTES, Type.BIT)),
    **dict.fromkeys(("and", "or"), Signature(_BITS, Type.BIT)),
    "not": Signature((Type.BIT,), Type.BIT),
    "~": Signature((Type.BYTE,), Type.BYTE),
    "not_wire": Signature((Type.WIRE,), Type.WIRE),
    "bit": Signature((Type.BYTE, Type.CONST), Type.BIT),  # 0 is the lowest
    # In each NP the second where the first is set, else the third.
    "select": Signature((Type.BIT, *_BYTES), Type.BYTE),
    "select_bit": Signature((Type.BIT, *_BITS), Type.BIT),
    "row": Signature((), Type.BYTE),  # the NP's own number
    "column": Signature((), Type.BYTE),
    # A byte of the memory; the address wraps.
    "load": Signature((Type.BYTE,), Type.BYTE, pure=False),
    **FUNCTIONS,
}

Expr = Const | Field | Arithmetic | Immediate | Register | Flag | Condition | Local | Operation


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
    """Set a local variable for the statements that follow."""

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
    """An action of the GCU or of a device.

    ``jump(target)``, ``call(target)``, ``ret()``, ``halt()``, ``expose()``,
    ``sample(level, bank)``, ``output(port, byte)``, ``mask_push(bit)``, ``mask_invert()``,
    ``mask_pop()``. With `guard`, it happens only if that wire is set.
    """

    name: EffectName
    args: tuple[Expr, ...]
    guard: Expr | None = None


Statement = SetRegister | SetFlag | SetLocal | Store | Effect
Node = Statement | Expr


def children(node: Node) -> Iterator[Node]:
    """Yield the nodes directly below a node of any kind."""
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
    """Return the value of a constant expression in a decoded word.

    Args:
        node: numbers, operands and arithmetic on them.
        values: operands of the word by name.
    """
    match node:
        case Const(value=value):
            return value
        case Field(name=name):
            return int(values[name])
        case Arithmetic(op=op, left=left, right=right):
            result: int = _ARITHMETIC[op](constant(left, values), constant(right, values))
            return result
    raise AssertionError(node)


_ARITHMETIC: Final = {"+": add, "-": sub, "&": and_, "|": or_, "^": xor}


class Evaluator(Generic[T]):
    """Evaluates the expressions of decoded words in a domain.

    Constants are folded, and operands and conditions are looked up, before anything reaches the
    domain.

    Attributes:
        fields: operands of the current word, by name.
        locals: values of the local variables, by name.
        meanings: expressions of the conditions, by name.
        number: returns a byte that is the same in every NP.
        read: returns the value of a variable.
        operations: functions by the names of `OPERATIONS`. They take the evaluated arguments; a
            constant is an int or a str.
    """

    fields: Mapping[str, Any]
    locals: dict[str, T]
    number: Callable[[int], T]
    read: Callable[[int], T]
    operations: Mapping[str, Callable[..., T]]

    def __init__(self, meanings: Mapping[str, Expr]) -> None:
        self.meanings = meanings

    def operation(self, node: Operation) -> T:
        """Return the result of an operation."""
        return self.operations[node.op](*[arg.evaluate(self) for arg in node.args])


def same_register(node: Operation, values: Mapping[str, int | str]) -> bool:
    """Return whether the first two arguments of an operation are the same register."""
    match node.args:
        case (Register(name=left), Register(name=right), *_):
            return values[left] == values[right]
    return False
