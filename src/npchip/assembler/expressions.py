"""Constant expressions: integers, names, the operators of the table below."""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from typing import Final

from npchip.assembler.diagnostics import SourceError
from npchip.assembler.lexer import Kind, Token

Lookup = Callable[[Token], int]
"""Value of a name; raises `SourceError` where it has none."""

_LIMIT: Final = 1 << 62  # no expression can grow without bound
_MAX_DEPTH: Final = 64

# Tightest first. Comparisons bind loosest (decision: as in Python, not as in C).
_LEVELS: Final[tuple[dict[str, Callable[[int, int], int]], ...]] = (
    {"*": operator.mul, "/": operator.floordiv, "%": operator.mod},
    {"+": operator.add, "-": operator.sub},
    {"<<": operator.lshift, ">>": operator.rshift},
    {"&": operator.and_},
    {"^": operator.xor},
    {"|": operator.or_},
    {
        "==": operator.eq,
        "!=": operator.ne,
        "<": operator.lt,
        "<=": operator.le,
        ">": operator.gt,
        ">=": operator.ge,
    },
)
OPERATORS: Final = frozenset("~").union(*_LEVELS)


def evaluate(tokens: Sequence[Token], end: Token, lookup: Lookup) -> int:
    """Value of a whole expression.

    Args:
        tokens: the expression, without an END token.
        end: the token that follows it, to blame where something is missing.
        lookup: gives the value of a name or a local label.

    Raises:
        SourceError: NP009 malformed, NP010 division by zero or a result out of bounds, and
            whatever `lookup` raises.
    """
    parser = _Parser(tokens, end, lookup)
    value = parser.level(len(_LEVELS) - 1)
    if parser.next is not end:
        raise parser.error("an operator")
    return value


class _Parser:
    def __init__(self, tokens: Sequence[Token], end: Token, lookup: Lookup) -> None:
        self._tokens = [*tokens, end]
        self._position = 0
        self._depth = 0
        self._lookup = lookup

    @property
    def next(self) -> Token:
        return self._tokens[self._position]

    def error(self, expected: str) -> SourceError:
        return SourceError(
            "NP009", f"expected {expected}, found {self.next.shown()}", self.next.span
        )

    def level(self, number: int) -> int:
        if number < 0:
            return self._unary()
        table = _LEVELS[number]
        value = self.level(number - 1)
        while self.next.kind is Kind.SIGN and self.next.text in table:
            sign = self.next
            self._position += 1
            value = _apply(sign, table[sign.text], value, self.level(number - 1))
        return value

    def _unary(self) -> int:
        token = self.next
        self._depth += 1
        if self._depth > _MAX_DEPTH:
            raise SourceError("NP009", "the expression is nested too deeply", token.span)
        value = self._primary(token)
        self._depth -= 1
        return value

    def _primary(self, token: Token) -> int:
        if token.kind is Kind.END or self._position == len(self._tokens) - 1:
            raise self.error("a number or a name")
        self._position += 1
        match token.kind, token.text:
            case Kind.NUMBER, _:
                return token.value
            case ((Kind.NAME | Kind.DOTTED), _):
                return self._lookup(token)
            case Kind.SIGN, "-":
                return -self._unary()
            case Kind.SIGN, "+":
                return self._unary()
            case Kind.SIGN, "~":
                return ~self._unary()
            case Kind.SIGN, "(":
                value = self.level(len(_LEVELS) - 1)
                if self.next.text != ")":
                    raise self.error("')'")
                self._position += 1
                return value
        self._position -= 1
        raise self.error("a number or a name")


def _apply(sign: Token, function: Callable[[int, int], int], left: int, right: int) -> int:
    if sign.text in {"/", "%"} and right == 0:
        raise SourceError("NP010", "division by zero", sign.span)
    if sign.text in {"<<", ">>"} and not 0 <= right < 63:
        raise SourceError("NP010", f"a shift by {right}: expected 0 to 62", sign.span)
    value = int(function(left, right))
    if not -_LIMIT < value < _LIMIT:
        raise SourceError("NP010", "the result is larger than 62 bits", sign.span)
    return value
