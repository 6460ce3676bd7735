"""Known bits of registers and flags, and the effect of an instruction on them.

They are kept for the NPs that are active in each open masked region. A write under a mask sets the
bits of the innermost region; in the regions around it only the bits that do not change stay known.
"""

from __future__ import annotations

from typing import Final

from npchip.isa import Decoded, Isa, ir
from npchip.isa.ir import CARRY, FLAGS, ZERO
from npchip.program import bits
from npchip.program.bits import UNKNOWN, Bits

VARIABLES: Final = CARRY + 1

Knowledge = dict[tuple[int, int], Bits]
"""Bits by variable and number of open regions; those of a missing key are unknown."""


def after_reset() -> Knowledge:
    """Return the knowledge after reset: all state is 0."""
    known: Knowledge = {(number, 0): bits.constant(0) for number in range(ZERO)}
    return known | {(flag, 0): bits.ZERO_BIT for flag in (ZERO, CARRY)}


def meet(a: Knowledge, b: Knowledge) -> Knowledge:
    """Return what two paths agree on."""
    found: Knowledge = {}
    for key, value in a.items():
        other = b.get(key, UNKNOWN)
        joined = value if value == other else bits.join(value, other)
        if joined[0]:
            found[key] = joined
    return found


class Transfer(ir.Evaluator[Bits]):
    """Executes one decoded word on knowledge.

    Args:
        decoded: the word.
        isa: the program's instruction set.
    """

    def __init__(self, decoded: Decoded, isa: Isa) -> None:
        super().__init__(isa.meanings)
        self.fields, self.locals = decoded.values, {}
        self.number, self.read = bits.constant, self._read
        self._form = decoded.form

    def apply(self, before: Knowledge, depth: int) -> tuple[Knowledge, bool | None]:
        """Return the knowledge after the word, and the wire that guards its branch.

        The wire is True without a guard, and None if it is unknown.

        Args:
            before: knowledge before the word.
            depth: number of open masked regions before the word.
        """
        self._known = dict(before)
        self._depth = depth
        wire: bool | None = True
        for statement in self._form.statements:
            match statement:
                case ir.SetRegister(name=name, value=value):
                    self._write(self.fields[name], value.evaluate(self))
                case ir.SetFlag(name=name, value=value):
                    self._write(FLAGS[name], value.evaluate(self))
                case ir.SetLocal(name=name, value=value):
                    self.locals[name] = value.evaluate(self)
                case ir.Effect(name=name, guard=guard):
                    if guard is not None and statement is self._form.flow:
                        wire = bits.truth(guard.evaluate(self))
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

    def _read(self, variable: int) -> Bits:
        return self._known.get((variable, self._depth), UNKNOWN)

    def operation(self, node: ir.Operation) -> Bits:
        """Return the known bits of the result of an operation."""
        depth = self._depth
        if node.op == "neighbour":  # of any NP, active or not
            self._depth = 0
        args = [arg.evaluate(self) for arg in node.args]
        self._depth = depth
        if node.op == "neighbour":
            return bits.join(args[0], bits.constant(0))  # 0 outside the array
        if node.op == "any":  # under a mask there may be no active NP
            any_of = bits.truth(args[0])
            return bits.bit(None if any_of and depth else any_of)
        return bits.transfer(node.op, *args, same=ir.same_register(node, self.fields))
