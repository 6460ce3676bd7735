"""Debugger scripts: files of commands, executed without a screen."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from npchip.assembler.sources import split_lines
from npchip.base.errors import InputError
from npchip.base.files import open_input
from npchip.debugger.commands import Commands
from npchip.debugger.session import Debugger

_MOST_BYTES = 1 << 18


def read_script(path: Path) -> tuple[str, list[str]]:
    """Read a script; ``-`` is standard input.

    Returns:
        its name in messages, and its lines.

    Raises:
        InputError: NP353, it cannot be read, is no UTF-8 text, or is larger than 256 KiB.
    """
    name = "standard input" if str(path) == "-" else str(path)
    try:
        with sys.stdin.buffer if str(path) == "-" else open_input(path) as file:
            data = file.read(_MOST_BYTES + 1)
        if len(data) > _MOST_BYTES:
            raise InputError("NP353", f"{name}: a script of more than {_MOST_BYTES:,} bytes")
        return name, split_lines(data.decode("utf-8-sig"))
    except OSError as error:
        raise InputError("NP353", f"cannot read {name}: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise InputError("NP353", f"{name}: not UTF-8 text at byte {error.start}") from None


def run_script(
    debugger: Debugger, lines: list[str], name: str, say: Callable[[str], None]
) -> list[str]:
    """Execute the lines of a script.

    Args:
        debugger: the session.
        lines: the commands.
        name: the script's name in messages.
        say: called with each command and its answer.

    Returns:
        messages on the expectations that failed.

    Raises:
        CommandError: a line that cannot be read. Those before it have been executed.
    """
    commands = Commands(debugger)
    failures = []
    for number, line in enumerate(lines, 1):
        reply = commands.execute(line, name, number)
        text = line.strip()
        if text and text[0] not in "#;":
            say(f"> {text}\n{reply.text}")
        if reply.failed:
            failures.append(f"{name}:{number}: error: {reply.text} [NP354]")
    return failures
