"""Makes the values of a block, simplified by identities of 8-bit arithmetic."""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Final

from npchip.engines.wasm.translate.values import (
    CONSTANT,
    NUMBERS,
    UNIFORM,
    VARYING,
    Value,
    ValueNumbering,
)

_BITWISE: Final = {"and": operator.and_, "or": operator.or_, "xor": operator.xor}
_BITS_AS_BYTES = frozenset({("mask", 0), ("mask", 255), ("byte", 0), ("byte", 1)})


class ValueBuilder(ValueNumbering):
    """Makes the values of one block at a time."""

    def __init__(self) -> None:
        super().__init__()
        self.false = NUMBERS[0]
        self.true = NUMBERS[1]
        self.ones = NUMBERS[255]

    # ---- leaves

    def constant(self, value: int) -> Value:
        """Return a byte, or a bit: 0 or 1."""
        return NUMBERS[value]

    def load(self, address: Value, version: int) -> Value:
        """Return the byte at an address, in the memory's state `version`."""
        return self._value("load", address, number=version, kind=VARYING)

    def neighbour(self, value: Value, direction: int) -> Value:
        """Return the neighbours' values; 0 outside the array."""
        if value is self.false:
            return value
        found = self._value("neighbour", value, number=direction, kind=VARYING)
        found.crosses = value.crosses + 1
        return found

    def any_of(self, bit: Value) -> Value:
        """Return the global OR of a bit, as a uniform bit."""
        if bit.kind != VARYING:
            return bit
        value = self._value("any", bit, kind=UNIFORM)
        value.crosses = bit.crosses + 1
        return value

    # ---- bytes

    def add(self, a: Value, b: Value) -> Value:
        """Add modulo 256."""
        if a.kind == CONSTANT:
            a, b = b, a
        if b.kind == CONSTANT:
            if a.kind == CONSTANT:
                return self.constant(a.number + b.number & 255)
            if b.number == 0:
                return a
            if a.op == "add" and a.args[1].kind == CONSTANT:  # (x + c) + d
                return self.add(a.args[0], self.constant(a.args[1].number + b.number & 255))
            return self._value("add", a, b)
        for x, y in ((a, b), (b, a)):
            if x.op == "byte" and x.kind == VARYING:  # a mask is -1 where it is set
                return self.sub(y, self.mask(x.args[0]))
            if x.op == "sub" and x.args[0] is self.false:  # (0 - x) + y
                return self.sub(y, x.args[1])
            if x.op == "add" and x.args[1].kind == CONSTANT:  # (x + c) + y
                return self.add(self.add(x.args[0], y), x.args[1])
        return self._value("add", a, b)

    def sub(self, a: Value, b: Value) -> Value:
        """Subtract modulo 256."""
        if b.kind == CONSTANT:
            return self.add(a, self.constant(-b.number & 255))
        if a is b:
            return self.false
        if b.op == "byte" and b.kind == VARYING:
            return self.add(a, self.mask(b.args[0]))
        if a is self.false and b.op == "mask":
            return self.byte(b.args[0])
        if a.op == "add" and a.args[1].kind == CONSTANT:  # (x + c) - b
            return self.add(self.sub(a.args[0], b), a.args[1])
        if b.op == "add" and b.args[1].kind == CONSTANT:  # a - (x + c)
            return self.sub(self.sub(a, b.args[0]), b.args[1])
        return self._value("sub", a, b)

    def and_(self, a: Value, b: Value) -> Value:
        """Return the bitwise AND of two bytes."""
        if a is b or (a.op == "and" and a.args[1] is b):
            return a
        return self._bitwise("and", a, b, unit=255, zero=0)

    def or_(self, a: Value, b: Value) -> Value:
        """Return the bitwise OR of two bytes."""
        return a if a is b else self._bitwise("or", a, b, unit=0, zero=255)

    def xor(self, a: Value, b: Value) -> Value:
        """Return the bitwise XOR of two bytes."""
        return self.false if a is b else self._bitwise("xor", a, b, unit=0)

    def _bitwise(self, op: str, a: Value, b: Value, *, unit: int, zero: int = -1) -> Value:
        """Operate on two bytes, of which `unit` keeps the other one, and `zero` gives itself."""
        if a.kind == CONSTANT:
            a, b = b, a
        if b.kind == CONSTANT:
            if a.kind == CONSTANT:
                return self.constant(_BITWISE[op](a.number, b.number))
            if b.number in (unit, zero):
                return a if b.number == unit else b
        return self._value(op, a, b)

    def invert(self, a: Value) -> Value:
        """Complement all bits of a byte."""
        return self.xor(a, self.ones)

    def shift_left(self, a: Value, count: int) -> Value:
        """Shift by a count modulo 256; zeros come in."""
        return self._shift("shl", a, count & 255)

    def shift_right(self, a: Value, count: int) -> Value:
        """Shift by a count modulo 256; zeros come in."""
        return self._shift("shr", a, count & 255)

    def _shift(self, op: str, a: Value, count: int) -> Value:
        if count > 7:
            return self.false
        if a.kind == CONSTANT:
            return self.constant(a.number << count & 255 if op == "shl" else a.number >> count)
        return self._value(op, a, number=count)

    def byte(self, bit: Value) -> Value:
        """Return a bit as the byte 0 or 1."""
        if bit.kind == CONSTANT:
            return bit
        if bit.op == "not" and bit.kind == VARYING:
            return self.add(self.mask(bit.args[0]), self.true)
        return self._value("byte", bit)

    def mask(self, bit: Value) -> Value:
        """Return a bit as the byte 0 or 255."""
        if bit.kind == CONSTANT:
            return self.constant(255 * bit.number)
        if bit.op == "not" and bit.kind == VARYING:
            return self.invert(self.mask(bit.args[0]))
        return self._value("mask", bit)

    def select(self, bit: Value, a: Value, b: Value) -> Value:
        """Return byte `a` where a bit is set, else byte `b`."""
        if bit.kind == CONSTANT:
            return a if bit.number else b
        if a is b:
            return a
        if bit.op == "not":
            return self.select(bit.args[0], b, a)
        if b.op == "select" and b.args[0] is bit:  # `b` is not used where the bit is set
            return self.select(bit, a, b.args[2])
        if b.op == "and" and b.args[1] is self.mask(self.not_(bit)):
            return self.select(bit, a, b.args[0])
        if b is self.false and bit.op == "ge" and a.op == "sub" and a.args == bit.args:
            if a.kind == VARYING:
                return self._value("sub_sat", *bit.args)
            return self._value("select", bit, a, b)
        if a is self.false:
            return self.and_(b, self.mask(self.not_(bit)))
        if b is self.false:
            return self.and_(a, self.mask(bit))
        return self._value("select", bit, a, b)

    # ---- bits

    def not_(self, a: Value) -> Value:
        """Invert a bit."""
        if a.kind == CONSTANT:
            return self.constant(1 - a.number)
        return a.args[0] if a.op == "not" else self._value("not", a)

    def both(self, a: Value, b: Value) -> Value:
        """Return the conjunction of two bits."""
        for one, other in ((a, b), (b, a)):
            if one.kind == CONSTANT:
                return other if one.number else one
        return a if a is b else self._value("both", a, b)

    def either(self, a: Value, b: Value) -> Value:
        """Return the disjunction of two bits."""
        for one, other in ((a, b), (b, a)):
            if one.kind == CONSTANT:
                return one if one.number else other
        return a if a is b else self._value("either", a, b)

    def select_bit(self, bit: Value, a: Value, b: Value) -> Value:
        """Return bit `a` where `bit` is set, else bit `b`."""
        if bit.kind == CONSTANT:
            return a if bit.number else b
        if a is b:
            return a
        if a.kind == CONSTANT:
            return self.either(bit, b) if a.number else self.both(self.not_(bit), b)
        if b.kind == CONSTANT:
            return self.either(self.not_(bit), a) if b.number else self.both(bit, a)
        if bit.kind == VARYING:
            return self._value("select", bit, a, b)
        return self.either(self.both(bit, a), self.both(self.not_(bit), b))

    def equal(self, a: Value, b: Value) -> Value:
        """Return whether two bytes are equal, as a bit."""
        if a.kind == CONSTANT:
            a, b = b, a
        if a is b:
            return self.true
        if b.kind == CONSTANT:
            if a.kind == CONSTANT:
                return self.constant(int(a.number == b.number))
            if (a.op, b.number) in _BITS_AS_BYTES:
                return a.args[0] if b.number else self.not_(a.args[0])
            if a.op == "add" and a.args[1].kind == CONSTANT:  # x + c == d
                return self.equal(a.args[0], self.constant(b.number - a.args[1].number & 255))
            if a.op == "sub" and b.number == 0:
                return self.equal(*a.args)
        return self._value("eq", a, b)

    def lower(self, a: Value, b: Value) -> Value:
        """Return whether a < b, unsigned, as a bit."""
        if a is b:
            return self.false
        if a.kind == CONSTANT and b.kind == CONSTANT:
            return self.constant(int(a.number < b.number))
        if b.kind == CONSTANT:
            if b.number == 0:
                return self.false
            if b.number == 128:
                return self.not_(self.bit(a, 7))
        if a.kind == CONSTANT:
            if a.number == 255:
                return self.false
            if a.number == 0:
                return self.not_(self.equal(b, a))
            if a.number == 127:
                return self.bit(b, 7)
        # SSE has no unsigned "less than", but max(a, b) == a takes two instructions.
        return self.not_(self._value("ge", a, b))

    def bit(self, a: Value, index: int) -> Value:
        """Return bit `index` modulo 8 of a byte."""
        index &= 7
        if a.kind == CONSTANT:
            return self.constant(a.number >> index & 1)
        return self._value("bit", a, number=index)

    def carry(self, a: Value, b: Value, extra: Value | None = None) -> Value:
        """Return bit 8 of a + b + extra."""
        if a is b:  # the carry in does not matter: bit 7 goes out
            return self.bit(a, 7)
        if a.kind == CONSTANT:
            a, b = b, a
        if b.kind == CONSTANT:  # a + b > 255 where a > 255 - b
            over = self.lower(self.constant(255 - b.number), a)
        else:
            over = self.lower(self.add(a, b), b)
        if extra is None or extra is self.false:
            return over
        full = self.equal(self.add(a, b), self.constant(255))
        return self.either(over, self.both(extra, full))

    def borrow(self, a: Value, b: Value, extra: Value | None = None) -> Value:
        """Return whether a - b - extra is negative, as a bit."""
        under = self.lower(a, b)
        if extra is None or extra is self.false:
            return under
        return self.either(under, self.both(extra, self.equal(a, b)))

    # ---- by the names of the intermediate form

    def operations(self) -> dict[str, Callable[..., Value]]:
        """Return the operations by their names in `npchip.isa.ir.OPERATIONS`."""
        return {
            "+": self.add,
            "-": self.sub,
            "&": self.and_,
            "|": self.or_,
            "^": self.xor,
            "<<": self.shift_left,
            ">>": self.shift_right,
            "~": self.invert,
            "==": self.equal,
            "!=": lambda a, b: self.not_(self.equal(a, b)),
            "<": self.lower,
            ">": lambda a, b: self.lower(b, a),
            ">=": lambda a, b: self.not_(self.lower(a, b)),
            "<=": lambda a, b: self.not_(self.lower(b, a)),
            "and": self.both,
            "or": self.either,
            "not": self.not_,
            "not_wire": self.not_,
            "bit": self.bit,
            "byte": self.byte,
            "select": self.select,
            "select_bit": self.select_bit,
            "carry": self.carry,
            "borrow": self.borrow,
            "row": lambda: self.plane("row"),
            "column": lambda: self.plane("column"),
        }
