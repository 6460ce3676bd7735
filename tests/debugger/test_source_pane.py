"""The source pane: numbers in few characters, lines with their indentation."""

from __future__ import annotations

import time
from pathlib import Path

from npchip import assemble
from npchip.assembler.listing import read_texts
from npchip.debugger.screen.look import Sources
from npchip.debugger.screen.source import compact, squeezed
from npchip.debugger.session import Debugger


def test_numbers_and_lines_fit() -> None:
    numbers = [0, 9_999, 10_000, 9_999_999, 10_000_000, 10**10, 10**13 - 1]
    assert [compact(number) for number in numbers] == [
        "0", "9999", "10k", "9999k", "10M", "10G", "9999G"
    ]  # fmt: skip
    texts = {
        "look:   LD      r1, [r0]      ; why  so": "look:   LD r1, [r0]  ; why  so",
        "        NOP": "        NOP",
        "\tNOP ;\ta": "        NOP  ;   a",
        "    ; a  remark": "    ; a  remark",
        '.require  A,  "two  blanks;  here"   ; so': '.require A, "two  blanks;  here"  ; so',
        '.error  "open  one': '.error "open  one',
        "": "",
    }
    for text, narrow in texts.items():
        assert squeezed(text) == narrow


def test_lines_are_narrowed_in_linear_time() -> None:
    start = time.process_time()
    for text in ("a" + 400_000 * " ", 400_000 * " " + "a", 200_000 * "a ", 200_000 * '" ;'):
        assert len(squeezed(text)) <= len(text) + 1
    assert time.process_time() - start < 2


def test_lines_are_those_that_the_assembler_counts(tmp_path: Path) -> None:
    file = tmp_path / "x.s"
    for end in ("\n", "\r\n", "\r"):
        lines = ["; a form feed \x0c and a separator \u2028 in remarks", " NOP", " HALT"]
        file.write_bytes((end.join(lines) + end).encode())
        program = assemble(file)
        rows = Sources(Debugger(program)).files[str(file)]
        assert [(row.number, row.text) for row in rows] == list(enumerate(lines, 1))
        assert read_texts(program) == {str(file): lines}
