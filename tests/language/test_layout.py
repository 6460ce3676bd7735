"""The layout of sources: it is the same twice, and no program changes by it."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from npchip import assemble_text
from npchip.assembler import AssemblyError
from npchip.assembler.sources import split_lines
from npchip.isa import load_isa
from npchip.language.layout import laid_out
from tests.support.programs import ASM

ISA = load_isa()
SOURCES = sorted(Path(ASM).rglob("*.s"))


def words(text: str, path: Path) -> object:
    """Return the words of a source, or its mistakes without their columns."""
    try:
        program = assemble_text(text, "program.s", include_paths=[path.parent, Path(ASM)])
    except AssemblyError as error:
        return [(item.code, item.message, item.span.line.number) for item in error.diagnostics]
    return program.words


def formatted(text: str) -> str:
    return "\n".join(laid_out(split_lines(text), ISA))


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.stem)
def test_programs_of_asm_keep_their_words(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    after = formatted(text)
    assert words(after, path) == words(text, path)
    assert formatted(after) == after
    different = sum(a != b for a, b in zip(split_lines(text), split_lines(after), strict=True))
    assert different <= 1  # they are laid out so


def blanks(text: str, random_: random.Random) -> str:
    """Return a text with other blanks, outside comments, strings and words."""
    lines = []
    for line in split_lines(text):
        code, semicolon, comment = line.partition(";")
        if '"' not in line and "'" not in line:
            code = "".join(
                random_.choice((" ", "  ", "\t", "     ")) if char == " " else char for char in code
            )
        lines.append(code + semicolon + comment + random_.choice(("", "", "  ", "\t")))
    return "\n".join(lines)


@pytest.mark.parametrize("seed", range(8))
def test_blanks_never_change_words(seed: int) -> None:
    random_ = random.Random(seed)
    path = random_.choice([item for item in SOURCES if item.parent == Path(ASM)])
    text = blanks(path.read_text(encoding="utf-8"), random_)
    after = formatted(text)
    assert words(after, path) == words(text, path)
    assert formatted(after) == after


@pytest.mark.parametrize("seed", range(40))
def test_damaged_sources_keep_their_mistakes(seed: int) -> None:
    random_ = random.Random(seed)
    path = random_.choice([item for item in SOURCES if item.stat().st_size < 4000])
    text = path.read_text(encoding="utf-8")
    for _ in range(4):
        start = random_.randrange(len(text))
        piece = random_.choice(("", "(", '"', ".macro m\n", "END\n", ";", "\t", "'", ": ", ","))
        text = text[:start] + piece + text[start + random_.randrange(30) :]
    after = formatted(text)
    assert words(after, path) == words(text, path)
    assert formatted(after) == after


def test_columns() -> None:
    text = (
        "start:MOV r1 ,r2;copy\n"
        "WHERE HI\n"
        "  MOV r1,#3 ; where it is higher\n"
        "END\n"
        ".equ  N,   3   \n"
        "a_long_label: HALT\n"
        "; alone   "
    )
    assert formatted(text).split("\n") == [
        "start:  MOV     r1, r2          ;copy",
        "        WHERE   HI",
        "          MOV   r1, #3          ; where it is higher",
        "        END",
        ".equ  N,   3",
        "a_long_label: HALT",
        "; alone",
    ]


def test_an_unreadable_line_stays() -> None:
    assert laid_out(["  MOV   r1,  $x  "], ISA) == ["  MOV   r1,  $x"]
