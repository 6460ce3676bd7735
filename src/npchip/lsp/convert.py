"""Places and ranges of npchip in those of the protocol: lines from 0, columns in UTF-16 units."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from lsprotocol import types

_UNUSED: Final = frozenset({"NPW01", "NPW02", "NPW03", "NPW04"})
"""Warnings about what is there for nothing: editors show it pale."""


def units(text: str) -> int:
    """Return the number of UTF-16 units of a text."""
    return len(text) if text.isascii() else len(text.encode("utf-16-le", "surrogatepass")) // 2


def column_of(line: str, character: int) -> int:
    """Return the column of a position in a line; one behind the line is its end."""
    if line.isascii():
        return max(0, min(character, len(line)))
    count = 0
    for column, char in enumerate(line):
        if count >= character:
            return column
        count += 2 if ord(char) > 0xFFFF else 1
    return len(line)


def stretch(lines: Sequence[str], line: int, column: int, length: int) -> types.Range:
    """Return a stretch of a line; `line` counts from 1, and need not be there any more."""
    text = lines[line - 1] if 0 < line <= len(lines) else ""
    start = units(text[:column])
    end = start + units(text[column : column + length])
    return types.Range(types.Position(line - 1, start), types.Position(line - 1, end))


def placed(place: Mapping[str, Any] | None) -> types.Range:
    """Return the range of a place of `npchip.language.places`; None is the first character."""
    if place is None:
        return types.Range(types.Position(0, 0), types.Position(0, 1))
    line, start = place["line"] - 1, place["column"] - 1
    return types.Range(types.Position(line, start), types.Position(line, start + place["length"]))


def message_of(fault: Mapping[str, Any]) -> str:
    """Return what is said of a mistake: its message and its help."""
    help_ = fault["help"]
    return f"{fault['message']}\nhelp: {help_}" if help_ else str(fault["message"])


def diagnostic(
    fault: Mapping[str, Any], uri_of: Callable[[str], str], *, related: bool
) -> types.Diagnostic:
    """Return a mistake as the protocol has it.

    Args:
        fault: the mistake, as `npchip.language.places` has it.
        uri_of: gives the address of a file by its name in messages.
        related: whether the editor shows related places; if not, notes join the message.
    """
    notes = fault["notes"]
    message = message_of(fault)
    if not related:
        message = "\n".join([message, *(f"note: {note['message']}" for note in notes)])
    is_error = fault["severity"] == "error"
    severity = types.DiagnosticSeverity
    return types.Diagnostic(
        range=placed(fault["place"]),
        message=message,
        severity=severity.Error if is_error else severity.Warning,
        code=fault["code"],
        source="npchip",
        tags=[types.DiagnosticTag.Unnecessary] if fault["code"] in _UNUSED else None,
        related_information=[
            types.DiagnosticRelatedInformation(
                types.Location(uri_of(note["place"]["file"]), placed(note["place"])),
                note["message"],
            )
            for note in notes
        ]
        if related and notes
        else None,
    )


def address(path: Path) -> str:
    """Return the address of a file."""
    return path.absolute().as_uri()
