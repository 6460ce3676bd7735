"""A line of the debugger's language as words, numbers and signs; its mistakes with their place."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from npchip.assembler.diagnostics import Line, SourceError, Span, did_you_mean, quoted
from npchip.base.errors import NpchipError

_TOKEN = re.compile(
    r"""\s*(?:
      (?P<end>[;#]|$)
    | (?P<number>\d\w*)
    | "(?P<quoted>[^"]*)"
    | (?P<word>[A-Za-z_.][\w./]*)
    | (?P<sign>==|!=|<=|>=|[-+*=<>()\[\],.:])
    )""",
    re.VERBOSE | re.ASCII,
)


class CommandError(NpchipError):
    """A condition or command that cannot be understood: place, caret, what was expected."""

    def __init__(self, fault: SourceError) -> None:
        super().__init__(fault.diagnostic.code, fault.diagnostic.message)
        self.diagnostic = fault.diagnostic

    def __str__(self) -> str:
        return str(self.diagnostic)


@dataclass(frozen=True)
class Token:
    """A word, number or sign, and where it stands."""

    kind: Literal["number", "word", "quoted", "sign", "end"]
    text: str
    span: Span

    def shown(self) -> str:
        """How messages call it."""
        return "the end of the line" if self.kind == "end" else quoted(self.text)


class Tokens:
    """Reads one line from left to right.

    Args:
        line: the line; messages show it.
        start: first column.

    Raises:
        SourceError: NP350, from every method, where something else was expected.
    """

    def __init__(self, line: Line, start: int = 0) -> None:
        self._line = line
        self._tokens: list[Token] = []
        self._at = 0
        position = start
        while not self._tokens or self._tokens[-1].kind != "end":
            match = _TOKEN.match(line.text, position)
            if match is None:
                rest = line.text[position:]
                column = position + len(rest) - len(rest.lstrip())
                char = quoted(line.text[column])
                raise SourceError("NP350", f"unexpected character {char}", Span(line, column))
            kind = match.lastgroup or "end"
            column = match.start(kind)
            position = match.end()
            marks = kind == "quoted"
            span = Span(line, column - marks, max(1, len(match[kind])) + 2 * marks)
            self._tokens.append(Token(kind, match[kind], span))  # type: ignore[arg-type]

    def peek(self, ahead: int = 0) -> Token:
        """A token that comes, without taking it."""
        return self._tokens[min(self._at + ahead, len(self._tokens) - 1)]

    def take(self) -> Token:
        """The next token."""
        token = self.peek()
        self._at += 1
        return token

    def accept(self, *texts: str) -> str | None:
        """Take the next token if it is one of these."""
        token = self.peek()
        if token.kind not in {"word", "sign"} or token.text not in texts:
            return None
        self._at += 1
        return token.text

    def sign(self, text: str) -> None:
        """Take a sign that must come."""
        if self.accept(text) is None:
            raise self.wrong(f"'{text}'")

    def end(self) -> None:
        """Nothing more must come."""
        if self.peek().kind != "end":
            raise self.wrong("the end of the line")

    def rest(self) -> str:
        """The text from the next token to the end of the line, without a remark."""
        start, last = self.peek().span.column, self._tokens[-1].span.column
        return self._line.text[start:last].strip()

    def wrong(
        self, expected: str, known: Iterable[str] = (), hint: str | None = None
    ) -> SourceError:
        """Make the error for the next token; `known` are words for a near miss."""
        token = self.peek()
        return SourceError(
            "NP350",
            f"expected {expected}, found {token.shown()}",
            token.span,
            suggestion=hint or did_you_mean(token.text, known),
        )

    def unknown(self, message: str, token: Token, hint: str | None = None) -> SourceError:
        """Make the error for what the program does not have."""
        return SourceError("NP351", message, token.span, suggestion=hint)
