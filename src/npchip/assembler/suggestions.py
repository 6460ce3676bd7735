"""Hints for errors in instructions, many of them habits from other processors."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from typing import Final

from npchip.assembler.diagnostics import SourceError, did_you_mean, nearest, quoted
from npchip.assembler.lexer import COMMENT_HINT, COMMENT_SIGNS, Kind, Token
from npchip.isa import Form, Isa

_FLOW = "flow follows the global OR: JANY {0}, JNONE {0} or JALL {0}, after a CMP"
_MASK = "masked regions are WHERE cc, ELSE and END"

# Thesis 2.1.2: only ADD, SUB, AND, OR, shifts and a compare are built in.
INSTEAD: Final[Mapping[str, str]] = {
    "XOR": "there is no XOR: a ^ b is (a | b) - (a & b)",
    "EOR": "there is no EOR: a ^ b is (a | b) - (a & b)",
    "NOT": "there is no NOT: ~a is 255 - a",
    "MVN": "there is no MVN: ~a is 255 - a",
    "NEG": "there is no NEG: -a is 0 - a",
    **dict.fromkeys(("MUL", "MULT", "IMUL"), "there is no MUL: multiply by shifts and additions"),
    **dict.fromkeys(("DIV", "IDIV", "UDIV"), "there is no DIV: divide by shifts, or by a table"),
    "INC": "write ADD rd, #1",
    "DEC": "write SUB rd, #1",
    "CLR": "write MOV rd, #0",
    "MOVE": "did you mean MOV?",
    "LDI": "a constant is loaded by MOV rd, #imm",
    "ADDI": "ADD takes a constant with #: ADD rd, #imm",
    "SUBI": "SUB takes a constant with #: SUB rd, #imm",
    "ORR": "did you mean OR?",
    "ANDI": "AND takes a constant with #: AND rd, #imm",
    "TST": "there is no TST: copy the register, then AND",
    "TEST": "there is no TEST: copy the register, then AND",
    **dict.fromkeys(("LSL", "SLL", "SAL"), "did you mean SHL?"),
    **dict.fromkeys(("LSR", "SRL"), "did you mean SHR?"),
    **dict.fromkeys(("ASR", "SAR", "SRA"), "numbers are unsigned: there is only SHR"),
    **dict.fromkeys(("ROL", "RLC", "RCL"), "a rotation to the left through C is ADC rd, rd"),
    **dict.fromkeys(("ROR", "RRC"), "a rotation to the right through C is RCR rd"),
    **dict.fromkeys(("LDR", "LDRB", "LOAD", "LW", "LB"), "did you mean LD?"),
    **dict.fromkeys(("STR", "STRB", "STORE", "SW", "SB"), "did you mean ST?"),
    **dict.fromkeys(
        ("PUSH", "POP"), "there is no data stack: keep values in registers or the NP's memory"
    ),
    **dict.fromkeys(("BL", "JSR", "JAL"), "did you mean CALL?"),
    **dict.fromkeys(("B", "BRA", "GOTO", "BR", "JUMP", "J"), "did you mean JMP?"),
    **dict.fromkeys(("RETURN", "RTS", "BX"), "did you mean RET?"),
    **dict.fromkeys(("STOP", "EXIT", "HLT"), "did you mean HALT?"),
    **dict.fromkeys(("JZ", "JE", "JEQ", "BEQ", "BZ"), _FLOW.format("EQ")),
    **dict.fromkeys(("JNZ", "JNE", "BNE", "BNZ"), _FLOW.format("NE")),
    **dict.fromkeys(
        ("JC", "JB", "JL", "JLO", "JCS", "BCS", "BLO", "BLT", "JLT"), _FLOW.format("LO")
    ),
    **dict.fromkeys(("JNC", "JAE", "JGE", "JHS", "JCC", "BCC", "BHS", "BGE"), _FLOW.format("HS")),
    **dict.fromkeys(("JA", "JG", "JHI", "BHI", "BGT", "JGT"), _FLOW.format("HI")),
    **dict.fromkeys(("JBE", "JLE", "JLS", "BLS", "BLE"), _FLOW.format("LS")),
    **dict.fromkeys(("IF", "ENDIF", "THEN", "ENDWHERE", "ELSEWHERE", "WHILE", "FOR"), _MASK),
}

_OTHER_CONDITIONS: Final = {
    "LT": "numbers are unsigned: did you mean LO?",
    "GE": "numbers are unsigned: did you mean HS?",
    "GT": "numbers are unsigned: did you mean HI?",
    "LE": "numbers are unsigned: did you mean LS?",
    "Z": "did you mean EQ?",
    "NZ": "did you mean NE?",
    "C": "did you mean CS?",
    "NC": "did you mean CC?",
    "B": "did you mean LO?",
    "AE": "did you mean HS?",
    "A": "did you mean HI?",
    "BE": "did you mean LS?",
    "MI": "numbers are unsigned; a borrow is LO",
    "PL": "numbers are unsigned; no borrow is HS",
}
_DIRECTIONS: Final = {"UP": "north", "DOWN": "south", "LEFT": "west", "RIGHT": "east"}


def is_bare_label(tokens: Sequence[Token], mnemonics: Collection[str]) -> bool:
    """Return whether an unknown instruction looks like a label without its colon."""
    name, after = tokens[0].text, tokens[1]
    if after.kind is Kind.NAME:
        return after.text.upper() in mnemonics
    return after.ends and name.upper() not in INSTEAD and nearest(name, mnemonics) is None


def unknown_instruction(
    tokens: Sequence[Token],
    mnemonics: Collection[str],
    macros: Collection[str],
    below: Collection[str],
    left_out: Collection[str],
) -> SourceError:
    """Make the error NP003 for a line whose first word is no instruction.

    Args:
        tokens: the line.
        mnemonics: names of instructions.
        macros: names of the macros defined so far.
        below: names of the macros defined anywhere.
        left_out: names of macros in lines that conditions leave out.
    """
    name = tokens[0]
    after = tokens[1]
    hint = INSTEAD.get(name.text.upper())
    if name.text in left_out:
        hint = "a condition leaves out the lines that define this macro"
    elif name.text in below:
        hint = "the macro is defined further down: define it above its use"
    elif is_bare_label(tokens, mnemonics):
        hint = f"if it is a label, it ends with a colon: {name.text}:"
    elif after.text == "=" or after.text.upper() == "EQU":
        hint = f"a constant is defined by .equ {name.text}, VALUE"
    elif hint is None:
        hint = did_you_mean(name.text, [*macros, *mnemonics])
    message = f"unknown instruction {quoted(name.text)}"
    return SourceError("NP003", message, name.span, suggestion=hint)


def operand_hint(
    token: Token, wanted: Sequence[str], line: Sequence[Token], isa: Isa, *, is_register: bool
) -> str:
    """Return a hint for an operand that no form of the instruction has.

    Args:
        token: the token found.
        wanted: descriptions of what was expected, as in the message.
        line: the whole statement.
        isa: the instruction set.
        is_register: True if `token` names a register.
    """
    mnemonic = line[0].text.upper()
    forms = isa.forms[mnemonic]
    hint = None
    before = token.line.text[: token.column]
    if forms[0].label and line[1].text.upper() in isa.condition_names and token.column:
        hint = "a jump that depends on a condition is JANY or JNONE"
    if wanted == ["','"] and not token.ends:
        hint = "a comma is missing"
    elif hint is None and wanted == ["the end of the line"] and token.text == ",":
        count = 1 + sum(item.text == "," for item in line if item.column < token.column)
        hint = f"{count} operand{'s' * (count > 1)}, no more: {written(mnemonic, forms)}"
    elif token.text in COMMENT_SIGNS and _may_end_before(token, wanted, line):
        hint = COMMENT_HINT
    elif "[" in before and token.text == "-":
        hint = offset_hint(f"{before}-", "#N")
    elif "[" in before and is_register and any(item.startswith("a bank") for item in wanted):
        hint = offset_hint(before, token.text)
    elif wanted[0].startswith("a condition"):
        hint = _condition_hint(token, line, isa, alone=len(forms[0].slots) == 1)
    elif looks_like_register(token) and not is_register:
        hint = "the registers are r0 to r15"
    elif "'#'" in wanted and _begins_value(token) and not is_register:
        hint = "a constant begins with #"
        if line[-1].line is token.line:
            hint += f": #{token.line.text[token.column : line[-1].column]}"
    elif token.text == "#" and any(not item.startswith("a register") for item in wanted):
        hint = "this operand is written without #"
    elif is_register and any(item.startswith("a number") for item in wanted):
        hint = _register_hint(token, line)
    elif token.kind is Kind.NAME and not is_register:
        choices = [word for item in wanted for word in item.split(" or ") if len(word) > 3]
        near = _DIRECTIONS.get(token.text.upper())
        hint = f"did you mean {near}?" if near in choices else did_you_mean(token.text, choices)
    return hint or written(mnemonic, forms)


def _may_end_before(token: Token, wanted: Sequence[str], line: Sequence[Token]) -> bool:
    """Return whether a line may end before a sign: where it must, or behind a whole operand."""
    before = [item for item in line[1:] if item.column < token.column]
    whole = before and (before[-1].kind is not Kind.SIGN or before[-1].text in {"]", ")"})
    return wanted == ["the end of the line"] or bool(whole and token.text == "#")


def offset_hint(before: str, added: str) -> str | None:
    """Return a hint if what follows `before` is added to a register within brackets.

    Args:
        before: the line up to there.
        added: the operand that adds it beforehand; empty if there is none.
    """
    found = re.search(r"\[\s*(\w+)\s*[-+]\s*$", before)
    if found is None:
        return None
    register = found[1]
    verb = "SUB" if before.rstrip().endswith("-") else "ADD"
    first = f"{verb} {register}, {added}" if added else f"{verb} to {register}"
    return f"there is no offset, only a bank: {first} first, then [{register}]"


def _condition_hint(token: Token, line: Sequence[Token], isa: Isa, *, alone: bool) -> str | None:
    """Return a hint for a missing condition; `alone` if it is the only operand."""
    if token.kind is not Kind.NAME:
        return None
    if not alone:
        last = line[-2].text
        if len(line) == 3:
            return f"the condition comes first, such as {line[0].text} EQ, {token.text}"
        if last.upper() in isa.condition_names:
            return f"the condition comes first: {line[0].text} {last}, {token.text}"
    names = [name for name in isa.condition_names if abs(len(name) - len(token.text)) < 2]
    return _OTHER_CONDITIONS.get(token.text.upper()) or did_you_mean(token.text, names)


def _register_hint(token: Token, line: Sequence[Token]) -> str | None:
    before = [item.text for item in line if item.column < token.column]
    if "[" in before:
        return f"the register comes first: [{token.text} + BANK]"
    if "#" in before:
        return f"{token.text} is a register, and # begins a constant"
    return None


def looks_like_register(token: Token) -> bool:
    """Return whether a name is that of a register, or would be if there were more of them."""
    return token.text[:1] in {"r", "R"} and token.text[1:].isdigit()


def _begins_value(token: Token) -> bool:
    return token.kind in (Kind.NUMBER, Kind.NAME) or token.text in {"-", "~", "(", "+"}


def written(mnemonic: str, forms: Sequence[Form]) -> str:
    """Return the syntax of an instruction: ``ADD is written ADD rd, rs or ADD rd, #imm``."""
    shown = list(dict.fromkeys(_syntax(form) for form in forms))
    if shown == [mnemonic]:
        return f"{mnemonic} is written alone"
    return f"{mnemonic} is written {' or '.join(shown)}"


def _syntax(form: Form) -> str:
    """Return the syntax of a form, with the longer of the two names of each operand."""
    text = form.syntax
    for slot in form.slots.values():
        shown = slot.name if len(slot.name) > 1 else slot.operand.name
        for field in (f"{{{slot.name}:{slot.operand.name}}}", f"{{{slot.name}}}"):
            text = text.replace(field, shown)
    return text
