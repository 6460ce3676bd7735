"""Diagnostics: a message with its place in the source, the notes that explain it, and help."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Literal, NamedTuple

from npchip.base.errors import NpchipError
from npchip.base.frozen import PortableError
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
    """A remark on a diagnostic, with a place of its own if it has one."""

    message: str
    span: Span | None = None


class Diagnostic(NamedTuple):
    """An error or a warning, its place, notes, and a suggestion."""

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
        """Return the diagnostic with further notes."""
        return self._replace(notes=(*self.notes, *notes))


_SHOWN = 4


@dataclass(eq=False)
class Expansion:
    """A macro, repetition or included file that a line came from.

    Attributes:
        what: the macro, repetition or file, as messages name it.
        at: the place where it was used or included.
        outer: the expansion that this place came from, if any.
        generates: True for a macro or a repetition, False for an included file.
    """

    what: str
    at: Span
    outer: Expansion | None
    generates: bool = True

    def _outwards(self) -> Iterator[Expansion]:
        step: Expansion | None = self
        while step is not None:
            yield step
            step = step.outer

    def notes(self) -> list[Note]:
        """Return a note for each place of use, innermost first, without the middle of many."""
        notes = [
            Note(f"in {step.what}, {'expanded' if step.generates else 'included'} here", step.at)
            for step in self._outwards()
        ]
        left_out = len(notes) - _SHOWN
        if left_out > 1:
            notes[_SHOWN - 1 : -1] = [Note(f"... and {left_out} more in between")]
        return notes


def with_backtrace(
    diagnostic: Diagnostic, start: Span | None, expansion: Expansion | None
) -> Diagnostic:
    """Return a diagnostic with notes that lead from an expanded line to its use.

    Args:
        diagnostic: the diagnostic; it may point to an argument, written where a macro is used.
        start: the start of the wrong line, if a line is wrong.
        expansion: the expansion that the line came from.
    """
    if expansion is None:
        return diagnostic
    notes = expansion.notes()
    if start is not None and diagnostic.span.line is not start.line:
        notes.insert(0, Note("this line uses it", start))
    return diagnostic.with_notes(notes)


_WIDTH = 120


def _excerpt(span: Span) -> str:
    """Return a line with a caret below it. A long line is cut around the caret."""
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
    """Return white space as wide as a character; a tab stays a tab."""
    if char == "\t":
        return char
    if unicodedata.combining(char):
        return ""
    return "  " if unicodedata.east_asian_width(char) in "WF" else " "


def printable(text: str) -> str:
    """Return a text without control characters, which a terminal would obey."""
    return "".join(
        char if char.isprintable() or char == "\t" else "\N{REPLACEMENT CHARACTER}" for char in text
    )


_QUOTED = 40


def quoted(text: str) -> str:
    """Return a word of the source in quotes, cut if it is long, as messages name it."""
    short = text if len(text) <= _QUOTED else f"{text[:_QUOTED]}…"
    return f"'{printable(short)}'"


def short_name(name: str) -> str:
    """Return a name as helps show it where it is to be written; one too long as ``NAME``."""
    return printable(name) if len(name) <= _QUOTED else "NAME"


class AssemblyError(NpchipError):
    """A source with errors, in the order of the source (exit code 2).

    Args:
        diagnostics: the errors, at least one.
        stopped: True if the assembler gave up because of their number.

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


class SourceError(PortableError):
    """An error in one statement, which is skipped; `diagnostic` is what to report."""

    def __init__(
        self, code: str, message: str, span: Span, *notes: Note, suggestion: str | None = None
    ) -> None:
        super().__init__(message)
        self.diagnostic = Diagnostic("error", code, message, span, notes, suggestion)


class FollowUpError(Exception):
    """An error that follows from a reported one: the statement is skipped without a message."""


_LONGEST = 40
_CANDIDATES = 400


def nearest(word: str, known: Iterable[str]) -> str | None:
    """Return the known word nearest to a misspelt one, or None if none is near.

    The search is slow, so it skips long words and all but the first 400 known ones.
    """
    if len(word) > _LONGEST:
        return None
    near = (item for item in known if len(item) <= 2 * len(word) + 1)
    table = {item.lower(): item for item in islice(near, _CANDIDATES)}
    match = near_miss(word.lower(), table)
    return table[match] if match and table[match] != word else None


def did_you_mean(word: str, known: Iterable[str]) -> str | None:
    """Return a hint that names the known word nearest to a misspelt one, if one is near."""
    found = nearest(word, known)
    return f"did you mean {found}?" if found else None
