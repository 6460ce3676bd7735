"""The picture pane: 8 columns and 4 rows of the screen for each NP."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.segment import Segment
from rich.style import Style
from textual.events import Click
from textual.geometry import Size
from textual.message import Message
from textual.scroll_view import ScrollView
from textual.strip import Strip

from npchip.debugger.screen.look import Look, Shown
from npchip.debugger.values import Cell

WIDE, HIGH = 8, 4
"""Columns and rows of the screen for each NP. A half block shows two pixels."""
_MARK = "#ffb000"
_INACTIVE = "╲"


class Picture(ScrollView, can_focus=True):
    """Shows one value of every NP, or all pixels as half blocks.

    Strokes cross inactive NPs. A frame surrounds the selected NP.
    """

    class Picked(Message):
        """A pixel was clicked on.

        Attributes:
            pixel: its row and column.
        """

        def __init__(self, pixel: tuple[int, int]) -> None:
            super().__init__()
            self.pixel = pixel

    def __init__(self, shape: tuple[int, int], **extra: Any) -> None:
        super().__init__(**extra)
        self._shape = shape
        self.virtual_size = Size(WIDE * shape[1], HIGH * shape[0])
        self._active = np.ones(shape, np.bool_)
        self._image: NDArray[Any] | None = None  # a value for each NP, or for each pixel
        self._selected = (0, 0)

    def show(self, look: Look, shown: Shown, selected: tuple[int, int]) -> None:
        """Draw a snapshot. `selected` is the row and column of an NP."""
        self._active, self._selected = look.active, selected
        self._image = shown.plane(look) if isinstance(shown, Cell) else look.pixels(shown)
        self.refresh()

    def reveal(self) -> None:
        """Scroll to the selected NP."""
        row, column = self._selected
        x, y = self.scroll_offset
        width, height = self.size
        if not x <= column * WIDE <= x + width - WIDE:
            self.scroll_to(x=max(0, column * WIDE - width // 2), animate=False)
        if not y <= row * HIGH <= y + height - HIGH:
            self.scroll_to(y=max(0, row * HIGH - height // 2), animate=False)

    def render_line(self, y: int) -> Strip:
        """Draw one row of the screen."""
        scroll_x, scroll_y = self.scroll_offset
        y += scroll_y
        image = self._image
        if image is None or y >= HIGH * self._shape[0]:
            return Strip.blank(self.size.width)
        draw = self._values if image.shape == self._shape else self._pixels
        return draw(image, y).crop(scroll_x, scroll_x + self.size.width)

    def _values(self, plane: NDArray[Any], y: int) -> Strip:
        row, part = divmod(y, HIGH)
        segments = []
        bright = 255 if plane.dtype == np.bool_ else 1
        for column in range(self._shape[1]):
            value = int(plane[row, column])
            inside = f"{value:^6d}" if part == 1 else f"0x{value:02X}".center(6)
            if part in {0, 3}:
                inside = " " * 6
            if not self._active[row, column]:
                blank = _INACTIVE * 6
                inside = blank if part in {0, 3} else _INACTIVE + inside[1:5] + _INACTIVE
            left, right = self._frame(row, column, part)
            grey = value * bright
            ink = "#000000" if grey > 110 else "#ffffff"
            style = Style(color=ink, bgcolor=f"#{grey:02x}{grey:02x}{grey:02x}")
            edge = style + Style(color=_MARK, bold=True) if left != " " else style
            segments += [Segment(left, edge), Segment(inside, style), Segment(right, edge)]
        return Strip(segments)

    def _frame(self, row: int, column: int, part: int) -> tuple[str, str]:
        if (row, column) != self._selected:
            return " ", " "
        return ("┏", "┓") if part == 0 else ("┗", "┛") if part == 3 else ("┃", "┃")

    def _pixels(self, pixels: NDArray[Any], y: int) -> Strip:
        top, bottom = pixels[2 * y].tolist(), pixels[2 * y + 1].tolist()
        row, part = divmod(y, HIGH)
        segments = []
        for column in range(self._shape[1]):
            marks: dict[int, str] = {}
            if not self._active[row, column]:
                marks = {2 * part: _INACTIVE, 2 * part + 1: _INACTIVE}
            left, right = self._frame(row, column, part)
            if left != " " and part in {0, 3}:
                marks |= {0: left, 7: right}
            for x in range(WIDE):
                upper, lower = top[column * WIDE + x], bottom[column * WIDE + x]
                if x in marks:
                    grey = (upper + lower) // 2
                    ink = _MARK if marks[x] != _INACTIVE else "#000000" if grey > 110 else "#ffffff"
                    segments.append(Segment(marks[x], _style(ink, grey)))
                else:
                    segments.append(
                        Segment("▀", _style(f"#{upper:02x}{upper:02x}{upper:02x}", lower))
                    )
        return Strip(segments).simplify()

    def on_click(self, event: Click) -> None:
        """Post a message with the pixel that was clicked on."""
        x, y = event.x + self.scroll_offset.x, event.y + self.scroll_offset.y
        if x < WIDE * self._shape[1] and y < HIGH * self._shape[0]:
            self.post_message(self.Picked((2 * y, x)))


@cache
def _style(ink: str, grey: int) -> Style:
    return Style(color=ink, bgcolor=f"#{grey:02x}{grey:02x}{grey:02x}")
