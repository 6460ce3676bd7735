"""Key bindings and their help."""

from __future__ import annotations

from typing import Final, NamedTuple

from textual.binding import Binding


class Keys(NamedTuple):
    """A group of keys.

    Attributes:
        shown: the keys in the help.
        text: their effect in the help.
        actions: action of each key, by Textual's name of the key.
    """

    shown: str
    text: str
    actions: dict[str, str]


KEYS: Final = (
    Keys("s  S", "step; back one instruction", {"s": "do('step')", "S": "do('back')"}),
    Keys(
        "n  o",
        "step over a call; out of the routine",
        {"n": "do('over')", "o": "do('out')"},
    ),
    Keys(
        "r  R",
        "run; run back to the last stop",
        {"r": "do('run')", "R": "do('run back')"},
    ),
    Keys(
        "f  F",
        "next frame; back to the frame before",
        {"f": "do('frame')", "F": "do('frame back')"},
    ),
    Keys("c", "run to the cursor", {"c": "to_cursor"}),
    Keys("0", "restart", {"0": "do('restart')"}),
    Keys("escape", "interrupt what is going on", {"escape": "interrupt"}),
    Keys(
        "b  space",
        "breakpoint at the cursor, or away with it",
        {"b": "breakpoint", "space": "breakpoint"},
    ),
    Keys(
        "w  g",
        "who wrote what is shown of the selected NP last; go there",
        {"w": "who", "g": "go"},
    ),
    Keys("e", "edit it", {"e": "edit"}),
    Keys(":", "command line", {"colon": "command"}),
    Keys(
        "h j k l",
        "select the NP to the left, below, above, to the right",
        {"h": "pick(0, -8)", "j": "pick(8, 0)", "k": "pick(-8, 0)", "l": "pick(0, 8)"},
    ),
    Keys(
        "H J K L",
        "the same for pixels",
        {"H": "pick(0, -1)", "J": "pick(1, 0)", "K": "pick(-1, 0)", "L": "pick(0, 1)"},
    ),
    Keys(
        "[  ]",
        "picture of the register, flag or bank before; after",
        {"left_square_bracket": "cycle(-1)", "right_square_bracket": "cycle(1)"},
    ),
    Keys("p", "picture: frame or values", {"p": "plane"}),
    Keys(
        "arrows",
        "cursor in the source, and its text sideways; NP where the picture has the focus",
        {
            "up": "arrow(-1, 0)",
            "down": "arrow(1, 0)",
            "left": "arrow(0, -1)",
            "right": "arrow(0, 1)",
            "pageup": "arrow(-10, 0)",
            "pagedown": "arrow(10, 0)",
        },
    ),
    Keys("tab  t", "source or picture; next source file", {"tab": "focus_next", "t": "file"}),
    Keys("?  q", "this help; quit", {"question_mark": "help", "q": "quit"}),
)

# Textual runs priority bindings before it delivers the next key. Without priority, keys pressed
# just after a colon would miss the command line.
_LATE: Final = ("interrupt", "quit")

BINDINGS: Final = [
    Binding(key, action, keys.text, priority=action not in _LATE)
    for keys in KEYS
    for key, action in keys.actions.items()
]
