"""Macros, and the arguments of macros and directives: a line's tokens, split at the commas."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from npchip.assembler import lexer
from npchip.assembler.blocks import Node
from npchip.assembler.diagnostics import Note, SourceError, quoted
from npchip.assembler.expressions import OPERATORS, Lookup, evaluate
from npchip.assembler.lexer import Kind, Token

_SHOWN = 20  # parameters in a message


class Macro(NamedTuple):
    """A macro's definition."""

    name: Token
    parameters: tuple[str, ...]
    body: list[Node]

    def bind(
        self, tokens: list[Token], is_register: Callable[[Token], bool]
    ) -> dict[str, list[Token]]:
        """Return the argument for each parameter in a line that uses the macro.

        Raises:
            SourceError: NP012 another number of arguments than of parameters, or an empty one.
        """
        arguments = split(tokens[1:])
        empty = next((item[0] for item in arguments if is_empty(item)), None)
        wanted = len(self.parameters)
        if len(arguments) != wanted or empty:
            shown = [*self.parameters[:_SHOWN], *["..."] * (wanted > _SHOWN)]
            listed = f" ({', '.join(shown)})" if wanted else ""
            raise SourceError(
                "NP012",
                f"macro {quoted(self.name.text)} takes {wanted or 'no'} "
                f"argument{'s' * (wanted != 1)}{listed}, "
                f"found {'an empty one' if empty else len(arguments) or 'none'}",
                empty.span if empty else tokens[0].span,
                Note(f"{quoted(self.name.text)} is defined here", self.name.span),
                suggestion=comma_hint(tokens[1:]) if len(arguments) < wanted else None,
            )
        return {
            parameter: grouped(argument, is_register)
            for parameter, argument in zip(self.parameters, arguments, strict=True)
        }


def read_macro(tokens: list[Token], body: list[Node], mnemonics: Collection[str]) -> Macro:
    """Return the macro that a ``.macro`` line defines.

    Args:
        tokens: the line.
        body: the lines of the macro.
        mnemonics: names of instructions, in capitals.

    Raises:
        SourceError: NP011 a name is missing or malformed, NP017 the name is an instruction, NP008
            two parameters have the same name.
    """
    name = tokens[1]
    if name.kind is not Kind.NAME:
        raise expected("a name for the macro", name)
    if name.text.upper() in mnemonics:
        message = f"{quoted(name.text)} is an instruction and cannot be a macro"
        raise SourceError("NP017", message, name.span)
    after = 3 if tokens[2].text == "," else 2  # a comma after the name is welcome
    parameters: dict[str, None] = {}
    for item in split(tokens[after:]):
        parameter = single_name(item, "the name of a parameter")
        if parameter.text in parameters:
            message = f"two parameters are called {quoted(parameter.text)}"
            raise SourceError("NP008", message, parameter.span)
        parameters[parameter.text] = None
    return Macro(name, tuple(parameters), body)


def split(tokens: Sequence[Token]) -> list[list[Token]]:
    """Return the arguments in the rest of a line, split at commas outside parentheses and brackets.

    An empty argument holds only the comma or line end after it, so that a message can point there.
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
    """Return whether an argument of `split` is empty."""
    return argument[0].ends or argument[0].text == ","


def single_name(argument: Sequence[Token], what: str = "a name") -> Token:
    """Return the name that an argument consists of; NP011 if it is anything else."""
    if argument[0].kind is not Kind.NAME:
        raise expected(what, argument[0])
    if len(argument) > 1:
        raise expected("a comma or the end of the line", argument[1])
    return argument[0]


def number(argument: Sequence[Token], line: Sequence[Token], lookup: Lookup) -> int:
    """Return the value of a directive's argument.

    Args:
        argument: the argument, a part of the line.
        line: the whole line.
        lookup: returns the value of a name.
    """
    if is_empty(argument):
        raise expected("a number", argument[0])
    last = next(index for index, token in enumerate(line) if token is argument[-1])
    return evaluate(argument, line[last + 1], lookup)


def expected(what: str, token: Token, hint: str | None = None) -> SourceError:
    """Make the error NP011 for a token of a directive or macro that expects something else."""
    return lexer.expected("NP011", what, token, hint)


def grouped(argument: list[Token], is_register: Callable[[Token], bool]) -> list[Token]:
    """Return an argument, an expression with operators in parentheses."""
    first, last = argument[0], argument[-1]
    if (
        len(argument) == 1
        or first.text in {"#", "["}
        or any(map(is_register, argument))  # no sum but part of an address: [ARGUMENT]
        or not any(token.kind is Kind.SIGN and token.text in OPERATORS for token in argument)
    ):
        return argument
    opening = Token(Kind.SIGN, "(", first.line, first.column)
    closing = Token(Kind.SIGN, ")", last.line, last.column)
    return [opening, *argument, closing]


def substitute(tokens: list[Token], table: Mapping[str, list[Token]]) -> list[Token]:
    """Return a line with each parameter replaced by its argument, which is not searched again."""
    result: list[Token] = []
    for token in tokens:
        is_parameter = token.kind is Kind.NAME and token.text in table
        result += table[token.text] if is_parameter else [token]
    return result


def comma_hint(tokens: Sequence[Token]) -> str | None:
    """Return a hint if two values follow each other without a comma."""
    values = (Kind.NAME, Kind.NUMBER, Kind.DOTTED, Kind.STRING)
    for left, right in pairwise(tokens):
        if right.kind in values and (left.kind in values or left.text == ")"):
            return "is a comma missing?"
    return None
