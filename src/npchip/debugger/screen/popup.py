"""Texts over the screen: help, and answers of more than one line."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.screen import ModalScreen
from textual.widgets import Static

from npchip.debugger.commands import COMMANDS

KEYS = (
    ("s  S", "step; back one instruction"),
    ("n  o", "step over a call; out of the routine"),
    ("r  R", "run; run back to the last stop"),
    ("f  F", "next frame; back to the frame before"),
    ("c", "run to the cursor"),
    ("0", "restart"),
    ("escape", "interrupt what is going on"),
    ("b", "breakpoint at the cursor, or away with it"),
    ("w  g", "who wrote what is shown of the selected NP last; go there"),
    ("e", "edit it"),
    (":", "command line"),
    ("h j k l", "select the NP to the left, below, above, to the right"),
    ("H J K L", "the same for pixels"),
    ("[  ]", "picture of the register, flag or bank before; after"),
    ("p", "picture: frame or values"),
    ("up down", "cursor in the source; NP where the picture has the focus"),
    ("tab  t", "source or picture; next source file"),
    ("?  q", "this help; quit"),
)


def help_text() -> str:
    """Keys and commands."""
    keys = "\n".join(f"  {key:<9} {text}" for key, text in KEYS)
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
    """A text that any of a few keys closes."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,q,question_mark,enter,space", "dismiss", "Close")
    ]
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
        """The text in a frame."""
        with VerticalScroll() as frame:
            frame.border_title = self._title
            frame.border_subtitle = "escape closes"
            yield Static(self._text, markup=False)

    async def action_dismiss(self, _result: None = None) -> None:
        """Close."""
        self.dismiss(None)
