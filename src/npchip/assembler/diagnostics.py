"""What the assembler has to say about a source: place, caret, expected and found, suggestion."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from npchip.errors import NpchipError


@dataclass(frozen=True, slots=True)
class Line:
    """One line of a source file; `number` counts from 1."""

    file: str
    number: int
    text: str


@dataclass(frozen=True, slots=True)
class Span:
    """A stretch of a line; `column` counts from 0."""

    line: Line
    column: int
    length: int = 1


@dataclass(frozen=True, slots=True)
class Note:
    """A remark that belongs to a diagnostic, with its own place if it has one."""

    message: str
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One mistake (or warning), its place, and what helps."""

    severity: Literal["error", "warning"]
    code: str
    message: str
    span: Span
    notes: tuple[Note, ...] = ()
    suggestion: str | None = None

    def __str__(self) -> str:
        line = self.span.line
        place = f"{line.file}:{line.number}:{self.span.column + 1}"
        parts = [f"{place}: {self.severity}: {self.message} [{self.code}]", _excerpt(self.span)]
        for note in self.notes:
            if note.span is None:
                parts.append(f"  note: {note.message}")
            else:
                at = note.span
                parts.append(
                    f"{at.line.file}:{at.line.number}:{at.column + 1}: note: {note.message}"
                )
                parts.append(_excerpt(at))
        if self.suggestion:
            parts.append(f"  help: {self.suggestion}")
        return "\n".join(parts)


_WIDTH = 120


def _excerpt(span: Span) -> str:
    """The line with a caret below; tabs keep their width, a long line is cut around the caret."""
    start = max(0, span.column - _WIDTH // 2) if len(span.line.text) > _WIDTH else 0
    text = "".join(
        char if char.isprintable() or char == "\t" else "\N{REPLACEMENT CHARACTER}"
        for char in span.line.text[start : start + _WIDTH]
    )
    lead = "".join("\t" if char == "\t" else " " for char in text[: span.column - start])
    room = max(1, len(text) - len(lead))
    caret = "^" + "~" * (min(span.length, room) - 1)
    number = f"{span.line.number:5d}"
    return f"{number} | {text}\n{' ' * len(number)} | {lead}{caret}"


class AssemblyError(NpchipError):
    """A source with mistakes: all of them, in the order of the source (exit code 2).

    Attributes:
        diagnostics: every error and warning found.
    """

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        errors = sum(item.severity == "error" for item in self.diagnostics)
        super().__init__(self.diagnostics[0].code, f"{errors} error{'s' * (errors != 1)}")

    def __str__(self) -> str:
        return "\n".join([*map(str, self.diagnostics), self.message])


class SourceError(Exception):
    """Carries one diagnostic from where it is found to where the statement is skipped."""

    def __init__(
        self, code: str, message: str, span: Span, *notes: Note, suggestion: str | None = None
    ) -> None:
        super().__init__(message)
        self.diagnostic = Diagnostic("error", code, message, span, notes, suggestion)


def did_you_mean(word: str, known: Iterable[str]) -> str | None:
    """A suggestion for a misspelt word, if one of the known words is near."""
    table = {item.lower(): item for item in known}
    match = difflib.get_close_matches(word.lower(), list(table), n=1, cutoff=0.6)
    return f"did you mean {table[match[0]]}?" if match else None
