"""The values that a block computes, numbered: equal values are one object (value numbering).

A value is *constant*, *uniform* (one number for all NPs) or *varying* (a number for each NP). A bit
is a value too: a uniform bit is 0 or 1, a varying one is 0 or 255 in each lane.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

CONSTANT: Final = 0
UNIFORM: Final = 1
VARYING: Final = 2
_LONGEST_CHAIN: Final = 9
"""Levels after which a value is computed at once, so that the emitter's recursion stays shallow and
Cranelift gets no long chains."""


@dataclass(eq=False, slots=True)
class Value:
    """A value.

    Attributes:
        op: its operation.
        args: operands.
        number: a number that belongs to the operation, such as a constant, a leaf's variable, or
            the distance of a shift.
        kind: constant, uniform or varying.
        deps: bits of the variables that it depends on, as they are when the block begins.
        level: length of the longest chain of operations below it.
        crosses: how often it needs values of other NPs, at most 2; cleared when these are computed.
        order: number of values that the block had made before.
        uses: number of references from needed code; set by the emitter.
        temp: local of a uniform value, or slot of a varying one (see `LoopRecorder`); -1 for none.
            Set by the emitter.
    """

    op: str
    args: tuple[Value, ...]
    number: int
    kind: int
    deps: int = 0
    level: int = 0
    crosses: int = 0
    order: int = 0
    uses: int = 0
    temp: int = -1


NUMBERS: Final = [Value("const", (), number, CONSTANT) for number in range(256)]
"""The constants, which all blocks share."""


def split(address: Value) -> tuple[Value, int]:
    """Split an address into a base and the constant that is added to it."""
    if address.op == "add" and address.args[1].kind == CONSTANT:
        return address.args[0], address.args[1].number
    return address, 0


class ValueNumbering:
    """Makes the values of a block, each one once.

    Attributes:
        deep: values that end a long chain, in the order they were made. The caller removes them,
            and must have them computed at that point.
    """

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Begin another block."""
        self._made: dict[tuple[object, ...], Value] = {}
        self.deep: list[Value] = []

    def leaf(self, variable: int, kind: int) -> Value:
        """Return the value of a variable at the beginning of the block."""
        value = self._value("leaf", number=variable, kind=kind)
        value.deps = 1 << variable
        return value

    def plane(self, op: str) -> Value:
        """Return a plane of bytes: ``row`` or ``column`` numbers, or ``received`` from a port."""
        return self._value(op, kind=VARYING)

    def _value(self, op: str, *args: Value, number: int = 0, kind: int = -1) -> Value:
        """Return the value of an operation. By default it varies if an operand varies."""
        key = (op, args, number)
        value = self._made.get(key)
        if value is not None:
            return value
        widest, deps, level, crosses = CONSTANT, 0, 0, 0
        for arg in args:
            deps |= arg.deps
            crosses += arg.crosses
            if arg.kind > widest:  # noqa: PLR1730 - `max` would take twice as long
                widest = arg.kind
            if arg.level >= level:
                level = arg.level + 1
        kind = widest if kind < 0 else kind
        value = Value(op, args, number, kind, deps, level, min(crosses, 2), len(self._made))
        self._made[key] = value
        if level > _LONGEST_CHAIN:
            value.level = 0
            self.deep.append(value)
        return value
