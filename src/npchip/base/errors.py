"""Errors that a user can cause, with a stable code, a message and a hint."""

from __future__ import annotations

import re
from typing import ClassVar

from npchip.base.frozen import PortableError


class NpchipError(PortableError):
    """Base of the errors that a user's input causes.

    Args:
        code: stable identifier such as ``"NP201"``, listed in ``docs/errors.md``.
        message: states the place, what was expected, and what was found. If it begins with
            ``FILE:LINE: ``, the error is shown as ``FILE:LINE: error: ...``, which editors turn
            into a link.
        hint: advice to the user, if there is any.

    Attributes:
        exit_code: exit code of the command line.
    """

    exit_code: ClassVar[int] = 2

    def __init__(self, code: str, message: str, *, hint: str | None = None) -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.hint = hint

    def __str__(self) -> str:
        place = re.match(r"(?:(?:(?!: ).)+:\d+: )?", self.message)
        assert place is not None
        text = f"{place[0]}error: {self.message[place.end() :]} [{self.code}]"
        return f"{text}\n  hint: {self.hint}" if self.hint else text


class InputError(NpchipError):
    """A file, an array or an option that cannot be used (exit code 2)."""


class IsaError(NpchipError):
    """An instruction-set file that contradicts itself; the message names entry and line."""
