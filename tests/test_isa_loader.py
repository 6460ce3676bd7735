"""Instruction-set files: an instruction of one's own, and every mistake with its line."""

from __future__ import annotations

from importlib import resources
from typing import TYPE_CHECKING, NamedTuple

import pytest
from chips import machine_of, places

from npchip import Chip, assemble_text
from npchip.errors import InputError, IsaError
from npchip.isa import Isa, load_isa, parse_isa, read_isa

if TYPE_CHECKING:
    from pathlib import Path

NAME = "mine.yaml"
MARK = "»"
"""Stands before the line that a message must name."""

BASE = """\
name: tiny
title: A tiny instruction set
word_bits: 16
operands:
  rd:  {letter: d, kind: register, text: to}
  rs:  {letter: s, kind: register, text: from}
  imm: {letter: i, kind: number, min: 0, max: 255, text: constant}
  to:  {letter: t, kind: label, text: label}
  cc:  {letter: c, kind: condition, text: condition}
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
    forms: [{syntax: "JANY {cc}, {to}", encoding: "0011 cccc 000t tttt"}]
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
ADD_HEAD = "  - group: one\n    name: ADD\n"
SUM = "      rd = rd + y\n"


class Case(NamedTuple):
    """A mistake: text to replace (its first occurrence), replacement, and what is said of it."""

    old: str
    new: str
    code: str
    says: str


def semantics(line: str, says: str) -> Case:
    """A mistake in the second line of ADD's semantics."""
    return Case(SUM, f"      {MARK}{line}\n", "NP403", f"ADD: semantics: {says}")


CASES = {
    # keys and types
    "unknown key at the top": Case("title: A", f"{MARK}titel: A", "NP401", "did you mean 'title'?"),
    "missing key at the top": Case("title: A tiny instruction set\n", "", "NP401", "'title' is missing"),
    "word bits": Case("word_bits: 16", f"{MARK}word_bits: 32", "NP401", "must be 16"),
    "word bits not a number": Case("word_bits: 16", f"{MARK}word_bits: '16'", "NP401", "must be a int"),
    "operands are a list": Case("operands:\n", f"{MARK}operands: []\nx:\n", "NP401", ""),
    "unknown key of an instruction": Case("    timing: alu", f"    {MARK}timeing: alu", "NP401", "ADD: unknown key 'timeing'; did you mean 'timing'?"),
    "missing key of an instruction": Case(f"{ADD_HEAD}    title: Add\n", f"{MARK}{ADD_HEAD}", "NP401", "ADD: 'title' is missing"),
    "instruction without a name": Case(ADD_HEAD, f"{MARK}  - group: one\n", "NP401", "'name' is missing"),
    "name is a number": Case("    name: ADD", f"    {MARK}name: 7", "NP401", "'name' must be a str, found a int"),
    "instruction is no mapping": Case("instructions:\n", f"{MARK}instructions:\n  - ADD\n", "NP401", "must be a mapping"),
    "instructions are a mapping": Case("instructions:\n", f"{MARK}instructions: {{}}\nmore:\n", "NP401", ""),
    "forms are empty": Case('    forms: [{syntax: "SNAP {level}", encoding: "0101 0000 0000 000l"}]', f"    {MARK}forms: []", "NP401", "SNAP: 'forms' must be a list of mappings"),
    "a form is no mapping": Case('    forms: [{syntax: "SNAP {level}", encoding: "0101 0000 0000 000l"}]', f"    {MARK}forms: [SNAP]", "NP401", "SNAP: 'forms' must be a list of mappings"),
    "unknown key of a form": Case(", alias: true}", f",\n      {MARK}aliass: true}}", "NP401", "ADD: unknown key 'aliass'; did you mean 'alias'?"),
    "alias is no boolean": Case(", alias: true}", f",\n      {MARK}alias: 1}}", "NP401", "'alias' must be a bool"),
    "semantics missing": Case("  - group: two\n    name: NBR", f"{MARK}  - group: two\n    nane: NBR", "NP401", "unknown key 'nane'; did you mean 'name'?"),
    "duplicate key": Case("    title: Add\n", f"    title: Add\n    {MARK}title: Sum\n", "NP401", "'title' is given twice"),
    "duplicate instruction": Case("    name: NBR", f"    {MARK}name: ADD", "NP401", "ADD: is defined twice"),
    # operands and conditions
    "unknown kind": Case("  rs:  {letter: s, kind: register", f"  {MARK}rs:  {{letter: s, kind: registr", "NP401", "operand rs: kind must be one of"),
    "two letters": Case("  rs:  {letter: s,", f"  {MARK}rs:  {{letter: ss,", "NP401", "operand rs: letter must be one small letter"),
    "capital letter": Case("  rs:  {letter: s,", f"  {MARK}rs:  {{letter: S,", "NP401", "operand rs: letter must be one small letter"),
    "unknown key of an operand": Case("min: 0, max: 255", f"mni: 0, {MARK}max: 255".replace(MARK, ""), "NP401", "operand imm: unknown key 'mni'; did you mean 'min'?"),
    "negative least": Case("  imm: {letter: i, kind: number, min: 0", f"  {MARK}imm: {{letter: i, kind: number, min: -1", "NP401", "0 <= min <= max"),
    "least above most": Case("  imm: {letter: i, kind: number, min: 0", f"  {MARK}imm: {{letter: i, kind: number, min: 256", "NP401", "0 <= min <= max"),
    "step of 0": Case("  imm: {", f"  {MARK}imm: {{step: 0, ", "NP401", "step must be at least 1"),
    "choice without a number": Case("  level: {letter: l, kind: choice, choices: {reset: 0", f"  {MARK}level: {{letter: l, kind: choice, choices: {{reset: zero", "NP401", "the code of 'reset' must be a number"),
    "two choices with one code": Case("  level: {letter: l, kind: choice, choices: {reset: 0", f"  {MARK}level: {{letter: l, kind: choice, choices: {{reset: 1", "NP402", "two choices have the same code"),
    "two conditions with one code": Case("  NE: {code: 1", f"  {MARK}NE: {{code: 0", "NP402", "condition NE: code 0 is that of EQ"),
    "negative condition": Case("  NE: {code: 1", f"  {MARK}NE: {{code: -1", "NP401", "condition NE: code must be at least 0"),
    "condition's name is taken": Case("  NE: {code: 1,", f"  {MARK}NE: {{code: 1, aliases: [EQ],", "NP401", "the name EQ is already taken"),
    "condition is a byte": Case("  NE: {code: 1, when: not Z", f"  {MARK}NE: {{code: 1, when: row", "NP403", "condition NE: 'when' must be a bit"),
    "condition names a register": Case("  NE: {code: 1, when: not Z", f"  {MARK}NE: {{code: 1, when: rd == 0", "NP403", "unknown name 'rd'"),
    # syntax and encoding
    "unknown operand": Case('      - {syntax: "NBR {rd}, {where}"', f'      {MARK}- {{syntax: "NBR {{rd}}, {{wehre}}"', "NP401", "NBR: unknown operand 'wehre'; did you mean 'where'?"),
    "operand twice": Case('      - {syntax: "NBR {rd}, {where}"', f'      {MARK}- {{syntax: "NBR {{rd}}, {{rd}}, {{where}}"', "NP401", "NBR: operand 'rd' stands twice"),
    "letter of two operands": Case('      - {syntax: "NBR {rd}, {where}"', f'      {MARK}- {{syntax: "NBR {{rd}}, {{x:rd}}, {{where}}"', "NP402", "two operands of the syntax have the letter 'd'"),
    "no mnemonic": Case('      - {syntax: "NBR {rd}, {where}"', f'      {MARK}- {{syntax: "{{rd}}, {{where}}"', "NP401", "NBR: the syntax must begin with a mnemonic"),
    "pattern too short": Case('encoding: "0100 dddd 0000 00nn"', f'\n        {MARK}encoding: "0100 dddd 0000 0nn"', "NP402", "must be 16 of 0, 1 and letters"),
    "pattern too long": Case('encoding: "0100 dddd 0000 00nn"', f'\n        {MARK}encoding: "0100 dddd 0000 000nn"', "NP402", "must be 16 of 0, 1 and letters"),
    "strange pattern": Case('encoding: "0100 dddd 0000 00nn"', f'\n        {MARK}encoding: "0100 dddd 0002 00nn"', "NP402", "must be 16 of 0, 1 and letters"),
    "letter missing": Case('encoding: "0100 dddd 0000 00nn"', f'\n        {MARK}encoding: "0100 dddd 0000 0000"', "NP402", "the letter 'n' of operand 'where' must stand in"),
    "letter split": Case('encoding: "0100 dddd 0000 00nn"', f'\n        {MARK}encoding: "0100 dddd 0000 0n0n"', "NP402", "all in one place"),
    "letter of nobody": Case('encoding: "0100 dddd 0000 00nn"', f'\n        {MARK}encoding: "0100 dddd 0000 0xnn"', "NP402", "no operand of the syntax has the letter 'x'"),
    "choice too narrow": Case('encoding: "0100 dddd 0000 00nn"', f'\n        {MARK}encoding: "0100 dddd 0000 000n"', "NP402", "operand 'where' needs more than 1 bits"),
    "register too narrow": Case('encoding: "0100 dddd 0000 00nn"', f'\n        {MARK}encoding: "0100 0ddd 0000 00nn"', "NP402", "register 'rd' needs 4 bits"),
    "register too wide": Case('encoding: "0100 dddd 0000 00nn"', f'\n        {MARK}encoding: "0100 dddd d000 00nn"', "NP402", "register 'rd' needs 4 bits"),
    "number too narrow": Case('encoding: "0010 dddd iiii iiii"', f'\n        {MARK}encoding: "0010 dddd 0iii iiii"', "NP402", "operand 'imm' needs more than 7 bits"),
    "condition too narrow": Case("  NE: {code: 1", "  NE: {code: 16", "NP402", "operand 'cc' needs more than 4 bits"),
    "overlapping encodings": Case('  - group: two\n    name: NBR', f"{MARK}  - group: two\n    name: NBR", "NP402", ""),
    "alias of nothing": Case('encoding: "0010 dddd 0000 0001"', 'encoding: "0110 dddd 0000 0001"', "NP402", "ADD: the alias 'INC {rd}' is no word of it"),
    # semantics
    "unknown name": semantics("rd = rd + z", "unknown name 'z'"),
    "near name": semantics("rd = rd + rowe", "unknown name 'rowe'; did you mean 'row'?"),
    "unknown function": semantics("C = carri(rd, y)", "unknown function 'carri'; did you mean 'carry'?"),
    "unknown effect": semantics("hlat()", "unknown effect 'hlat'; did you mean 'halt'?"),
    "bit where byte expected": semantics("rd = Z", "expected a byte, found a bit: 'Z'"),
    "byte where bit expected": semantics("C = rd + y", "expected a bit, found a byte: 'rd + y'"),
    "wire where bit expected": semantics("C = any(Z)", "expected a bit, found a wire"),
    "bit where wire expected": semantics("if Z: halt()", "expected a wire, found a bit"),
    "wire with a name of its own": semantics("w = any(Z)", "expected a byte, found a wire"),
    "shift by a register": semantics("rd = rd << rd", "expected a constant, found a byte"),
    "jump to a register": semantics("jump(rd)", "expected a constant, found a byte"),
    "constant too large": semantics("rd = 256", "256 does not fit in a byte (0 to 255)"),
    "bit number too large": semantics("C = rd[8]", "a byte has the bits 0 to 7, found 8"),
    "operator of no ALU": semantics("rd = rd * y", "the ALU has only"),
    "chained comparison": semantics("Z = 1 < rd < 3", "is not part of the language"),
    "boolean": semantics("Z = True", "'True' is not part of the language"),
    "attribute": semantics("rd = rd.real", "is not part of the language"),
    "call of a call": semantics("rd.real()", "unknown effect 'rd.real'"),
    "too few arguments": semantics("C = carry(rd)", "carry() takes 2 or 3 arguments, found 1"),
    "too many arguments": semantics("halt(rd)", "halt() takes 0 arguments, found 1"),
    "keyword argument": semantics("C = carry(rd, y=y)", "carry() takes 2 or 3 arguments"),
    "assigning an immediate": semantics("y = rd", "'y' is not a register in every form"),
    "assigning a reserved name": semantics("row = rd", "'row' cannot be assigned"),
    "two targets": semantics("rd = C = 0", "expected an assignment"),
    "adding in place": semantics("rd += y", "expected an assignment"),
    "import": semantics("import os", "expected an assignment"),
    "no Python": semantics("rd = = y", "cannot be read"),
    "too deep": semantics(f"rd = {'~' * 5000}rd", "cannot be read"),
    "after a jump": Case(SUM, f"      halt()\n      {MARK}rd = rd + y\n", "NP403", "nothing may follow"),
    "after a jump in an if": Case("        jump(to)\n", f"        jump(to)\n        {MARK}halt()\n", "NP403", "nothing may follow"),
    "assignment in an if": Case("        jump(to)\n", f"        {MARK}Z = Z\n", "NP403", "JANY: semantics: an if may hold effects only"),
    "else": Case("      if any(cc):\n        jump(to)\n", f"      {MARK}if any(cc):\n        jump(to)\n      else:\n        halt()\n", "NP403", "expected an assignment"),
    "mask in an if": Case("        jump(to)\n", f"        {MARK}mask_pop()\n", "NP403", "an address has one mask depth"),
    "plain semantics": Case("    semantics: sample(level, 0)", f"    {MARK}semantics: sample(1, 0)", "NP403", "SNAP: semantics: expected a name, found a constant: '1'"),
    "block of one line": Case("    semantics: sample(level, 0)", f"    semantics: |\n      {MARK}snap(level, 0)", "NP403", "SNAP: semantics: unknown effect 'snap'"),
    "block that begins with empty lines": Case("    semantics: sample(level, 0)", f"    semantics: |\n\n\n      {MARK}snap(level, 0)", "NP403", "SNAP: semantics: unknown effect 'snap'"),
    "definition of a form": Case('let: {y: "1"}', f'\n        let: {{\n        {MARK}y: "one"}}', "NP403", "ADD: y: unknown name 'one'"),
    "strange directions": Case("    semantics: sample(level, 0)", f"    {MARK}semantics: mem[0] = neighbour(row, level)", "NP403", "SNAP: operand 'level' may only be north, east, south, west; found 'reset'"),
    "strange levels": Case("    semantics: rd = neighbour(rd, where)", f"    {MARK}semantics: sample(where, 0)", "NP403", "NBR: operand 'where' may only be reset, signal; found 'north'"),
}  # fmt: skip
