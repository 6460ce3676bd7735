"""Warnings: where there is one, where there is none, and what a comment allows.

How they are worded is in ``tests/asm/errors``.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from npchip.assembler import Diagnostic, assemble, assemble_text


def warnings(text: str, defines: Mapping[str, int] | None = None) -> list[tuple[str, int]]:
    """Code and line of each warning."""
    found: list[Diagnostic] = []
    assemble_text(text, defines=defines, on_warning=found.append)
    return [(item.code, item.span.line.number) for item in found]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("start: NOP\nHALT", []),
        ("NOP\nstart: HALT", [("NPW01", 2)]),
        ("NOP\nstart: NOP\n.equ L, start\nMOV r0, #L\nHALT", []),
        ("NOP\n.x: HALT", [("NPW01", 2)]),
        ("NOP\nend: NOP\n.if 0\nJMP end\n.endif\nHALT", []),
        (".macro m\n.x: NOP\n.endm\nm\nHALT", []),
        (".rept 2\n.x: NOP\n.endr\nHALT", []),
        ("HALT\nend:", [("NPW01", 2)]),
        (".equ A, 1\n.equ B, A\nMOV r0, #B\nHALT", []),
        (".equ A, 1\nHALT", [("NPW02", 1)]),
        (".reg a, r1\nHALT", [("NPW02", 1)]),
        (".equ A, 1\n.ifdef A\nNOP\n.endif\nHALT", []),
        (".equ A, 1\n.macro m\nMOV r0, #A\n.endm\nHALT", [("NPW03", 2)]),
        ("JMP b\nNOP\nNOP\nb: HALT", [("NPW04", 2)]),
        ("CALL f\nNOP\nHALT\nf: JMP f", [("NPW04", 2)]),
        ("CALL f\nHALT\nf: JANY EQ, f\nRET", []),
        ("JANY EQ, 3\nHALT\nNOP\nHALT", [("NPW04", 3)]),
        (".word 0\nHALT", [("NPW04", 2)]),
        ("NOP", [("NPW05", 1)]),
        ("a: JMP a", []),
        ("JNONE EQ, 7\nHALT", [("NPW05", 1)]),
        ("CALL 9\nHALT", [("NPW04", 2), ("NPW05", 1)]),
        (".output a, 3, scalar\nOUT 4, r0\nHALT", [("NPW06", 1)]),
        (".output a, 3, scalar\n.equ P, 3\nOUT P, r0\nHALT", []),
        ("OUT 7, r0\nHALT", []),
        ("RET", [("NPW07", 1)]),
        ("JMP f\nf: RET", [("NPW07", 2)]),
        ("CALL f\nHALT\nf: CALL g\nRET\ng: RET", []),
        ("CALL f\nf: NOP\nRET", [("NPW07", 3)]),
        ("a: CALL b\nHALT\nb: CALL c\nRET\nc: CALL d\nRET\nd: CALL e\nRET\ne: RET", []),
        ("CALL f\nHALT\nf: CALL g\nRET\ng: JANY EQ, .x\nCALL f\n.x: RET", [("NPW08", 6)]),
    ],
)
def test_warnings(text: str, expected: list[tuple[str, int]]) -> None:
    assert sorted(warnings(text)) == expected


def test_the_return_stack_is_that_of_the_machine(tmp_path: Path) -> None:
    machine = tmp_path / "small.yaml"
    machine.write_text("extends: default\nmemory: {return_stack: 1}\n")
    found: list[Diagnostic] = []
    text = "CALL f\nHALT\nf: CALL g\nRET\ng: RET"
    assemble_text(text, machine=machine, on_warning=found.append)
    assert [item.code for item in found] == ["NPW08"]


def test_a_defined_constant_uses_what_its_expression_names() -> None:
    text = ".equ A, 1\n.equ B, A\nMOV r0, #B\nHALT"
    assert warnings(text, {"B": 7}) == []


def test_allow() -> None:
    assert warnings("HALT\nNOP ; npchip: allow NPW04 a mark") == []
    assert warnings("HALT\nNOP ; npchip: allow NPW05 NPW04: a mark") == [("NPW09", 2)]
    assert warnings("HALT ; npchip: allow NPW04 in another line\nNOP") == [
        ("NPW09", 1),
        ("NPW04", 2),
    ]
    assert warnings("NOP ; npchip: the emulator\nHALT") == []
    assert warnings("NOP ; see npchip: allow NPW04\nHALT") == []


def test_allow_in_and_around_a_macro() -> None:
    text = ".macro mark\nHALT\nNOP{inside}\n.endm\nmark{outside}\n"
    allow = " ; npchip: allow NPW04 NPW05 a mark"
    codes = ["NPW04"]
    assert [code for code, _ in warnings(text.format(inside="", outside=""))] == codes
    for inside, outside in (("NPW04", ""), ("", "NPW04")):
        comments = {
            "inside": inside and f" ; npchip: allow {inside} a mark",
            "outside": outside and f" ; npchip: allow {outside} a mark",
        }
        assert warnings(text.format(**comments)) == []
    assert warnings(text.format(inside=allow, outside="")) == [("NPW09", 3)]


def test_what_is_left_out_need_not_be_allowed() -> None:
    text = ".equ N, 0\n.if N\nHALT\nNOP ; npchip: allow NPW04 a mark\n.endif\nHALT"
    assert warnings(text) == []
    unused = ".macro m\nHALT\nNOP ; npchip: allow NPW04 a mark\n.endm\nHALT"
    assert warnings(unused) == [("NPW03", 1)]


def test_a_library_has_more_than_is_used(tmp_path: Path) -> None:
    library = ".equ A, 1\n.reg b, r1\n.macro m\n.endm\nlabel:\nNOP ; npchip: allow NPW04 no news\n"
    (tmp_path / "lib.s").write_text(library)
    (tmp_path / "main.s").write_text('NOP\n.include "lib.s"\nHALT\n')
    found: list[Diagnostic] = []
    assemble(tmp_path / "main.s", on_warning=found.append)
    assert found == []


def test_dead_code_of_a_library_costs_words(tmp_path: Path) -> None:
    (tmp_path / "lib.s").write_text("half: SHR r0, #1\nRET\n")
    (tmp_path / "main.s").write_text('HALT\n.include "lib.s"\n')
    found: list[Diagnostic] = []
    assemble(tmp_path / "main.s", on_warning=found.append)
    assert [(item.code, item.span.line.number) for item in found] == [("NPW04", 1)]
    assert "included here" in str(found[0])


def test_warnings_come_in_the_order_of_the_source() -> None:
    text = ".equ A, 1\nNOP\nx: NOP\nHALT\nNOP\n.equ B, 1\n.output o, 0, list"
    lines = [line for _, line in warnings(text)]
    assert lines == sorted(lines)
    assert len(lines) == 5
