"""A reader of debugger commands and test lines."""

from __future__ import annotations

from collections.abc import Iterable

from npchip.assembler.diagnostics import Line, SourceError, did_you_mean
from npchip.assembler.expressions import Lookup, evaluate
from npchip.assembler.lexer import Kind, Syntax, Token, expected, read_tokens


class LineReader:
    """Reads one line from left to right.

    Args:
        line: the line; messages show it.
        syntax: its language.
        start: first column.

    Raises:
        SourceError: by every method, with the language's code, if the line holds something else.
    """

    def __init__(self, line: Line, syntax: Syntax, start: int = 0) -> None:
        self._line = line
        self._code = syntax.malformed
        self._tokens: list[Token] = []
        self._at = 0
        read_tokens(line, syntax, start, self._tokens)

    def peek(self, ahead: int = 0) -> Token:
        """Return the next token, or one after it, without taking it."""
        return self._tokens[min(self._at + ahead, len(self._tokens) - 1)]

    def take(self) -> Token:
        """Take the next token."""
        token = self.peek()
        self._at += 1
        return token

    def accept(self, *texts: str) -> str | None:
        """Take the next token and return its text if it is one of these names or signs."""
        token = self.peek()
        if token.ends or token.text not in texts:
            return None
        self._at += 1
        return token.text

    def sign(self, text: str) -> None:
        """Take a sign that must come next."""
        if self.accept(text) is None:
            raise self.wrong(f"'{text}'")

    def first_sign(self, text: str) -> None:
        """Take a sign that must come next, or a name's first letters if they are this text."""
        token = self.peek()
        rest = token.text.removeprefix(text)
        if token.kind is not Kind.NAME or rest in {token.text, ""}:
            self.sign(text)
        else:
            column = token.column + len(text)
            self._tokens[self._at] = token._replace(text=rest, column=column)

    def end(self) -> None:
        """Raise an error unless the line ends here."""
        if not self.peek().ends:
            raise self.wrong("the end of the line")

    def rest(self) -> str:
        """Return the text from the next token to the end of the line, without a comment."""
        return self.text_from(self.peek())

    def text_from(self, first: Token) -> str:
        """Return the text from a token to the end of the line, without a comment."""
        return self._line.text[first.column : self._tokens[-1].column].strip()

    def literal(self, what: str) -> int:
        """Take a number literal, which messages call `what`, and return its value."""
        if self.peek().kind is not Kind.NUMBER:
            raise self.wrong(what)
        return self.take().value

    def expression(self, what: str, names: Lookup) -> int:
        """Take numbers and names joined by ``+``, ``-`` and ``*``, and return the value.

        Args:
            what: a name for the expression in messages.
            names: returns the value of a name.
        """
        tokens: list[Token] = []
        while True:
            while self.peek().text == "-":
                tokens.append(self.take())
            token = self.peek()
            if token.kind is Kind.NAME:
                token = token._replace(kind=Kind.NUMBER, value=names(token))
            elif token.kind is not Kind.NUMBER:
                raise self.wrong(what)
            tokens.append(token)
            self.take()
            if self.peek().text not in {"+", "-", "*"}:
                break
            tokens.append(self.take())
        try:
            return evaluate(tokens, self.peek(), names)
        except SourceError as error:
            message, span = error.diagnostic.message, error.diagnostic.span
            raise SourceError(self._code, message, span) from None

    def wrong(self, what: str, known: Iterable[str] = (), hint: str | None = None) -> SourceError:
        """Make the error for the next token, with `hint` or the nearest of the `known` words."""
        token = self.peek()
        near = None if token.ends else did_you_mean(token.text, known)
        return expected(self._code, what, token, hint or near)
