"""Fixes: the text that the help of a mistake suggests ends the mistake."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from npchip.assembler import AssemblyError, Diagnostic, assemble_text
from npchip.assembler.sources import split_lines
from npchip.language.fixes import fixes

ERRORS = Path(__file__).parents[1] / "asm" / "errors"


def mistakes(text: str) -> list[Diagnostic]:
    found: list[Diagnostic] = []
    try:
        assemble_text(text, "x.s", include_paths=[ERRORS], on_warning=found.append)
    except AssemblyError as error:
        found += error.diagnostics
    return found


def readable() -> list[tuple[str, str]]:
    found = []
    for path in sorted(ERRORS.glob("*.s")):
        data = path.read_bytes()
        try:
            found.append((path.stem, data.decode("utf-8-sig")))
        except UnicodeDecodeError:
            continue
    return found


def test_every_fix_ends_its_mistake() -> None:
    titles: Counter[str] = Counter()
    for name, text in readable():
        before = mistakes(text)
        for item in before:
            if item.span.line.file != "x.s":
                continue
            line = item.span.line
            for fix in fixes(
                item.code, item.suggestion, line.text, item.span.column, item.span.length
            ):
                titles[fix.title.split()[0]] += 1
                lines = split_lines(text)
                new = line.text[: fix.column] + fix.text + line.text[fix.column + fix.length :]
                lines[line.number - 1] = new
                after = mistakes("\n".join(lines))
                same = [
                    other
                    for other in after
                    if (other.code, other.message, other.span.line.number, other.span.column)
                    == (item.code, item.message, line.number, item.span.column)
                ]
                assert not same, f"{name}: {fix}"
    assert titles.keys() == {"Change", "Type", "Insert", "Delete", "Begin"}
    assert sum(titles.values()) > 50


@pytest.mark.parametrize(
    ("code", "help_", "line", "word", "after"),
    [
        ("NP003", "did you mean SUB?", "SBU r1, r2", "SBU", "SUB r1, r2"),
        ("NP027", "did you mean lib/a.s?", '.include "lib/b.s"', '"lib/b.s"', '.include "lib/a.s"'),
        ("NP005", "a comma is missing", "ADD r1 r2", "r2", "ADD r1, r2"),
        ("NP005", "a constant begins with #: #5", "ADD r1, 5", "5", "ADD r1, #5"),
        ("NPW09", "delete the comment", "HALT ; npchip: allow x", "; npchip: allow x", "HALT"),
    ],
)
def test_a_fix(code: str, help_: str, line: str, word: str, after: str) -> None:
    (fix,) = fixes(code, help_, line, line.index(word), len(word))
    assert line[: fix.column] + fix.text + line[fix.column + fix.length :] == after


def test_advice_is_no_fix() -> None:
    assert not [*fixes("NP012", "is a comma missing?", "m 1 2", 0, 1)]
    assert not [*fixes("NP005", "SAMPLE is written SAMPLE level, bank", "SAMPLE", 6, 1)]
    assert not [*fixes("NP005", None, "SAMPLE", 6, 1)]
