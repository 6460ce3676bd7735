"""Macros, repetitions and conditions: what they expand to."""

from __future__ import annotations

import pytest

from npchip.assembler import assemble_text


def words(text: str) -> tuple[int, ...]:
    return assemble_text(text).words


# ---- macros and repetitions


def test_macro_labels_are_its_own() -> None:
    program = assemble_text(
        ".macro wait reg\n.again: SUB reg, #1\nJANY NE, .again\n.endm\n"
        "start: .again: wait r1\nwait r2\nJMP .again\n"
    )
    targets = [program.words[at] & 0x1FF for at in (1, 3, 4)]
    assert targets == [0, 2, 0]


def test_a_local_label_as_argument_is_that_of_the_caller() -> None:
    program = assemble_text(
        ".macro unless cc, to\n.skip: JNONE cc, to\nJMP .skip\n.endm\n"
        "start: unless EQ, .skip\n.skip: HALT\n"
    )
    assert [word & 0x1FF for word in program.words[:2]] == [2, 0]


def test_a_global_label_in_a_macro() -> None:
    program = assemble_text(".macro routine name\nname: RET\n.endm\nCALL f\nHALT\nroutine f\n")
    assert program.labels == {"f": 2}


def test_arguments_keep_together() -> None:
    macro = ".macro set x\nMOV r0, #x * 2\n.endm\n"
    assert words(f"{macro}set 1 + 2\nHALT") == words("MOV r0, #6\nHALT")
    assert words(f"{macro}set (1) + (2)\nHALT") == words("MOV r0, #6\nHALT")
    assert words(f"{macro}set -1 + 2\nHALT") == words("MOV r0, #2\nHALT")


def test_arguments_may_be_any_operands() -> None:
    macro = ".macro load to, what\nLD to, [what]\nMOV r9, to\n.endm\n.reg p, r3\n"
    assert words(f"{macro}load r1, p + 64\nHALT") == words("LD r1, [r3 + 64]\nMOV r9, r1\nHALT")
    assert words(f"{macro}load r1, 60 + 4\nHALT") == words("LD r1, [64]\nMOV r9, r1\nHALT")
    assert words(".macro put y\nADD r0, y\n.endm\nput #3 + 4\nput r1\nHALT") == (
        words("ADD r0, #7\nADD r0, r1\nHALT")
    )


def test_macro_parameters_after_a_comma_or_not() -> None:
    body = "ADD a, b\n.endm\nsum r1, r2\nHALT"
    assert words(f".macro sum a, b\n{body}") == words(f".macro sum, a, b\n{body}")


def test_arguments_are_not_searched_for_parameters() -> None:
    text = (
        ".macro inner a, b\nMOV a, #b\n.endm\n"
        ".macro outer b, a\ninner b, a\n.rept 2, i\nADD b, #a + i\n.endr\n.endm\n"
        ".reg i, r5\n.equ b, 7\nouter i, b\nHALT"
    )
    assert words(text) == words("MOV r5, #7\nADD r5, #7\nADD r5, #8\nHALT")


def test_macros_that_use_themselves_end_by_a_condition() -> None:
    text = ".macro down n\n.if n > 0\nMOV r0, #n\ndown n - 1\n.endif\n.endm\ndown 20\nHALT"
    assert words(text) == words("".join(f"MOV r0, #{n}\n" for n in range(20, 0, -1)) + "HALT")


def test_rept() -> None:
    assert words(".rept 0\nNOP\n.endr\n.rept 3, i\nMOV r0, #i * 2\n.endr\nHALT") == (
        words("MOV r0, #0\nMOV r0, #2\nMOV r0, #4\nHALT")
    )
    nested = ".rept 2, i\n.rept 3, j\nMOV r0, #10 * i + j\n.endr\n.endr\nHALT"
    assert words(nested) == (
        words("".join(f"MOV r0, #{10 * i + j}\n" for i in range(2) for j in range(3)) + "HALT")
    )


def test_local_labels_of_a_repetition() -> None:
    program = assemble_text("a: .rept 2\nJANY EQ, .out\nJMP .end\n.out:\n.endr\n.end: HALT\n")
    assert [word & 0x1FF for word in program.words[:4]] == [2, 4, 4, 4]


# ---- conditions


@pytest.mark.parametrize(("n", "expected"), [(1, "#10"), (2, "#20"), (3, "#30"), (4, "#40")])
def test_if(n: int, expected: str) -> None:
    text = (
        ".equ N, 0\n.if N == 1\nMOV r0, #10\n.elif N == 2\nMOV r0, #20\n"
        ".elif N == 3\nMOV r0, #30\n.else\nMOV r0, #40\n.endif\nHALT"
    )
    assert assemble_text(text, defines={"N": n}).words == words(f"MOV r0, {expected}\nHALT")


def test_what_a_condition_leaves_out_is_not_looked_at() -> None:
    text = ".if 0\nnonsense #\nMOV r0, #UNKNOWN\n.equ A, 1 / 0\n.if ALSO\n.endif\n.endif\nHALT"
    assert words(text) == words("HALT")
    assert words(".if 1\nHALT\n.elif 1 / 0\n.endif") == words("HALT")


def test_ifdef() -> None:
    text = ".ifndef N\n.equ N, 5\n.endif\n.ifdef N\nMOV r0, #N\n.else\nNOP\n.endif\nHALT"
    assert words(text) == words("MOV r0, #5\nHALT")
    assert words(f".equ N, 6\n{text}") == words("MOV r0, #6\nHALT")
    assert words(".macro m\n.endm\n.ifdef m\nNOP\n.endif\n.ifdef ROWS\nNOP\n.endif\nHALT") == (
        words("NOP\nNOP\nHALT")
    )
    assert words(".ifdef later\nNOP\n.endif\nHALT\n.equ later, 1") == words("HALT")


def test_conditions_and_labels() -> None:
    """A label in a branch is one of the program; a local label after it belongs to it."""
    text = "a: .x: NOP\n.if 1\nb:\n.x: NOP\n.endif\nJMP .x\nc: .if ROWS == 64\n.x: JMP .x\n.endif\n"
    assert [word & 0x1FF for word in words(text)[2:]] == [1, 3]


def test_conditions_see_the_addresses_above() -> None:
    assert len(words("a: NOP\nb: .if b - a == 1\nNOP\n.endif\n.rept 4 - (b - a)\nNOP\n.endr")) == 5


def test_labels_beside_directives() -> None:
    program = assemble_text("a: .rept 2\nNOP\nJMP .x\n.x: .endr\nb: .if 1\nNOP\nc: .endif\nHALT\n")
    assert program.labels == {"a": 0, "b": 4, "c": 5}
    assert [word & 0x1FF for word in program.words[1:4:2]] == [2, 4]
