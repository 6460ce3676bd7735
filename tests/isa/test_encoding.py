"""All 65,536 words: which are defined, what they decode to, and the way back."""

from __future__ import annotations

from collections import Counter
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pytest

from npchip.assembler import assemble_text, disassemble_word
from npchip.isa import load_isa
from tests.support.chips import word

if TYPE_CHECKING:
    from npchip.isa import Decoded, Form

WORDS = range(1 << 16)

# Words of each instruction, counted from its operands: 16 registers, 256 constants or addresses,
# 4 banks, 7 shift counts, 4 directions, 6 conditions, 512 targets, 2 levels, 16 ports.
COUNTS = (
    dict.fromkeys(("ADD", "ADC", "SUB", "SBC", "CMP", "AND", "OR"), 16 * 16 + 16 * 256)
    | {"MOV": 16 * 16 + 16 * 256}
    | {"LD": 16 * 256 + 16 * 16 * 4, "ST": 16 * 256 + 16 * 16 * 4}
    | {"SHL": 16 * 7, "SHR": 16 * 7, "RCR": 16, "NBR": 16 * 16 * 4, "ROW": 16, "COL": 16}
    | {"WHERE": 6, "ELSE": 1, "END": 1}
    | {"JMP": 512, "JANY": 6 * 512, "JNONE": 6 * 512, "CALL": 512}
    | {"RET": 1, "HALT": 1, "NOP": 1, "EXPOSE": 1, "SAMPLE": 2 * 4}
    | {"OUT": 16 * 16, "IN": 16 * 16}
)
OPPOSITES = {"EQ": "NE", "NE": "EQ", "LO": "HS", "HS": "LO", "HI": "LS", "LS": "HI"}
REGISTERS = [f"r{number}" for number in range(16)]
ALIASES = {  # each other way to write a word, and the way that the disassembler writes it
    "LD {rd}, [{rs}]": [
        (f"LD {d}, [{s}]", f"LD {d}, [{s} + 0]") for d in REGISTERS for s in REGISTERS
    ],
    "ST [{ra}], {rs}": [
        (f"ST [{d}], {s}", f"ST [{d} + 0], {s}") for d in REGISTERS for s in REGISTERS
    ],
    "JALL {cc:not_cc}, {target}": [
        (f"JALL {cc}, {target}", f"JNONE {opposite}, {target}")
        for cc, opposite in OPPOSITES.items()
        for target in (0, 1, 255, 256, 511)
    ],
}


@cache
def decoded_words() -> dict[int, Decoded]:
    """Every word that is defined, taken apart."""
    isa = load_isa()
    return {number: found for number in WORDS if (found := isa.decode(number)) is not None}


def real_forms() -> list[Form]:
    return [
        form for item in load_isa().instructions.values() for form in item.forms if not form.alias
    ]


def test_decode_then_encode_gives_the_word() -> None:
    isa = load_isa()
    for number, found in decoded_words().items():
        assert isa.encode(found.form, found.values) == number


def test_each_instruction_has_the_words_of_its_operands() -> None:
    """Nothing is lost, nothing is defined that has no meaning."""
    assert Counter(found.form.instruction for found in decoded_words().values()) == COUNTS


def test_two_words_never_mean_the_same() -> None:
    texts = {disassemble_word(number, load_isa()) for number in decoded_words()}
    assert None not in texts
    assert len(texts) == len(decoded_words()) == sum(COUNTS.values())


def test_undefined_words() -> None:
    defined = decoded_words()
    assert 0x0000 not in defined  # an empty memory
    assert 0xFFFF not in defined  # an erased one
    assert not any(number >> 12 == 0xF for number in defined)  # the major opcode for users
    assert {number >> 12 for number in defined} == set(range(0xF))
    # Conditions 6 and 7 do not exist; neither do shifts by 0.
    for base in (word("JANY", cc="EQ", target=5), word("JNONE", cc="EQ", target=5)):
        assert [base | code << 9 in defined for code in range(8)] == [True] * 6 + [False] * 2
    for name in ("SHL", "SHR"):
        one = word(name, rd=3, count=1)
        assert [one & ~0x70 | count << 4 in defined for count in range(8)] == [False] + [True] * 7


def test_no_word_has_two_forms() -> None:
    numbers = np.arange(1 << 16)
    matches = np.zeros(1 << 16, np.int64)
    for form in real_forms():
        matches += numbers & form.mask == form.match
    assert matches.max() == 1
    assert all(matches[number] == 1 for number in decoded_words())


def test_masks_follow_from_patterns() -> None:
    assert real_forms()
    for form in real_forms():
        bits = form.pattern.replace(" ", "")
        assert len(bits) == 16
        for place, bit in enumerate(reversed(bits)):
            fixed, value = form.mask >> place & 1, form.match >> place & 1
            assert (fixed, value) == {"0": (1, 0), "1": (1, 1)}.get(bit, (0, 0))
        letters = Counter(bit for bit in bits if bit.isalpha())
        assert letters == {slot.operand.letter: slot.width for slot in form.slots.values()}


def test_every_alias_is_tried() -> None:
    aliases = [f.syntax for item in load_isa().instructions.values() for f in item.forms if f.alias]
    assert sorted(aliases) == sorted(ALIASES)


@pytest.mark.parametrize("syntax", ALIASES)
def test_alias_is_a_real_word_of_the_same_meaning(syntax: str) -> None:
    isa = load_isa()
    for written, meant in ALIASES[syntax]:
        # Behind a HALT, so that the masks of what cannot be reached do not matter.
        program = assemble_text(f"HALT\n{written}\n{meant}")
        assert program.words[1] == program.words[2]
        found = isa.decode(program.words[1])
        assert found is not None
        assert not found.form.alias


BY_HAND = {  # worked out from the tables of docs/isa.md
    "ST [0x12], r3": 0xA312,
    "ST [r4 + 128], r3": 0xB43E,
    "LD r1, [r2 + 192]": 0xB12B,
    "OUT 5, r3": 0x0358,
    "IN r3, 5": 0x0353,
    "SHL r2, #7": 0x0271,
    "SHR r2, #1": 0x0291,
    "NBR r1, r2, north": 0x0124,
    "NBR r1, r2, east": 0x0125,
    "NBR r1, r2, south": 0x0126,
    "NBR r1, r2, west": 0x0127,
    "SAMPLE reset, 64": 0x008B,
    "SAMPLE signal, 128": 0x030B,
    "JANY EQ, 5": 0xC005,
    "JANY NE, 5": 0xC205,
    "JANY LO, 5": 0xC405,
    "JNONE HS, 261": 0xD705,
    "JNONE HI, 5": 0xD805,
    "JNONE LS, 5": 0xDA05,
    "JALL EQ, 5": 0xD205,
    "JMP 261": 0xE105,
    "CALL 261": 0xE305,
}


@pytest.mark.parametrize("line", BY_HAND)
def test_words_are_those_that_the_manual_s_tables_give(line: str) -> None:
    """Codes of conditions, directions, levels and banks; in a direct store the register is dddd."""
    assert assemble_text(f"HALT\n{line}").words[1] == BY_HAND[line]


def test_conditions_come_in_opposite_pairs() -> None:
    isa = load_isa()
    assert list(isa.conditions) == list(OPPOSITES)
    for name, condition in isa.conditions.items():
        assert isa.conditions[OPPOSITES[name]].code == condition.code ^ 1
    assert isa.condition_names["CS"] is isa.conditions["LO"]
    assert isa.condition_names["CC"] is isa.conditions["HS"]


def test_flags_that_instructions_write() -> None:
    written = {name: item.flags for name, item in load_isa().instructions.items() if item.flags}
    both, only_zero = ("Z", "C"), ("Z",)
    assert written == dict.fromkeys(("ADD", "ADC", "SUB", "SBC", "CMP"), both) | {
        **dict.fromkeys(("AND", "OR"), only_zero),
        **dict.fromkeys(("SHL", "SHR", "RCR"), both),
    }
