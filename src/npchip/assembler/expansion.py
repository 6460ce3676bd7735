"""Statements, and the macros, repetitions and files that they came from."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from npchip.assembler.diagnostics import Diagnostic, Note, Span
from npchip.assembler.lexer import Token

_SHOWN = 4


@dataclass(eq=False)
class Expansion:
    """The origin of a line that a macro, a repetition or an included file brought.

    Attributes:
        what: the macro, repetition or file, as messages call it.
        at: where it was used or included.
        outer: how that place came to stand there.
        generates: whether it makes lines; an included file only brings them.
    """

    what: str
    at: Span
    outer: Expansion | None
    generates: bool = True

    def way(self) -> Iterator[Expansion]:
        """Yield this one and those around it, innermost first."""
        step: Expansion | None = self
        while step is not None:
            yield step
            step = step.outer

    def notes(self) -> list[Note]:
        """The way from the innermost use outwards; the middle of a long one is left out."""
        notes = [
            Note(f"in {step.what}, {'expanded' if step.generates else 'included'} here", step.at)
            for step in self.way()
        ]
        left_out = len(notes) - _SHOWN
        if left_out > 1:
            notes[_SHOWN - 1 : -1] = [Note(f"... and {left_out} more in between")]
        return notes


class Statement(NamedTuple):
    """An instruction as written; its address is its index among the statements.

    Attributes:
        tokens: mnemonic and operands; an END or BROKEN token last.
        expansion: how it came to stand here, if not by being written here.
    """

    tokens: tuple[Token, ...]
    expansion: Expansion | None


def with_backtrace(
    diagnostic: Diagnostic, first: Token | None, expansion: Expansion | None
) -> Diagnostic:
    """The diagnostic with notes that lead from an expanded line to where it was asked for.

    Args:
        diagnostic: may point to an argument, which was written where a macro is used.
        first: the first token of the line that is wrong, if it was a line.
        expansion: how the line came there.
    """
    if expansion is None:
        return diagnostic
    notes: list[Note] = []
    if first is not None and diagnostic.span.line is not first.line:
        notes.append(Note("this line uses it", first.span))
    return diagnostic.with_notes([*notes, *expansion.notes()])
