"""Constant expressions: integers and names joined by the operators in `LEVELS`."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, Literal

from npchip.assembler.diagnostics import SourceError
from npchip.assembler.lexer import Kind, Token, expected

Lookup = Callable[[Token], int]
"""Returns the value of a name; raises `SourceError` if it has none."""

Op = Literal["==", "!=", "<", "<=", ">", ">="]
COMPARISONS: Final[Mapping[str, Callable[[Any, Any], Any]]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<=": operator.le,
    ">=": operator.ge,
    "<": operator.lt,
    ">": operator.gt,
}

# Tightest first, as in Python and not as in C (decision): & ^ | bind tighter than comparisons.
LEVELS: Final[tuple[Mapping[str, Callable[[int, int], int]], ...]] = (
    {"*": operator.mul, "/": operator.floordiv, "%": operator.mod},
    {"+": operator.add, "-": operator.sub},
    {"<<": operator.lshift, ">>": operator.rshift},
    {"&": operator.and_},
    {"^": operator.xor},
    {"|": operator.or_},
    COMPARISONS,
)
_BINARY: Final = {
    sign: (-level, function)
    for level, table in enumerate(LEVELS)
    for sign, function in table.items()
}
_UNARY: Final[dict[str, Callable[[int], int]]] = {
    "-": operator.neg,
    "+": operator.pos,
    "~": operator.invert,
}
OPERATORS: Final = frozenset({*_BINARY, *_UNARY})

_LIMIT: Final = 1 << 62  # no expression can grow without bound
_UNARY_RANK: Final = 1
_OPEN_RANK: Final = -len(LEVELS)  # only its partner removes an open parenthesis


def evaluate(tokens: Sequence[Token], end: Token, lookup: Lookup) -> int:
    """Return the value of a whole expression.

    Operators wait on a stack until one that binds no tighter follows, so that no input nests
    Python calls.

    Args:
        tokens: the expression, without an END token.
        end: the token after it; an error about something missing points there.
        lookup: returns the value of a name or a local label.

    Raises:
        SourceError: NP009 malformed, NP010 division by zero or a result out of bounds, or an
            error from `lookup`.
    """
    if len(tokens) == 1 and tokens[0].kind is Kind.NUMBER:
        return tokens[0].value
    values: list[int] = []
    waiting: list[tuple[int, Token]] = []
    want_value = True
    for token in tokens:
        sign = token.text if token.kind is Kind.SIGN else ""
        if want_value:
            if sign == "(":
                waiting.append((_OPEN_RANK, token))
            elif sign in _UNARY:
                waiting.append((_UNARY_RANK, token))
            else:
                values.append(_operand(token, lookup))
                want_value = False
        elif sign in _BINARY:
            rank = _BINARY[sign][0]
            while waiting and waiting[-1][0] >= rank:
                _apply(values, *waiting.pop())
            waiting.append((rank, token))
            want_value = True
        elif sign == ")":
            while waiting and waiting[-1][0] > _OPEN_RANK:
                _apply(values, *waiting.pop())
            if not waiting:
                raise _expected(_OPERATOR, token, hint="no parenthesis is open here")
            waiting.pop()
        else:
            raise _expected(_OPERATOR, token, _AFTER_HINTS.get(token.text))
    if want_value:
        raise _expected("a number or a name", end)
    while waiting:
        if waiting[-1][0] == _OPEN_RANK:
            raise _expected("')'", end)
        _apply(values, *waiting.pop())
    return values[0]


def _operand(token: Token, lookup: Lookup) -> int:
    match token.kind:
        case Kind.NUMBER:
            return token.value
        case Kind.NAME | Kind.DOTTED:
            return lookup(token)
        case Kind.STRING:
            hint = "a character is written with single quotes, such as 'A'"
            raise _expected("a number or a name", token, hint)
    raise _expected("a number or a name", token, _SIGN_HINTS.get(token.text))


_OPERATOR: Final = "an operator or the end of the expression"
_AFTER_HINTS: Final = {":": "a label has its colon only where it is placed"}
_SIGN_HINTS: Final = {
    "#": "# stands only before the constant of an instruction",
    "%": "binary is written 0b0101",
    "&": "hexadecimal is written 0x1F",
}


def _apply(values: list[int], rank: int, sign: Token) -> None:
    """Replace the operands of a sign on the stack of values by its result."""
    right = values.pop()
    if rank == _UNARY_RANK:
        values.append(_UNARY[sign.text](right))
        return
    left = values.pop()
    if sign.text in {"/", "%"} and right == 0:
        raise SourceError("NP010", "division by zero", sign.span)
    if sign.text in {"<<", ">>"} and not 0 <= right < 63:
        raise SourceError("NP010", f"a shift by {right}: expected 0 to 62", sign.span)
    value = int(_BINARY[sign.text][1](left, right))
    if not -_LIMIT < value < _LIMIT:
        raise SourceError("NP010", "the result is larger than 62 bits", sign.span)
    values.append(value)


def _expected(what: str, token: Token, hint: str | None = None) -> SourceError:
    return expected("NP009", what, token, hint)
