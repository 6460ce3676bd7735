"""Messages and limits for sources that are odd in ways that people or programs make them."""

from __future__ import annotations

import re
import time
from pathlib import Path

import pytest
from click.testing import CliRunner

from npchip import AssemblyError, assemble, assemble_text
from npchip.assembler.blocks import DIRECTIVES
from npchip.assembler.usage import USAGE
from npchip.base.numbers import whole_number
from npchip.cli.main import cli
from npchip.isa import load_isa


def errors(text: str) -> str:
    with pytest.raises(AssemblyError) as caught:
        assemble_text(text)
    return str(caught.value)


def test_a_constant_in_a_macro_that_is_used_twice() -> None:
    """The help said to make it `.K`, which is no constant's name."""
    said = errors(".macro m\n.equ K, 1\n.endm\n m\n m\n HALT")
    assert "move this line out of the macro" in said
    assert ".K" not in said
    assert "make it a local label, .here" in errors(".macro m\nhere: HALT\n.endm\n m\n m")


def test_a_use_of_a_broken_macro_is_not_reported() -> None:
    """It was said to be defined further down."""
    said = errors(".macro m x $\n HALT\n.endm\n m r0\n HALT")
    assert "further down" not in said
    assert said.endswith("1 error")


def test_a_macro_of_very_many_parameters() -> None:
    """63,000 took 13 seconds and a message of 315 KB."""
    names = ",".join(f"p{k:x}" for k in range(40_000))
    before = time.process_time()
    said = errors(f".macro m {names}\n HALT\n.endm\n m")
    assert time.process_time() - before < 5
    assert "takes 40000 arguments (p0, p1" in said
    assert len(said) < 500_000  # the source's line is shown
    assert len(said.splitlines()[0]) < 300


@pytest.mark.parametrize("word", ["JLO", "JHS", "JHI", "JLS", "JCS", "JCC", "JEQ"])
def test_a_conditional_jump_of_other_processors_has_help(word: str) -> None:
    """JNE had help, JLO had none."""
    assert "flow follows the global OR" in errors(f"a: HALT\n {word} a")


def test_digits_of_other_scripts_are_no_numbers() -> None:
    """`--define T=٣` was taken as 3, which the source refuses."""
    assert whole_number("٣") is None
    assert whole_number(" 0x10 ") == 16
    assert whole_number("0o17") is None


def test_what_a_condition_leaves_out_may_be_anything() -> None:
    """A quotation mark in it was an error, though what is left out is not looked at."""
    left_out = " this isn't code\n \"x\n .frobnicate 0b2\n"
    program = assemble_text(f".if 0\n{left_out}.elif 0\n{left_out}.else\n HALT\n.endif")
    assert len(program.words) == 1
    assert "NP001" in errors(f".if 1\n{left_out}.endif\n HALT")
    chosen_once = f".macro m x\n.if x\n{left_out}.endif\n.endm\n m 0\n m 1\n HALT"
    assert "NP001" in errors(chosen_once)
    assert "NP001" in errors(f".macro m\n{left_out}.endm\n HALT")


def test_a_third_operand_says_how_many_there_are() -> None:
    """Only the syntax was shown."""
    assert "help: 2 operands, no more: ADD is written" in errors(" ADD r2, r1, r3\n HALT")


@pytest.mark.parametrize(
    ("word", "shown"),
    [
        (".rept", ".rept COUNT"),
        (".endif", ".if EXPRESSION"),
        ("BNE", "JANY NE"),
        ("bne", "Jump if any NP meets a condition"),
        ("XOR", "(a | b) - (a & b)"),
        ("eq", "EQ - a condition: equal"),
        ("CS", "LO or CS - a condition"),
    ],
)
def test_a_word_that_is_no_instruction_is_explained(word: str, shown: str) -> None:
    """`npchip isa .rept`, BNE and EQ said only that there is no such instruction."""
    done = CliRunner().invoke(cli, ["isa", word])
    assert done.exit_code == 0
    assert shown in done.stdout


@pytest.mark.parametrize(
    ("word", "hint"),
    [("JANI", "did you mean JANY"), (".rep", "did you mean .rept"), ("frobnicate", "lists them")],
)
def test_a_word_without_meaning_is_refused(word: str, hint: str) -> None:
    done = CliRunner().invoke(cli, ["isa", word])
    assert done.exit_code == 2
    assert hint in done.stderr


def test_every_directive_is_explained() -> None:
    assert set(USAGE) == set(DIRECTIVES)


@pytest.mark.parametrize("name", load_isa().instructions)
def test_a_page_that_goes_to_a_file_is_plain_text(name: str) -> None:
    """It was raw Markdown, with tables and fences."""
    text = CliRunner().invoke(cli, ["isa", name]).stdout
    assert text.startswith(f"{name} - ")
    assert not re.search(r"[`#]{3}|\*\*|\| ---|`", text)
    assert max(map(len, text.splitlines())) <= 79


@pytest.mark.parametrize(
    ("line", "hint"),
    [
        ("LD r1, [r0+1]", "no offset, only a bank: ADD r0, #1 first, then [r0]"),
        ("LD r1, [r0 + 65]", "ADD r0, #65 first"),
        ("ST [r2+3], r1", "bank 3 begins at 192; there is no offset"),
        ("LD r1, [r0-1]", "SUB r0, #N first"),
        ("LD r1, [r0+r2]", "ADD r0, r2 first"),
        (".reg at, r3\n LD r1, [at+5]", "ADD at, #5 first"),
        ("SAMPLE signal, 1", "help: bank 1 begins at 64\n"),
    ],
)
def test_an_offset_in_brackets_is_explained(line: str, hint: str) -> None:
    """Only banks were spoken of."""
    assert hint in errors(f" {line}\n HALT")


@pytest.mark.parametrize(
    "word", [".ends", ".endp", ".endfunc", ".endfi", ".ifeq 1", ".repeat 3", ".mend", "endif"]
)
def test_what_is_left_out_may_be_for_another_assembler(word: str) -> None:
    """Directives that resemble the begin or end of a block were taken for it."""
    program = assemble_text(f".if 0\n NOP\n{word}\n NOP\n.endif\n HALT\n")
    assert len(program.words) == 1


@pytest.mark.parametrize(
    "word", [".end", ".ends", ".endc", "endif", "ENDIF", "#endif", ".endfi", ".fi", ".endi"]
)
def test_a_near_miss_of_the_end_is_named(word: str) -> None:
    """In what is left out, the message named the `.if` only."""
    said = errors(f".if 0\n NOP\n{word}\n HALT\n")
    assert f"'{word}'" in said
    assert ".endif?" in said
    assert said.count("error:") == 1


def test_unknown_blocks_are_taken_as_meant_where_they_close() -> None:
    said = errors(".repeat 2, i\n MOV r0, #i\n.endrepeat\n HALT")
    assert said.count("error:") == 2
    assert "did you mean .rept?" in said
    assert "did you mean .endr?" in said


def test_an_allow_comment_in_what_is_left_out_is_not_looked_at() -> None:
    assert "NP030" in errors(" NOP ; npchip: alow NPW04 x\n HALT")
    assert len(assemble_text(".if 0\n NOP ; npchip: alow NPW04 x\n.endif\n HALT").words) == 1


def test_conditions_in_macros_that_are_not_used_are_not_looked_at() -> None:
    text = ".macro m\n.if 0\n this isn't code\n.endif\n.endm\n HALT"
    assert len(assemble_text(text).words) == 1


def test_a_macro_that_is_left_out_is_not_said_to_follow() -> None:
    """The help said that it is defined further down."""
    said = errors(".if 0\n.macro m\n NOP\n.endm\n.endif\n m\n HALT")
    assert "a condition leaves out the lines that define this macro" in said
    assert "further down" not in said


@pytest.mark.parametrize("line", [".output K, 0, plane", ".budget words 9"])
def test_what_a_macro_declares_each_time_is_explained(line: str) -> None:
    assert "move this line out of the macro" in errors(f".macro m\n{line}\n.endm\n m\n m\n HALT")


def test_lines_of_other_files_are_named_with_their_file(tmp_path: Path) -> None:
    """The number of a line of another file was taken for one of this file."""
    (tmp_path / "part.inc").write_text("\n\n\n MOV r0, #NIX\n")
    source = tmp_path / "p.s"
    source.write_text(' MOV r1, #NIX\n MOV r2, #NIX\n.include "part.inc"\n HALT\n')
    with pytest.raises(AssemblyError) as caught:
        assemble(source)
    assert f"also in line 2, {tmp_path}/part.inc:4" in str(caught.value)


@pytest.mark.parametrize(
    "arguments",
    [
        "trace imaging --frames shapes_photo --np ٣,٤",
        "trace imaging --frames shapes_photo --from ٣",
        "trace imaging --frames shapes_photo --from f٣",
        "fuse ball.1 ball.2 --rig chip --threshold ٢٣",
        "scene --shape disc --radius ٩ --start 9,9 --velocity 1,1 -o x.npy",
        "scene --shape disc --radius 5 --start ٩,9 --velocity 1,1 -o x.npy",
        "orient predict x.png --yaw ٤٥ --pitch -67",
        "orient train --neurons ٣ -o x.json",
    ],
)
def test_digits_of_other_scripts_are_refused(
    arguments: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(cli, arguments.split())
    assert done.exit_code == 2, done.output
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("option", ["levels=٣", "levels=1,2 first=٢", "levels=1 max-cycles=٢٠٠"])
def test_digits_of_other_scripts_are_refused_in_test_lines(option: str, tmp_path: Path) -> None:
    source = tmp_path / "t.s"
    source.write_text(f"; run: a {option}\n; expect: frames == 1\n HALT\n", encoding="utf-8")
    done = CliRunner().invoke(cli, ["test", str(source)])
    assert done.exit_code == 2, done.output
