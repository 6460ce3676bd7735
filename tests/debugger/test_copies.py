"""Lines that the assembler copies: breakpoints and the cursor stop at every copy."""

from __future__ import annotations

from pathlib import Path

import pytest

from npchip import Program, assemble, assemble_text
from npchip.debugger.language import CommandError, parse_condition
from npchip.debugger.session import Debugger
from npchip.formats.npo import from_text, to_text
from npchip.isa import load_isa
from tests.support.screen_driver import Driver, drive

SIDE_BY_SIDE = """.macro twice x
 ADD x, #1
 ADD x, #2
.endm
 NOP
.rept 3
 ADD r0, #1
.endr
.rept 2
 twice r1
.endr
 HALT
"""


def places(program: Program, *texts: str) -> list[list[int]]:
    names = Debugger(program).names
    return [sorted(parse_condition(text, names).places) for text in texts]


def test_copies_side_by_side_are_stops_of_their_own() -> None:
    program = assemble_text(SIDE_BY_SIDE, "x.s")
    lines = ("x.s:7", "x.s:6", "line 10", "line 2", "line 3", "line 9")
    expected = [[1, 2, 3], [1], [4, 6], [4, 6], [5, 7], [4]]
    assert places(program, *lines) == expected
    again = from_text(to_text(program, load_isa()), "x.npo", load_isa())
    assert again == program
    assert places(again, *lines) == expected
    debugger = Debugger(program)
    debugger.add("x.s:7")
    assert [(debugger.run().reason, debugger.chip.pc) for _ in range(4)] == [
        ("breakpoint", 1),
        ("breakpoint", 2),
        ("breakpoint", 3),
        ("halted", 9),
    ]


def test_a_file_included_again_is_a_copy(tmp_path: Path) -> None:
    (tmp_path / "one.s").write_text(" ADD r0, #1\n", encoding="utf-8")
    main = tmp_path / "main.s"
    main.write_text('.rept 2\n.include "one.s"\n.endr\n.include "one.s"\n HALT\n', encoding="utf-8")
    program = assemble(main)
    assert places(program, "one.s:1", "main.s:5") == [[0, 1, 2], [3]]
    assert from_text(to_text(program, load_isa()), "x.npo", load_isa()) == program


def test_files_of_the_same_name_are_told_apart(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "part.s").write_text(" NOP\n NOP\n", encoding="utf-8")
    main = tmp_path / "part.s"
    main.write_text('.include "a/part.s"\n.include "b/part.s"\n NOP\n HALT\n', encoding="utf-8")
    program = assemble(main)
    assert places(program, "a/part.s:1", "b/part.s:2", f'"{main}":3') == [[0], [3], [4]]
    names = Debugger(program).names
    with pytest.raises(CommandError, match=r"3 source files are called 'part\.s'"):
        parse_condition("part.s:1", names)
    assert names.line_called(str(tmp_path / "b" / "part.s"), 1) == "b/part.s:1"
    assert names.line_called(str(main), 3) == f"{tmp_path.name}/part.s:3"


@pytest.mark.long
def test_the_keys_b_and_c_take_all_copies_of_a_line() -> None:
    async def work(driver: Driver) -> None:
        debugger, press = driver.debugger, driver.press

        def cursor_to(number: int) -> None:
            driver.source.cursor = next(
                index for index, row in enumerate(driver.source.rows) if row.number == number
            )

        cursor_to(7)
        await press("c", "c", "c")
        assert (driver.reason, debugger.chip.pc) == ("place", 3)
        await press("0")
        for number, text, stops in ((7, "x.s:7", [1, 2, 3]), (10, "x.s:10", [4, 6])):
            cursor_to(number)
            await press("b")
            (item,) = debugger.breakpoints.values()
            assert item.condition is not None
            assert (item.text, sorted(item.condition.places)) == (text, stops)
            await press("b")
            assert not debugger.breakpoints

    drive(Debugger(assemble_text(SIDE_BY_SIDE, "x.s")), work)
