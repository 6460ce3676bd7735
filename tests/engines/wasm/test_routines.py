"""Routines, which are copied for each caller."""

from __future__ import annotations

from dataclasses import replace

import pytest

from npchip import Chip, assemble_text
from npchip.engines.base import TrapError
from npchip.isa import parse_isa
from tests.engines.wasm.test_extended import entry
from tests.support.chips import machine_of
from tests.support.lockstep import assert_engines_agree, state, state_difference, tight
from tests.support.random_cases import Case

MACHINE = machine_of(2, 8)
TREE = (
    "CALL a0\n" * 20
    + "HALT\n"
    + "".join(f"a{n}:\n" + f"CALL a{n + 1}\n" * 20 + "RET\n" for n in range(3))
    + "a3: ADD r0, #1\nRET\n"
)
"""Its innermost routine would have to be copied 160,000 times."""
PROGRAMS = {
    "callers": "COL r0\nCALL sub\nADD r1, r0\nCALL sub\nSUB r1, #3\nHALT\nsub: ADD r0, r0\nRET",
    "nested": (
        "COL r0\nCALL a\nCALL b\nCALL a\nHALT\n"
        "a: ADD r1, r0\nCALL b\nCALL b\nADC r2, r1\nRET\nb: ADD r0, #37\nRET"
    ),
    "uniform for one caller only": (
        "MOV r0, #5\nCALL sub\nMOV r2, r1\nCOL r0\nCALL sub\nHALT\nsub: ADD r1, r0\nRET"
    ),
    "needed by one caller only": (
        "CALL sub\nMOV r5, #0\nCALL sub\nADD r6, r5\nHALT\n"
        "sub: CMP r0, #9\nJANY HS, other\nMOV r5, #3\nRET\nother: MOV r5, #4\nRET"
    ),
    "returns to where others jump": (
        "MOV r3, #2\nCALL sub\nback: ADD r1, r3\nSUB r3, #1\nJANY HS, back\nCALL sub\nHALT\n"
        "sub: ADD r2, #1\nRET"
    ),
    "two ends": (
        "COL r0\nCMP r0, #3\nCALL sub\nCMP r0, #99\nCALL sub\nHALT\n"
        "sub: JANY HS, some\nADD r1, #1\nRET\nsome: ADD r2, #7\nRET"
    ),
    "two routines": ("CALL a\nCALL b\nCALL a\nHALT\na: ADD r0, #1\nRET\nb: ADD r1, #1\nRET"),
    "ends with another": "CALL a\nCALL b\nHALT\na: ADD r0, #1\nJMP b\nb: ADD r1, #2\nRET",
    "overflow": "ADD r0, #1\nCALL sub\nHALT\nsub: ADD r1, #1\nCALL sub\nRET",
    "never called": "ADD r0, #1\nRET",
    "one return too many": "CALL sub\nADD r0, #1\nRET\nsub: ADD r1, #1\nRET",
    "stops in a routine": "CALL sub\nHALT\nsub: ADD r1, #1\nCALL deep\nRET\ndeep: HALT",
    "frames in a routine": (
        ".output x, 1, list\nframe: CALL take\nCALL take\nJMP frame\n"
        "take: EXPOSE\nSAMPLE signal, 0\nLD r0, [9]\nOUT 1, r0\nRET"
    ),
    "inputs in a routine": "frame: EXPOSE\nCALL take\nCALL take\nJMP frame\ntake: IN r1, 1\nRET",
}


def _case(text: str, limit: int = 5_000, **rest: object) -> Case:
    return Case(text + "\n", MACHINE, 6, 5, limit, again=True, tight=True, **rest)  # type: ignore[arg-type]


@pytest.mark.parametrize("text", PROGRAMS.values(), ids=PROGRAMS)
def test_routines_and_their_copies(text: str) -> None:
    assert_engines_agree(_case(text, partner="stops"))


MASKED = {
    "opens a region": (
        "COL r0\nCMP r0, #3\nCALL open\nADD r1, #1\n.word 0xFFFE\nCMP r0, #5\nCALL open\n"
        "ADD r1, #9\n.word 0xFFFE\nHALT\nopen: WHERE LO\n.word 0xFFFF"
    ),
    "called at two depths": (
        "COL r0\nCALL sub\nCMP r0, #3\nWHERE LO\n.word 0xFFFD\nEND\nCALL sub\nHALT\n"
        "sub: ADD r1, r0\nRET"
    ),
    "closes a region that is not open": "CALL a\nHALT\na: CALL b\n.word 0xFFFE\nRET\nb: RET",
}
"""With words that the assembler would not let be there, written as others that mean nothing."""
WORDS = {0xFFFF: 0x003A, 0xFFFE: 0x005A, 0xFFFD: 0xE208}  # RET, END, CALL 8


@pytest.mark.parametrize("text", MASKED.values(), ids=MASKED)
def test_routines_that_change_the_mask(text: str) -> None:
    program = assemble_text(text, "test.s", MACHINE)
    program = replace(program, words=tuple(WORDS.get(word, word) for word in program.words))
    chips = [Chip(program, MACHINE, engine) for engine in ("reference", "wasm")]
    with tight():
        ends = [_end(chip) for chip in chips]
    assert ends[0] == ends[1]
    assert not state_difference(*map(state, chips))


def _end(chip: Chip) -> str:
    try:
        return chip.run().status
    except TrapError as error:
        return str(error)


@pytest.mark.parametrize("limit", range(1, 40))
def test_a_limit_within_a_routine(limit: int) -> None:
    assert_engines_agree(_case(PROGRAMS["nested"], limit))


@pytest.mark.parametrize("profile", [False, True])
def test_a_program_with_countless_copies_is_left_to_the_reference_engine(*, profile: bool) -> None:
    chip = Chip(assemble_text(TREE, "test.s", MACHINE), MACHINE, profile=profile)
    result = chip.run(max_cycles=5_000)
    assert "copied too often: the reference engine" in chip.notice
    assert (result.engine, result.cycles) == ("reference", 5_000)


RECEIVING = parse_isa(
    "extends: npchip\nname: test\ninstructions:\n"
    + entry("ASK", "{target}", "1111 000t tttt tttt", "Z = input(1) < 100\ncall(target)")
    + entry("ANSWER", "", "1111 0010 0000 0000", "C = input(1) < 100\nret()"),
    "test.yaml",
)


@pytest.mark.parametrize(
    "text", ["CALL s\nHALT\ns: ADD r0, #1\nASK s\nRET", "CALL s\nADD r1, #1\ns: ADD r0, #1\nANSWER"]
)
def test_a_call_that_traps_has_not_received(text: str) -> None:
    assert_engines_agree(_case(text, isa=RECEIVING, partner="sends"))
