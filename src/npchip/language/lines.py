"""A line of a source, split as an editor needs it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Final, NamedTuple

from npchip.assembler.blocks import CLOSERS
from npchip.assembler.diagnostics import Line
from npchip.assembler.lexer import Kind, Token, after_labels, tokenize
from npchip.isa import Isa

BRANCHES: Final = frozenset({".elif", ".else"})
ENDS: Final = frozenset(CLOSERS.values())


class View(NamedTuple):
    """A line in tokens.

    Attributes:
        tokens: the tokens; the last is END, or BROKEN where the line cannot be read.
        at: index of the first token after the labels.
        word: that token if it is a directive, in lower case, or an instruction's or macro's name
            as it is written; empty for none.
    """

    tokens: tuple[Token, ...]
    at: int
    word: str

    @property
    def broken(self) -> bool:
        """True if the line cannot be read to its end."""
        return self.tokens[-1].kind is Kind.BROKEN

    @property
    def comment(self) -> str:
        """The comment with its semicolon, or an empty text."""
        return self.tokens[-1].text

    @property
    def labels(self) -> tuple[Token, ...]:
        """The labels at its start."""
        return self.tokens[: self.at : 2]


@lru_cache(maxsize=1 << 11)
def view(text: str) -> View:
    """Return a line in tokens; their file is empty and their line 0."""
    tokens = tokenize(Line("", 0, text), lambda _: None)
    at = after_labels(tokens)
    first = tokens[at]
    word = ""
    if first.kind is Kind.DOTTED:
        word = first.text.lower()
    elif first.kind is Kind.NAME:
        word = first.text
    return View(tuple(tokens), at, word)


def word_at(text: str, column: int) -> Token | None:
    """Return the name, directive or number that a column lies in or behind; None in a comment."""
    behind = None
    for token in view(text).tokens:
        if token.kind in {Kind.SIGN, Kind.END, Kind.BROKEN, Kind.STRING}:
            continue
        if token.column <= column < token.column + len(token.text):
            return token
        if token.column + len(token.text) == column:
            behind = token
    return behind


def code_end(text: str) -> int:
    """Return the column at which the code of a line ends, before its comment and blanks."""
    shown = view(text)
    if shown.broken:
        return len(text.rstrip())
    return len(text.rstrip()) - len(shown.comment) if not shown.comment else _before_comment(shown)


def _before_comment(shown: View) -> int:
    before = shown.tokens[-2] if len(shown.tokens) > 1 else None
    return before.column + len(before.text) if before else 0


def opened(isa: Isa) -> Mapping[str, int]:
    """Return by mnemonic, in capitals, what it does to masked regions: 1 opens, 0 inverts, -1."""
    found: dict[str, int] = {}
    for name, forms in isa.forms.items():
        effects = forms[0].effects
        for effect, change in (("mask_push", 1), ("mask_invert", 0), ("mask_pop", -1)):
            if effect in effects:
                found[name] = change
    return found
