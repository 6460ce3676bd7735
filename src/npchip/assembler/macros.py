"""Macros: their definition, and the arguments of a use."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import NamedTuple

from npchip.assembler.arguments import comma_hint, expected, grouped, is_empty, single_name, split
from npchip.assembler.blocks import Node
from npchip.assembler.diagnostics import Note, SourceError, quoted
from npchip.assembler.lexer import Kind, Token


class Macro(NamedTuple):
    """A macro's definition."""

    name: Token
    parameters: tuple[str, ...]
    body: list[Node]

    def bind(
        self, tokens: list[Token], is_register: Callable[[Token], bool]
    ) -> dict[str, list[Token]]:
        """Return the argument for each parameter in a use of the macro.

        Raises:
            SourceError: NP012 more or fewer arguments than parameters, or an empty one.
        """
        arguments = split(tokens[1:])
        empty = next((item[0] for item in arguments if is_empty(item)), None)
        wanted = len(self.parameters)
        if len(arguments) != wanted or empty:
            listed = f" ({', '.join(self.parameters)})" if wanted else ""
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
    """Read the line that opens a macro.

    Args:
        tokens: the line.
        body: the lines of the macro.
        mnemonics: names of instructions, in capitals.

    Raises:
        SourceError: NP011 no name or no parameters, NP017 the name of an instruction, NP008 two
            parameters of one name.
    """
    name = tokens[1]
    if name.kind is not Kind.NAME:
        raise expected("a name for the macro", name)
    if name.text.upper() in mnemonics:
        message = f"{quoted(name.text)} is an instruction and cannot be a macro"
        raise SourceError("NP017", message, name.span)
    after = 3 if tokens[2].text == "," else 2  # a comma after the name is welcome
    parameters: list[str] = []
    for item in split(tokens[after:]):
        parameter = single_name(item, "the name of a parameter")
        if parameter.text in parameters:
            message = f"two parameters are called {quoted(parameter.text)}"
            raise SourceError("NP008", message, parameter.span)
        parameters.append(parameter.text)
    return Macro(name, tuple(parameters), body)
