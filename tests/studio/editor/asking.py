"""Questions to the page's editor, and the sources in ``asm/`` as it holds them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

from npchip.isa import load_isa
from npchip.machine import load_machine
from npchip.program.model import Program, SourceLine
from npchip.studio.toolchain.language import language
from tests.support.page_code import Answers
from tests.support.programs import ASM

PROGRAMS = sorted(path.stem for path in ASM.glob("*.s"))
ISA = load_isa()


def ask_all(page: Answers, what: str, questions: Sequence[dict[str, Any]]) -> list[Any]:
    """Return the editor's answers to questions of one kind."""
    answers: list[Any] = page.ask({"ask": what, "many": questions})
    return answers


def ask(page: Answers, what: str, **question: Any) -> Any:
    """Return the editor's answer to a question."""
    [answer] = ask_all(page, what, [question])
    return answer


@cache
def project(name: str) -> dict[str, Any]:
    """A program of ``asm/`` with its includes, as the page holds it."""
    files: dict[str, str] = {}

    def add(path: Path) -> None:
        files[path.relative_to(ASM).as_posix()] = text = path.read_text()
        for wanted in re.findall(r'^[^;"\n]*\.include\s+"([^"]+)"', text, re.MULTILINE):
            add((path.parent / wanted).resolve())

    add(ASM / f"{name}.s")
    return {"main": f"{name}.s", "files": files}


@cache
def entries() -> list[dict[str, Any]]:
    """Return the entries of the language that the page knows."""
    found: list[dict[str, Any]] = language(ISA)["entries"]
    return found


def words_of(program: Program) -> list[dict[str, Any]]:
    cycles = program.cycles(load_machine("default"), ISA)
    return [
        {
            "origins": [{"file": name_of(at), "line": at.line} for at in line.origins],
            "text": line.code,
            "cycles": cycles[address],
        }
        for address, line in enumerate(program.source)
    ]


def name_of(line: SourceLine) -> str:
    return Path(line.file).resolve().relative_to(ASM).as_posix()
