"""Measure the figures of docs/programming.md, and write them into it.

    python -m examples.programming_page [FILE]

A block of the page that begins with ``; asm/NAME.s`` must stand in that source word for word.
Behind the name come the cycles of one pass through these lines: all cycles that a run of the
program spends in them, by how often it enters them. The table of instructions that would help
stands between two marks; `examples.silicon` measures it.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from examples import silicon
from examples.measure import MACHINES, PROGRAMS, ROOT, run
from examples.target import asked
from npchip import load_machine
from npchip.isa import load_isa

if TYPE_CHECKING:
    from collections.abc import Iterator

    from npchip import Program
    from npchip.program.model import SourceLine

PAGE = ROOT / "docs" / "programming.md"
BLOCK = re.compile(r"^```asm\n; (asm/\S+\.s)(?:: [^\n]*)?\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SILICON = re.compile(r"(<!-- silicon -->\n).*?(\n<!-- end -->)", re.DOTALL)


def document(page: str) -> str:
    """Return the page with all figures as they are measured now."""
    page = SILICON.sub(lambda found: f"{found[1]}{silicon.document()}{found[2]}", page)
    return with_cycles(page)


def with_cycles(page: str) -> str:
    """Return the page with the cycles of its pieces as they are measured now."""
    return BLOCK.sub(lambda found: _block(found[1], found[2]), page)


def _block(file: str, text: str) -> str:
    first, last = lines_of(file, text)
    costs = [cost(file, first, last, machine) for machine in MACHINES]
    shown = [f"{value:.1f}".removesuffix(".0") for value in costs]
    return f"```asm\n; {file}: {shown[0]} cycles, {shown[1]} ({MACHINES[1]})\n{text}```"


def lines_of(file: str, text: str) -> tuple[int, int]:
    """First and last line of a piece of a source, counted from 1."""
    source = (ROOT / file).read_text(encoding="utf-8")
    at = f"\n{source}".find(f"\n{text}")
    if at < 0:
        raise SystemExit(f"{PAGE.name}: not in {file}:\n{text}")
    first = source.count("\n", 0, at) + 1
    return first, first + text.count("\n") - 1


def cost(file: str, first: int, last: int, machine_name: str) -> float:
    """Mean cycles of a pass through some lines of a source."""
    name = runner(file)
    measured, machine, isa = run(name, machine_name), load_machine(machine_name), load_isa()
    cycles = entries = 0
    for address, enters in passages(measured.program, ROOT / file, first, last):
        decoded = isa.decode(measured.program.words[address])
        assert decoded
        times = int(measured.executions[address])
        cycles += times * machine.cycles(decoded.form.timing)
        entries += times * enters
    assert entries, f"{file}:{first}: never executed"
    return cycles / entries


@cache
def runner(file: str) -> str:
    """Name of a program that has the lines of a file."""
    path = ROOT / file
    return next(
        name
        for name in PROGRAMS
        if any(inside(line, path, 1, 10_000) for line in run(name).program.source)
    )


def passages(program: Program, path: Path, first: int, last: int) -> Iterator[tuple[int, bool]]:
    """Addresses that came from some lines, and whether a passage through the lines begins there."""
    before: SourceLine | None = None
    for address, line in enumerate(program.source):
        here = inside(line, path, first, last)
        if here is not None:
            repeated = before is not None and (
                here.expanded_from == before.expanded_from
                and (before.line < here.line or (before.line == here.line and here is not line))
            )
            yield address, not repeated
        before = here


def inside(line: SourceLine, path: Path, first: int, last: int) -> SourceLine | None:
    """The outermost line of an expansion that is one of those lines."""
    found, link = None, line
    while True:
        if first <= link.line <= last and Path(link.file) == path:
            found = link
        if link.expanded_from is None:
            return found
        link = link.expanded_from


if __name__ == "__main__":
    target = asked(PAGE)
    target.write_text(document(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
