"""What an instruction set consists of: operands, conditions, forms, instructions.

None of it is ever changed. What remembers nothing is a named tuple and the rest is not frozen, as
a frozen class takes five times as long to make, at the start of every process.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Final, Literal, NamedTuple

from npchip.isa import ir

OperandKind = Literal["register", "number", "label", "condition", "choice"]
FieldValue = int | str
"""A decoded field: a number, or the name of a condition or choice."""


class Operand(NamedTuple):
    """A kind of operand, bound to a letter of the bit patterns.

    Attributes:
        letter: the letter that marks its bits.
        kind: how it is written: register, number, label, condition or choice.
        least, most, step: the numbers it may be; the word holds number ÷ step.
        wraps: whether negative numbers down to -128 stand for their 8-bit pattern.
        choices: names and codes of a choice.
        opposite: a condition whose word holds the opposite.
        text: one phrase for the manual.
    """

    name: str
    letter: str
    kind: OperandKind
    text: str
    least: int = 0
    most: int = 0
    step: int = 1
    wraps: bool = False
    choices: Mapping[str, int] = MappingProxyType({})
    opposite: bool = False


class ConditionCode(NamedTuple):
    """A condition on the flags, such as ``LO``; `when` is its meaning as an expression."""

    name: str
    code: int
    when: ir.Expr
    when_text: str
    aliases: tuple[str, ...]
    text: str


class Slot(NamedTuple):
    """An operand's place in a form: its name there and its bits in the word."""

    name: str
    operand: Operand
    shift: int
    width: int


Token = str | Slot
"""Part of a form's syntax: literal text, or the slot of an operand."""


@dataclass(eq=False)
class Form:
    """One way to write an instruction, with its encoding and meaning.

    Attributes:
        instruction: name of the instruction.
        timing: its timing class.
        mnemonic: first word of the syntax; differs from the instruction's name in an alias.
        syntax: as in the file, such as ``ADD {rd}, #{y:imm}``.
        tokens: the operand part of the syntax.
        pattern: the bit pattern as in the file.
        mask, match: a word is of this form when ``word & mask == match``.
        slots: operands by their name in the form.
        let: names that this form defines for the semantics, as in the file.
        statements: meaning in the intermediate form.
        alias: only another way to write a word; the disassembler prefers the other form.
    """

    instruction: str
    timing: str
    mnemonic: str
    syntax: str
    tokens: tuple[Token, ...]
    pattern: str
    mask: int
    match: int
    slots: Mapping[str, Slot]
    let: Mapping[str, str]
    statements: tuple[ir.Statement, ...]
    alias: bool

    @cached_property
    def effects(self) -> Mapping[ir.EffectName, ir.Effect]:
        """Effects on the GCU and the devices, by name."""
        return {item.name: item for item in self.statements if isinstance(item, ir.Effect)}

    @cached_property
    def guarded(self) -> bool:
        """Whether an effect depends on the global OR."""
        return any(isinstance(s, ir.Effect) and s.guard is not None for s in self.statements)

    @cached_property
    def pure(self) -> bool:
        """Whether its operations are all functions of their arguments; see `ir.Signature`."""
        nodes = [node for node in self._nodes if isinstance(node, ir.Operation)]
        return all(ir.OPERATIONS[node.op].pure for node in nodes)

    @cached_property
    def inputs(self) -> Sequence[ir.Expr]:
        """Ports that it receives from."""
        return [node.args[0] for node in self.operations("input")]

    @cached_property
    def label(self) -> str | None:
        """Name of the slot that holds a program address, if there is one."""
        return next((s.name for s in self.slots.values() if s.operand.kind == "label"), None)

    @cached_property
    def flow(self) -> ir.Effect | None:
        """The jump, call, ret or halt among its effects."""
        found = [effect for name, effect in self.effects.items() if name in _FLOW]
        return found[-1] if found else None

    @property
    def exposes(self) -> bool:
        """Whether it takes a frame."""
        return "expose" in self.effects

    def depth_behind(self, depth: int, limit: int) -> int | None:
        """Return how many masked regions are open behind it; None where it traps.

        Args:
            depth: how many are open before it.
            limit: how many can be open at a time.
        """
        for name in self._mask_effects:
            depth += _OPENED[name]
            if not int(name == "mask_invert") <= depth <= limit:
                return None
        return depth

    @cached_property
    def _mask_effects(self) -> Sequence[str]:
        effects = [item for item in self.statements if isinstance(item, ir.Effect)]
        return [item.name for item in effects if item.name in _OPENED]

    def nodes(self) -> Iterator[ir.Node]:
        """Every node of the meaning."""
        return iter(self._nodes)

    def operations(self, *names: str) -> Iterator[ir.Operation]:
        """Yield the operations of the meaning that have one of these names."""
        return (n for n in self._nodes if isinstance(n, ir.Operation) and n.op in names)

    @cached_property
    def size(self) -> int:
        """How many nodes the meaning has, a constant as a byte being one."""
        return sum(not isinstance(node, ir.Immediate) for node in self._nodes)

    @cached_property
    def _nodes(self) -> tuple[ir.Node, ...]:
        return tuple(node for statement in self.statements for node in ir.walk(statement))


_FLOW: Final = frozenset({"jump", "call", "ret", "halt"})
_OPENED: Final = {"mask_push": 1, "mask_invert": 0, "mask_pop": -1}
"""By effect how many masked regions it opens."""


class Instruction(NamedTuple):
    """An instruction as the manual describes it; `line` is its place in the file."""

    name: str
    group: str
    title: str
    timing: str
    forms: tuple[Form, ...]
    semantics: str
    text: str
    line: int

    @property
    def flags(self) -> tuple[str, ...]:
        """Flags that it writes, in the order Z, C."""
        written = {n.name for f in self.forms for n in f.nodes() if isinstance(n, ir.SetFlag)}
        return tuple(flag for flag in ("Z", "C") if flag in written)


class Decoded(NamedTuple):
    """A word taken apart: its form and the value of each slot."""

    form: Form
    values: Mapping[str, FieldValue]

    @property
    def target(self) -> int | None:
        """Address that it jumps to or calls; None for others, or where the operand is missing."""
        flow = self.form.flow
        if flow is None or not flow.args:
            return None
        try:
            return ir.constant(flow.args[0], self.values)
        except KeyError:
            return None

    @property
    def port(self) -> int | None:
        """Port from which it receives a byte, if it does."""
        inputs = self.form.inputs
        return ir.constant(inputs[0], self.values) if inputs else None


@dataclass(eq=False)
class Isa:
    """A whole instruction set; `npchip.isa.load_isa` makes it from its file."""

    name: str
    title: str
    operands: Mapping[str, Operand]
    conditions: Mapping[str, ConditionCode]
    instructions: Mapping[str, Instruction]

    @cached_property
    def timing_classes(self) -> tuple[str, ...]:
        """Classes that a machine file may give cycles to, in the order of the file."""
        return tuple(dict.fromkeys(item.timing for item in self.instructions.values()))

    @cached_property
    def forms(self) -> Mapping[str, tuple[Form, ...]]:
        """Forms by mnemonic, aliases included."""
        table: dict[str, tuple[Form, ...]] = {}
        for item in self.instructions.values():
            for form in item.forms:
                table[form.mnemonic] = (*table.get(form.mnemonic, ()), form)
        return table

    @cached_property
    def condition_names(self) -> Mapping[str, ConditionCode]:
        """Conditions by name and by alias."""
        names = dict(self.conditions)
        for item in self.conditions.values():
            names |= dict.fromkeys(item.aliases, item)
        return names

    @cached_property
    def meanings(self) -> Mapping[str, ir.Expr]:
        """What each condition means, by its name."""
        return {item.name: item.when for item in self.conditions.values()}

    @cached_property
    def _by_mask(self) -> list[tuple[int, dict[int, Form]]]:
        tables: dict[int, dict[int, Form]] = {}
        for item in self.instructions.values():
            for form in item.forms:
                if not form.alias:
                    tables.setdefault(form.mask, {})[form.match] = form
        return list(tables.items())

    @cached_property
    def _condition_by_code(self) -> Mapping[int, str]:
        return {item.code: item.name for item in self.conditions.values()}

    def decode(self, word: int) -> Decoded | None:
        """Take a 16-bit word apart; None where the word is undefined."""
        if word not in self._decoded:
            self._decoded[word] = self._decode(word)
        return self._decoded[word]

    @cached_property
    def _decoded(self) -> dict[int, Decoded | None]:
        """Words that have been decoded: every program is, by all that look at it."""
        return {}

    def _decode(self, word: int) -> Decoded | None:
        for mask, table in self._by_mask:
            form = table.get(word & mask)
            if form is not None:
                values: dict[str, FieldValue] = {}
                for slot in form.slots.values():
                    value = self._field_value(slot, word)
                    if value is None:
                        return None
                    values[slot.name] = value
                return Decoded(form, values)
        return None

    def _field_value(self, slot: Slot, word: int) -> FieldValue | None:
        raw = (word >> slot.shift) & ((1 << slot.width) - 1)
        operand = slot.operand
        match operand.kind:
            case "condition":
                return self._condition_by_code.get(raw ^ operand.opposite)
            case "choice":
                return next((n for n, code in operand.choices.items() if code == raw), None)
            case "number":
                value = raw * operand.step
                return value if operand.least <= value <= operand.most else None
        return raw

    def encode(self, form: Form, values: Mapping[str, FieldValue]) -> int:
        """Make the word of a form.

        Args:
            form: a form of this instruction set.
            values: for each slot a register number, a number, a label's address, or the name
                of a condition or choice, all within their range.
        """
        word = form.match
        for slot in form.slots.values():
            value = values[slot.name]
            operand = slot.operand
            if operand.kind == "condition":
                raw = self.condition_names[str(value)].code ^ operand.opposite
            elif operand.kind == "choice":
                raw = operand.choices[str(value)]
            else:
                raw = (int(value) & 0xFF if operand.wraps else int(value)) // operand.step
            word |= raw << slot.shift
        return word
