"""Popups for the help and for long answers."""

from __future__ import annotations

from typing import Final

from textual.app import ComposeResult
from textual.containers import VerticalScroll
from textual.screen import ModalScreen
from textual.widgets import Static

from npchip.debugger.commands import COMMANDS
from npchip.debugger.screen.keys import KEYS

SCROLLING: Final = frozenset({"up", "down", "left", "right", "pageup", "pagedown", "home", "end"})
"""Keys that move the text of a popup."""
CLOSING: Final = frozenset({"escape", "q", "question_mark", "enter", "space"})
"""Keys that do no more than to close a popup; all others then do their work."""


def help_text() -> str:
    """Return the help on keys, commands and conditions."""
    keys = "\n".join(f"  {keys.shown:<9} {keys.text}" for keys in KEYS)
    commands = "\n".join(f"  {item.syntax:<17} {item.text}" for item in COMMANDS)
    extra = "  show VALUE|frame|bank N   what the picture is of\n  np R C            select an NP"
    conditions = (
        "  scan    scan + 3    FILE:LINE    line 40    0x1F    PLACE if TEST\n"
        "  any r3 > 40    all Z == 1    np(3,4).mem[0x12] changes    np(3,4).r3 == 7\n"
        "  pixel(20,33) < 10    pixel(20,33,64) > 5    output 2    output row > 9    mask empty\n"
        "  pc  frame  cycles  frame_cycles  instructions  calls"
    )
    return (
        f"Keys\n{keys}\n\nCommands (:)\n{commands}\n{extra}\n\nConditions and values\n{conditions}"
    )


class Popup(ModalScreen[None]):
    """Shows a text until a key closes it, which is up to the application."""

    CSS = """
    Popup { align: center middle; }
    Popup VerticalScroll {
        width: auto; max-width: 96%; height: auto; max-height: 96%;
        border: round $accent; background: $surface; padding: 0 1;
    }
    Popup Static { width: auto; }
    """

    def __init__(self, text: str, title: str) -> None:
        super().__init__()
        self._text, self._title = text, title

    def compose(self) -> ComposeResult:
        """Yield the text in a frame."""
        with VerticalScroll() as frame:
            frame.border_title = self._title
            frame.border_subtitle = "up and down scroll, any other key closes"
            yield Static(self._text, markup=False)
