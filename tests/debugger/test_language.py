"""Conditions as text: what they mean, and what is said about mistakes."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from npchip import assemble
from npchip.debugger.commands import Commands
from npchip.debugger.conditions import Changes, Compare, MaskEmpty, Sent
from npchip.debugger.language import CommandError, parse_condition
from npchip.debugger.session import Debugger
from npchip.debugger.values import Cell, Counter, One, Pixel
from npchip.program.model import Program

ROOT = Path(__file__).parents[2]
PROGRAM = assemble(ROOT / "asm" / "keypoints.s", defines={"THRESHOLD": 190})
DEBUGGER = Debugger(PROGRAM)
NAMES = DEBUGGER.names


@pytest.mark.parametrize(
    ("text", "test"),
    [
        ("any r3 > 40", Compare(Cell("register", 3), ">", 40, "any")),
        ("all seed == 0x10", Compare(Cell("register", 4), "==", 16, "all")),
        ("any Z == 1", Compare(Cell("flag", "Z"), "==", 1, "any")),
        ("all active != 0", Compare(Cell("active"), "!=", 0, "all")),
        ("np(3,4).r3 == 7", Compare(One(Cell("register", 3), 3, 4), "==", 7)),
        ("np( 7 , 9 ) . C <= 0", Compare(One(Cell("flag", "C"), 7, 9), "<=", 0)),
        ("np(0,0).mem[FOUND] >= 2", Compare(One(Cell("memory", 240), 0, 0), ">=", 2)),
        ("np(0,0).mem[BITS+3*2-1] < -1", Compare(One(Cell("memory", 133), 0, 0), "<", -1)),
        ("pixel(20,33) < 10", Compare(Pixel(20, 33), "<", 10)),
        ("pixel(20,33,64) > 5", Compare(One(Cell("memory", 64 + 33), 2, 4), ">", 5)),
        ("mask empty", MaskEmpty()),
        ("frame == 3", Compare(Counter("frame"), "==", 3)),
        ("pc == scan", Compare(Counter("pc"), "==", 48)),
    ],
)
def test_tests(text: str, test: object) -> None:
    condition = parse_condition(f"  {text}  ; a remark", NAMES)
    assert (condition.text, condition.test) == (text, test)
    assert not condition.places
    assert condition.event is None
    assert condition.triggers


@pytest.mark.parametrize(
    ("text", "event"),
    [
        ("np(3,4).mem[0x12] changes", Changes(One(Cell("memory", 0x12), 3, 4))),
        ("run changes", Changes(Cell("register", 8))),
        ("output 2", Sent(2)),
        ("output points", Sent(2)),
        ("output objects > 3", Sent(0, ">", 3)),
    ],
)
def test_events(text: str, event: object) -> None:
    condition = parse_condition(text, NAMES)
    assert condition.event == event
    assert condition.triggers


@pytest.mark.parametrize(
    ("text", "places"),
    [
        ("scan", {48}),
        ("scan + 3", {51}),
        ("48", {48}),
        ("0x1F", {31}),
        ("edge_tracer.s:158", {49}),
        ("lib/edge_tracer.s:158", {49}),
        ('"keypoints.s":48', {277}),
        ("line 48", {277}),
        ("line 47", {277}),  # a remark: the next instruction
    ],
)
def test_places(text: str, places: set[int]) -> None:
    assert parse_condition(text, NAMES).places == places


def line_of(start: str) -> int:
    lines = (ROOT / "asm" / "lib" / "edge_tracer.s").read_text(encoding="utf-8").splitlines()
    return next(number for number, line in enumerate(lines, 1) if line.startswith(start))


def test_a_line_of_a_macro_stands_for_all_its_uses() -> None:
    number = line_of(".macro mark") + 1
    assert len(parse_condition(f"edge_tracer.s:{number}", NAMES).places) == 2


def test_a_place_may_have_a_test() -> None:
    condition = parse_condition("scan if any y > 3", NAMES)
    assert condition.places == {48}
    assert condition.test == Compare(Cell("register", 0), ">", 3, "any")


@pytest.mark.parametrize(
    ("text", "column", "said", "helped"),
    [
        ("scna", 1, "no label 'scna' [NP351]", "scan"),
        ("any r16 > 3", 5, "no register 'r16' [NP351]", "r0 to r15"),
        ("r3 > 40", 4, "expected 'changes', found '>' [NP350]", "any r3 > ..., all r3 > ..."),
        ("any np(0,0).r3 > 4", 5, "one number [NP351]", "leave it out"),
        ("any r3 = 4", 8, "expected one of ==", "did you mean ==?"),
        ("any r3 >", 9, "expected a number, found the end of the line [NP350]", ""),
        ("np(8,0).r3 == 1", 4, "expected the NP's row from 0 to 7, found 8 [NP351]", ""),
        ("np(0,10).r3 == 1", 6, "expected the NP's column from 0 to 9, found 10", ""),
        ("np(0,0).sed == 1", 9, "no register or label 'sed' [NP351]", "did you mean seed?"),
        ("np(0,0).mem[256] == 1", 13, "expected an address from 0 to 255, found 256", ""),
        ("pixel(64,0) < 1", 7, "expected the pixel's row from 0 to 63, found 64", ""),
        ("pixel(0,0,5) < 1", 11, "5 is not the first byte of a bank", "0, 64, 128 or 192"),
        ("mask full", 6, "expected 'empty', found 'full' [NP350]", ""),
        ("output 16", 8, "expected a port or the name of an output from 0 to 15", ""),
        ("output pionts", 8, "no output 'pionts' [NP351]", "did you mean points?"),
        ("edge_tracr.s:3", 1, "no source file 'edge_tracr.s'", "did you mean edge_tracer.s?"),
        ("line 999", 6, "has no instruction below line", ""),
        ("999", 1, "address 999: the program ends at 297 [NP351]", ""),
        ("scan iff any r3 > 4", 6, "expected 'if' or the end of the line, found 'iff'", "mean if?"),
        ("scan 3", 6, "expected 'if' or the end of the line, found '3' [NP350]", ""),
        ("any r3 > 4 5", 12, "expected the end of the line, found '5' [NP350]", ""),
        ("any r3 > 0xZZ", 10, "'0xZZ' is not a number [NP350]", "hexadecimal"),
        ("any r3 > 9*9*", 14, "expected a number, found the end of the line [NP350]", ""),
        ("any r3 > NOWHERE +", 10, "no constant or label 'NOWHERE' [NP351]", ""),
        (
            f"any r3 > {'99999*' * 5}1",
            27,
            "the result is larger than 62 bits [NP350]",
            "",
        ),
        ("any r3 § 4", 8, "unexpected character U+00A7 (SECTION SIGN) [NP350]", ""),
        ("", 1, "expected a place or a condition, found the end of the line [NP350]", ""),
    ],
)
def test_mistakes_show_their_place(text: str, column: int, said: str, helped: str) -> None:
    with pytest.raises(CommandError) as caught:
        parse_condition(text, NAMES, "x.dbg", 7)
    message = str(caught.value)
    assert message.startswith(f"x.dbg:7:{column}: error: "), message
    assert said in message
    assert helped in message


def test_a_program_without_source_has_addresses_only() -> None:
    names = Debugger(Program("raw", PROGRAM.words)).names
    assert parse_condition("48", names).places == {48}
    with pytest.raises(CommandError, match="no source"):
        parse_condition("line 3", names)


@given(text=st.text(st.sampled_from('np(0,1).r3[]mem if any <>=!+-*/:;"0x12 pixelou'), max_size=40))
def test_nothing_else_is_ever_raised(text: str) -> None:
    debugger = Debugger(Program("raw", (0x001A, 0x002A)))
    for line in (text, f"break {text}", f"print {text}", f"edit {text}", f"expect {text}"):
        with suppress(CommandError):
            Commands(debugger).execute(line)
