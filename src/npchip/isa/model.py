"""An instruction set: operands, conditions, forms and instructions.

All objects are immutable. Classes with cached properties are not frozen because frozen dataclasses
slow down the start of every process.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final, Literal, NamedTuple

from npchip.base.frozen import FrozenMap
from npchip.isa import ir

OperandKind = Literal["register", "number", "label", "condition", "choice"]
FieldValue = int | str
"""A decoded field: a number, or the name of a condition or choice."""


class Operand(NamedTuple):
    """A kind of operand, bound to a letter of the bit patterns.

    Attributes:
        letter: the letter that marks its bits.
        kind: its syntax: register, number, label, condition or choice.
        least, most, step: range of a number; the word holds number ÷ step.
        wraps: whether negative numbers down to -128 stand for their 8-bit pattern.
        choices: codes of a choice by name.
        opposite: whether the word holds the code of the opposite condition.
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
    choices: Mapping[str, int] = FrozenMap()
    opposite: bool = False


class ConditionCode(NamedTuple):
    """A condition on the flags, such as ``LO``; `when` is the expression it stands for."""

    name: str
    code: int
    when: ir.Expr
    when_text: str
    aliases: tuple[str, ...]
    text: str


class Slot(NamedTuple):
    """An operand of a form: its name in the form and its bits in the word."""

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
        timing: timing class.
        mnemonic: first word of the syntax; in an alias not the instruction's name.
        syntax: text of the file, such as ``ADD {rd}, #{y:imm}``.
        tokens: the operand part of the syntax.
        pattern: bit pattern, as in the file.
        mask, match: a word has this form if ``word & mask == match``.
        slots: operands by their name in the form.
        let: definitions for the semantics, as in the file.
        statements: semantics in the intermediate form.
        alias: whether another form has the same words; the disassembler uses that one.
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
        """True if an effect depends on the global OR."""
        return any(isinstance(s, ir.Effect) and s.guard is not None for s in self.statements)

    @cached_property
    def pure(self) -> bool:
        """True if all its operations are pure; see `ir.Signature`."""
        nodes = [node for node in self.nodes if isinstance(node, ir.Operation)]
        return all(ir.OPERATIONS[node.op].pure for node in nodes)

    @cached_property
    def inputs(self) -> Sequence[ir.Expr]:
        """Ports that it receives bytes from."""
        return [node.args[0] for node in self.operations("input")]

    @cached_property
    def label(self) -> str | None:
        """Name of the slot that holds a program address, if there is one."""
        return next((s.name for s in self.slots.values() if s.operand.kind == "label"), None)

    @cached_property
    def flow(self) -> ir.Effect | None:
        """The jump, call, ret or halt among its effects, if there is one."""
        found = [effect for name, effect in self.effects.items() if name in _FLOW]
        return found[-1] if found else None

    @property
    def exposes(self) -> bool:
        """True if it exposes a frame."""
        return "expose" in self.effects

    def depth_after(self, depth: int, limit: int) -> int | None:
        """Return the number of masked regions that are open after it; None if it traps.

        Args:
            depth: number of open regions before it.
            limit: number of regions that can be open at a time.
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

    @cached_property
    def nodes(self) -> tuple[ir.Node, ...]:
        """Every node of the semantics."""
        return tuple(node for statement in self.statements for node in ir.walk(statement))

    def operations(self, name: str) -> Iterator[ir.Operation]:
        """Yield the operations of the semantics that have this name."""
        return (n for n in self.nodes if isinstance(n, ir.Operation) and n.op == name)

    @cached_property
    def size(self) -> int:
        """Number of nodes of the semantics; an immediate and its constant count as one."""
        return sum(not isinstance(node, ir.Immediate) for node in self.nodes)


_FLOW: Final = frozenset({"jump", "call", "ret", "halt"})
_OPENED: Final = {"mask_push": 1, "mask_invert": 0, "mask_pop": -1}
"""Number of masked regions that an effect opens."""


class Instruction(NamedTuple):
    """An instruction as the manual describes it; `line` is its line in the file."""

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
        written = {n.name for f in self.forms for n in f.nodes if isinstance(n, ir.SetFlag)}
        return tuple(flag for flag in ("Z", "C") if flag in written)


class Decoded(NamedTuple):
    """A decoded word: its form and the value of each slot."""

    form: Form
    values: Mapping[str, FieldValue]

    @property
    def target(self) -> int | None:
        """Address that it jumps to or calls; None without one, or if the operand is missing."""
        flow = self.form.flow
        if flow is None or not flow.args:
            return None
        try:
            return ir.constant(flow.args[0], self.values)
        except KeyError:
            return None

    @property
    def port(self) -> int | None:
        """Port that it receives a byte from, if there is one."""
        inputs = self.form.inputs
        return ir.constant(inputs[0], self.values) if inputs else None


@dataclass(eq=False, repr=False)
class Isa:
    """An instruction set; `npchip.isa.load_isa` reads it from its file."""

    name: str
    title: str
    operands: Mapping[str, Operand]
    conditions: Mapping[str, ConditionCode]
    instructions: Mapping[str, Instruction]
    _decoded: dict[int, Decoded | None] = field(default_factory=dict, init=False, repr=False)

    def __repr__(self) -> str:
        return f"<Isa {self.name!r}: {len(self.instructions)} instructions>"

    @cached_property
    def timing_classes(self) -> tuple[str, ...]:
        """Timing classes, in the order of the file."""
        return tuple(dict.fromkeys(item.timing for item in self.instructions.values()))

    @cached_property
    def forms(self) -> Mapping[str, tuple[Form, ...]]:
        """Forms by mnemonic, with the aliases."""
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
        """Expressions of the conditions by name."""
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
        """Decode a 16-bit word; return None if it is undefined."""
        if word not in self._decoded:
            self._decoded[word] = self._decode(word)
        return self._decoded[word]

    def _decode(self, word: int) -> Decoded | None:
        for mask, table in self._by_mask:
            form = table.get(word & mask)
            if form is not None:
                fields = {slot.name: self._field(slot, word) for slot in form.slots.values()}
                values = {name: value for name, value in fields.items() if value is not None}
                return Decoded(form, values) if len(values) == len(fields) else None
        return None

    def _field(self, slot: Slot, word: int) -> FieldValue | None:
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
        """Return the word of a form.

        Args:
            form: a form of this instruction set.
            values: for each slot a register number, a number, a label's address, or the name
                of a condition or choice, in its range.
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
