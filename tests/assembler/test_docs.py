"""``docs/assembly.md``: what it shows assembles, and nothing of the language is left out."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from npchip.assembler import assemble
from npchip.assembler.blocks import DIRECTIVES
from npchip.assembler.codes import WARNINGS
from npchip.assembler.expander import MAX_DEPTH, MAX_LINES
from npchip.assembler.expressions import LEVELS
from npchip.assembler.sources import MAX_BYTES
from npchip.isa import load_isa
from npchip.program.model import OUTPUT_KINDS

TEXT = (Path(__file__).parents[2] / "docs" / "assembly.md").read_text("utf-8")
BLOCKS = re.findall(r"^```asm\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)


def test_there_are_blocks() -> None:
    assert len(BLOCKS) >= 10


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: re.sub(r"\W+", "_", block[:30]))
def test_a_block_assembles(block: str, tmp_path: Path) -> None:
    for other in BLOCKS:
        if named := re.match(r"; (\w+\.s)\n", other):
            (tmp_path / named[1]).write_text(other, encoding="utf-8")
    main = tmp_path / "main.s"
    is_library = re.match(r"; \w+\.s\n", block) is not None
    main.write_text(f"{block}\nHALT" if is_library else block)
    # Of what is only defined, has no end, or leaves half of the work to the reader.
    names = {"NPW01", "NPW02", "NPW03", "NPW05", "NPW13", "NPW14"}
    warnings: list[str] = []
    assemble(main, on_warning=lambda item: warnings.append(item.code))
    assert set(warnings) <= names


def test_everything_is_mentioned() -> None:
    for word in (*DIRECTIVES, *OUTPUT_KINDS, *WARNINGS, *load_isa().condition_names):
        assert re.search(rf"(?<![\w.]){re.escape(word)}\b", TEXT), word


def test_the_table_of_operators() -> None:
    rows = re.findall(r"^\| (`.*?) \|", TEXT.split("tightest first")[1], re.MULTILINE)
    levels = [set(re.findall(r"`(.+?)`", row.replace("\\|", "|"))) for row in rows]
    assert levels[1 : 1 + len(LEVELS)] == [set(level) for level in LEVELS]


def test_the_limits() -> None:
    assert f"{MAX_LINES:,} lines" in TEXT
    assert f"{MAX_DEPTH} levels" in TEXT
    assert f"{MAX_BYTES >> 10} KiB" in TEXT
