"""Arguments of directives and macros: a line's tokens, split at the commas."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise

from npchip.assembler import lexer
from npchip.assembler.diagnostics import SourceError
from npchip.assembler.expressions import OPERATORS, Lookup, evaluate
from npchip.assembler.lexer import Kind, Token


def split(tokens: Sequence[Token]) -> list[list[Token]]:
    """Split at the commas outside parentheses and brackets; the line's last token ends the list.

    An empty argument is given as the token that stands in its place, so that a message can
    point there.
    """
    if tokens[0].ends:
        return []
    parts: list[list[Token]] = [[]]
    depth = 0
    for token in tokens:
        if token.ends or (token.text == "," and depth == 0):
            if not parts[-1]:
                parts[-1].append(token)
            if token.ends:
                break
            parts.append([])
            continue
        if token.kind is Kind.SIGN:
            depth += (token.text in "([") - (token.text in ")]")
        parts[-1].append(token)
    return parts


def is_empty(argument: Sequence[Token]) -> bool:
    """Return whether nothing was written in an argument's place."""
    return argument[0].ends or argument[0].text == ","


def single_name(argument: Sequence[Token], what: str = "a name") -> Token:
    """Return the one name that an argument must be."""
    if argument[0].kind is not Kind.NAME:
        raise expected(what, argument[0])
    if len(argument) > 1:
        raise expected("a comma or the end of the line", argument[1])
    return argument[0]


def number(argument: Sequence[Token], line: Sequence[Token], lookup: Lookup) -> int:
    """Return the value of an argument of a directive.

    Args:
        argument: part of the line.
        line: the whole line.
        lookup: gives the value of a name.
    """
    if is_empty(argument):
        raise expected("a number", argument[0])
    last = next(index for index, token in enumerate(line) if token is argument[-1])
    return evaluate(argument, line[last + 1], lookup)


def expected(what: str, token: Token, hint: str | None = None) -> SourceError:
    """NP011: the error of a directive or macro that something else should stand here."""
    return lexer.expected("NP011", what, token, hint)


def grouped(argument: list[Token], is_register: Callable[[Token], bool]) -> list[Token]:
    """Put parentheses around an argument that is a sum or the like."""
    if len(argument) == 1 or argument[0].text in {"#", "["}:
        return argument
    if any(map(is_register, argument)):  # no sum but part of an address: [ARGUMENT]
        return argument
    if not any(token.kind is Kind.SIGN and token.text in OPERATORS for token in argument):
        return argument
    first, last = argument[0], argument[-1]
    opening = Token(Kind.SIGN, "(", first.line, first.column)
    closing = Token(Kind.SIGN, ")", last.line, last.column)
    return [opening, *argument, closing]


def substitute(tokens: list[Token], table: Mapping[str, list[Token]]) -> list[Token]:
    """Replace each parameter of a line, once: an argument is not searched again."""
    result: list[Token] = []
    for token in tokens:
        argument = table.get(token.text) if token.kind is Kind.NAME else None
        if argument is None:
            result.append(token)
        else:
            result.extend(argument)
    return result


def comma_hint(tokens: Sequence[Token]) -> str | None:
    """Return a hint if two values stand side by side."""
    values = (Kind.NAME, Kind.NUMBER, Kind.DOTTED, Kind.STRING)
    for left, right in pairwise(tokens):
        if right.kind in values and (left.kind in values or left.text == ")"):
            return "is a comma missing?"
    return None
