"""Instruction-set files: an instruction of one's own, and every mistake with its line."""

from __future__ import annotations

from typing import NamedTuple

import pytest

from npchip import assemble_text
from npchip.base.errors import InputError, IsaError, NpchipError
from npchip.isa import parse_isa

NAME = "mine.yaml"
BASE = """\
name: tiny
title: A tiny instruction set
word_bits: 16
operands:
  rd:  {letter: d, kind: register, text: to}
  rs:  {letter: s, kind: register, text: from}
  imm: {letter: i, kind: number, min: 0, max: 255, text: constant}
  to:  {letter: t, kind: label, text: label}
  not_cc: {letter: c, kind: condition, opposite: true, text: condition}
  where: {letter: n, kind: choice, choices: {north: 0, east: 1, south: 2, west: 3}, text: side}
  level: {letter: l, kind: choice, choices: {reset: 0, signal: 1}, text: level}
conditions:
  EQ: {code: 0, when: Z, text: equal, aliases: [ZS]}
  NE: {code: 1, when: not Z, text: other}
instructions:
  - group: one
    name: ADD
    title: Add
    timing: alu
    forms:
      - {syntax: "ADD {rd}, {y:rs}", encoding: "0001 dddd ssss 0000"}
      - {syntax: "ADD {rd}, #{y:imm}", encoding: "0010 dddd iiii iiii"}
      - {syntax: "INC {rd}", encoding: "0010 dddd 0000 0001", let: {y: "1"}, alias: true}
    semantics: |
      C = carry(rd, y)
      rd = rd + y
      Z = rd == 0
    text: Adds.
  - group: two
    name: JANY
    title: Jump
    timing: flow
    forms: [{syntax: "JANY {cc:not_cc}, {to}", encoding: "0011 cccc 000t tttt"}]
    semantics: |
      if any(cc):
        jump(to)
    text: Jumps.
  - group: two
    name: NBR
    title: Neighbour
    timing: alu
    forms:
      - {syntax: "NBR {rd}, {where}", encoding: "0100 dddd 0000 00nn"}
    semantics: rd = neighbour(rd, where)
    text: Neighbour.
  - group: two
    name: SNAP
    title: Convert
    timing: alu
    forms: [{syntax: "SNAP {level}", encoding: "0101 0000 0000 000l"}]
    semantics: sample(level, 0)
    text: Converts.
"""
LAST = "    text: Converts.\n"


ADD, NBR = "  - group: one\n    name: ADD\n", "  - group: two\n    name: NBR\n"
NBR_FORM = '- {syntax: "NBR {rd}, {where}"'
SNAP_FORMS = 'forms: [{syntax: "SNAP {level}", encoding: "0101 0000 0000 000l"}]'
SNAP_MEANING = "semantics: sample(level, 0)"


class Case(NamedTuple):
    """A mistake made in `BASE`, and what must be said of it.

    Attributes:
        code: code of the error.
        old: text that is replaced; stands once in `BASE`.
        new: text with the mistake.
        says: part of the message.
        at: text whose line the message must name; the first line of `new` if not given.
    """

    code: str
    old: str
    new: str
    says: str
    at: str = ""

    def text(self) -> str:
        """`BASE` with the mistake."""
        assert BASE.count(self.old) == 1, self.old
        return BASE.replace(self.old, self.new)

    def line(self) -> int:
        """The line that the message must name."""
        text = self.text()
        place = text.index(self.at) if self.at else BASE.index(self.old)
        return text.count("\n", 0, place) + 1


def entry(old: str, new: str, says: str, at: str = "") -> Case:
    """Make an entry malformed."""
    return Case("NP401", old, new, says, at)


def pattern(bits: str, says: str) -> Case:
    """Give NBR a bit pattern that does not work."""
    old, new = (f'encoding: "{pattern}"' for pattern in ("0100 dddd 0000 00nn", bits))
    return Case("NP402", old, new, f"NBR: {says}")


def meaning(line: str, says: str) -> Case:
    """Write something else in the second line of ADD's semantics."""
    return Case("NP403", "rd = rd + y", line, f"ADD: semantics: {says}")


def in_if(line: str, says: str) -> Case:
    """Write something else in the `if` of JANY."""
    return Case("NP403", "jump(to)", line, f"JANY: semantics: {says}", at=line.splitlines()[-1])


def device(line: str, says: str) -> Case:
    """Ask something else of a device in SNAP."""
    return Case("NP403", SNAP_MEANING, f"semantics: {line}", says)


CASES = [
    # Keys and types of values
    entry("title: A tiny", "titel: A tiny", "instruction set has no titel: it takes name, title,"),
    entry(
        "name: tiny\ntitle: A tiny instruction set\n", "name: tiny\n", "instruction set needs title"
    ),
    entry("word_bits: 16", "word_bits: 32", "word_bits must be 16"),
    entry("word_bits: 16", "word_bits: '16'", "word_bits: expected a whole number, found '16'"),
    entry(
        "word_bits: 16",
        "word_bits: true",
        "word_bits: expected a whole number, found true",
    ),
    entry("conditions:\n", "conditions: []\nx:\n", "has no x", at="x:\n"),
    entry(
        "  EQ: {code: 0, when: Z, text: equal, aliases: [ZS]}",
        "  EQ: 0",
        "EQ: expected a mapping (key: value), found 0",
    ),
    entry("    title: Add\n", "    titles: Add\n", "ADD has no titles"),
    entry(f"{ADD}    title: Add\n", ADD, "ADD needs title"),
    entry(ADD, "  - group: one\n", "an instruction needs name"),
    entry("name: ADD", "name: 7", "7: name: expected a text, found 7"),
    entry("title: Add", "title: [Add]", "ADD: title: expected a text, found ['Add']"),
    entry("title: Add", "title:", "ADD: title: expected a text, found nothing"),
    entry("instructions:\n", "instructions:\n  - ADD\n", "each instruction must be a mapping"),
    entry(SNAP_FORMS, "forms: []", "SNAP: 'forms' must be a list of mappings"),
    entry(SNAP_FORMS, "forms: [SNAP]", "SNAP: 'forms' must be a list of mappings"),
    entry(SNAP_FORMS, "forms: SNAP", "SNAP: forms: expected a list, found 'SNAP'"),
    entry(
        "alias: true", "aliass: true", "ADD has no aliass: it takes syntax, encoding, let, alias"
    ),
    entry("alias: true", "alias: 1", "ADD: alias: expected true or false, found 1"),
    entry("title: Add", "title: Add\n    title: Sum", "'title' is given twice", at="title: Sum"),
    entry("name: NBR", "name: ADD", "ADD: is defined twice", at="name: ADD\n    title: Neighbour"),
    # Operands
    entry("s, kind: register", "s, kind: registr", "operand rs: kind must be one of register,"),
    entry("letter: s", "letter: ss", "operand rs: letter must be one small letter"),
    entry("letter: s", "letter: S", "operand rs: letter must be one small letter"),
    entry("min: 0", "mni: 0", "operand imm has no mni"),
    entry("min: 0", "min: -1", "operand imm: expected 0 <= min <= max"),
    entry("min: 0", "min: 256", "operand imm: expected 0 <= min <= max"),
    entry("min: 0", "step: 0", "operand imm: step must be at least 1"),
    entry("{reset: 0", "{reset: zero", "operand level: the code of 'reset' must be a number"),
    entry("{reset: 0", "{reset: -1", "operand level: the code of 'reset' must be a number"),
    Case("NP402", "{reset: 0", "{reset: 1", "operand level: two choices have the same code"),
    # Conditions
    Case("NP402", "NE: {code: 1", "NE: {code: 0", "condition NE: code 0 is that of EQ"),
    entry("NE: {code: 1", "NE: {code: -1", "condition NE: code must be at least 0"),
    entry("NE: {code: 1", "NE: {code: 1, aliases: [EQ]", "NE: the name EQ is already taken"),
    Case("NP403", "when: not Z", "when: row", "condition NE: 'when' must be a bit"),
    Case("NP403", "when: not Z", 'when: "mem[3] == 0"', "NE: a condition is one on the flags"),
    Case("NP403", "when: not Z", 'when: "input(0) == 0"', "NE: a condition is one on the flags"),
    Case("NP403", "when: not Z", "when: rd == 0", "condition NE: when: unknown name 'rd'"),
    # Syntax and encoding
    entry(NBR_FORM, '- {syntax: "NBR {rd}, {wehre}"', "'wehre'; did you mean 'where'?"),
    entry(NBR_FORM, '- {syntax: "NBR {rd}, {rd}, {where}"', "operand 'rd' stands twice"),
    entry(NBR_FORM, '- {syntax: "{rd}, {where}"', "NBR: the syntax must begin with a mnemonic"),
    Case("NP402", NBR_FORM, '- {syntax: "NBR {rd}, {x:rd}, {where}"', "have the letter 'd'"),
    Case(
        "NP402", "{cc:not_cc}, {to}", "{cc:not_cc}", "no operand of the syntax has the letter 't'"
    ),
    pattern("0100 dddd 0000 0nn", "the encoding '0100 dddd 0000 0nn' must be 16 of 0, 1"),
    pattern("0100 dddd 0000 000nn", "the encoding '0100 dddd 0000 000nn' must be 16 of 0, 1"),
    pattern("0100 dddd 0002 00nn", "the encoding '0100 dddd 0002 00nn' must be 16 of 0, 1"),
    pattern("0100 dddd 0000 0000", "the letter 'n' of operand 'where' must stand in the encoding"),
    pattern("0100 dddd 0000 0n0n", "the letter 'n' of operand 'where' must stand in the encoding"),
    pattern("0100 dddd 0000 0xnn", "no operand of the syntax has the letter 'x'"),
    pattern("0100 dddd 0000 000n", "operand 'where' needs more than 1 bits"),
    pattern("0100 0ddd 0000 00nn", "register 'rd' needs 4 bits"),
    pattern("0100 dddd d000 00nn", "register 'rd' needs 4 bits"),
    Case("NP402", "dddd iiii iiii", "dddd 0iii iiii", "operand 'imm' needs more than 7 bits"),
    Case(
        "NP402",
        "NE: {code: 1",
        "NE: {code: 16",
        "operand 'not_cc' needs more than 4 bits",
        at='forms: [{syntax: "JANY',
    ),
    Case(
        "NP402",
        "NE: {code: 1, when: not Z, text: other}",
        "NE: {code: 2, when: not Z, text: other}",
        "operand 'not_cc' needs conditions whose codes come in pairs",
        at='forms: [{syntax: "JANY',
    ),
    Case(
        "NP402",
        "0100 dddd 0000 00nn",
        "0001 dddd 0000 00nn",
        "NBR: the encoding of 'NBR {rd}, {where}' overlaps that of 'ADD {rd}, {y:rs}' (ADD, line",
        at=NBR,
    ),
    Case("NP402", "0010 dddd 0000 0001", "0110 dddd 0000 0001", "ADD: the alias", at=ADD),
    # Names in the semantics
    meaning("rd = rd + z", "unknown name 'z'"),
    meaning("rd = rd + rowe", "unknown name 'rowe'; did you mean 'row'?"),
    meaning("C = carri(rd, y)", "unknown function 'carri'; did you mean 'carry'?"),
    meaning("hlat()", "unknown effect 'hlat'; did you mean 'halt'?"),
    meaning("rd.real()", "unknown effect 'rd.real'"),
    meaning("y = rd", "'y' is not a register in every form"),
    meaning("row = rd", "'row' cannot be assigned"),
    meaning("carry = rd", "'carry' cannot be assigned"),
    # Types in the semantics
    meaning("rd = Z", "expected a byte, found a bit: 'Z'"),
    meaning("C = rd + y", "expected a bit, found a byte: 'rd + y'"),
    meaning("C = any(Z)", "expected a bit, found a wire: 'any(Z)'"),
    meaning("w = any(Z)", "expected a byte, found a wire: 'any(Z)'"),
    meaning("if Z: halt()", "expected a wire, found a bit: 'Z'"),
    meaning("rd = rd << rd", "expected a constant, found a byte: 'rd'"),
    meaning("rd = 1 if rd else 0", "expected a bit, found a byte: 'rd'"),
    meaning("Z = Z if C else rd", "expected a bit, found a byte: 'rd'"),
    meaning("jump(rd)", "expected a constant, found a byte: 'rd'"),
    meaning("rd = 256", "256 does not fit in a byte (0 to 255)"),
    meaning("C = rd[8]", "a byte has the bits 0 to 7, found 8"),
    meaning("C = carry(rd)", "carry() takes 2 or 3 arguments, found 1"),
    meaning("C = carry(rd, y, carry=C)", "carry() takes 2 or 3 arguments, found 2"),
    meaning("halt(rd)", "halt() takes 0 arguments, found 1"),
    # What is no part of the language
    meaning("rd = rd * y", "the ALU has only + - & | ^ << >> and comparisons"),
    meaning("rd = -rd", "'-rd' is not part of the language"),
    meaning("Z = 1 < rd < 3", "'1 < rd < 3' is not part of the language"),
    meaning("Z = True", "'True' is not part of the language"),
    meaning("rd = rd.real", "'rd.real' is not part of the language"),
    meaning("rd = C = 0", "expected an assignment"),
    meaning("rd += y", "expected an assignment"),
    meaning("import os", "expected an assignment"),
    meaning("rd = = y", "cannot be read: invalid syntax"),
    meaning(f"rd = {'~' * 5000}rd", "cannot be read")._replace(at="C = carry"),
    # Flow and masks
    Case("NP403", "rd = rd + y", "halt()", "nothing may follow", at="Z = rd == 0"),
    in_if("jump(to)\n        halt()", "nothing may follow a statement that changes the flow"),
    in_if("Z = C", "an if may hold effects only, such as jump(target)"),
    in_if("if any(C): halt()", "an if may hold effects only, such as jump(target)"),
    in_if("mask_pop()", "mask_pop() may not depend on an if"),
    Case(
        "NP403",
        "        jump(to)\n",
        "        jump(to)\n      else:\n        halt()\n",
        "JANY: semantics: expected an assignment",
        at="if any(cc)",
    ),
    # Where the line is
    Case("NP403", SNAP_MEANING, "semantics: sample(1, 0)", "SNAP: semantics: expected a name"),
    Case("NP403", SNAP_MEANING, "semantics: |\n      snap()", "unknown effect", at="snap()"),
    Case("NP403", SNAP_MEANING, "semantics: |\n\n\n      snap()", "unknown effect", at="snap()"),
    Case("NP403", 'y: "1"', 'y: "one"', "ADD: y: unknown name 'one'"),
    # Choices that the array or the sensor would not know
    Case("NP403", SNAP_MEANING, "semantics: mem[0] = neighbour(row, level)", "found 'reset'"),
    Case("NP403", "semantics: rd = neighbour(rd, where)", "semantics: sample(where, 0)", "'north'"),
    # Banks, ports and addresses that there are not
    device("sample(level, 250)", "sample() takes a bank, 0, 64, 128 or 192; this may be 250"),
    device("sample(level, 256)", "this may be 256"),
    device("sample(level, 64 - 65)", "this may be -1"),
    device("output(20, row)", "output() takes a port, 0 to 15; this may be 20"),
    device("output(8 + 8, row)", "this may be 16"),
    device("mem[0] = input(16)", "input() takes a port, 0 to 15; this may be 16"),
    device("jump(1024)", "jump() takes a program address, 0 to 1023; this may be 1024"),
    # Words that YAML takes for something else
    entry("aliases: [ZS]", "aliases: [NO]", "EQ: each alias must be a text"),
    entry("name: SNAP", "name: NO", "name: expected a text, found false"),
]


def refusal(text: str) -> NpchipError:
    with pytest.raises((InputError, IsaError)) as caught:
        parse_isa(text, NAME)
    return caught.value


def test_the_file_without_mistakes_is_read() -> None:
    isa = parse_isa(BASE, NAME)
    assert list(isa.instructions) == ["ADD", "JANY", "NBR", "SNAP"]
    assert assemble_text("INC r7", isa=isa).words == assemble_text("ADD r7, #1", isa=isa).words


@pytest.mark.parametrize("case", CASES, ids=[case.says[:40] for case in CASES])
def test_mistake_is_refused_with_its_line(case: Case) -> None:
    error = refusal(case.text())
    assert error.code == case.code
    assert error.message.startswith(f"{NAME}:{case.line()}: ")
    assert case.says in error.message
    assert "Located" not in error.message


ARGUMENTS = {
    "any(Z)": "if {}: halt()",
    "none(Z)": "if {}: halt()",
    "byte(Z)": "rd = {}",
    "carry(rd, rd)": "C = {}",
    "carry(rd, rd, C)": "C = {}",
    "borrow(rd, rd)": "C = {}",
    "borrow(rd, rd, C)": "C = {}",
    "neighbour(rd, where)": "rd = {}",
    "input(3)": "rd = {}",
    "jump(1)": "{}",
    "call(1)": "{}",
    "ret()": "{}",
    "halt()": "{}",
    "expose()": "{}",
    "output(3, rd)": "{}",
    "mask_push(Z)": "{}",
    "mask_invert()": "{}",
    "mask_pop()": "{}",
    "sample(level, 0)": "{}",
}
"""All functions and effects with all their arguments, and a statement for each."""


@pytest.mark.parametrize("call", ARGUMENTS)
def test_functions_take_their_arguments_and_no_others(call: str) -> None:
    """One less and one more are refused, each with what was expected and found."""
    name, arguments = call.rstrip(")").split("(")
    given = arguments.split(", ") if arguments else []
    old, statement = "semantics: rd = neighbour(rd, where)", ARGUMENTS[call]
    if name == "sample":
        old = SNAP_MEANING
    least, most = (2, 3) if name in {"carry", "borrow"} else (len(given), len(given))

    def text(arguments: list[str]) -> str:
        written = statement.format(f"{name}({', '.join(arguments)})")
        return BASE.replace(old, f"semantics: |\n      {written}")

    assert parse_isa(text(given), NAME)
    wrong = [given[:count] for count in range(least)] + [given + ["Z"] * (most + 1 - len(given))]
    for found in wrong:
        error = refusal(text(found))
        assert error.code == "NP403"
        wanted = str(least) if least == most else f"{least} or {most}"
        assert f"{name}() takes {wanted} arguments, found {len(found)}" in error.message
