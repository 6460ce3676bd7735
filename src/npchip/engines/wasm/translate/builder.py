"""Values of a block, simplified while they are made.

The simplifications are generic identities of 8-bit arithmetic; none of them knows an instruction.
"""

from __future__ import annotations

from collections.abc import Callable

from npchip.engines.wasm.translate.values import (
    CONSTANT,
    NUMBERS,
    UNIFORM,
    VARYING,
    Value,
    ValueNumbering,
)


class ValueBuilder(ValueNumbering):
    """Makes the values of one block at a time."""

    def __init__(self) -> None:
        super().__init__()
        self.false = NUMBERS[0]
        self.true = NUMBERS[1]
        self.ones = NUMBERS[255]

    # ---- leaves

    def constant(self, value: int) -> Value:
        """A byte, or a bit: 0 or 1."""
        return NUMBERS[value]

    def load(self, address: Value, version: int) -> Value:
        """The byte at an address, in the memory's state `version`."""
        return self._unary("load", address, version, VARYING)

    def neighbour(self, value: Value, direction: int) -> Value:
        """What the node is one NP away; 0 outside the array."""
        if value is self.false:
            return value
        node = self._unary("neighbour", value, direction, VARYING)
        node.crosses = True
        return node

    def any_of(self, bit: Value) -> Value:
        """The global OR of a bit, as a uniform bit."""
        if bit.kind != VARYING:
            return bit
        node = self._unary("any", bit, 0, UNIFORM)
        node.crosses = True
        return node

    # ---- bytes

    def add(self, a: Value, b: Value) -> Value:
        """Modulo 256."""
        if a.kind == CONSTANT:
            a, b = b, a
        if b.kind == CONSTANT:
            if a.kind == CONSTANT:
                return self.constant(a.value + b.value & 255)
            if b.value == 0:
                return a
            if a.op == "add" and a.args[1].kind == CONSTANT:  # (x + c) + d
                return self.add(a.args[0], self.constant(a.args[1].value + b.value & 255))
            return self._binary("add", a, b)
        for x, y in ((a, b), (b, a)):
            if x.op == "byte" and x.kind == VARYING:  # a mask is -1 where it is set
                return self.sub(y, self.mask(x.args[0]))
            if x.op == "sub" and x.args[0] is self.false:  # (0 - x) + y
                return self.sub(y, x.args[1])
            if x.op == "xor" and x.args[1] is self.ones:  # (-1 - x) + y
                return self.add(self.sub(y, x.args[0]), self.ones)
            if x.op == "add" and x.args[1].kind == CONSTANT:  # (x + c) + y
                return self.add(self.add(x.args[0], y), x.args[1])
        return self._binary("add", a, b)

    def sub(self, a: Value, b: Value) -> Value:
        """Modulo 256."""
        if b.kind == CONSTANT:
            return self.add(a, self.constant(-b.value & 255))
        if a is b:
            return self.false
        if b.op == "byte" and b.kind == VARYING:
            return self.add(a, self.mask(b.args[0]))
        if a is self.false and b.op == "mask":
            return self.byte(b.args[0])
        if b.op == "xor" and b.args[1] is self.ones:  # a - (-1 - x)
            return self.add(self.add(a, b.args[0]), self.true)
        if a.op == "add" and a.args[1].kind == CONSTANT:  # (x + c) - b
            return self.add(self.sub(a.args[0], b), a.args[1])
        if b.op == "add" and b.args[1].kind == CONSTANT:  # a - (x + c)
            return self.sub(self.sub(a, b.args[0]), b.args[1])
        return self._binary("sub", a, b)

    def and_(self, a: Value, b: Value) -> Value:
        """Of bytes."""
        if a.kind == CONSTANT:
            a, b = b, a
        if a is b:
            return a
        if b.kind == CONSTANT:
            if a.kind == CONSTANT:
                return self.constant(a.value & b.value)
            if b.value == 0:
                return b
            if b.value == 255:
                return a
            if a.op == "and" and a.args[1].kind == CONSTANT:
                return self.and_(a.args[0], self.constant(a.args[1].value & b.value))
        return a if a.op == "and" and a.args[1] is b else self._binary("and", a, b)

    def or_(self, a: Value, b: Value) -> Value:
        """Of bytes."""
        if a.kind == CONSTANT:
            a, b = b, a
        if a is b:
            return a
        if b.kind == CONSTANT:
            if a.kind == CONSTANT:
                return self.constant(a.value | b.value)
            if b.value == 0:
                return a
            if b.value == 255:
                return b
        return self._binary("or", a, b)

    def xor(self, a: Value, b: Value) -> Value:
        """Of bytes."""
        if a.kind == CONSTANT:
            a, b = b, a
        if a is b:
            return self.false
        if b.kind == CONSTANT:
            if a.kind == CONSTANT:
                return self.constant(a.value ^ b.value)
            if b.value == 0:
                return a
            if a.op == "xor" and a.args[1].kind == CONSTANT:
                return self.xor(a.args[0], self.constant(a.args[1].value ^ b.value))
        return self._binary("xor", a, b)

    def invert(self, a: Value) -> Value:
        """All eight complements."""
        return self.xor(a, self.ones)

    def shift_left(self, a: Value, count: int) -> Value:
        """By a count modulo 256; zeros come in."""
        count &= 255
        if count == 0:
            return a
        if count > 7:
            return self.false
        if a.kind == CONSTANT:
            return self.constant(a.value << count & 255)
        return self._unary("shl", a, count)

    def shift_right(self, a: Value, count: int) -> Value:
        """By a count modulo 256; zeros come in."""
        count &= 255
        if count == 0:
            return a
        if count > 7:
            return self.false
        if a.kind == CONSTANT:
            return self.constant(a.value >> count)
        return self._unary("shr", a, count)

    def byte(self, bit: Value) -> Value:
        """A bit as 0 or 1."""
        if bit.kind == CONSTANT:
            return bit
        if bit.op == "not" and bit.kind == VARYING:
            return self.add(self.mask(bit.args[0]), self.true)
        return self._unary("byte", bit)

    def mask(self, bit: Value) -> Value:
        """A bit as 0 or 255."""
        if bit.kind == CONSTANT:
            return self.constant(255 * bit.value)
        if bit.op == "not" and bit.kind == VARYING:
            return self.invert(self.mask(bit.args[0]))
        return self._unary("mask", bit)

    def select(self, bit: Value, a: Value, b: Value) -> Value:
        """`a` where the bit is set, else `b`: bytes."""
        if bit.kind == CONSTANT:
            return a if bit.value else b
        if a is b:
            return a
        if bit.op == "not":
            return self.select(bit.args[0], b, a)
        if b.op == "select" and b.args[0] is bit:  # what `b` is where the bit is set is lost
            return self.select(bit, a, b.args[2])
        if b.op == "and" and b.args[1] is self.mask(self.not_(bit)):
            return self.select(bit, a, b.args[0])
        if b is self.false and bit.op == "ge" and a.op == "sub" and a.args == bit.args:
            return (
                self._binary("sub_sat", *bit.args)
                if a.kind == VARYING
                else (self._choose(bit, a, b))
            )
        if a is self.false:
            return self.and_(b, self.mask(self.not_(bit)))
        if b is self.false:
            return self.and_(a, self.mask(bit))
        return self._choose(bit, a, b)

    # ---- bits

    def not_(self, a: Value) -> Value:
        """Of a bit."""
        if a.kind == CONSTANT:
            return self.constant(1 - a.value)
        return a.args[0] if a.op == "not" else self._unary("not", a)

    def both(self, a: Value, b: Value) -> Value:
        """Both of two bits."""
        if a.kind == CONSTANT:
            return b if a.value else a
        if b.kind == CONSTANT:
            return a if b.value else b
        return a if a is b else self._binary("both", a, b)

    def either(self, a: Value, b: Value) -> Value:
        """One or both of two bits."""
        if a.kind == CONSTANT:
            return a if a.value else b
        if b.kind == CONSTANT:
            return b if b.value else a
        return a if a is b else self._binary("either", a, b)

    def select_bit(self, bit: Value, a: Value, b: Value) -> Value:
        """`a` where `bit` is set, else `b`: bits."""
        if bit.kind == CONSTANT:
            return a if bit.value else b
        if a is b:
            return a
        if a.kind == CONSTANT:
            return self.either(bit, b) if a.value else self.both(self.not_(bit), b)
        if b.kind == CONSTANT:
            return self.either(self.not_(bit), a) if b.value else self.both(bit, a)
        if b.op == "select" and b.args[0] is bit:
            return self.select_bit(bit, a, b.args[2])
        if bit.kind == VARYING:
            return self._choose(bit, a, b)
        return self.either(self.both(bit, a), self.both(self.not_(bit), b))

    def equal(self, a: Value, b: Value) -> Value:
        """Of bytes, as a bit."""
        if a.kind == CONSTANT:
            a, b = b, a
        if a is b:
            return self.true
        if b.kind == CONSTANT:
            if a.kind == CONSTANT:
                return self.constant(int(a.value == b.value))
            if a.op == "mask" and b.value in {0, 255}:
                return a.args[0] if b.value else self.not_(a.args[0])
            if a.op == "byte" and b.value in {0, 1}:
                return a.args[0] if b.value else self.not_(a.args[0])
            if a.op == "add" and a.args[1].kind == CONSTANT:  # x + c == d
                return self.equal(a.args[0], self.constant(b.value - a.args[1].value & 255))
            if a.op == "sub" and b.value == 0:
                return self.equal(*a.args)
            if a.op == "xor" and a.args[1].kind == CONSTANT:
                return self.equal(a.args[0], self.constant(b.value ^ a.args[1].value))
        return self._binary("eq", a, b)

    def lower(self, a: Value, b: Value) -> Value:
        """Whether a < b, unsigned, as a bit."""
        if a is b:
            return self.false
        if a.kind == CONSTANT and b.kind == CONSTANT:
            return self.constant(int(a.value < b.value))
        if b.kind == CONSTANT:
            if b.value == 0:
                return self.false
            if b.value == 128:
                return self.not_(self.bit(a, 7))
        if a.kind == CONSTANT:
            if a.value == 255:
                return self.false
            if a.value == 0:
                return self.not_(self.equal(b, a))
            if a.value == 127:
                return self.bit(b, 7)
        # SSE knows no unsigned "lower", but "a is the greater of a and b" takes two instructions.
        return self.not_(self._binary("ge", a, b))

    def bit(self, a: Value, index: int) -> Value:
        """Bit number `index` of a byte."""
        index &= 7
        if a.kind == CONSTANT:
            return self.constant(a.value >> index & 1)
        if a.op == "mask":
            return a.args[0]
        return self._unary("bit", a, index)

    def carry(self, a: Value, b: Value, extra: Value | None = None) -> Value:
        """Bit 8 of a + b + extra."""
        if a is b:  # whatever comes in from the right, the highest bit goes out
            return self.bit(a, 7)
        if a.kind == CONSTANT:
            a, b = b, a
        if b.kind == CONSTANT:  # a + b > 255 where a > 255 - b
            over = self.lower(self.constant(255 - b.value), a)
        else:
            over = self.lower(self.add(a, b), b)
        if extra is None or extra is self.false:
            return over
        full = self.equal(self.add(a, b), self.constant(255))
        return self.either(over, self.both(extra, full))

    def borrow(self, a: Value, b: Value, extra: Value | None = None) -> Value:
        """Whether a - b - extra is negative."""
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
            "row": lambda: self.place("row"),
            "column": lambda: self.place("column"),
        }
