"""Reader of the instruction-set file. Errors name the entry and its line."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, TypeVar, get_args

from npchip.base.errors import InputError, IsaError, NpchipError
from npchip.base.files import read_bytes
from npchip.base.section import QUOTES, Codes, Section
from npchip.base.suggest import suggestion
from npchip.base.yaml import MAX_BYTES, Located, load_mapping
from npchip.isa import ir
from npchip.isa.devices import misuse
from npchip.isa.language import SemanticsError, parse_expression, parse_statements
from npchip.isa.model import (
    ConditionCode,
    Form,
    Instruction,
    Isa,
    Operand,
    OperandKind,
    Slot,
    Token,
)

_T = TypeVar("_T")

WORD_BITS = 16
_REGISTER_BITS = 4
BUILT_IN = "npchip.yaml"
_BEYOND_FLAGS = ("load", "input")

_TOKEN = re.compile(r"\{(\w+)(?::(\w+))?\}|[A-Za-z]\w*|[^\s\w]")


class Entry(Section):
    """An entry of the file."""

    codes = Codes("NP401", "NP401", "NP401")
    error_type = IsaError

    def worded(self, message: str) -> str:
        """Return the message with the name of the entry."""
        return message if message.startswith(f"{self.name} ") else f"{self.name}: {message}"

    def text(self, key: str) -> str:
        """Return the text of a key without surrounding space."""
        return str(self.get(key, str)).strip()

    def encoding_error(self, message: str, key: str = "encoding") -> NpchipError:
        """Return an error of the encoding, NP402."""
        return self.error(message, code="NP402", key=key)


@cache
def load_isa() -> Isa:
    """Return the built-in instruction set."""
    text = files("npchip.isa").joinpath(BUILT_IN).read_text(encoding="utf-8")
    return parse_isa(text, BUILT_IN)


def read_isa(path: Path) -> Isa:
    """Read a user's instruction-set file.

    Raises:
        IsaError: NP401 the file cannot be read; else as `parse_isa`.
    """
    try:
        text = read_bytes(path, MAX_BYTES).decode()
    except (OSError, UnicodeDecodeError) as error:
        raise IsaError("NP401", f"cannot read {path}: {error}") from None
    return parse_isa(text, str(path))


def parse_isa(text: str, name: str) -> Isa:
    """Return the instruction set of a file's text. Messages call the file `name`.

    Raises:
        IsaError: NP401 malformed file or entry, NP402 encoding, NP403 semantics.
    """
    try:
        data = load_mapping(text, name, "NP401")
    except InputError as error:
        raise IsaError(error.code, error.message, hint=error.hint) from None
    return _Loader(name).load(data)


class _Loader:
    def __init__(self, file: str) -> None:
        self._file = file
        self._operands: dict[str, Operand] = {}
        self._conditions: dict[str, ConditionCode] = {}
        self._instructions: dict[str, Instruction] = {}
        self._inherited: set[str] = set()

    def load(self, data: Located) -> Isa:
        top = Entry(data, self._file, "instruction set")
        if "extends" in data:
            self._inherit(top)
        else:
            top.check_keys(("name", "title", "word_bits", "operands", "conditions", "instructions"))
            if top.get("word_bits", int) != WORD_BITS:
                raise top.error(f"word_bits must be {WORD_BITS}", key="word_bits")
        if "operands" in data:
            self._load_operands(top.section("operands"))
        if "conditions" in data:
            self._load_conditions(top.section("conditions"))
        for item in top.get("instructions", list):
            if not isinstance(item, Located):
                raise top.error("each instruction must be a mapping", key="instructions")
            entry = Entry(item, self._file, str(item.get("name", "an instruction")))
            instruction = self._instruction(entry)
            if instruction.name in self._instructions:
                raise entry.error(f"is defined twice{self._origin(instruction.name)}", key="name")
            self._instructions[instruction.name] = instruction
        self._check_encodings()
        name = top.text("name")
        title = top.text("title") if "title" in data else f"{load_isa().title}, as {name}"
        return Isa(name, title, self._operands, self._conditions, self._instructions)

    def _inherit(self, top: Entry) -> None:
        """Start from the built-in instruction set."""
        top.check_keys(("extends", "name", "instructions"), ("title", "operands", "conditions"))
        base = load_isa()
        if top.text("extends") != base.name:
            raise top.error(f"only '{base.name}' can be extended", key="extends")
        if top.text("name") == base.name:
            raise top.error("an extension needs a name of its own", key="name")
        self._operands = dict(base.operands)
        self._conditions = dict(base.conditions)
        self._instructions = dict(base.instructions)
        self._inherited = set(base.instructions)

    def _origin(self, name: str) -> str:
        return " (it is built in)" if name in self._inherited else ""

    # ---- operands and conditions

    def _load_operands(self, section: Entry) -> None:
        for name in section.data:
            entry = section.section(name, f"operand {name}")
            if name in self._operands:
                raise entry.error("is built in and cannot be changed")
            entry.check_keys(
                ("letter", "kind", "text"),
                ("min", "max", "step", "wraps", "choices", "opposite"),
            )
            kind: OperandKind = entry.get("kind", str)
            if kind not in get_args(OperandKind):
                kinds = ", ".join(get_args(OperandKind))
                raise entry.error(f"kind must be one of {kinds}; found '{kind}'", key="kind")
            letter = entry.text("letter")
            if not re.fullmatch("[a-z]", letter):
                raise entry.error("letter must be one small letter", key="letter")
            choices: Mapping[str, int] = entry.get("choices", dict, {})
            for choice, code in choices.items():
                if not isinstance(code, int) or isinstance(code, bool) or code < 0:
                    raise entry.error(f"the code of '{choice}' must be a number", key="choices")
            if len(set(choices.values())) < len(choices):
                raise entry.encoding_error("two choices have the same code", "choices")
            self._operands[name] = Operand(
                name=name,
                letter=letter,
                kind=kind,
                text=entry.text("text"),
                least=entry.get("min", int, 0),
                most=entry.get("max", int, 0),
                step=entry.get("step", int, 1),
                wraps=entry.get("wraps", bool, False),
                choices=choices,
                opposite=entry.get("opposite", bool, False),
            )
            if self._operands[name].step < 1:
                raise entry.error("step must be at least 1", key="step")
            if not 0 <= self._operands[name].least <= self._operands[name].most:
                raise entry.error("expected 0 <= min <= max", key="min")

    def _load_conditions(self, section: Entry) -> None:
        codes = {item.code: item.name for item in self._conditions.values()}
        names = {w for item in self._conditions.values() for w in (item.name, *item.aliases)}
        for name in section.data:
            entry = section.section(name, f"condition {name}")
            entry.check_keys(("code", "when", "text"), ("aliases",))
            code = entry.get("code", int)
            if code < 0:
                raise entry.error("code must be at least 0", key="code")
            if code in codes:
                raise entry.encoding_error(f"code {code} is that of {codes[code]}", "code")
            codes[code] = name
            aliases = tuple(entry.get("aliases", list, []))
            if any(not isinstance(alias, str) for alias in aliases):
                raise entry.error("each alias must be a text", key="aliases", hint=QUOTES)
            for word in (name, *aliases):
                if word in names:
                    raise entry.error(f"the name {word} is already taken")
                names.add(word)
            when = self._semantics(entry, "when", parse_expression, {})
            if when.type is not ir.Type.BIT:
                raise entry.error("'when' must be a bit", code="NP403", key="when")
            nodes = ir.walk(when)
            if any(isinstance(n, ir.Operation) and n.op in _BEYOND_FLAGS for n in nodes):
                raise entry.error(
                    "a condition is one on the flags; 'mem' and 'input' belong into the "
                    "semantics of an instruction",
                    code="NP403",
                    key="when",
                )
            self._conditions[name] = ConditionCode(
                name, code, when, entry.text("when"), aliases, entry.text("text")
            )

    # ---- instructions

    def _instruction(self, entry: Entry) -> Instruction:
        entry.check_keys(("group", "name", "title", "timing", "forms", "semantics", "text"))
        forms = entry.get("forms", list)
        if not forms or not all(isinstance(form, Located) for form in forms):
            raise entry.error("'forms' must be a list of mappings", key="forms")
        return Instruction(
            name=entry.text("name"),
            group=entry.text("group"),
            title=entry.text("title"),
            timing=entry.text("timing"),
            forms=tuple(self._form(entry, Entry(f, self._file, entry.name)) for f in forms),
            semantics=entry.text("semantics"),
            text=entry.text("text"),
            line=entry.line(),
        )

    def _form(self, instruction: Entry, entry: Entry) -> Form:
        entry.check_keys(("syntax", "encoding"), ("let", "alias"))
        syntax, pattern = entry.text("syntax"), entry.text("encoding")
        bits = pattern.replace(" ", "")
        if len(bits) != WORD_BITS or not re.fullmatch("[01a-z]+", bits):
            raise entry.encoding_error(
                f"the encoding '{pattern}' must be {WORD_BITS} of 0, 1 and letters"
            )
        slots: dict[str, Slot] = {}
        tokens: list[Token] = []
        for found in _TOKEN.finditer(syntax):
            if found[1] is None:
                tokens.append(found[0])
                continue
            slot = self._slot(entry, bits, found[1], found[2] or found[1])
            if slot.name in slots:
                raise entry.error(f"operand '{slot.name}' stands twice in the syntax", key="syntax")
            if slot.operand.letter in {other.operand.letter for other in slots.values()}:
                raise entry.encoding_error(
                    f"two operands of the syntax have the letter '{slot.operand.letter}'", "syntax"
                )
            slots[slot.name] = slot
            tokens.append(slot)
        unused = set(bits) - {"0", "1"} - {slot.operand.letter for slot in slots.values()}
        if unused:
            raise entry.encoding_error(f"no operand of the syntax has the letter '{min(unused)}'")
        if not tokens or not isinstance(tokens[0], str):
            raise entry.error("the syntax must begin with a mnemonic", key="syntax")
        scope: dict[str, ir.Expr] = {slot.name: _operand_expr(slot) for slot in slots.values()}
        if "let" in entry.data:
            definitions = entry.section("let", entry.name)
            for name in definitions.data:
                scope[name] = self._semantics(definitions, name, parse_expression, scope)
        statements = self._semantics(instruction, "semantics", parse_statements, scope)
        fault = misuse(statements, {slot.name: slot.operand for slot in slots.values()})
        if fault:
            raise instruction.error(fault, code="NP403", key="semantics")
        return Form(
            instruction=instruction.text("name"),
            timing=instruction.text("timing"),
            mnemonic=tokens[0].upper(),
            syntax=syntax,
            tokens=tuple(tokens[1:]),
            pattern=pattern,
            mask=int("".join("1" if bit in "01" else "0" for bit in bits), 2),
            match=int("".join(bit if bit in "01" else "0" for bit in bits), 2),
            slots=slots,
            let={name: str(text) for name, text in entry.get("let", dict, {}).items()},
            statements=statements,
            alias=entry.get("alias", bool, False),
        )

    def _slot(self, entry: Entry, bits: str, name: str, kind: str) -> Slot:
        operand = self._operands.get(kind)
        if operand is None:
            near = suggestion(kind, self._operands)
            hint = f"; {near}" if near else ""
            raise entry.error(f"unknown operand '{kind}'{hint}", key="syntax")
        field = re.search(f"{operand.letter}+", bits)
        if field is None or bits.count(operand.letter) != len(field[0]):
            raise entry.encoding_error(
                f"the letter '{operand.letter}' of operand '{kind}' must stand in the encoding, "
                "all in one place"
            )
        width = len(field[0])
        codes = [item.code for item in self._conditions.values()]
        largest = {
            "number": operand.most // operand.step,
            "choice": max(operand.choices.values(), default=0),
            "condition": max(codes, default=0),
        }.get(operand.kind, 0)
        if operand.kind == "register" and width != _REGISTER_BITS:
            raise entry.encoding_error(f"register '{kind}' needs {_REGISTER_BITS} bits")
        if largest >= 1 << width:
            raise entry.encoding_error(f"operand '{kind}' needs more than {width} bits")
        if operand.opposite and {code ^ 1 for code in codes} != set(codes):
            raise entry.encoding_error(
                f"operand '{kind}' needs conditions whose codes come in pairs", "syntax"
            )
        return Slot(name, operand, WORD_BITS - field.end(), width)

    @staticmethod
    def _semantics(entry: Entry, key: str, parse: Callable[[str, Any], _T], scope: Any) -> _T:
        try:
            return parse(entry.text(key), scope)
        except SemanticsError as error:
            # A block text begins on the line after its key, a plain one on the same line.
            text = entry.get(key, str)
            above = text[: len(text) - len(text.lstrip())].count("\n")
            start = entry.line(key) + ("\n" in text) + above
            place = f"{entry.file}:{start + error.line - 1}"
            raise IsaError("NP403", f"{place}: {entry.name}: {key}: {error}") from None

    # ---- encodings

    def _check_encodings(self) -> None:
        seen: list[Form] = []
        for item in self._instructions.values():
            for form in item.forms:
                clash = [o for o in seen if not (form.match ^ o.match) & form.mask & o.mask]
                message = None
                if not form.alias:
                    seen.append(form)
                    if clash:
                        other = self._instructions[clash[0].instruction]
                        origin = self._origin(other.name) or f", line {other.line}"
                        message = (
                            f"the encoding of '{form.syntax}' overlaps that of "
                            f"'{clash[0].syntax}' ({other.name}{origin})"
                        )
                elif not any(real.mask & form.mask == real.mask for real in clash):
                    message = f"the alias '{form.syntax}' is no word of it"
                if message:
                    place = f"{self._file}:{item.line}"
                    raise IsaError("NP402", f"{place}: {item.name}: {message}")


def _operand_expr(slot: Slot) -> ir.Expr:
    match slot.operand.kind:
        case "register":
            return ir.Register(slot.name)
        case "condition":
            return ir.Condition(slot.name)
        case "choice":
            return ir.Field(slot.name, ir.Type.NAME)
    return ir.Field(slot.name)
