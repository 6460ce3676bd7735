"""Diagnostics: the place in a source, a caret below it, what was expected and found, help."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable
from itertools import islice
from typing import Literal, NamedTuple

from npchip.base.errors import NpchipError
from npchip.base.suggest import near_miss


class Line(NamedTuple):
    """One line of a source file; `number` counts from 1."""

    file: str
    number: int
    text: str


class Span(NamedTuple):
    """A stretch of a line; `column` counts from 0."""

    line: Line
    column: int
    length: int = 1

    def __str__(self) -> str:
        return f"{self.line.file}:{self.line.number}:{self.column + 1}"


class Note(NamedTuple):
    """A remark that belongs to a diagnostic, with its own place if it has one."""

    message: str
    span: Span | None = None


class Diagnostic(NamedTuple):
    """One mistake (or warning), its place, and what helps."""

    severity: Literal["error", "warning"]
    code: str
    message: str
    span: Span
    notes: tuple[Note, ...] = ()
    suggestion: str | None = None

    def __str__(self) -> str:
        parts = [f"{self.span}: {self.severity}: {self.message} [{self.code}]", _excerpt(self.span)]
        for note in self.notes:
            if note.span is None:
                parts.append(f"  note: {note.message}")
            else:
                parts += [f"{note.span}: note: {note.message}", _excerpt(note.span)]
        if self.suggestion:
            parts.append(f"  help: {self.suggestion}")
        return "\n".join(parts)

    def with_notes(self, notes: Iterable[Note]) -> Diagnostic:
        """The same diagnostic with further notes."""
        return self._replace(notes=(*self.notes, *notes))


_WIDTH = 120


def _excerpt(span: Span) -> str:
    """The line with a caret below; tabs keep their width, a long line is cut around the caret."""
    line = span.line.text
    start = max(0, span.column - _WIDTH // 2) if len(line) > _WIDTH else 0
    text = printable(line[start : start + _WIDTH])
    lead = "".join(map(_blank, text[: span.column - start]))
    room = max(1, len(text) - (span.column - start))
    caret = "^" + "~" * (min(span.length, room) - 1)
    left, right = "…" * (start > 0), "…" * (start + _WIDTH < len(line))
    number = f"{span.line.number:5d}"
    margin = " " * len(number)
    return f"{number} | {left}{text}{right}\n{margin} | {' ' * len(left)}{lead}{caret}"


def _blank(char: str) -> str:
    """White space as wide as a character."""
    if char == "\t":
        return char
    if unicodedata.combining(char):
        return ""
    return "  " if unicodedata.east_asian_width(char) in "WF" else " "


def printable(text: str) -> str:
    """The text without control characters, which could do anything to a terminal."""
    return "".join(
        char if char.isprintable() or char == "\t" else "\N{REPLACEMENT CHARACTER}" for char in text
    )


_QUOTED = 40


def quoted(text: str) -> str:
    """A word of the source as a message names it."""
    short = text if len(text) <= _QUOTED else f"{text[:_QUOTED]}…"
    return f"'{printable(short)}'"


class AssemblyError(NpchipError):
    """A source with mistakes: all of them, in the order of the source (exit code 2).

    Args:
        diagnostics: the errors, at least one.
        stopped: whether there were too many to go on.

    Attributes:
        diagnostics: the errors.
    """

    def __init__(self, diagnostics: Iterable[Diagnostic], *, stopped: bool = False) -> None:
        self.diagnostics = tuple(diagnostics)
        count = len(self.diagnostics)
        tail = ", and the assembler stopped there" if stopped else ""
        super().__init__(self.diagnostics[0].code, f"{count} error{'s' * (count != 1)}{tail}")

    def __str__(self) -> str:
        return "\n".join([*map(str, self.diagnostics), self.message])


class SourceError(Exception):
    """Carries one diagnostic from where it is found to where the statement is skipped."""

    def __init__(
        self, code: str, message: str, span: Span, *notes: Note, suggestion: str | None = None
    ) -> None:
        super().__init__(message)
        self.diagnostic = Diagnostic("error", code, message, span, notes, suggestion)


class FollowUpError(Exception):
    """Only follows from a mistake that has been reported: the statement is skipped in silence."""


class TooManyErrors(Exception):  # noqa: N818 - it ends the assembly, it is no error class
    """No further mistake would help anybody."""


_LONGEST = 40
_CANDIDATES = 400


def nearest(word: str, known: Iterable[str]) -> str | None:
    """The known word that a misspelt one is nearest to, if it is near.

    Only so many words of a sane length are looked at: the search takes time.
    """
    if len(word) > _LONGEST:
        return None
    near = (item for item in known if len(item) <= 2 * len(word) + 1)
    table = {item.lower(): item for item in islice(near, _CANDIDATES)}
    match = near_miss(word.lower(), table)
    return table[match] if match and table[match] != word else None


def did_you_mean(word: str, known: Iterable[str]) -> str | None:
    """A hint for a misspelt word, if one of the known words is near."""
    found = nearest(word, known)
    return f"did you mean {found}?" if found else None
