"""Hints beside the lines: their cycles, and the words that are left."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from npchip.language.analysis import Analysis
from npchip.language.cards import counted
from npchip.language.lines import code_end, view


class Hint(NamedTuple):
    """A remark behind the code of a line; `line` counts from 1, `column` from 0."""

    line: int
    column: int
    text: str
    more: str


def hints(analysis: Analysis, file: str, lines: Sequence[str]) -> Iterator[Hint]:
    """Yield the remarks on a file; none where the program has errors."""
    program = analysis.examined.program if analysis.examined else None
    if program is None:
        return
    machine = analysis.machine
    last = 0
    for number, line in enumerate(lines, 1):
        cost = analysis.costs.get((file, number))
        if cost is None:
            continue
        last = number
        text = counted(cost.cycles, "cycle")
        more = f"{counted(cost.words, 'word')}, each passed once, on {machine.name}"
        if cost.words > 1:
            text = f"{counted(cost.words, 'word')}, {text}"
        yield Hint(number, code_end(line), text, more)
    if file != str(analysis.root):
        return
    used, room = len(program.words), machine.rom_words
    more = f"{used} of the {room} words of the ROM of {machine.name} are used"
    budgets = (n for n, line in enumerate(lines, 1) if _is_budget(line))
    at = next(budgets, last)
    limit = program.budget.words
    if at and at != last and limit is not None:
        yield Hint(
            at, code_end(lines[at - 1]), f"{limit - used} left, {room - used} in the ROM", more
        )
    elif at:
        yield Hint(at, code_end(lines[at - 1]), f"{counted(room - used, 'word')} left", more)


def _is_budget(line: str) -> bool:
    shown = view(line)
    tokens = shown.tokens[shown.at :]
    return shown.word == ".budget" and len(tokens) > 1 and tokens[1].text == "words"
