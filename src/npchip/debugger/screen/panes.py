"""The panes of the screen: source, NP, counters, picture, outputs."""

from __future__ import annotations

from typing import Final, NamedTuple

from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical
from textual.content import Content
from textual.events import Resize
from textual.widgets import Static

from npchip.debugger.screen import texts
from npchip.debugger.screen.look import Look, Shown, Sources, title
from npchip.debugger.screen.picture import WIDE, Picture
from npchip.debugger.screen.source import Source
from npchip.debugger.session import Debugger

_LEFT: Final = 38
_LINES: Final = 5
"""Lines of the source that are shown if there is room for anything."""


class View(NamedTuple):
    """The content of the panes.

    Attributes:
        look: snapshot of the session.
        since: cycles since the previous stop.
        shown: subject of the picture.
        pixel: row and column of the selected pixel, whose NP is selected too.
    """

    look: Look
    since: int
    shown: Shown
    pixel: tuple[int, int]


class Outputs(Static):
    """Shows the outputs of as many frames as fit."""

    _look: Look | None = None

    def show(self, look: Look) -> None:
        """Draw a snapshot."""
        self._look = look
        self.refresh()

    def render(self) -> Content:
        """Return the text for the pane's size."""
        size = self.size
        return Content(texts.outputs(self._look, size.width, size.height) if self._look else "")


class Panes(Horizontal):
    """All panes.

    Args:
        debugger: the session; only its program and machine are used.
        view: first content.
    """

    DEFAULT_CSS = """
    Panes { height: 1fr; }
    Panes #left { width: 38; margin-right: 1; }
    Panes #right { width: 1fr; }
    Panes .head { height: 1; background: $primary; color: $text; text-style: bold; }
    Panes #source { height: 1fr; scrollbar-size: 0 0; }
    Panes #np { height: 9; }
    Panes #counters { height: 4; }
    Panes #picture { height: 1fr; max-height: 33; scrollbar-size: 1 1; }
    Panes #outputs { height: 4; }
    """

    def __init__(self, debugger: Debugger, view: View) -> None:
        super().__init__()
        self._program = debugger.program
        self._shape = debugger.chip.machine.geometry
        self._sources = Sources(debugger)
        self._view = view

    def compose(self) -> ComposeResult:
        """Yield source, NP and counters on the left, and picture and outputs on the right."""
        with Vertical(id="left"):
            yield Static(id="source-head", classes="head", markup=False)
            yield Source(self._sources, id="source")
            yield Static(id="np-head", classes="head", markup=False)
            yield Static(id="np", markup=False)
            yield Static(id="counters", markup=False)
        with Vertical(id="right"):
            yield Static(id="picture-head", classes="head", markup=False)
            yield Picture(self._shape, id="picture")
            yield Outputs(id="outputs")

    def on_resize(self, event: Resize) -> None:
        """Give the picture the width it needs and the rest to the source, lines before others."""
        wanted = WIDE * self._shape[1] + 1
        self.query_one("#left").styles.width = max(_LEFT, event.size.width - wanted)
        self.query_one(Source).styles.min_height = max(1, min(_LINES, event.size.height - 1))

    def show(self, view: View, *, follow: bool = False) -> None:
        """Draw a view; `follow` moves the source's cursor to the next instruction."""
        self._view = view
        look, (row, column) = view.look, (view.pixel[0] // 8, view.pixel[1] // 8)
        self.query_one(Source).show(look, follow=follow)
        self._text("np-head", f" NP ({row},{column})")
        self._text("np", texts.processor(look, self._program, row, column))
        self._text("counters", texts.counters(look, view.since, self._sources))
        self.query_one(Picture).show(look, view.shown, (row, column))
        self.query_one(Outputs).show(look)
        self.heads()

    def heads(self) -> None:
        """Draw the titles of source and picture, with a mark at the focused one."""
        source, picture, view = self.query_one(Source), self.query_one(Picture), self._view
        caption = texts.caption(view.look, view.shown, view.pixel, self._program)
        for name, pane, text in (
            ("source-head", source, f"{title(source.file)}  cycles, line"),
            ("picture-head", picture, caption),
        ):
            self._text(name, f"{'▸' if pane.has_focus else ' '}{text}")

    def on_descendant_focus(self) -> None:
        """Mark the pane that has the focus."""
        self.heads()

    def _text(self, name: str, text: str) -> None:
        self.query_one(f"#{name}", Static).update(text)
