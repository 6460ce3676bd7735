"""Instruction-set files that are none, too large, meant to do harm, or cannot be read."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from npchip.base.errors import IsaError
from npchip.isa import parse_isa, read_isa
from tests.isa.test_loader import BASE, NAME, refusal

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(
    "text",
    [
        "",
        "- a list",
        "just text",
        "name: [",
        "name: !!python/object/apply:os.system [ls]",
        "name: &a x\ntitle: *a\n",
        "name: " + "[" * 40 + "]" * 40,
        "name: " + "{a: " * 5000,
        "name: \x00",
        "name: " + "x" * (1 << 20),
        f"word_bits: {'9' * 5000}",
        "a0: &a [x]\n" + "".join(f"a{n + 1}: &b{n} [{'*a, ' * 9}]\n" for n in range(9)),
    ],
    ids=lambda text: text[:20],
)
def test_hostile_files(text: str) -> None:
    error = refusal(text)
    assert error.code == "NP401"
    assert NAME in error.message
    assert len(error.message) < 300


def test_long_sums_are_read_in_no_time() -> None:
    """Each part of an expression is translated once, however deep it lies."""
    text = BASE.replace("rd = rd + y", f"rd = {'y + ' * 150}y").replace(
        "Z = rd == 0", f"Z = {'not ' * 100}C"
    )
    parse_isa(text, NAME)


def test_unreadable_files(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    for reason, content in (("No such file", None), ("codec", b"name: \xff")):
        if content is not None:
            file.write_bytes(content)
        with pytest.raises(IsaError) as caught:
            read_isa(file)
        assert caught.value.code == "NP401"
        assert str(file) in caught.value.message
        assert reason in caught.value.message
    file.write_text(BASE, encoding="utf-8")
    assert read_isa(file).title == "A tiny instruction set"
