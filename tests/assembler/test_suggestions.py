"""Words of other assemblers: each gets the hint that names the way to say it here."""

from __future__ import annotations

import pytest

from npchip.assembler import assemble_text
from npchip.assembler.diagnostics import AssemblyError
from npchip.assembler.suggestions import INSTEAD

MNEMONICS = {
    "(a | b) - (a & b)": "XOR EOR",
    "255 - a": "NOT MVN",
    "0 - a": "NEG",
    "multiply by shifts": "MUL MULT IMUL",
    "divide by shifts": "DIV IDIV UDIV",
    "ADD rd, #1": "INC",
    "SUB rd, #1": "DEC",
    "MOV rd, #0": "CLR",
    "mean MOV?": "MOVE",
    "MOV rd, #imm": "LDI",
    "ADD rd, #imm": "ADDI",
    "SUB rd, #imm": "SUBI",
    "AND rd, #imm": "ANDI",
    "mean OR?": "ORR",
    "then AND": "TST TEST",
    "mean SHL?": "LSL SLL SAL",
    "mean SHR?": "LSR SRL",
    "only SHR": "ASR SAR SRA",
    "ADC rd, rd": "ROL RLC RCL",
    "RCR rd": "ROR RRC",
    "mean LD?": "LDR LDRB LOAD LW LB",
    "mean ST?": "STR STRB STORE SW SB",
    "no data stack": "PUSH POP",
    "mean CALL?": "BL JSR JAL",
    "mean JMP?": "B BRA GOTO BR JUMP J",
    "mean RET?": "RETURN RTS BX",
    "mean HALT?": "STOP EXIT HLT",
    "JANY EQ": "JZ JE JEQ BEQ BZ",
    "JANY NE": "JNZ JNE BNE BNZ",
    "JANY LO": "JC JB JL JLO JCS BCS BLO BLT JLT",
    "JANY HS": "JNC JAE JGE JHS JCC BCC BHS BGE",
    "JANY HI": "JA JG JHI BHI BGT JGT",
    "JANY LS": "JBE JLE JLS BLS BLE",
    "WHERE cc, ELSE and END": "IF ENDIF THEN ENDWHERE ELSEWHERE WHILE FOR",
}
OPERANDS = {
    "WHERE": {
        "LO": "LT B",
        "HS": "GE AE PL",
        "HI": "GT A",
        "EQ": "Z",
        "NE": "NZ",
        "CS": "C",
        "CC": "NC",
        "LS": "LE BE",
        "a borrow is LO": "MI",
    },
    "NBR r1, r2,": {"north": "up", "south": "down", "west": "left", "east": "right"},
}


def hint(line: str) -> str:
    """The hint for a wrong line."""
    with pytest.raises(AssemblyError) as caught:
        assemble_text(f"{line}\nHALT")
    (diagnostic,) = caught.value.diagnostics
    return diagnostic.suggestion or ""


def test_mnemonics_of_other_assemblers() -> None:
    words = [(word, says) for says, words in MNEMONICS.items() for word in words.split()]
    assert {word for word, _ in words} == set(INSTEAD)
    for word, says in words:
        assert says in hint(f"{word} r1, r2"), word
        assert says in hint(f"{word.lower()} r1, r2"), word


@pytest.mark.parametrize("before", OPERANDS)
def test_conditions_and_directions_of_other_assemblers(before: str) -> None:
    for says, words in OPERANDS[before].items():
        for word in words.split():
            assert says in hint(f"{before} {word}"), word
