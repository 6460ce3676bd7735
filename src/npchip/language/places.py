"""Diagnostics and their places in JSON."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from npchip.assembler import AssemblyError, Diagnostic
from npchip.assembler.diagnostics import Span
from npchip.base.errors import NpchipError

_PLACE = re.compile(r"(?P<file>(?:(?!: ).)+):(?P<line>\d+): (?P<message>.*)", re.DOTALL)


def place(span: Span) -> dict[str, Any]:
    """Return a span as a ``Place``: columns count from 1, in the UTF-16 units of JavaScript."""
    line = span.line
    before, marked = (
        _units(line.text[start : start + length])
        for start, length in ((0, span.column), (span.column, span.length))
    )
    return {
        "file": line.file,
        "line": line.number,
        "column": before + 1,
        "length": max(marked, 1),
    }


def _units(text: str) -> int:
    return len(text.encode("utf-16-le", "surrogatepass")) // 2


def diagnostic(found: Diagnostic) -> dict[str, Any]:
    """Return an error or a warning as a ``Diagnostic``."""
    return {
        "severity": found.severity,
        "code": found.code,
        "message": found.message,
        "help": found.suggestion,
        "place": place(found.span),
        "notes": [
            {"message": note.message, "place": place(note.span or found.span)}
            for note in found.notes
        ],
    }


def diagnostics(error: NpchipError) -> Iterator[dict[str, Any]]:
    """Yield each mistake of an error; one that is no place of a source has none."""
    if isinstance(error, AssemblyError):
        yield from map(diagnostic, error.diagnostics)
        return
    found = _PLACE.match(error.message)
    yield {
        "severity": "error",
        "code": error.code,
        "message": found["message"] if found else error.message,
        "help": error.hint,
        "place": found
        and {"file": found["file"], "line": int(found["line"]), "column": 1, "length": 1},
        "notes": [],
    }
