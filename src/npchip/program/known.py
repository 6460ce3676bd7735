"""What an instruction does to what is known of registers and flags.

Knowledge is of all NPs that are active in the innermost masked region, and, apart, of those in
each region around it: what is written under a mask holds inside, and behind its end only where
it agrees with what was there before.
"""

from __future__ import annotations

from typing import Final

from npchip.isa import Decoded, Isa, ir
from npchip.isa.ir import Type
from npchip.program import bits
from npchip.program.bits import UNKNOWN, Bits

ZERO: Final = 16
CARRY: Final = 17
VARIABLES: Final = 18
FLOW: Final[tuple[ir.EffectName, ...]] = ("jump", "call", "ret", "halt")
"""Effects that say where the program goes on."""

Knowledge = dict[tuple[int, int], Bits]
"""By variable (a register, or a flag) and number of open regions; what is missing is unknown."""


def after_reset() -> Knowledge:
    """All state starts at 0."""
    known: Knowledge = {(number, 0): bits.constant(0) for number in range(ZERO)}
    return known | {(flag, 0): bits.ZERO_BIT for flag in (ZERO, CARRY)}


def meet(a: Knowledge, b: Knowledge) -> Knowledge:
    """What holds on both ways."""
    found: Knowledge = {}
    for key, value in a.items():
        other = b.get(key)
        if other is not None:
            joined = value if value == other else bits.join(value, other)
            if joined[0]:
                found[key] = joined
    return found


class Transfer:
    """Executes one decoded word on knowledge.

    Args:
        decoded: the word.
        isa: for the meaning of conditions.
    """

    def __init__(self, decoded: Decoded, isa: Isa) -> None:
        self.decoded = decoded
        self.isa = isa
        self._locals: dict[str, Bits] = {}

    def apply(self, before: Knowledge, depth: int) -> tuple[Knowledge, bool | None]:
        """What is known afterwards, and the wire that guards a branch; None if unknown.

        Args:
            before: what is known before.
            depth: masked regions open before.
        """
        self._known = dict(before)
        self._depth = depth
        self._locals.clear()
        wire: bool | None = True
        for statement in self.decoded.form.statements:
            match statement:
                case ir.SetRegister(name=name, value=value):
                    self._write(self._number(name), self._byte(value))
                case ir.SetFlag(name=name, value=value):
                    self._write(ZERO if name == "Z" else CARRY, self._expr(value))
                case ir.SetLocal(name=name, value=value):
                    self._locals[name] = self._byte(value)
                case ir.Effect(name=name, guard=guard):
                    if guard is not None and name in FLOW:
                        wire = bits.truth(self._expr(guard))
                    self._effect(name)
                case ir.Store():
                    pass
        return self._known, wire

    def _effect(self, name: ir.EffectName) -> None:
        known, depth = self._known, self._depth
        match name:
            case "mask_push":
                for number in range(VARIABLES):
                    if (number, depth) in known:
                        known[number, depth + 1] = known[number, depth]
                self._depth += 1
            case "mask_invert" | "mask_pop":
                for number in range(VARIABLES):
                    known.pop((number, depth), None)
                    if name == "mask_invert" and (number, depth - 1) in known:
                        known[number, depth] = known[number, depth - 1]
                self._depth -= name == "mask_pop"

    def _write(self, variable: int, value: Bits) -> None:
        known = self._known
        for level in range(self._depth):
            old = known.get((variable, level))
            if old is not None and old != value:
                known[variable, level] = bits.join(old, value)
        known[variable, self._depth] = value

    def _number(self, name: str) -> int:
        return int(self.decoded.values[name])

    def _read(self, variable: int) -> Bits:
        return self._known.get((variable, self._depth), UNKNOWN)

    def _byte(self, node: ir.Expr) -> Bits:
        if node.type is Type.CONST:
            return bits.constant(ir.constant(node, self.decoded.values))
        return self._expr(node)

    def _expr(self, node: ir.Expr) -> Bits:
        match node:
            case ir.Const() | ir.Field():
                return self._byte(node)
            case ir.Register(name=name):
                return self._read(self._number(name))
            case ir.Flag(name=name):
                return self._read(ZERO if name == "Z" else CARRY)
            case ir.Local(name=name):
                return self._locals[name]
            case ir.Condition(name=name):
                return self._expr(self.isa.conditions[str(self.decoded.values[name])].when)
            case ir.Binary():
                return self._binary(node)
            case ir.Not(value=value, type=kind):
                return bits.complement(self._byte(value), 1 if kind is Type.BIT else 255)
            case ir.NotWire(value=value):
                return bits.complement(self._expr(value), 1)
            case ir.BitOf(value=value, index=index):
                number = ir.constant(index, self.decoded.values) & 7
                known, found = self._byte(value)
                return known >> number & 1, found >> number & 1
            case ir.Select(condition=condition, then=then, otherwise=otherwise):
                chosen = bits.truth(self._expr(condition))
                if chosen is not None:
                    return self._byte(then if chosen else otherwise)
                return bits.join(self._byte(then), self._byte(otherwise))
            case ir.Carry(left=left, right=right, carry=extra):
                if self._same(left, right):
                    known, found = self._byte(left)
                    return known >> 7, found >> 7
                return bits.add(self._byte(left), self._byte(right), self._optional(extra))[1]
            case ir.Borrow(left=left, right=right, borrow=extra):
                if self._same(left, right):
                    return self._optional(extra)
                return bits.subtract(self._byte(left), self._byte(right), self._optional(extra))[1]
            case ir.ToByte(value=value):
                known, found = self._expr(value)
                return 254 | known, found
            case ir.Neighbour(value=value):  # of any NP, active or not; 0 outside
                depth, self._depth = self._depth, 0
                found_there = self._byte(value)
                self._depth = depth
                return bits.join(found_there, bits.constant(0))
            case ir.AnyOf(value=value):
                any_of = bits.truth(self._expr(value))
                # Behind a mask there may be no active NP at all.
                return bits.bit(None if any_of and self._depth else any_of)
            case _:  # memory, place, link
                return UNKNOWN

    def _binary(self, node: ir.Binary) -> Bits:
        left, right, op = node.left, node.right, node.op
        same = self._same(left, right)
        if op in {"<<", ">>"}:
            shift = bits.shift_left if op == "<<" else bits.shift_right
            return shift(self._byte(left), min(ir.constant(right, self.decoded.values) & 255, 8))
        if op == "+" and same:  # a shift, whatever it is
            return bits.shift_left(self._byte(left), 1)
        if same and op in {"-", "^"}:
            return bits.constant(0)
        if same and op in {"==", "<=", ">="}:
            return bits.ONE_BIT
        if same and op in {"!=", "<", ">"}:
            return bits.ZERO_BIT
        a, b = self._byte(left), self._byte(right)
        match op:
            case "+":
                return bits.add(a, b, bits.ZERO_BIT)[0]
            case "-":
                return bits.subtract(a, b, bits.ZERO_BIT)[0]
            case "&" | "and":
                return bits.both(a, b)
            case "|" | "or":
                return bits.either(a, b)
            case "^":
                return bits.differ(a, b)
            case "==" | "!=":
                return bits.equal(a, b) if op == "==" else bits.complement(bits.equal(a, b), 1)
            case "<" | ">=":
                return bits.lower(a, b) if op == "<" else bits.complement(bits.lower(a, b), 1)
        # > and <= are left
        return bits.lower(b, a) if op == ">" else bits.complement(bits.lower(b, a), 1)

    def _same(self, left: ir.Expr, right: ir.Expr) -> bool:
        """Whether both are the same register."""
        if not isinstance(left, ir.Register) or not isinstance(right, ir.Register):
            return False
        return self._number(left.name) == self._number(right.name)

    def _optional(self, node: ir.Expr | None) -> Bits:
        return bits.ZERO_BIT if node is None else self._expr(node)
