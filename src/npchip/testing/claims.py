"""The parser of ``; expect:`` and ``; mistake:`` lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from npchip.assembler.diagnostics import Line, SourceError, Span
from npchip.assembler.expressions import COMPARISONS, Op
from npchip.assembler.lexer import Kind, Syntax, Token, expected, token_pattern
from npchip.assembler.reader import LineReader

FUNCTIONS = ("min", "max", "sum", "len")
GOLDEN_PARTS = ("outputs", "cycles")
MAX_POINTS = 1000
_KEYWORDS = ("all", "any", "setup", "total", "worst")


@dataclass(frozen=True)
class Range:
    """Whole numbers from `first` to `last`, both included; None is the end."""

    first: int
    last: int | None

    def __str__(self) -> str:
        return f"{self.first}..{'' if self.last is None else self.last}"


Wanted = int | Range | tuple[int, ...] | str | None
"""The right side: a number, a range, a list, a word such as ``halted``, or ``null``."""

Frames = Literal["all", "any", "setup", "total", "worst"] | Range | None
"""The first brackets; None without brackets."""


@dataclass(frozen=True)
class Claim:
    """``function(name[frames][element]) op value, value``.

    Attributes:
        span: place of the claim.
        text: the claim as written, without a comment.
        name: an output or a measure such as ``cycles``; `name_span` is its place.
        function: one of `FUNCTIONS`, or None.
        frames: the frames that it is about.
        element: (row, column) of pixels, or (item,); empty for the whole value.
        op: the comparison.
        values: one for all frames, or one for each.
        points: what it counts where a class is graded.
    """

    span: Span
    text: str
    name: str
    name_span: Span
    function: str | None
    frames: Frames
    element: tuple[Range, ...]
    op: Op
    values: tuple[Wanted, ...]
    points: int = 1


@dataclass(frozen=True)
class GoldenClaim:
    """``golden``, ``golden outputs`` or ``golden cycles``: equal to the golden file."""

    span: Span
    text: str
    outputs: bool
    cycles: bool
    points: int = 1


@dataclass(frozen=True)
class Mistake:
    """A claim that holds of runs whose program has a known mistake.

    Attributes:
        claim: a comparison that holds where the mistake was made.
        text: what to say to its author.
    """

    claim: Claim
    text: str


_EXAMPLE = "such as: center_row[3] == 31"
_SYNTAX = Syntax(
    token_pattern(r"\.\.|==|!=|<=|>=|[-<>=\[\](),.]", name=r"[A-Za-z_][\w-]*", minus="-?"),
    "NP270",
    "NP270",
    otherwise=f"an expectation is a comparison {_EXAMPLE}",
)


def parse_claim(line: Line, start: int) -> Claim | GoldenClaim:
    """Read the claim in `line` from column `start` to the end or a comment (``;``).

    Raises:
        SourceError: NP270, it is not a claim.
    """
    parser = _Parser(line, _SYNTAX, start)
    points = parser.points()
    after = parser.peek(1)
    golden = parser.peek().text == "golden" and (after.ends or after.kind is Kind.NAME)
    claim = parser.golden() if golden else parser.claim()
    points = points or parser.points()
    parser.end()
    return replace(claim, points=points or 1)


def parse_mistake(line: Line, start: int) -> Mistake:
    """Read a claim from column `start` on, and the comment behind it as the text.

    Raises:
        SourceError: NP270, it is not a claim, or no text follows.
    """
    claim = parse_claim(line, start)
    text = line.text[start:].partition(";")[2].strip(" ;")
    if isinstance(claim, GoldenClaim):
        raise SourceError("NP270", "a mistake is a comparison, not a golden", claim.span)
    if not text:
        hint = "such as: ; mistake: picture == null ; nothing is sent: OUT does that"
        raise SourceError(
            "NP270", "a mistake needs words for its author", claim.span, suggestion=hint
        )
    return Mistake(claim, text)


class _Parser(LineReader):
    def golden(self) -> GoldenClaim:
        first = self.take()
        part = self.peek()
        if not part.ends and not self._at_points():
            self._one_of(GOLDEN_PARTS, "golden, golden outputs or golden cycles")
        span, text = self._so_far(first)
        outputs, cycles = part.text != "cycles", part.text != "outputs"
        return GoldenClaim(span, text, outputs, cycles)

    def claim(self) -> Claim:
        first = self.peek()
        function: str | None = None
        if self.peek(1).text == "(":
            function = self._one_of(FUNCTIONS, f"one of {', '.join(FUNCTIONS)} before '('")
            self.take()
        name = self.peek()
        if name.kind is not Kind.NAME:
            raise self.wrong("the name of an output, or cycles, words, status ...")
        self.take()
        frames: Frames = None
        element: tuple[Range, ...] = ()
        if self.accept("["):
            frames = self._frames()
            self.sign("]")
            if self.accept("["):
                element = self._element()
        if function:
            self.sign(")")
        op = self._op()
        values = self._values()
        span, text = self._so_far(first)
        return Claim(span, text, name.text, name.span, function, frames, element, op, values)

    def points(self) -> int | None:
        """Take ``points=N``, if it comes next."""
        if not self._at_points():
            return None
        self.take()
        self.take()
        token = self.peek()
        value = self.literal(f"points from 1 to {MAX_POINTS}")
        if not 1 <= value <= MAX_POINTS:
            raise expected("NP270", f"points from 1 to {MAX_POINTS}", token)
        return value

    def end(self) -> None:
        """Refuse anything more but a comment."""
        if self.peek().kind is Kind.NAME:
            raise self.wrong("the end of the line", hint="a remark begins with another ;")
        super().end()

    # ---- parts of a claim

    def _one_of(self, words: Sequence[str], what: str) -> str:
        if self.peek().text not in words:
            raise self.wrong(what, words)
        return self.take().text

    def _frames(self) -> Frames:
        if self.peek().kind is Kind.NAME:
            what = f"frame numbers or {', '.join(_KEYWORDS)}"
            return self._one_of(_KEYWORDS, what)  # type: ignore[return-value]
        return self._range("a frame number, or all, any, setup ...", negative=True)

    def _element(self) -> tuple[Range, ...]:
        first = self._range("a row or an item, counted from 0")
        others = (self._range("a column, counted from 0"),) if self.accept(",") else ()
        self.sign("]")
        return (first, *others)

    def _range(self, what: str, *, negative: bool = False) -> Range:
        token = self.peek()
        first = self.literal(what)
        last: int | None = first
        if self.accept(".."):
            last = self.literal(what) if self.peek().kind is Kind.NUMBER else None
        for value in (first, last):
            if value is not None and value < 0 and not negative:
                raise expected("NP270", what, token)
        if last is not None and (first < 0) == (last < 0):
            return _ordered(first, last, token)
        return Range(first, last)

    def _values(self) -> tuple[Wanted, ...]:
        values = [self._value()]
        while self.accept(","):
            values.append(self._value())
        return tuple(values)

    def _value(self) -> Wanted:
        token = self.peek()
        if token.kind is Kind.NAME:
            self.take()
            return None if token.text == "null" else token.text
        if self.accept("["):
            if self.accept("]"):
                return ()
            items = [self.literal("a number or ']'")]
            while self.accept(","):
                items.append(self.literal("a number"))
            self.sign("]")
            return tuple(items)
        first = self.literal("a number, a range such as 30..34, [a, list], null or a word")
        if not self.accept(".."):
            return first
        return _ordered(first, self.literal("the last number of the range"), token)

    def _op(self) -> Op:
        token = self.peek()
        if token.text not in COMPARISONS:
            hints = {
                "=": "did you mean ==?",
                ".": "frames stand in brackets: name[3], name[3..8]",
                "[": "rows and columns share a bracket: picture[3][10, 20]",
            }
            hint = f"an expectation is a comparison {_EXAMPLE}" if token.ends else None
            raise self.wrong("one of == != < <= > >=", hint=hint or hints.get(token.text))
        return self.take().text  # type: ignore[return-value]

    def _at_points(self) -> bool:
        return self.peek().text == "points" and self.peek(1).text == "="

    def _so_far(self, first: Token) -> tuple[Span, str]:
        text = first.line.text[first.column : self.peek().column].strip()
        return Span(first.line, first.column, len(text)), text


def _ordered(first: int, last: int, token: Token) -> Range:
    if last < first:
        raise SourceError("NP270", f"the range {first}..{last} is empty", token.span)
    return Range(first, last)
