"""The source pane: the next instruction, breakpoints, and cycles of every line."""

from __future__ import annotations

import re
from typing import Any

from rich.segment import Segment
from rich.style import Style
from textual.events import Click
from textual.geometry import Size
from textual.scroll_view import ScrollView
from textual.strip import Strip

from npchip.debugger.screen.look import Look, Row, Sources

_STEP = 8
"""Characters by which the text scrolls sideways."""
_HEAD = re.compile(r"\s*(?:[\w.]+:)?\s*")
_GAP = re.compile(r'"[^"]*"?|;.*|(?P<gap>\s+)(?P<note>;.*)?')


class Source(ScrollView, can_focus=True):
    """Shows one source file.

    ``▶`` marks the next instruction, ``●`` a breakpoint (``○``: disabled), ``>`` the cursor.

    Attributes:
        file: name of the shown file.
        cursor: row of the cursor.
    """

    def __init__(self, sources: Sources, **extra: Any) -> None:
        super().__init__(**extra)
        self._sources = sources
        self.file = next(iter(sources.files))
        self.cursor = 0
        self._left = 0
        self._look: Look | None = None

    @property
    def rows(self) -> list[Row]:
        """Rows of the shown file."""
        return self._sources.files[self.file]

    def show(self, look: Look, *, follow: bool) -> None:
        """Draw a snapshot; `follow` moves the cursor to the next instruction."""
        self._look = look
        self._go(*(self._sources.place(look.pc) if follow else (self.file, self.cursor)))

    def switch(self) -> None:
        """Show the next file."""
        files = list(self._sources.files)
        self._go(files[(files.index(self.file) + 1) % len(files)], 0)

    def _go(self, file: str, cursor: int) -> None:
        self.file, self.cursor = file, cursor
        self.virtual_size = Size(1, len(self.rows))
        self._reveal()
        self.refresh()

    def move(self, rows: int, steps: int = 0) -> None:
        """Move the cursor by rows and scroll the text sideways by steps."""
        widest = max(len(squeezed(row.text)) for row in self.rows)
        self._left = max(0, min(self._left + _STEP * steps, widest - _STEP))
        self.cursor = max(0, min(len(self.rows) - 1, self.cursor + rows))
        self._reveal()
        self.refresh()

    def _reveal(self) -> None:
        height = self.size.height or 1
        top = self.scroll_offset.y
        if not top + 1 < self.cursor < top + height - 2:
            self.scroll_to(y=max(0, self.cursor - height // 2), animate=False)

    def on_resize(self) -> None:
        """Keep the cursor in sight."""
        self.call_after_refresh(self._reveal)

    def on_click(self, event: Click) -> None:
        """Move the cursor to the line that was clicked on."""
        self.move(event.y + self.scroll_offset.y - self.cursor)

    def render_line(self, y: int) -> Strip:
        """Draw one row of the screen."""
        index = y + self.scroll_offset.y
        if self._look is None or index >= len(self.rows):
            return Strip.blank(self.size.width)
        row, look = self.rows[index], self._look
        here = look.pc in row.addresses and (self.file, index) == self._sources.place(look.pc)
        points = [look.breakpoints[at] for at in row.addresses if at in look.breakpoints]
        mark = "▶" if here else ">" if index == self.cursor else " "
        point = " " if not points else "●" if any(points) else "○"
        cycles = sum(int(look.executions[at] * self._sources.costs[at]) for at in row.addresses)
        count = compact(cycles) if cycles else "" if not row.addresses else "·"
        text = f"{mark}{point}{count:>5} {row.number:>4} {squeezed(row.text)[self._left :]}"
        style = Style(bold=True, reverse=True) if here else Style(underline=index == self.cursor)
        if not row.addresses and not here:
            style += Style(dim=True)
        return Strip([Segment(text, style)]).adjust_cell_length(
            self.size.width, style if here else None
        )


def compact(number: int) -> str:
    """Format a number in at most five characters."""
    for unit in ("", "k", "M", "G"):
        if number < 10_000:
            return f"{number}{unit}"
        number //= 1_000
    return f"{number}T"


def squeezed(text: str) -> str:
    """Return a source line with the gaps inside it narrowed, so that more of it fits.

    Its indentation stays, and so does the column of what follows a label; texts in quotes do too.
    """
    text = text.expandtabs(8).rstrip()
    head = _HEAD.match(text)
    start = head.end() if head else 0
    return text[:start] + _GAP.sub(_narrowed, text[start:])


def _narrowed(found: re.Match[str]) -> str:
    gap, note = found["gap"], found["note"]
    if gap is None:
        return found[0]
    return f"  {note}" if note else " "
