"""One ``; expect:`` line: what it claims, read without a program or a result."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

from npchip.assembler.diagnostics import Line, SourceError, Span, did_you_mean

Op = Literal["==", "!=", "<", "<=", ">", ">="]
OPS: tuple[Op, ...] = ("==", "!=", "<=", ">=", "<", ">")
FUNCTIONS = ("min", "max", "sum", "len")
GOLDEN_PARTS = ("outputs", "cycles")
_KEYWORDS = ("all", "any", "setup", "total", "worst")


@dataclass(frozen=True)
class Range:
    """Whole numbers from `first` to `last`, both included; None: to the end."""

    first: int
    last: int | None

    def __str__(self) -> str:
        return f"{self.first}..{'' if self.last is None else self.last}"


Value = int | Range | tuple[int, ...] | str | None
"""What stands on the right: a number, a range, a list, a word such as ``halted``, or ``null``."""

Frames = Literal["all", "any", "setup", "total", "worst"] | Range | None
"""What stands in the first brackets; None without brackets."""


@dataclass(frozen=True)
class Claim:
    """``function(name[frames][element]) op value, value``.

    Attributes:
        span: place of the claim.
        text: the claim as it was written, without a remark.
        name: an output or a measure such as ``cycles``; `name_span` is its place.
        function: one of `FUNCTIONS`, or None.
        frames: which frames it speaks of.
        element: (row, column) of pixels, or (item,); empty for the whole value.
        op: the comparison.
        values: one for all frames, or one for each.
    """

    span: Span
    text: str
    name: str
    name_span: Span
    function: str | None
    frames: Frames
    element: tuple[Range, ...]
    op: Op
    values: tuple[Value, ...]


@dataclass(frozen=True)
class GoldenClaim:
    """``golden``, ``golden outputs`` or ``golden cycles``: as recorded in the golden file."""

    span: Span
    text: str
    outputs: bool
    cycles: bool


@dataclass(frozen=True)
class _Token:
    kind: Literal["number", "word", "sign", "end"]
    text: str
    span: Span

    def shown(self) -> str:
        return "the end of the line" if self.kind == "end" else f"'{self.text}'"


_TOKEN = re.compile(
    r"""\s*(?:
      (?P<end>;|$)
    | (?P<number>-?\d\w*)
    | (?P<word>[A-Za-z_][\w-]*)
    | (?P<sign>\.\.|==|!=|<=|>=|[-<>=\[\](),.])
    )""",
    re.VERBOSE | re.ASCII,
)
_EXAMPLE = "such as: center_row[3] == 31"


def parse_claim(line: Line, start: int) -> Claim | GoldenClaim:
    """Read the claim in `line` from column `start` on, up to its end or a remark (``;``).

    Raises:
        SourceError: NP270, it is none.
    """
    parser = _Parser(line, start)
    if parser.peek().text == "golden" and parser.peek(1).kind in {"word", "end"}:
        return parser.golden()
    return parser.claim()


def number(text: str) -> int | None:
    """Read a decimal, ``0x`` or ``0b`` number; None if it is none."""
    try:
        return int(text, 0) if re.match(r"-?0[xXbB]", text) else int(text)
    except ValueError:
        return None


class _Parser:
    def __init__(self, line: Line, start: int) -> None:
        self._line = line
        self._tokens: list[_Token] = []
        self._at = 0
        position = start
        while not self._tokens or self._tokens[-1].kind != "end":
            match = _TOKEN.match(line.text, position)
            if match is None:
                rest = line.text[position:]
                column = position + len(rest) - len(rest.lstrip())
                raise SourceError(
                    "NP270",
                    f"unexpected character '{line.text[column]}'",
                    Span(line, column),
                    suggestion=f"an expectation is a comparison {_EXAMPLE}",
                )
            position = match.end()
            kind = match.lastgroup or "end"
            column = match.start(kind)
            span = Span(line, column, max(1, position - column))
            self._tokens.append(_Token(kind, match[kind], span))  # type: ignore[arg-type]

    def peek(self, ahead: int = 0) -> _Token:
        return self._tokens[min(self._at + ahead, len(self._tokens) - 1)]

    def golden(self) -> GoldenClaim:
        first = self._next()
        token = self._next()
        if token.kind != "end":
            if token.text not in GOLDEN_PARTS:
                near = did_you_mean(token.text, GOLDEN_PARTS)
                raise _wrong("golden, golden outputs or golden cycles", token, near)
            self._end()
        part = token.text if token.kind == "word" else ""
        span = self._whole(first)
        return GoldenClaim(span, _text(span), outputs=part != "cycles", cycles=part != "outputs")

    def claim(self) -> Claim:
        first = self.peek()
        function: str | None = None
        if self.peek(1).text == "(":
            function = self._next().text
            if function not in FUNCTIONS:
                near = did_you_mean(function, FUNCTIONS)
                raise _wrong(f"one of {', '.join(FUNCTIONS)} before '('", first, near)
            self._next()
        name = self._word("the name of an output, or cycles, words, status ...")
        frames: Frames = None
        element: tuple[Range, ...] = ()
        if self._accept("["):
            frames = self._frames()
            self._sign("]")
            if self._accept("["):
                element = self._element()
        if function:
            self._sign(")")
        op = self._op()
        values = self._values()
        self._end()
        span = self._whole(first)
        return Claim(span, _text(span), name.text, name.span, function, frames, element, op, values)

    # ---- parts of a claim

    def _frames(self) -> Frames:
        token = self.peek()
        if token.kind == "word":
            self._next()
            if token.text not in _KEYWORDS:
                near = did_you_mean(token.text, _KEYWORDS)
                raise _wrong(f"frame numbers or {', '.join(_KEYWORDS)}", token, near)
            return token.text  # type: ignore[return-value]
        return self._range("a frame number, or all, any, setup ...", negative=True)

    def _element(self) -> tuple[Range, ...]:
        parts = [self._range("a row or an item, counted from 0")]
        if self._accept(","):
            parts.append(self._range("a column, counted from 0"))
        self._sign("]")
        return tuple(parts)

    def _range(self, expected: str, *, negative: bool = False) -> Range:
        token = self.peek()
        first = self._number(expected)
        last: int | None = first
        if self._accept(".."):
            last = self._number(expected) if self.peek().kind == "number" else None
        for value in (first, last):
            if value is not None and value < 0 and not negative:
                raise _wrong(expected, token)
        if last is not None and (first < 0) == (last < 0) and last < first:
            raise SourceError("NP270", f"the range {first}..{last} is empty", token.span)
        return Range(first, last)

    def _values(self) -> tuple[Value, ...]:
        values = [self._value()]
        while self._accept(","):
            values.append(self._value())
        return tuple(values)

    def _value(self) -> Value:
        token = self.peek()
        if token.kind == "word":
            self._next()
            return None if token.text == "null" else token.text
        if self._accept("["):
            items: list[int] = []
            if not self._accept("]"):
                items.append(self._number("a number or ']'"))
                while self._accept(","):
                    items.append(self._number("a number"))
                self._sign("]")
            return tuple(items)
        first = self._number("a number, a range such as 30..34, [a, list], null or a word")
        if not self._accept(".."):
            return first
        last = self._number("the last number of the range")
        if last < first:
            raise SourceError("NP270", f"the range {first}..{last} is empty", token.span)
        return Range(first, last)

    def _op(self) -> Op:
        token = self._next()
        if token.text not in OPS:
            hints = {
                "=": "did you mean ==?",
                ".": "frames stand in brackets: name[3], name[3..8]",
                "end": f"an expectation is a comparison {_EXAMPLE}",
                "[": "rows and columns share a bracket: picture[3][10, 20]",
            }
            hint = hints.get("end" if token.kind == "end" else token.text)
            raise _wrong("one of == != < <= > >=", token, hint)
        return token.text

    # ---- tokens

    def _next(self) -> _Token:
        token = self.peek()
        self._at += 1
        return token

    def _accept(self, sign: str) -> bool:
        if self.peek().text != sign:
            return False
        self._at += 1
        return True

    def _sign(self, sign: str) -> None:
        token = self._next()
        if token.text != sign:
            raise _wrong(f"'{sign}'", token)

    def _word(self, expected: str) -> _Token:
        token = self._next()
        if token.kind != "word":
            raise _wrong(expected, token)
        return token

    def _number(self, expected: str) -> int:
        token = self._next()
        value = number(token.text) if token.kind == "number" else None
        if value is None:
            raise _wrong(expected, token)
        return value

    def _end(self) -> None:
        token = self._next()
        if token.kind != "end":
            hint = "a remark begins with another ;" if token.kind == "word" else None
            raise _wrong("the end of the line", token, hint)

    def _whole(self, first: _Token) -> Span:
        last = self._tokens[-2].span
        return Span(self._line, first.span.column, last.column + last.length - first.span.column)


def _text(span: Span) -> str:
    return span.line.text[span.column : span.column + span.length]


def _wrong(expected: str, token: _Token, suggestion: str | None = None) -> SourceError:
    message = f"expected {expected}, found {token.shown()}"
    return SourceError("NP270", message, token.span, suggestion=suggestion)
