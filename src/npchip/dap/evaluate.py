"""Expressions and commands in the language of the debugger."""

from __future__ import annotations

from typing import Any, Final

from npchip.base.errors import NpchipError
from npchip.dap.arguments import Arguments
from npchip.dap.session import Session
from npchip.dap.variables import edit, shown_plane
from npchip.debugger.commands import COMMANDS
from npchip.debugger.language import parse_number, parse_test, parse_value
from npchip.debugger.values import COUNTERS, Cell

Body = dict[str, Any]

MOVING: Final = {"step", "over", "out", "run", "until", "frame", "back", "goto", "restart"}
"""Commands that move the program."""
SEARCHING: Final = {"who"}
"""Commands that take long, and leave it where it is."""
_SHORT: Final = {item.short: item.name for item in COMMANDS if item.short}
_MORE: Final = ("np", "any", "all", "pixel", "mem", "active", "Z", "C", "output", "line", "mask")


def command_of(text: str) -> str | None:
    """Return the command that a text begins with, by its long name; None if it is none."""
    words = text.split(maxsplit=1)
    name = _SHORT.get(words[0], words[0]) if words else ""
    return name if name in {item.name for item in COMMANDS} else None


def lasting(arguments: Arguments) -> str | None:
    """Return the command of the console that moves or searches; None for all else."""
    name = command_of(arguments.text("expression"))
    lasts = name in MOVING | SEARCHING and arguments.text("context", "") == "repl"
    return name if lasts else None


def evaluate(session: Session, arguments: Arguments) -> Body:
    """Evaluate an expression; in the console also a command that is done at once.

    Raises:
        NpchipError: it cannot be read.
    """
    text = arguments.text("expression").strip()
    if arguments.text("context", "") == "repl":
        first, _, rest = text.partition(" ")
        if first == "choose":
            session.choose(*session.commands.processor(rest.strip().removeprefix("np")))
            return {"result": "np({},{})".format(*session.chosen), **_LEAF}
        if command_of(text) or not text:
            return {"result": session.commands.execute(text).text, **_LEAF}
    return _value(session, text, "#04x" if arguments.inner("format").flag("hex") else "")


_LEAF: Final = {"variablesReference": 0}


def _value(session: Session, text: str, style: str) -> Body:
    """Return a quantity, a test, a number, or what ``print`` knows."""
    names, chip = session.debugger.names, session.debugger.chip
    try:
        value = parse_value(text, names)
    except NpchipError as fault:
        for attempt in (_test, _number, _print):
            try:
                return {"result": attempt(session, text), **_LEAF}
            except NpchipError:
                continue
        raise fault from None
    if isinstance(value, Cell):
        return shown_plane(session, value, style)
    return {"result": format(value.value(chip), style), **_LEAF}


def _test(session: Session, text: str) -> str:
    holds = parse_test(text, session.debugger.names).holds(session.debugger.chip)
    return "true" if holds else "false"


def _number(session: Session, text: str) -> str:
    number = parse_number(text, session.debugger.names)
    return f"{number}, 0x{number:02X}" if number >= 0 else str(number)


def _print(session: Session, text: str) -> str:
    return session.commands.execute(f"print {text}").text


def set_expression(session: Session, arguments: Arguments) -> Body:
    """Edit a place of the debugger's language.

    Raises:
        NpchipError: as the command ``edit``.
    """
    return edit(session, arguments.text("expression"), arguments.text("value"), arguments)


def completions(session: Session, arguments: Arguments) -> Body:
    """Return the words that may stand where the user types, as far as their letters tell."""
    program, first = session.debugger.program, session.client.first
    lines = arguments.text("text").split("\n")
    line = lines[min(arguments.number("line", first, first) - first, len(lines) - 1)]
    typed = line[: arguments.number("column", least=first) - first]
    start = len(typed)
    while start and (typed[start - 1].isalnum() or typed[start - 1] == "_"):
        start -= 1
    commands = () if typed[:start].strip() else (*(item.name for item in COMMANDS), "choose")
    words = (*program.registers, *program.labels, *program.symbols, *COUNTERS, *_MORE)
    known = dict.fromkeys((*commands, *words))
    found = [word for word in known if word.startswith(typed[start:])]
    return {
        "targets": [
            {"label": word, "start": start, "length": len(typed) - start} for word in found[:100]
        ]
    }
