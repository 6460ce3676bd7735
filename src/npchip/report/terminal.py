"""The table of a run for a terminal; a long clip shows its ends and the worst frame."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from rich.box import SIMPLE
from rich.console import Console
from rich.table import Table

from npchip.report.table import Clock, has_setup_row, header, rows, summary, worst_frame

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.markdown import Markdown

    from npchip.run.result import RunResult

_FIRST, _LAST, _FEW = 20, 15, 5


def terminal_text(result: RunResult, clock: Clock, width: int) -> str:
    """Return the table in `width` columns with the summary below; the worst frame is bold."""
    shown = _shown(result)
    table = _table(header(result), left=0)
    cells = iter(rows(result, shown, whole=False))
    if has_setup_row(result):
        table.add_row(*next(cells))
    expected = 0
    for k, row in zip(shown, cells, strict=True):
        if k != expected:
            table.add_row(*["..."] * len(row), style="dim")
        table.add_row(*row, style="bold" if k == worst_frame(result) else None)
        expected = k + 1
    lines = summary(result, clock)
    hidden = result.frames - len(shown)
    if hidden:
        lines.insert(0, f"{hidden} frames are not shown; a pipe or a file gets all of them")
    return _stripped(table, width) + "\n" + "\n".join(lines) + "\n"


def side_by_side(cells: Sequence[Sequence[str]], width: int) -> str:
    """Draw rows, the first of them bold, in `width` columns; the first column is a title."""
    first, *rest = cells
    table = _table(first, left=1)
    for row in rest:
        table.add_row(*row)
    return _stripped(table, width)


def _table(heads: Sequence[str], *, left: int) -> Table:
    table = Table(box=SIMPLE, pad_edge=False, show_edge=False, header_style="bold")
    for number, name in enumerate(heads):
        table.add_column(name, justify="left" if number < left else "right", overflow="fold")
    return table


def drawn(item: Table | Markdown, width: int) -> str:
    """Return `item` as text in `width` columns, coloured as the terminal and NO_COLOR allow."""
    console = Console(file=io.StringIO(), force_terminal=True, width=width, highlight=False)
    with console.capture() as captured:
        console.print(item)
    return captured.get()


def _stripped(table: Table, width: int) -> str:
    return "".join(line.rstrip() + "\n" for line in drawn(table, width).splitlines())


def _shown(result: RunResult) -> list[int]:
    """Return all frames of a short clip; else its ends and the worst frame."""
    count, worst = result.frames, worst_frame(result)
    if worst is None or count <= _FIRST + _LAST + _FEW:
        return list(range(count))
    return sorted({*range(_FIRST), worst, *range(count - _LAST, count)})
