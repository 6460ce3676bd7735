"""The outputs of the last frames."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from textual.content import Content
from textual.widgets import Static

if TYPE_CHECKING:
    from npchip.debugger.screen.look import Look
    from npchip.run.result import Value


class Outputs(Static):
    """The table, cut to the room that there is."""

    def __init__(self, **extra: Any) -> None:
        super().__init__(**extra)
        self._look: Look | None = None

    def show(self, look: Look) -> None:
        """Draw a moment."""
        self._look = look
        self.refresh()

    def render(self) -> Content:
        """The lines."""
        text = table(self._look, self.size.width, self.size.height) if self._look else ""
        return Content(text)


def table(look: Look, width: int, most: int) -> str:
    """The last frames and the present one: a table of at most so many lines."""
    names = list(look.outputs)
    ended = look.frame_number in look.records
    rows = [("frame", "cycles", *names)]
    before = [number for number in sorted(look.records) if number >= 0][-(most - 1) :]
    if not ended:
        before = before[-(most - 2) :] if most > 2 else []
    for number in before:
        record = look.records[number]
        rows.append(
            (str(number), f"{record.cycles:,}", *(_short(record.outputs.get(n)) for n in names))
        )
    if not ended:
        label = f"{look.frame_number}…" if look.frame_number >= 0 else "set-up…"
        rows.append(
            (label, f"{look.frame_cycles:,}", *(_short(look.outputs[name]) for name in names))
        )
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = [
        "  ".join(f"{cell:>{wide}}" for cell, wide in zip(row, widths, strict=True)) for row in rows
    ]
    return "\n".join(line if len(line) <= width else line[: width - 1] + "…" for line in lines)


def _short(value: Value) -> str:
    if value is None:
        return "–"
    if isinstance(value, np.ndarray):
        return f"{value.shape[0]}x{value.shape[1]}"
    if isinstance(value, list) and len(value) > 6:
        return f"[{', '.join(map(str, value[:5]))}, … {len(value)}]"
    return str(value)
