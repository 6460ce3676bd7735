"""Changes that the help of a mistake asks for, where it says them exactly."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import Final, NamedTuple


class Fix(NamedTuple):
    """A change of one line: `length` characters from `column` on become `text`."""

    title: str
    column: int
    length: int
    text: str


class _At(NamedTuple):
    """The place of a mistake in its line."""

    line: str
    column: int
    length: int

    @property
    def word(self) -> str:
        return self.line[self.column : self.column + self.length]


_Make = Callable[[_At, re.Match[str]], Fix | None]


def _replace(at: _At, found: re.Match[str]) -> Fix:
    text = found[1]
    if at.word.startswith('"'):
        text = f'"{text}"'
    return Fix(f"Change {at.word} to {text}", at.column, at.length, text)


def _one(at: _At, found: re.Match[str]) -> Fix:
    return Fix(f"Type {found[1]} anew", at.column, 1, found[1])


def _number_sign(at: _At, _found: re.Match[str]) -> Fix:
    return Fix("Insert #", at.column, 0, "#")


def _no_number_sign(at: _At, _found: re.Match[str]) -> Fix | None:
    return Fix("Delete #", at.column, 1, "") if at.word == "#" else None


def _comment(at: _At, _found: re.Match[str]) -> Fix | None:
    if not re.match(r"//|/\*|[/@#*|-]", at.word):
        return None
    return Fix("Begin the comment with ;", at.column, at.length, ";")


def _comma(at: _At, _found: re.Match[str]) -> Fix:
    before = at.line[: at.column].rstrip()
    return Fix("Insert a comma", len(before), 0, ",")


def _blank(at: _At, _found: re.Match[str]) -> Fix:
    return Fix("Change it to a space", at.column, 1, " ")


def _delete(at: _At, _found: re.Match[str]) -> Fix:
    before = at.line[: at.column].rstrip()
    return Fix("Delete the comment", len(before), len(at.line) - len(before), "")


_RULES: Final[tuple[tuple[re.Pattern[str], _Make], ...]] = tuple(
    (re.compile(pattern), make)
    for pattern, make in (
        (r"did you mean (\S+)\?", _replace),
        (r"^write hexadecimal as (0x\w+)$", _replace),
        (r"^directives begin with a dot: (\.\w+)$", _replace),
        (r"^if it is a label, it ends with a colon: (\w+:)$", _replace),
        (r"^it looks like (\S) but is another character", _one),
        (r"^it is invisible, or looks like a space", _blank),
        (r"^a constant begins with #: #", _number_sign),
        (r"^this operand is written without #$", _no_number_sign),
        (r"^a comment begins with ;$", _comment),
        (r"^(?:is )?a comma (?:is )?missing\??$", _comma),
        (r"^delete the comment$", _delete),
    )
)
_OF_THE_LINE: Final = frozenset({"NP012"})
"""Codes whose place is the line and not the word that the help is about."""


def fixes(code: str, help_: str | None, line: str, column: int, length: int) -> Iterator[Fix]:
    """Yield the changes that the help of a mistake asks for.

    Args:
        code: the mistake's code.
        help_: its help.
        line: the line that it is in.
        column: where it is, from 0.
        length: number of its characters.
    """
    if not help_ or code in _OF_THE_LINE:
        return
    at = _At(line, column, min(length, len(line) - column))
    for pattern, make in _RULES:
        found = pattern.search(help_)
        if found:
            fix = make(at, found)
            if fix is not None:
                yield fix
