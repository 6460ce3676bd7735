"""Errors that a user can cause: a stable code, a message that names the place, a remedy."""

from __future__ import annotations

import re
from typing import ClassVar


class NpchipError(Exception):
    """Base of every error that is the input's fault, not the program text's.

    Args:
        code: stable identifier such as ``"NP201"``, listed in ``docs/errors.md``.
        message: what was expected and what was found, naming the place. One about a line of a file
            begins with ``FILE:LINE: ``, and is shown as ``FILE:LINE: error: ...``, which editors
            take for a place to jump to.
        hint: what the user can do about it, if there is something to say.

    Attributes:
        exit_code: what the command line exits with.
    """

    exit_code: ClassVar[int] = 2

    def __init__(self, code: str, message: str, *, hint: str | None = None) -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.hint = hint

    def __str__(self) -> str:
        place, message = _split(self.message)
        text = f"{place}error: {message} [{self.code}]"
        return f"{text}\n  hint: {self.hint}" if self.hint else text


def _split(message: str) -> tuple[str, str]:
    """Part the place at the beginning of a message from the rest."""
    found = re.match(r"(?:(?!: ).)+:\d+: ", message)
    return (found[0], message[found.end() :]) if found else ("", message)


class InputError(NpchipError):
    """A file, an array or an option that cannot be used (exit code 2)."""


class IsaError(NpchipError):
    """An instruction-set file that contradicts itself; the message names entry and line."""
